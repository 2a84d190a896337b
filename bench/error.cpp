// SPDX-License-Identifier: MIT
// What each rung of the ladder lists beyond the exact set, and whether it misses any of it: every pair of a tile and a light
// decided in exact arithmetic. Writes error.csv, and cluster_error.csv: the same of clusters.
//
// Columns of the first, a row for each scene (all views of it together), tile size and rung:
//   misses          entries that the rung must have and lacks, in `verdicts` pairs of a tile and a light: every pair there
//                   is (by_rationals: questions left to the rationals; open: such about spots that no certificate was found
//                   for)
//   exact           pairs whose light meets the tile's cell between its Z bounds, its gap left out
//   excess          entries / exact - 1
//   margin          entries / entries of the same rung in exact arithmetic: what rounding outward adds; for
//                   silhouettes, also what keeping some lights' rectangles adds. Not where there are spots
#include "arguments.hpp"
#include "cluster_error.hpp"
#include "console.hpp"
#include "exact_pairs.hpp"
#include "glb_scenes.hpp"
#include "ladder.hpp"
#include "tiled_view.hpp"

#include <cmath>
#include <exception>

namespace {

struct Case {
    std::string name;
    std::vector<SeenScene> views;
};

struct Row {
    std::uint64_t misses = 0, entries = 0, unrounded = 0;
};

/// Sums over a case's views.
struct Report {
    std::vector<Row> rows{std::size(ladder)};
    std::uint64_t verdicts = 0, by_rationals = 0, exact = 0, open = 0;
};

/// Whether a rung has this pair when nothing is rounded, and whether it must.
bool keeps(const Method& method, std::uint32_t facts) {
    constexpr std::uint32_t needed[] = {0, by_interval, by_box, by_split_box};
    const std::uint32_t depth = needed[static_cast<int>(method.depth_test)];
    return (facts & depth) == depth &&
           (method.footprint == Footprint::rectangle || (facts & in_pyramid) != 0);
}

/// Counts what the rungs list for one view against what they ought to.
template <class Any>
void count(const SeenScene& seen, const std::vector<Any>& lights, int tile_size, Report& report) {
    const TiledView view(seen.scene, seen.picture, tile_size);
    const ExactPairs truth =
        ExactDecider(seen.scene.projection, seen.picture.size, tile_size).pairs(lights, view.bounds());
    report.verdicts += truth.verdicts;
    report.open += truth.open;
    report.by_rationals += truth.by_rationals;
    for (const std::vector<Pair>& pairs : truth.tiles)
        for (const Pair& pair : pairs)
            report.exact += (pair.facts & in_split) != 0;

    Ladder().for_each([&](std::size_t rung, auto& bin) {
        const Method& method = ladder[rung];
        Row& row = report.rows[rung];
        const auto grid = bin(view, lights);
        row.entries += grid.ids().size();
        for (std::size_t tile = 0; tile < truth.tiles.size(); ++tile) {
            const lightbin::ListRange list = grid.ranges()[tile];
            for_each_listed(truth.tiles[tile], grid.ids().subspan(list.offset, list.count),
                            [&](const Pair& pair, bool listed) {
                                row.unrounded += keeps(method, pair.facts);
                                row.misses += !listed && (pair.facts & must_be_met(method.depth_test));
                            });
        }
    });
}

/// What is said of a rung, over all scenes and tile sizes.
struct Said {
    std::string scene;
    int tile_size;
    double excess, margin;  ///< margin: NaN where there are spots
};

void write(std::FILE* csv, const Case& scene, int tile_size, const Report& report,
           std::vector<std::vector<Said>>& said) {
    for (std::size_t rung = 0; rung < std::size(ladder); ++rung) {
        const Row& row = report.rows[rung];
        const auto part = [](auto a, auto b) { return static_cast<double>(a) / static_cast<double>(b); };
        const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
        const double excess = part(row.entries, report.exact) - 1,
                     margin = scene.views[0].scene.spots ? std::nan("") : part(row.entries, row.unrounded);
        std::fprintf(csv, "%s,%zu,%d,%s,%s,%llu,%llu,%llu,%llu,%llu,%llu,%.5f,%.6f\n", scene.name.c_str(),
                     scene.views.size(), tile_size, to_string(ladder[rung].footprint),
                     to_string(ladder[rung].depth_test), number(row.misses), number(report.verdicts),
                     number(report.by_rationals), number(report.open), number(row.entries),
                     number(report.exact), excess, margin);
        said[rung].push_back({scene.name, tile_size, excess, margin});
    }
    std::fflush(csv);
}

/// A row a rung: the median of the scenes at each tile size, and the worst of all.
std::vector<TableRow> table(const std::vector<std::vector<Said>>& said, const std::vector<int>& tile_sizes) {
    std::vector<TableRow> rows = {{"footprint", "depth test"}};
    for (const int tile_size : tile_sizes)
        rows[0].push_back(text("%d px", tile_size));
    rows[0].push_back("worst");
    for (std::size_t rung = 0; rung < said.size(); ++rung) {
        TableRow row = {to_string(ladder[rung].footprint), to_string(ladder[rung].depth_test)};
        for (const int tile_size : tile_sizes) {
            std::vector<double> excess;
            for (const Said& one : said[rung])
                if (one.tile_size == tile_size) excess.push_back(one.excess);
            row.push_back(text("%.1f %%", 100 * median(excess)));
        }
        const Said& worst = *std::ranges::max_element(said[rung], {}, &Said::excess);
        row.push_back(text("%.1f %%, %s at %d px", 100 * worst.excess, worst.scene.c_str(), worst.tile_size));
        rows.push_back(row);
    }
    return rows;
}

std::vector<Case> cases(const std::vector<std::string>& paths) {
    std::vector<Case> all;
    for (BenchScene& scene : std::vector{scenes::field_with_depth(), scenes::foliage(), scenes::top_down(),
                                         scenes::street_lamps(), scenes::stage(), scenes::car_park()}) {
        std::string name = scene.name;
        all.push_back({std::move(name), {see(std::move(scene))}});
    }
    for (const std::string& path : paths) {
        Case scene;
        for (BenchScene& view : glb_scenes(path)) {
            scene.name = view.name.substr(0, view.name.find(':'));
            scene.views.push_back(see(std::move(view)));
        }
        all.push_back(std::move(scene));
    }
    return all;
}

}  // namespace

