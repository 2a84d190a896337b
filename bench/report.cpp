// SPDX-License-Identifier: MIT
// Error against run time: of every method and tile size, what a frame pays and how many light evaluations it makes over
// those needed; and what the picture loses by where lights end. Writes report.csv, and report.page, which page.sh makes
// report.html of; prints a table with verdicts and a sentence for each scene.
//
// Columns of report.csv, a row for each scene (all its views together), method and tile size:
//   bounds_ms       median of reduce_depth() on the CPU, where the method takes Z bounds. Drawing the depth is not in it
//   build_ms        of the lists, lights in to lists out on one core, on rotating light sets
//   upload_ms       of copying what a shader reads of them, lights left out, to memory that it can read
//   shade_ms        evaluations of all pixels times evaluation_ns; a word of masks is AdviceCosts::word_evaluations of one
//   total_ms        these together, with the 10th and 90th percentile of the frames
//   evals, needed   light evaluations a drawn pixel, and of those lights that reach its point; ratio: of the two
//   words           of masks that a drawn pixel looks at
//   front           1 on the Pareto front: no other is both faster and nearer to what is needed
//   misses          lights that reach a pixel and are not in its list. For ours they end the run
// and a row for each place to end lights, `ends smooth` (cutoff.hpp), of 16-pixel tiles with `box`:
//   cutoff          in parts of white
//   rmse, rmse_restored   of the picture to that of endless lights, white = 1
#include "arguments.hpp"
#include "console.hpp"
#include "cutoff.hpp"
#include "glb_scenes.hpp"
#include "measure.hpp"
#include "needed.hpp"
#include "ways.hpp"

#include <lightbin/advise.hpp>

#include <cctype>
#include <cmath>
#include <cstddef>
#include <exception>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace {

bool quick = false;
double evaluation_ns = lightbin::AdviceCosts{}.evaluation_ns;

constexpr double as_good = 1.03;  ///< a cost up to this times the least counts as equally good

struct Case {
    std::string name;
    std::vector<BenchScene> views;
};

std::string words(const Way& way) {
    return text("%s at %d px", way.method, way.tile_size);
}

struct Result {
    Way way;
    double bounds, build, upload, shade;  ///< milliseconds for each frame
    double total, low, high;
    double evaluations, words, ratio, kilobytes;
    std::uint64_t misses;
    bool front = false;
};

double total_of(const Result& result) {
    return result.total;
}
/// As if Z bounds took no time.
double total_without_bounds(const Result& result) {
    return result.build + result.upload + result.shade;
}

struct Ending {
    double part, total, evaluations;
    Difference difference;
};

struct SceneReport {
    std::string name;
    std::size_t lights, views;
    double needed;
    std::string advice;
    std::vector<Result> results;
    std::vector<Ending> endings;

    /// Returns the result with the least cost among those that `wanted` accepts.
    template <class Wanted, class Cost = double (*)(const Result&)>
    const Result& best(Wanted wanted, Cost cost = total_of) const {
        const Result* least = nullptr;
        for (const Result& result : results)
            if (wanted(result.way) && (least == nullptr || cost(result) < cost(*least))) least = &result;
        return *least;
    }
};

bool ours(const Way& way) {
    return way.ours && !way.variant;
}
bool with_bounds(const Way& way) {
    return ours(way) && way.needs_bounds;
}
bool without_bounds(const Way& way) {
    return ours(way) && !way.needs_bounds;
}

/// A view of a scene in all tile sizes, and the lights that its pixels need.
struct PreparedView {
    SeenScene seen;
    Views tiled;
    Needed needed;

    explicit PreparedView(BenchScene scene)
        : seen(see(std::move(scene))), tiled(seen.scene, seen.picture),
          needed(seen, spots_of(seen.scene.light_set(0)), quick ? 3 : 1) {}
};

/// What was measured of one method at one tile size: milliseconds of each frame, and sums over the views.
struct Measured {
    std::vector<double> bounds, build, upload;
    double evaluations = 0, words = 0, bytes = 0;  ///< sums over all sampled pixels
    std::uint64_t misses = 0;
};

