// SPDX-License-Identifier: MIT
// Is advise() right? For each scene every plan is measured (build time on rotating light sets, evaluations of
// the first one counted over the drawn pixels), and what the chosen one costs is held against the cheapest with the same
// ids: with Z bounds; without any against those that need none, told how much of the picture is drawn; and of
// advise_slices() against those with slices, too. They see the first light set alone, advise_slices() the depth of one
// pixel in 64.
//
// advise.csv has a row for each scene and cost of an evaluation: the choice, the best plan, and the regret, their ratio: as
// swept, and, where that is over the limit, of the two timed again by themselves.
#include "arguments.hpp"
#include "built.hpp"
#include "console.hpp"
#include "glb_scenes.hpp"

#include <lightbin/advise.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <exception>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace {

using lightbin::IdWidth;
using lightbin::Isa;
using lightbin::Plan;
using lightbin::Slicing;

constexpr int tile_sizes[] = {8, 16, 32, 64, screen.width};
constexpr double evaluation_costs[] = {0.005, 0.02, 0.05, 0.2, 1};  ///< ns
constexpr double limit = 1.05;
std::size_t turns = 15;

/// A plan and how to build it.
struct Candidate {
    Plan plan;
    IdWidth ids;
    BuildLists build;
    double build_us = 0, evaluations = 0;

    double total_us(double evaluation_ns) const { return build_us + evaluations * evaluation_ns * 1e-3; }
};

/// Every method and tile size: with narrow ids, as advise() is asked, and as advise_slices() is, with wide ones.
template <Isa isa> std::vector<Candidate> candidates() {
    std::vector<Candidate> all;
    const auto add = [&]<lightbin::Options options> {
        for (const int tile_size : tile_sizes)
            all.push_back({.plan = {.depth_test = options.depth_test,
                                    .slicing = options.slicing,
                                    .tile_size = tile_size},
                           .ids = options.ids,
                           .build = builder<options>()});
    };
    const auto add_method = [&]<bool depth_test> {
        constexpr auto with = [](IdWidth ids, Slicing slicing) {
            return lightbin::Options{.ids = ids, .depth_test = depth_test, .slicing = slicing, .isa = isa};
        };
        add.template operator()<with(IdWidth::u16, Slicing::none)>();
        add.template operator()<with(IdWidth::u32, Slicing::clusters)>();
        if constexpr (!depth_test) {
            add.template operator()<with(IdWidth::u32, Slicing::none)>();
            add.template operator()<with(IdWidth::u32, Slicing::z_bins)>();
        }
    };
    add_method.template operator()<false>();
    add_method.template operator()<true>();
    return all;
}

/// This thread's own time: what else runs on the machine is no plan's cost.
struct ThreadClock {
    using duration = std::chrono::nanoseconds;
    using time_point = std::chrono::time_point<ThreadClock>;

    static time_point now() {
        std::timespec time;
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return time_point(std::chrono::seconds(time.tv_sec) + duration(time.tv_nsec));
    }
};

template <class Work> double own_seconds(Work work) {
    const ThreadClock::time_point start = ThreadClock::now();
    work();
    return std::chrono::duration<double>(ThreadClock::now() - start).count();
}

/// Times all candidates in turns, each turn with another light set.
void time(std::vector<Candidate>& candidates, const Views& views, std::span<const LightSet> sets,
          std::size_t turn_count) {
    std::vector<std::vector<double>> times(candidates.size());
    std::vector<int> together(candidates.size(), 1);  // builds too short for the clock
    for (std::size_t turn = 0; turn < turn_count + 1; ++turn)
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            if (!candidates[i].plan.tiled) continue;
            const TiledView& view = views.of(candidates[i].plan.tile_size);
            const auto build = [&] {
                for (int again = 0; again < together[i]; ++again)
                    candidates[i].build(view, sets[turn % sets.size()]);
            };
            if (turn > 0) {
                times[i].push_back(own_seconds(build) / together[i]);
                continue;
            }
            build();  // finds no memory
            const double time = std::min({own_seconds(build), own_seconds(build), own_seconds(build)});
            together[i] = static_cast<int>(std::clamp(100e-6 / time, 1.0, 64.0));
        }
    for (std::size_t i = 0; i < candidates.size(); ++i)
        if (candidates[i].plan.tiled) candidates[i].build_us = 1e6 * median(times[i]);
}

std::string words(const Plan& plan, IdWidth ids) {
    if (!plan.tiled) return "no tiling";
    const std::string slicing =
        plan.slicing == Slicing::none ? "" : std::string(" ") + to_string(plan.slicing);
    return std::to_string(plan.tile_size) + " px " + (plan.depth_test ? "box" : "none") + slicing + " " +
           to_string(ids);
}

