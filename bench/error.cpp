// SPDX-License-Identifier: MIT
// Error against run time: what each rung of the ladder lists that no pixel needs, and what it takes to build,
// by tile size. Writes error_vs_time.csv, which plot.gp draws; no_pre_pass.csv: the same of grids that need no depth
// buffer, z-bins and clusters among them; cluster_error.csv: what clusters list too much; spot_error.csv: the same of
// spots, and of the spheres around them.
//
// Columns of the first, a row for each scene (all views of it together), tile size and rung:
//   misses          entries that the rung must have by exact arithmetic and lacks, in `verdicts` pairs of a
//                   tile and a light: every pair there is (by_rationals: questions left to the rationals)
//   exact           pairs whose sphere meets the tile's cell between its Z bounds, its gap left out
//   excess          entries / exact - 1
//   lit             pairs with a pixel whose point is in the sphere; excess_lit = entries / lit - 1
//   margin          entries / entries of the same rung in exact arithmetic: what rounding outward adds; for
//                   silhouettes, also what keeping some lights' rectangles adds. Not where there are spots
//   evals           light evaluations a drawn pixel: the mean length of its list; evals_beyond: those of
//                   lights that do not reach its point
//   index_bytes     of the light index list, 32-bit ids
//   us, ratio       median time of a build, and as a part of the flat baseline's (with Z interval tests for
//                   every rung with a depth test), on rotating light sets; Z bounds not included. The baseline bins
//                   whole spheres
//   reduce_us       what making the Z bounds of one view takes
//   open            questions about spots that no certificate was found for
#include "arguments.hpp"
#include "cluster_error.hpp"
#include "exact_pairs.hpp"
#include "glb_scenes.hpp"
#include "ladder.hpp"
#include "lit.hpp"
#include "no_pre_pass.hpp"
#include "spot_error.hpp"

#include <exception>

namespace {

bool quick = false;

struct Case {
    std::string name;
    std::vector<SeenScene> views;
};

struct Row {
    std::uint64_t misses = 0, entries = 0, unrounded = 0;
    double evaluations = 0;  ///< of all drawn pixels
    double us = 0, ratio = 0;
};

/// Sums over a case's views.
struct Report {
    std::vector<Row> rows{std::size(ladder)};
    std::uint64_t verdicts = 0, by_rationals = 0, exact = 0, lit = 0, needed = 0, drawn = 0, open = 0;
    double reduce_us = 0;
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
    report.reduce_us += 1e6 * view.reduce_seconds;

    report.drawn += view.all_drawn;
    for (int y = 0, tile = 0; y < view.view.tiles_y(); ++y)
        for (int x = 0; x < view.view.tiles_x(); ++x, ++tile) {
            const Points points(seen, view.view, x, y);
            for (const Pair& pair : truth.tiles[static_cast<std::size_t>(tile)]) {
                if ((pair.facts & in_split) == 0) continue;
                const std::uint32_t inside = points.inside(lights[pair.id]);
                ++report.exact;
                report.lit += inside > 0;
                report.needed += inside;
            }
        }