void count(const std::vector<PreparedView>& views, const Way& way, const std::string& scene,
           Measured& measured) {
    for (const PreparedView& view : views) {
        const TiledView& tiled = view.tiled.of(way.tile_size);
        const Built built = way.build(tiled, lights_of(view.seen.scene, way.form, 0));
        const auto width = static_cast<std::uint32_t>(view.seen.picture.size.width);
        const Reading reading =
            read_lists(tiled, view.seen.picture, built.masks ? MaskLists(built).built() : built, view.needed);
        measured.words += static_cast<double>(reading.words);
        measured.evaluations += static_cast<double>(reading.evaluations);
        measured.bytes += static_cast<double>(built.bytes) / static_cast<double>(views.size());
        measured.misses += reading.misses;
        if (way.ours && reading.misses > 0)
            throw std::runtime_error(text("%s: %s misses light %u in pixel %u, %u, and %llu more",
                                          scene.c_str(), words(way).c_str(), reading.light,
                                          reading.pixel % width, reading.pixel / width,
                                          static_cast<unsigned long long>(reading.misses - 1)));
    }
}

/// Returns the milliseconds that copying what a shader reads takes.
double upload_ms(const Built& built) {
    static std::vector<std::byte> memory;
    memory.resize(std::max(memory.size(), built.bytes));
    return 1e3 * seconds([&] {
               std::byte* to = memory.data();
               for (const auto bytes :
                    {std::as_bytes(built.ranges), std::as_bytes(built.ids), std::as_bytes(built.bins),
                     built.masks ? std::as_bytes(built.masks->words()) : std::span<const std::byte>()})
                   to = std::ranges::copy(bytes, to).out;
           });
}

/// Times all methods in turns, each turn with other lights.
void time(std::vector<PreparedView>& views, const std::vector<Way>& ways, std::vector<Measured>& measured) {
    for (std::uint32_t turn = 0; turn < (quick ? 12 : 100); ++turn) {
        PreparedView& view = views[turn % views.size()];
        std::map<Form, LightSet> sets;
        std::map<int, double> bounds;
        for (std::size_t i = 0; i < ways.size(); ++i) {
            // The method that comes first finds no lights in the cache, so the methods take turns in being first.
            const std::size_t place = (turn + i) % ways.size();
            const Way& way = ways[place];
            Measured& times = measured[place];
            if (turn % 4 != 0 && times.build.back() > 4) continue;
            TiledView& tiled = view.tiled.of(way.tile_size);
            if (!sets.contains(way.form)) sets[way.form] = lights_of(view.seen.scene, way.form, turn + 1);
            if (way.needs_bounds && !bounds.contains(way.tile_size))
                bounds[way.tile_size] = 1e3 * tiled.reduce(view.seen.picture);
            Built built;
            const double seconds_to_build = seconds([&] { built = way.build(tiled, sets[way.form]); });
            times.bounds.push_back(way.needs_bounds ? bounds[way.tile_size] : 0);
            times.build.push_back(1e3 * seconds_to_build);
            times.upload.push_back(upload_ms(built));
        }
    }
}

void mark_front(std::vector<Result>& results) {
    for (Result& result : results)
        result.front = !result.way.variant && std::ranges::none_of(results, [&](const Result& other) {
            return !other.way.variant && other.total <= result.total && other.ratio <= result.ratio &&
                   (other.total < result.total || other.ratio < result.ratio);
        });
}

/// "+12 %", of a total to a lesser one.
std::string more(const Result& a, const Result& b) {
    return text("%+.0f %%", 100 * (a.total / b.total - 1));
}

/// Returns the depth of the middle pixel of each block of 8 x 8.
std::vector<float> sampled(const Picture& picture) {
    std::vector<float> samples;
    const auto width = static_cast<std::size_t>(picture.size.width);
    for (std::size_t y = 4; y < static_cast<std::size_t>(picture.size.height); y += 8)
        for (std::size_t x = 4; x < width; x += 8)
            samples.push_back(picture.triangle[y * width + x] == Picture::nothing
                                  ? std::numeric_limits<float>::infinity()
                                  : picture.view_depth[y * width + x]);
    return samples;
}