/// What is known of depth.
enum class Known { bounds, nothing, samples };
constexpr const char* known_names[] = {"both", "none", "samples"};

/// The ids of the plans that are asked for.
IdWidth ids_of(Known known) {
    return known == Known::samples ? IdWidth::u32 : IdWidth::u16;
}

/// Whether a plan is within what is asked.
bool allowed(Known known, const Candidate& candidate) {
    if (candidate.ids != ids_of(known)) return false;
    if (known == Known::bounds) return candidate.plan.slicing == Slicing::none;
    const bool needs_bounds =
        candidate.plan.depth_test && candidate.plan.slicing != Slicing::clusters;
    return !needs_bounds && (known == Known::samples || candidate.plan.slicing == Slicing::none);
}

/// The depth of the middle pixel of each 8 x 8.
std::vector<float> sampled(const Picture& picture) {
    std::vector<float> samples;
    const std::size_t width = static_cast<std::size_t>(picture.size.width);
    for (std::size_t y = 4; y < static_cast<std::size_t>(picture.size.height); y += 8)
        for (std::size_t x = 4; x < width; x += 8)
            samples.push_back(picture.triangle[y * width + x] == Picture::nothing
                                  ? std::numeric_limits<float>::infinity()
                                  : picture.view_depth[y * width + x]);
    return samples;
}

/// What one choice cost over the best.
struct Regret {
    double regret;
    std::string scene;
    Known known;
    double cost;  ///< ns an evaluation
    std::string choice, best;
};

struct Report {
    std::FILE* csv;
    std::vector<Regret> regrets;
    std::vector<double> asking;  ///< over the plain build at the view's tile size
};

template <Isa isa>
lightbin::Advice ask(const TiledView& view, const Picture& picture, const Lights& lights, double cost,
                     Known known) {
    lightbin::Costs costs = {.evaluation_ns = cost};
    if (known == Known::samples) {
        const std::vector<float> samples = sampled(picture);
        return *lightbin::advise_slices<lightbin::Options{.isa = isa}, ThreadClock>(
            view.view, lights, {.clusters = view.clusters, .z_bins = view.z_bins},
            {.depths = samples, .size = {picture.size.width / 8, picture.size.height / 8}}, costs);
    }
    const lightbin::ZBounds bounds = known == Known::bounds ? view.bounds() : lightbin::ZBounds{};
    if (known == Known::nothing)
        costs.evaluation_ns *= static_cast<double>(view.all_drawn) / (1.0 * screen.width * screen.height);
    return *lightbin::advise<lightbin::Options{.ids = IdWidth::u16, .isa = isa}, ThreadClock>(
        view.view, lights, costs, bounds);
}

template <Isa isa> void judge(const BenchScene& scene, Report& report) {
    const Picture picture = rasterise(scene, screen);
    const Views views(scene, picture);
    std::vector<LightSet> sets;
    for (std::uint32_t seed = 0; seed < turns; ++seed)
        sets.push_back(scene.lights(seed));

    std::vector<Candidate> sweep = candidates<isa>();
    time(sweep, views, sets, turns);
    for (Candidate& candidate : sweep) {
        const TiledView& view = views.of(candidate.plan.tile_size);
        candidate.evaluations = all_evaluations(view, picture, candidate.build(view, sets[0]));
    }
    const Lights& lights = std::get<Lights>(sets[0]);
    const std::vector<lightbin::ListRange> one(1, {0, static_cast<std::uint32_t>(lights.size())});
    for (const IdWidth ids : {IdWidth::u16, IdWidth::u32})
        sweep.push_back({{.tiled = false}, ids, {}, 0, views.of(screen.width).all_evaluations(one)});
    const auto measured = [&](const Plan& plan, IdWidth ids) -> const Candidate& {
        const auto found = std::ranges::find_if(sweep, [&](const Candidate& c) {
            return c.ids == ids && words(c.plan, c.ids) == words(plan, ids);
        });
        if (found == sweep.end())
            std::fprintf(stderr, "advise: no such plan: %s\n", words(plan, ids).c_str()), std::abort();
        return *found;
    };

    const TiledView& finest = views.of(tile_sizes[0]);
    const Plan plain = {.tile_size = tile_sizes[0]};
    const double plain_us = measured(plain, IdWidth::u16).build_us;
    for (const Known known : {Known::bounds, Known::nothing, Known::samples})
        for (const double cost : evaluation_costs) {
            const double start = time_now();
            const lightbin::Advice advice = ask<isa>(finest, picture, lights, cost, known);
            const double asking = 1e6 * (time_now() - start) / plain_us;
            report.asking.push_back(asking);
            const Candidate& choice = measured(advice.best(), ids_of(known));
            const Candidate& best = *std::ranges::min_element(sweep, {}, [&](const Candidate& candidate) {
                return allowed(known, candidate) ? candidate.total_us(cost) : HUGE_VAL;
            });
            const double swept = choice.total_us(cost) / best.total_us(cost);
            double regret = swept;
            if (swept > limit) {  // the least of dozens of times is one that came out too short
                std::vector<Candidate> two = {choice, best};
                time(two, views, sets, 5 * turns);
                regret = two[0].total_us(cost) / two[1].total_us(cost);
            }
            const std::string chosen = words(choice.plan, choice.ids), cheapest = words(best.plan, best.ids);
            report.regrets.push_back({regret, scene.name, known, cost, chosen, cheapest});
            std::fprintf(report.csv, "%s,%s,%g,%s,%.2f,%s,%.2f,%.4f,%.4f,%.1f\n", scene.name.c_str(),
                         known_names[static_cast<int>(known)], cost, chosen.c_str(), choice.total_us(cost),
                         cheapest.c_str(), best.total_us(cost), swept, regret, asking);
        }
}

