// SPDX-License-Identifier: MIT
// Leaving out: what each part costs and saves, by kind of scene. Every row is one change against an earlier
// row. Writes ablation.csv, and says of each part in how many scenes it saves time where an evaluation takes what
// lightbin::Costs takes for one, about a GPU's.
//
// Columns: us: median time of a build on rotating light sets; evals: light evaluations a drawn pixel;
// bytes: of what a shader reads beside the lights; us_more, evals_less: against the row named; pays_ns: what one light
// evaluation must cost, in nanoseconds of the same clock, for the change to save time as a whole;
// z_bounds_us: what reduce_depth takes here for these tiles, in no other column (a GPU makes them where the
// depth buffer lies).
#include "arguments.hpp"
#include "built.hpp"
#include "console.hpp"
#include "glb_scenes.hpp"
#include "ladder.hpp"

#include <lightbin/advise.hpp>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <exception>
#include <functional>
#include <memory>

namespace {

/// What spots are handed over as.
enum class Form { spots, least_spheres, whole_spheres };

/// One way to bin, and the row that it is compared with.
struct Part {
    const char* name;
    int against;
    int tile_size;
    std::function<Built(const TiledView&, const LightSet&)> build;
    Form form = Form::spots;

    /// Whether there is a difference to the row that it is compared with.
    bool says_something_of(const BenchScene& scene) const { return form == Form::spots || scene.spots; }