/// Returns what advise() and advise_slices() recommend of the methods measured here, given the first view and the depth
/// of one pixel in 64, and how far that is from the best method.
std::string advice_of(const SceneReport& report, const PreparedView& view) {
    const Result &box = report.best([](const Way&way) { return way.method == std::string_view("box"); }),
                 &best = report.best(ours);
    const lightbin::AdviceCosts costs = {.evaluation_ns = evaluation_ns,
                                   .z_bounds_ns = 1e6 * box.bounds,
                                   .upload_byte_ns = 1e3 * box.upload / box.kilobytes};
    const TiledView &finest = view.tiled.of(8), &finest_clusters = view.tiled.of(16);
    const std::vector<float> samples = sampled(view.seen.picture);
    const lightbin::ImageSize size = view.seen.picture.size;
    std::vector<lightbin::AdvicePlan> plans;
    std::visit(
        [&](const auto& lights) {
            const lightbin::Advice tiles = *lightbin::advise(finest.view, lights, costs, finest.bounds()),
                                   slices = *lightbin::advise_slices(
                                       finest_clusters.view, lights,
                                       {.clusters = finest.clusters, .z_bins = finest.z_bins},
                                       {.depths = samples, .size = {size.width / 8, size.height / 8}}, costs);
            for (const lightbin::Advice* const advice : {&tiles, &slices})
                plans.insert(plans.end(), advice->plans().begin(), advice->plans().end());
        },
        view.seen.scene.light_set(0));
    const auto result_of = [&](const lightbin::AdvicePlan& plan) {
        return std::ranges::find_if(report.results, [&](const Result& r) {
            return ours(r.way) && plan.tiled && r.way.tile_size == plan.tile_size &&
                   r.way.depth_test == plan.depth_test && r.way.slicing == plan.slicing &&
                   r.way.masks == plan.masks && r.way.needs_bounds == plan.has_z_bounds();
        });
    };
    std::erase_if(plans, [&](const auto& plan) { return result_of(plan) == report.results.end(); });
    const lightbin::AdvicePlan plan = lightbin::Advice(plans).best();
    return "; advise(): " + to_string(plan) + ", " + more(*result_of(plan), best);
}

std::vector<Ending> study_endings(const PreparedView& view) {
    std::vector<Ending> endings;
    CutoffStudy study(view.seen.scene);
    if (!(study.white() > 0)) return endings;
    const TiledView& tiled = view.tiled.of(16);
    lightbin::Binner<lightbin::Options{.depth_test = true}> binner;
    for (int k = 4; k <= 1024; k *= quick ? 4 : 2) {
        std::vector<double> builds;
        for (std::uint32_t seed = 1; seed <= 5; ++seed) {
            const LightSet set = study.ended(view.seen.scene.light_set(seed), 1.0 / k);
            builds.push_back(seconds([&] { build(binner, tiled, set, tiled.bounds()); }));
        }
        const Built built =
            build(binner, tiled, study.ended(view.seen.scene.light_set(0), 1.0 / k), tiled.bounds());
        const double evaluations = tiled.evaluations(built.ranges),
                     shade = tiled.all_evaluations(built.ranges) * evaluation_ns * 1e-6,
                     total = 1e3 * (tiled.reduce_seconds + median(builds)) + upload_ms(built) + shade;
        endings.push_back({1.0 / k, total, evaluations, study.difference(1.0 / k)});
    }
    return endings;
}

SceneReport measure(Case scene) {
    SceneReport report = {scene.name, scene.views[0].lights(0).size(), scene.views.size(), 0, {}, {}, {}};
    const std::vector<Way> ways = Ways::all(static_cast<bool>(scene.views[0].spots));
    std::vector<PreparedView> views;
    for (BenchScene& view : scene.views)
        views.emplace_back(std::move(view));
    double pixels = 0, drawn = 0, needed = 0;
    for (const PreparedView& view : views) {
        pixels += static_cast<double>(view.needed.pixels().size());
        drawn += static_cast<double>(view.tiled.of(16).all_drawn) / static_cast<double>(views.size());
        needed += static_cast<double>(view.needed.evaluations());
    }
    if (needed == 0) throw std::runtime_error(scene.name + ": no light reaches a pixel in any of its views");
    report.needed = needed / pixels;

    std::vector<Measured> measured(ways.size());
    for (std::size_t i = 0; i < ways.size(); ++i)
        count(views, ways[i], scene.name, measured[i]);
    time(views, ways, measured);
    for (std::size_t i = 0; i < ways.size(); ++i) {
        const Measured& m = measured[i];
        const double evaluations = m.evaluations / pixels, words = m.words / pixels,
                     shade = (evaluations + words * lightbin::AdviceCosts{}.word_evaluations) * drawn *
                             evaluation_ns * 1e-6;
        std::vector<double> totals;
        for (std::size_t turn = 0; turn < m.build.size(); ++turn)
            totals.push_back(m.bounds[turn] + m.build[turn] + m.upload[turn] + shade);
        report.results.push_back({ways[i], median(m.bounds), median(m.build), median(m.upload), shade,
                                  median(totals), percentile(totals, 0.1), percentile(totals, 0.9),
                                  evaluations, words, m.evaluations / needed, m.bytes / 1e3, m.misses});
    }
    mark_front(report.results);
    report.advice = advice_of(report, views[0]);
    report.endings = study_endings(views[0]);
    return report;
}