void print(const Report& report) {
    constexpr const char* asked[] = {"advise() with Z bounds", "advise() without", "advise_slices()"};
    const auto within = [](const std::vector<Regret>& regrets) {
        return text("%td of %zu",
                    std::ranges::count_if(regrets, [](const Regret& r) { return r.regret <= limit; }),
                    regrets.size());
    };
    std::vector<TableRow> table = {{"asked", text("within %.2f", limit), "median", "worst", "scene", "ns",
                                    "choice there", "best there"}};
    for (const Known known : {Known::bounds, Known::nothing, Known::samples}) {
        std::vector<Regret> its = report.regrets;
        std::erase_if(its, [&](const Regret& r) { return r.known != known; });
        std::ranges::sort(its, {}, &Regret::regret);
        const Regret& worst = its.back();
        table.push_back({asked[static_cast<int>(known)], within(its),
                         text("%.3f", its[its.size() / 2].regret), text("%.3f", worst.regret), worst.scene,
                         text("%g", worst.cost), worst.choice, worst.best});
    }
    std::puts("What the chosen plan costs over the best of the sweep\n");
    print_table(table);
    const Regret& worst = *std::ranges::max_element(report.regrets, {}, &Regret::regret);
    conclude({within(report.regrets) +
                  text(" choices cost at most %.2f times the best, the worst %.3f (", limit, worst.regret) +
                  worst.scene + text(", %g ns an evaluation).", worst.cost),
              text("Asking takes as long as %.0f plain builds in the median, %.0f at worst.",
                   median(report.asking), *std::ranges::max_element(report.asking))},
             {"advise.csv"});
}

/// Calls visit.operator()<isa>() for one of the instruction sets with a build model.
template <class Visit> void with_isa(Isa isa, Visit visit) {
    switch (isa) {
    case Isa::avx512:
        return visit.template operator()<Isa::avx512>();
    case Isa::avx2:
        return visit.template operator()<Isa::avx2>();
    case Isa::simd128:
        return visit.template operator()<Isa::simd128>();
    default:
        return visit.template operator()<Isa::scalar>();
    }
}

}  // namespace

int main(int argc, char** argv) try {
    Arguments arguments(argc, argv);
    if (arguments.take("--quick")) turns = 5;
    Isa isa = lightbin::machine_isa();
    for (const Isa named : {Isa::scalar, Isa::simd128, Isa::avx2})
        if (arguments.take(std::string("--") + to_string(named))) isa = lightbin::machine_isa(named);

    std::vector<BenchScene> all = scene_kinds();
    for (const std::string& file : arguments.scenes_or_fixtures())
        for (BenchScene& scene : glb_scenes(file))
            all.push_back(std::move(scene));
    Report report = {.csv =
                         open_report("advise.csv", "scene,bounds,evaluation_ns,choice,choice_us,best,best_us,"
                                                   "swept_regret,regret,asking"),
                     .regrets = {},
                     .asking = {}};
    for (Progress progress; const BenchScene& scene : all) {
        progress(scene.name);
        with_isa(isa, [&]<Isa tier> { judge<tier>(scene, report); });
    }
    print(report);
    std::fclose(report.csv);
} catch (const std::exception& problem) {
    std::fprintf(stderr, "advise: %s\n", problem.what());
    return EXIT_FAILURE;
}