    LightSet lights(const BenchScene& scene, std::uint32_t seed) const {
        if (form == Form::spots) return scene.light_set(seed);
        return form == Form::whole_spheres ? scene.lights(seed) : least_spheres(scene.spots(seed));
    }
};

enum class Bounds { none, max, both };

template <lightbin::Options options>
auto build_with(Bounds sides, std::shared_ptr<tbb::task_arena> threads = nullptr) {
    auto binner = std::make_shared<lightbin::Binner<options>>();
    return [=](const TiledView& view, const LightSet& lights) {
        const auto loop = [&](std::size_t n, const auto& body) {
            threads->execute([&] { tbb::parallel_for(std::size_t{0}, n, body); });
        };
        const lightbin::Parallel parallel =
            threads == nullptr
                ? lightbin::Parallel()
                : lightbin::Parallel(static_cast<std::size_t>(threads->max_concurrency()), loop);
        lightbin::ZBounds bounds = view.bounds();
        if (sides == Bounds::max) bounds = {.min = {}, .max = bounds.max};
        return build<options>(*binner, view, lights, bounds, parallel);
    };
}

std::vector<Part> parts() {
    using lightbin::IdWidth, lightbin::Options, lightbin::Slicing;
    constexpr Options plain, interval = {.depth_test = DepthTest::interval},
                             box = {.depth_test = DepthTest::box},
                             split_box = {.depth_test = DepthTest::split_box},
                             narrow = {.ids = IdWidth::u16, .depth_test = DepthTest::box},
                             outline = {.footprint = Footprint::silhouette},
                             outline_box = {.footprint = Footprint::silhouette, .depth_test = DepthTest::box},
                             z_bins = {.slicing = Slicing::z_bins}, clusters = {.slicing = Slicing::clusters},
                             cluster_boxes = {.depth_test = DepthTest::box, .slicing = Slicing::clusters};
    const auto two = std::make_shared<tbb::task_arena>(2);
    enum {
        everything,
        tiles,
        interval_both = 4,
        box_both = 5,
        clusters_none = 16,
        clusters_box
    };  // places in the list
    return {
        {"no tiling", everything, 0, nullptr},
        {"16 px tiles, rectangles, no Z", everything, 16, build_with<plain>(Bounds::none)},
        {"silhouettes, no Z", tiles, 16, build_with<outline>(Bounds::none)},
        {"Z maximum alone, interval", tiles, 16, build_with<interval>(Bounds::max)},
        {"Z minimum and maximum, interval", tiles, 16, build_with<interval>(Bounds::both)},
        {"box", interval_both, 16, build_with<box>(Bounds::both)},
        {"box with Z maximum alone", box_both, 16, build_with<box>(Bounds::max)},
        {"split_box", box_both, 16, build_with<split_box>(Bounds::both)},
        {"box with silhouettes", box_both, 16, build_with<outline_box>(Bounds::both)},
        {"16-bit ids", box_both, 16, build_with<narrow>(Bounds::both)},
        {"8 px tiles", box_both, 8, build_with<box>(Bounds::both)},
        {"32 px tiles", box_both, 32, build_with<box>(Bounds::both)},
        {"64 px tiles", box_both, 64, build_with<box>(Bounds::both)},
        {"2 threads", box_both, 16, build_with<box>(Bounds::both, two)},
        {"2 threads, no Z", tiles, 16, build_with<plain>(Bounds::none, two)},
        {"1,024 z-bins, no Z", tiles, 16, build_with<z_bins>(Bounds::none)},
        {"64 px tiles in 24 slices, no Z", tiles, 64, build_with<clusters>(Bounds::none)},
        {"the same with boxes", clusters_none, 64, build_with<cluster_boxes>(Bounds::none)},
        {"no Z, spots as their least spheres", tiles, 16, build_with<plain>(Bounds::none),
         Form::least_spheres},
        {"no Z, spots as whole spheres", tiles, 16, build_with<plain>(Bounds::none), Form::whole_spheres},
        {"box, spots as their least spheres", box_both, 16, build_with<box>(Bounds::both),
         Form::least_spheres},
        {"box, spots as whole spheres", box_both, 16, build_with<box>(Bounds::both), Form::whole_spheres},
        {"slices with boxes, spots as their least spheres", clusters_box, 64,
         build_with<cluster_boxes>(Bounds::none), Form::least_spheres},
        {"slices with boxes, spots as whole spheres", clusters_box, 64,
         build_with<cluster_boxes>(Bounds::none), Form::whole_spheres},
    };
}

struct Measured {
    double us = 0, evaluations = 0, z_bounds_us = 0;
    std::size_t bytes = 0;
};

std::vector<Measured> measure(const std::vector<Part>& parts, const BenchScene& scene, const Picture& picture,
                              bool quick) {
    const Views views(scene, picture);
    const std::size_t lights = scene.lights(0).size();
    std::vector<Measured> result(parts.size());
    result[0].evaluations = static_cast<double>(lights);
    std::vector<std::size_t> measured;
    for (std::size_t i = 1; i < parts.size(); ++i) {
        if (!parts[i].says_something_of(scene)) continue;
        measured.push_back(i);
        const TiledView& view = views.of(parts[i].tile_size);
        const Built built = parts[i].build(view, parts[i].lights(scene, 0));
        result[i].evaluations = all_evaluations(view, picture, built) / static_cast<double>(view.all_drawn);
        result[i].bytes = built.bytes;
        result[i].z_bounds_us = 1e6 * view.reduce_seconds;
    }

    const std::size_t turns = quick ? 12 : std::min<std::size_t>(rotation(lights), 200);
    std::vector<std::vector<double>> times(parts.size());
    for (std::size_t turn = 1; turn <= turns; ++turn)
        for (const std::size_t i : measured) {
            const LightSet set = parts[i].lights(scene, static_cast<std::uint32_t>(turn));
            times[i].push_back(seconds([&] { parts[i].build(views.of(parts[i].tile_size), set); }));
        }
    for (const std::size_t i : measured)
        result[i].us = 1e6 * median(times[i]);
    return result;
}

/// What one light evaluation must cost for a change to be worth having, in nanoseconds of the same clock.
std::string pays(double us_more, double evaluations_less, double pixels) {
    if (us_more <= 0 && evaluations_less >= 0) return "always";
    if (us_more >= 0 && evaluations_less <= 0) return "never";
    char text[40];
    std::snprintf(text, sizeof text, "%s %.5f", evaluations_less > 0 ? "over" : "under",
                  1e3 * us_more / (evaluations_less * pixels));
    return text;
}

/// What a change gives in one scene.
struct Change {
    const Part* part;
    std::string scene;
    double us_more, evaluations_kept;  ///< kept: 1 where it changes nothing
    double us_saved;                   ///< of a frame
};

const char* against(const std::vector<Part>& parts, const Part& part) {
    return &part == &parts[0] ? "" : parts[static_cast<std::size_t>(part.against)].name;
}

/// A row a part, over the scenes in which it says something.
TableRow row_of(const std::vector<Part>& parts, const Part& part, const std::vector<Change>& its) {
    std::vector<double> more, kept;
    for (const Change& change : its)
        more.push_back(change.us_more), kept.push_back(change.evaluations_kept);
    const auto [worst, best] = std::ranges::minmax_element(its, {}, &Change::us_saved);
    const auto in = [](const Change& change) {
        return text("%+.0f us (%s)", change.us_saved, change.scene.c_str());
    };
    return {part.name,
            against(parts, part),
            text("%+.0f", median(more)),
            text("%.2f", median(kept)),
            text("%td of %zu", std::ranges::count_if(its, [](const Change& c) { return c.us_saved > 0; }),
                 its.size()),
            in(*best),
            in(*worst)};
}

void print(const std::vector<Part>& parts, const std::vector<Change>& changes, double z_bounds_us) {
    const double ns = lightbin::Costs{}.evaluation_ns;
    std::printf("Against another part: us that a build takes longer and light evaluations times as many, "
                "medians of the "
                "scenes;\nwhere it saves time at %g ns an evaluation, and how much at best and at worst\n\n",
                ns);
    std::vector<TableRow> table = {{"part", "against", "us", "evals", "saves in", "at best", "at worst"}};
    std::vector<std::string> kinds[3];
    for (const Part& part : parts) {
        std::vector<Change> its = changes;
        std::erase_if(its, [&](const Change& change) { return change.part != &part; });
        if (its.empty()) continue;
        table.push_back(row_of(parts, part, its));
        if (part.form != Form::spots) continue;
        const auto saves = std::ranges::count_if(its, [](const Change& c) { return c.us_saved > 0; });
        kinds[2 * saves > std::ssize(its) ? 0 : 4 * saves > std::ssize(its) ? 1 : 2].push_back(part.name);
    }
    print_table(table);
    const auto names = [](const std::vector<std::string>& some) {
        std::string all;
        for (const std::string& part : some)
            all += (all.empty() ? "" : "; ") + part;
        return all.empty() ? std::string("nothing") : all;
    };
    std::vector<std::string> verdict = {
        "Saves time in most scenes: " + names(kinds[0]) + ".",
        "In a quarter or fewer: " + names(kinds[2]) + ".",
        text("Making Z bounds of 16-pixel tiles here takes %.0f us in the median, which is in no row.",
             z_bounds_us)};
    std::vector<double> lost;
    for (const Change& change : changes)
        if (change.part->form != Form::spots) lost.push_back(-change.us_saved);
    if (!lost.empty())
        verdict.push_back(text("Spots handed over as spheres lose %.0f us in the median, %.0f to %.0f.",
                               median(lost), percentile(lost, 0), percentile(lost, 1)));
    conclude(verdict, {"ablation.csv"});
}

}  // namespace