void write_csv(const std::vector<SceneReport>& reports) {
    std::FILE* const csv = open_report(
        "report.csv",
        "scene,lights,views,method,tile_px,bounds_ms,build_ms,upload_ms,shade_ms,total_ms,total_p10_ms,"
        "total_p90_ms,evals,needed,ratio,kilobytes,front,misses,evaluation_ns,cutoff,rmse,rmse_restored,"
        "words");
    for (const SceneReport& report : reports) {
        for (const Result& r : report.results)
            std::fprintf(csv,
                         "%s,%zu,%zu,%s,%d,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.3f,%.3f,%.4f,%.1f,%d,%"
                         "llu,%g,,,,%.3f\n",
                         report.name.c_str(), report.lights, report.views, r.way.method, r.way.tile_size,
                         r.bounds, r.build, r.upload, r.shade, r.total, r.low, r.high, r.evaluations,
                         report.needed, r.ratio, r.kilobytes, r.front,
                         static_cast<unsigned long long>(r.misses), evaluation_ns, r.words);
        for (const Ending& e : report.endings)
            std::fprintf(csv, "%s,%zu,%zu,ends smooth,16,,,,,%.4f,,,%.3f,,,,,,%g,%.9g,%.5f,%.5f,\n",
                         report.name.c_str(), report.lights, report.views, e.total, e.evaluations,
                         evaluation_ns, e.part, e.difference.rmse, e.difference.rmse_restored);
    }
    std::fclose(csv);
}

/// The answer for one scene.
std::string sentence(const SceneReport& report) {
    const Result &best = report.best(ours), &bare = report.best(without_bounds);
    std::string s = report.name + ": " + words(best.way) +
                    text(", %.2f ms, %.2f times the evaluations needed; ", best.total, best.ratio);
    if (best.way.needs_bounds)
        s += "without Z bounds " + words(bare.way) + ", " + more(bare, best);
    else {
        const Result& bounded = report.best(with_bounds, total_without_bounds);
        const double worth = bare.total - total_without_bounds(bounded);
        if (bounded.way.needs_bounds && worth >= 0.005)
            s += words(bounded.way) +
                 text(" if Z bounds take under %.2f ms (%.2f here, on the CPU)", worth, bounded.bounds);
        else
            s += "Z bounds don't pay";
    }
    const auto whole = [](const Way& way) { return way.ours && way.form == Form::whole_spheres; };
    if (std::ranges::any_of(report.results, [&](const Result& r) { return whole(r.way); }))
        s += "; cones instead of whole spheres save " +
             text("%.0f %%", 100 * (1 - best.total / report.best(whole).total));
    for (const char* const masks : {"masks", "masks+z-bins"}) {
        const auto of = [&](const char* method) -> const Result& {
            return report.best([=](const Way& way) { return way.method == std::string_view(method); });
        };
        s += std::string("; ") + masks + " " + more(of(masks), of("plain")) + " to plain, " +
             more(of(masks), report.best([](const Way& way) { return without_bounds(way) && !way.masks; })) +
             " to the best lists without Z bounds";
    }
    return s + report.advice;
}

/// Returns at what brightness lights can end for an error of 1 %, with a smooth end and the mean loss added back.
std::string ending_sentence(const SceneReport& report) {
    const Ending* last = nullptr;
    for (const Ending& ending : report.endings) {
        last = &ending;
        if (ending.difference.rmse_restored <= 0.01) break;
    }
    const bool kept = last->difference.rmse_restored <= 0.01;
    return text(
        "%s white / %.0f: an RMSE of %.1f %% with the mean given back, %.0f light evaluations a pixel.",
        kept ? "Lights may end smoothly at" : "No smooth end keeps an RMSE of 1 %. At", 1 / last->part,
        100 * last->difference.rmse_restored, last->evaluations);
}

const TableRow row_head = {"method", "px", "frame", "at worst", "evaluations", "verdict"};