    Ladder().for_each([&](std::size_t rung, auto& bin) {
        const Method& method = ladder[rung];
        Row& row = report.rows[rung];
        const auto grid = bin(view, lights);
        row.entries += grid.ids().size();
        row.evaluations += view.all_evaluations(grid.ranges());
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

/// Times the rungs and the baseline in turns.
void time(const Case& scene, int tile_size, Report& report) {
    std::vector<TiledView> views;
    for (const SeenScene& seen : scene.views)
        views.emplace_back(seen.scene, seen.picture, tile_size);
    const std::size_t lights = scene.views[0].scene.lights(0).size();
    const std::size_t turns = quick ? 12 : rotation(lights);

    Flat<float> flat;
    std::vector<double> times[std::size(ladder)], flat_times[2];
    Ladder bins;
    for (std::size_t turn = 0; turn < turns; ++turn) {
        const std::size_t place = turn % views.size();
        const TiledView& view = views[place];
        const auto seed = static_cast<std::uint32_t>(turn);
        const Lights set = scene.views[place].scene.lights(seed);
        flat_times[0].push_back(
            seconds([&] { flat.build<false>(view.flat, set, view.min.data(), view.max.data()); }));
        flat_times[1].push_back(
            seconds([&] { flat.build<true>(view.flat, set, view.min.data(), view.max.data()); }));
        const auto time_all = [&](const auto& lights) {
            bins.for_each([&](std::size_t rung, auto& bin) {
                times[rung].push_back(seconds([&] { bin(view, lights); }));
            });
        };
        std::visit(time_all, scene.views[place].scene.light_set(seed));
    }
    for (std::size_t rung = 0; rung < std::size(ladder); ++rung) {
        Row& row = report.rows[rung];
        row.us = 1e6 * median(times[rung]);
        row.ratio = row.us / (1e6 * median(flat_times[ladder[rung].depth_test == DepthTest::none ? 0 : 1]));
    }
}

void write(std::FILE* csv, const Case& scene, int tile_size, const Report& report) {
    for (std::size_t rung = 0; rung < std::size(ladder); ++rung) {
        const Row& row = report.rows[rung];
        const auto part = [](auto a, auto b) { return static_cast<double>(a) / static_cast<double>(b); };
        const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
        const double views = static_cast<double>(scene.views.size());
        const double evaluations = row.evaluations / static_cast<double>(report.drawn);
        std::fprintf(csv, "%s,%zu,%d,%s,%s,%llu,%llu,%llu,", scene.name.c_str(), scene.views.size(),
                     tile_size, to_string(ladder[rung].footprint), to_string(ladder[rung].depth_test),
                     number(row.misses), number(report.verdicts), number(report.by_rationals));
        std::fprintf(csv, "%llu,%llu,%.5f,%llu,%.5f,%.6f,", number(row.entries), number(report.exact),
                     part(row.entries, report.exact) - 1, number(report.lit),
                     part(row.entries, report.lit) - 1,
                     scene.views[0].scene.spots ? std::nan("") : part(row.entries, row.unrounded));
        std::fprintf(csv, "%.3f,%.3f,%.0f,%.1f,%.3f,%.0f,%llu\n", evaluations,
                     evaluations - part(report.needed, report.drawn),
                     4 * static_cast<double>(row.entries) / views, row.us, row.ratio,
                     report.reduce_us / views, number(report.open));
        std::printf(
            "%-12s %2d px  %-10s %-9s  %llu misses  excess %7.1f %%  evals %6.2f  %8.1f us  %.2f of flat\n",
            scene.name.c_str(), tile_size, to_string(ladder[rung].footprint),
            to_string(ladder[rung].depth_test), number(row.misses),
            100 * (part(row.entries, report.exact) - 1), evaluations, row.us, row.ratio);
    }
    if (report.open > 0)
        std::printf("%-12s %2d px  %llu questions about spots left open\n", scene.name.c_str(), tile_size,
                    static_cast<unsigned long long>(report.open));
    std::fflush(csv);
    std::fflush(stdout);
}

std::vector<Case> cases(const std::vector<std::string>& paths) {
    std::vector<Case> all;
    for (BenchScene& scene : std::vector{scenes::field_with_depth(), scenes::foliage(), scenes::top_down()}) {
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
    quick = arguments.take("--quick");
    std::FILE* const csv =
        open_report("error_vs_time.csv", "scene,views,tile_px,footprint,depth_test,misses,verdicts,by_"
                                         "rationals,entries,exact,excess,lit,excess_lit,"
                                         "margin,evals,evals_beyond,index_bytes,us,ratio,reduce_us,open");
    std::FILE* const ways_csv =
        open_report("no_pre_pass.csv", "scene,way,tile_px,evals,evals_beyond,bytes,us");
    std::uint64_t misses = 0;
    std::vector<SeenScene> with_spots;
    for (const Case& scene : cases(arguments.scenes_or_fixtures())) {
        for (const SeenScene& view : scene.views)
            if (view.scene.spots) with_spots.push_back(view);
        Report report;
        for (const int tile_size : {8, 16, 32, 64}) {
            report = {};
            time(scene, tile_size, report);
            for (const SeenScene& seen : scene.views)
                std::visit([&](const auto& lights) { count(seen, lights, tile_size, report); },
                           seen.scene.light_set(0));
            write(csv, scene, tile_size, report);
            for (const Row& row : report.rows)
                misses += row.misses;
        }
        report_ways(ways_csv, scene.name, scene.views,
                    static_cast<double>(report.needed) / static_cast<double>(report.drawn), quick);
    }
    std::fclose(ways_csv);
    std::fclose(csv);
    misses += report_cluster_errors(quick);
    for (BenchScene& scene : spot_scenes())
        with_spots.push_back(see(std::move(scene)));
    misses += report_spot_errors(with_spots, quick);
    return misses == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
} catch (const std::exception& problem) {
    std::fprintf(stderr, "error: %s\n", problem.what());
    return EXIT_FAILURE;
}