int main(int argc, char** argv) try {
    Arguments arguments(argc, argv);
    const bool quick = arguments.take("--quick");
    std::vector<BenchScene> scenes = scene_kinds();
    for (const std::string& path : arguments.scenes())
        scenes.push_back(glb_scenes(path).front());

    std::FILE* const csv = open_report(
        "ablation.csv",
        "scene,lights,part,against,tile_px,us,evals,bytes,us_more,evals_less,pays_ns,z_bounds_us");
    const std::vector<Part> all = parts();
    std::vector<Change> changes;
    std::vector<double> z_bounds;
    for (Progress progress; const BenchScene& scene : scenes) {
        progress(scene.name);
        const Picture picture = rasterise(scene, screen);
        const double pixels = static_cast<double>(
            std::count_if(picture.triangle.begin(), picture.triangle.end(),
                          [](std::uint32_t triangle) { return triangle != Picture::nothing; }));
        const std::vector<Measured> measured = measure(all, scene, picture, quick);
        z_bounds.push_back(measured[1].z_bounds_us);
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (!all[i].says_something_of(scene)) continue;
            const Measured &now = measured[i], &before = measured[static_cast<std::size_t>(all[i].against)];
            const double more = now.us - before.us, less = before.evaluations - now.evaluations;
            std::fprintf(csv, "%s,%zu,\"%s\",\"%s\",%d,%.1f,%.3f,%zu,%.1f,%.3f,%s,%.0f\n", scene.name.c_str(),
                         scene.lights(0).size(), all[i].name,
                         all[static_cast<std::size_t>(all[i].against)].name, all[i].tile_size, now.us,
                         now.evaluations, now.bytes, more, less, pays(more, less, pixels).c_str(),
                         now.z_bounds_us);
            if (i > 0)
                changes.push_back({&all[i], scene.name, more, now.evaluations / before.evaluations,
                                   less * pixels * lightbin::Costs{}.evaluation_ns * 1e-3 - more});
        }
    }
    std::fclose(csv);
    print(all, changes, median(z_bounds));
} catch (const std::exception& problem) {
    std::fprintf(stderr, "ablation: %s\n", problem.what());
    return EXIT_FAILURE;
}