/// Asks in which scenes one of some methods, at its best tile size, costs as little as any.
struct Question {
    const char* verdict;
    bool (*wanted)(const Way&);
    double (*cost)(const Result&);
};
constexpr Question questions[] = {{"take it", ours, total_of},
                                  {"take it without Z bounds", without_bounds, total_of},
                                  {"take it where Z bounds cost nothing", ours, total_without_bounds}};

std::string verdict_of(const std::vector<SceneReport>& reports, const std::string& method) {
    const auto this_one = [&](const Way& way) { return way.method == method; };
    std::string in_some;
    for (const Question& question : questions) {
        if (!question.wanted(reports[0].best(this_one).way)) continue;
        std::vector<std::string> names;
        for (const SceneReport& report : reports)
            if (question.cost(report.best(this_one, question.cost)) <=
                question.cost(report.best(question.wanted, question.cost)) * as_good)
                names.push_back(report.name);
        if (2 * names.size() > reports.size())
            return text("%s: as good as any in %zu of %zu", question.verdict, names.size(), reports.size());
        if (names.empty() || !in_some.empty()) continue;
        in_some = question.verdict + std::string(" for ");
        for (std::size_t i = 0; i < names.size(); ++i)
            in_some.append(i == 0 ? "" : ", ").append(names[i]);
    }
    if (!in_some.empty()) return in_some;
    double least = HUGE_VAL;
    for (const SceneReport& report : reports)
        least = std::min(least, report.best(this_one).total / report.best(ours).total);
    return text("leave it out at %g ns: %.0f %% behind the best or more", evaluation_ns, 100 * (least - 1));
}

/// Returns a table row for a method over all scenes, at its best tile size in each.
TableRow row_of(const std::vector<SceneReport>& reports, const std::string& method) {
    const auto this_one = [&](const Way& way) { return way.method == method; };
    const bool alone = reports.size() == 1;
    std::map<int, int> tiles;
    std::vector<double> frames;
    std::string worst, most;
    double worst_frame = 0, least_ratio = HUGE_VAL, most_ratio = 0;
    for (const SceneReport& report : reports) {
        const Result& result = report.best(this_one);
        ++tiles[result.way.tile_size];
        frames.push_back(result.total / report.best(ours).total);
        if (frames.back() > worst_frame) worst_frame = frames.back(), worst = report.name;
        if (result.ratio > most_ratio) most_ratio = result.ratio, most = report.name;
        least_ratio = std::min(least_ratio, result.ratio);
    }
    const int tile = std::ranges::max_element(tiles, {}, [](const auto& t) { return t.second; })->first;
    return {method,
            std::to_string(tile),
            text("%.2f", median(frames)),
            alone ? "" : text("%.2f (%s)", worst_frame, worst.c_str()),
            alone ? text("%.2f", most_ratio)
                  : text("%.2f to %.2f (%s)", least_ratio, most_ratio, most.c_str()),
            reports[0].best(this_one).way.ours ? verdict_of(reports, method) : "as engines do it"};
}

std::vector<TableRow> table(const std::vector<SceneReport>& reports) {
    std::vector<TableRow> rows;
    for (const Result& result : reports[0].results)
        if (!result.way.variant && (rows.empty() || rows.back()[0] != result.way.method))
            rows.push_back(row_of(reports, result.way.method));
    return rows;
}

void print(const std::vector<SceneReport>& reports) {
    std::printf("\nframe: Z bounds, build, upload and light evaluations, over the best method's of each "
                "scene; median and\n"
                "worst. An evaluation takes %g ns. evaluations: over the lights that reach the pixel. As "
                "good: within %.0f %%.\n",
                evaluation_ns, 100 * (as_good - 1));
    std::vector<TableRow> rows = table(reports);
    rows.insert(rows.begin(), row_head);
    print_table(rows);
    std::puts("");
    for (const SceneReport& report : reports)
        std::puts(sentence(report).c_str());
}