int main(int argc, char** argv) try {
    Arguments arguments(argc, argv);
    const bool quick = arguments.take("--quick");
    std::FILE* const csv =
        open_report("error.csv", "scene,views,tile_px,footprint,depth_test,misses,verdicts,by_rationals,"
                                 "open,entries,exact,excess,margin");
    std::vector<int> tile_sizes = {8, 16, 32, 64};
    if (quick) tile_sizes = {32, 64};
    std::uint64_t misses = 0, verdicts = 0, open = 0;
    std::vector<std::vector<Said>> said(std::size(ladder));
    std::vector<TableRow> clusters;
    {
        Progress progress;
        for (const Case& scene : cases(arguments.scenes_or_fixtures()))
            for (const int tile_size : tile_sizes) {
                progress(text("%s, %d px", scene.name.c_str(), tile_size));
                Report report;
                for (const SeenScene& seen : scene.views)
                    std::visit([&](const auto& lights) { count(seen, lights, tile_size, report); },
                               seen.scene.light_set(0));
                write(csv, scene, tile_size, report, said);
                verdicts += report.verdicts, open += report.open;
                for (const Row& row : report.rows)
                    misses += row.misses;
            }
        std::fclose(csv);
        progress("clusters");
        misses += report_cluster_errors(quick, clusters);
    }
    std::puts("Entries beyond the exact set, median of the scenes\n");
    print_table(table(said, tile_sizes));
    std::puts("");
    print_table(clusters);
    const auto over_all = [&](std::size_t rung, auto member) {
        std::vector<double> values;
        for (const Said& one : said[rung])
            if (!std::isnan(one.*member)) values.push_back(one.*member);
        return values;
    };
    double margin = 1;
    for (std::size_t rung = 0; rung < 4; ++rung)  // of silhouettes it is also some rectangles
        for (const double value : over_all(rung, &Said::margin))
            margin = std::max(margin, value);
    const auto half = [&](std::size_t rung) { return 100 * median(over_all(rung, &Said::excess)); };
    conclude({text("%llu entries missed, clusters counted in; %.2g pairs of a tile and a light were decided, "
                   "%llu left open.",
                   static_cast<unsigned long long>(misses), static_cast<double>(verdicts),
                   static_cast<unsigned long long>(open)),
              text("Listed beyond the exact set, in the median: without Z bounds %.0f %%, interval %.0f %%, "
                   "box %.1f %%, "
                   "split_box %.1f %%.",
                   half(0), half(1), half(2), half(3)),
              text("Rounding outward adds %.3f %% at most to rectangles' entries.", 100 * (margin - 1))},
             {"error.csv", "cluster_error.csv"});
    return misses == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
} catch (const std::exception& problem) {
    std::fprintf(stderr, "error: %s\n", problem.what());
    return EXIT_FAILURE;
}