void write_page(const std::vector<SceneReport>& reports) {
    std::FILE* const page = open_report("report.page", "# Error against run time");
    const auto line = [&](const std::string& words) { std::fprintf(page, "%s\n", words.c_str()); };
    const auto row = [&](const auto& cells) {
        std::string words = "|";
        for (const auto& cell : cells)
            words.append(" ").append(cell).append(" |");
        line(words);
    };
    line(text("What a frame of %dx%d pixels pays for its lists and lights, and how many light evaluations it "
              "makes over those needed: %g ns an evaluation, one core builds (`%s`).",
              screen.width, screen.height, evaluation_ns, to_string(lightbin::machine_isa())));
    const std::vector<TableRow> rows = table(reports);
    for (const Question& question : questions)
        for (const TableRow& cells : rows)
            if (cells.back().starts_with(std::string(question.verdict) + ":"))
                line("> " + cells[0] + ": " + cells.back());
    for (const SceneReport& report : reports)
        line("- " + sentence(report));
    line("\n## Methods\nEach at its best tile size: a frame's time over the best of its scene, median and "
         "worst, "
         "and light evaluations over those needed, from the least to the greatest.\n");
    row(row_head);
    for (const TableRow& cells : rows)
        row(cells);
    line("\n## What an evaluation costs\nThe best method by what a light evaluation takes: about .005 to .05 "
         "ns "
         "on a GPU, 1 ns on a core.\n");
    constexpr double costs[] = {0.005, 0.02, 0.05, 0.2, 1};
    std::vector<std::string> cells = {"scene"};
    for (const double ns : costs)
        cells.push_back(text("%.3g ns", ns));
    row(cells);
    for (const SceneReport& report : reports) {
        cells = {report.name};
        for (const double ns : costs)
            cells.push_back(words(
                report
                    .best(ours, [&](const Result& r) { return r.total + r.shade * (ns / evaluation_ns - 1); })
                    .way));
        row(cells);
    }
    for (const SceneReport& report : reports) {
        line("\n## " + report.name +
             text("\n%zu lights, %zu view%s; %.2f evaluations a pixel are needed.\n", report.lights,
                  report.views, report.views > 1 ? "s" : "", report.needed));
        line("![Each method by tile size. Bars: 10th to 90th percentile of frames. Thick: the Pareto front.]"
             "(report.gp methods " +
             report.name + ")");
        if (report.endings.empty()) continue;
        line("![What the picture loses where lights end at white / 4 to white / 1024.](report.gp endings " +
             report.name + ")");
        line(ending_sentence(report));
    }
    std::fclose(page);
}

std::vector<Case> made_scenes() {
    std::vector<Case> all;
    for (BenchScene& scene :
         std::vector{scenes::field_with_depth(), scenes::top_down(), scenes::street(), scenes::corridor(),
                     scenes::foliage(), scenes::street_lamps(), scenes::stage(), scenes::car_park()}) {
        const std::string name = scene.name;
        all.push_back({name, {std::move(scene)}});
    }
    return all;
}

}  // namespace

int main(int argc, char** argv) try {
    Arguments arguments(argc, argv);
    quick = arguments.take("--quick");
    const std::string given = arguments.take("--evaluation-ns", "");
    if (!given.empty()) evaluation_ns = std::strtod(given.c_str(), nullptr);
    if (!(evaluation_ns > 0)) throw std::runtime_error("--evaluation-ns must be a number greater than 0");

    std::vector<Case> all;
    if (arguments.scenes().empty()) all = made_scenes();
    for (const std::string& path : arguments.scenes_or_fixtures()) {
        std::vector<BenchScene> views = glb_scenes(path), some;
        if (views[0].lights(0).empty()) throw std::runtime_error(path + ": has no lights");
        std::string name = views[0].name.substr(0, views[0].name.find(':'));
        for (char& c : name)  // it goes to CSV and to a shell
            if (std::string_view("-_.").find(c) == std::string_view::npos &&
                !std::isalnum(static_cast<unsigned char>(c)))
                c = '_';
        while (std::ranges::any_of(all, [&](const Case& other) { return other.name == name; }))
            name += '_';
        const std::size_t most = quick ? 2 : 4, step = (views.size() + most - 1) / most;
        for (std::size_t i = 0; i < views.size(); i += step)
            some.push_back(std::move(views[i]));
        all.push_back({name, std::move(some)});
    }
    std::vector<SceneReport> reports;
    for (Progress progress; Case & scene : all) {
        progress(text("%zu of %zu: %s", reports.size() + 1, all.size(), scene.name.c_str()));
        reports.push_back(measure(std::move(scene)));
    }
    write_csv(reports);
    write_page(reports);
    print(reports);
} catch (const std::exception& problem) {
    std::fprintf(stderr, "report: %s\n", problem.what());
    return EXIT_FAILURE;
}
