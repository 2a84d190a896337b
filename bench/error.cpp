// SPDX-License-Identifier: MIT
// What lists have beyond the exact set, and whether they miss any of it: every pair of a cell and a light decided in exact
// arithmetic, of tiles without and with a depth test and of clusters; of single spots by half angle; and of single
// boxes and balls cut by boxes. Writes error.csv, spots_error.csv and boxes_error.csv.
//
// Columns of the first, a row for each scene (all views of it together), tile size and method:
//   misses          entries that the method must have and lacks, in `verdicts` pairs of a cell and a light: every pair there
//                   is (by_rationals: questions left to the rationals; open: such about spots that no certificate was found
//                   for)
//   exact           pairs whose light meets the cell between its Z bounds
//   excess          entries / exact - 1
// The method `interval` is the papers' test, a light's depths against the tile's, by the flat loop (flat.hpp): of spots
// the spheres of their range. As it rounds to nearest, its misses don't end the run.
#include "arguments.hpp"
#include "built.hpp"
#include "console.hpp"
#include "exact_pairs.hpp"
#include "glb_scenes.hpp"
#include "shapes_error.hpp"
#include "tiled_view.hpp"

#include <cmath>
#include <exception>

namespace {

using lightbin::Slicing;

/// What lists test of a light's depth: nothing, its interval of depth, or the box around the cell.
enum class Method { none, interval, box };
constexpr Method methods[] = {Method::none, Method::interval, Method::box};

const char* name_of(Method method) {
    constexpr const char* names[] = {"none", "interval", "box"};
    return names[static_cast<int>(method)];
}

/// A row of error.csv.
struct Row {
    std::string scene;
    std::size_t views;
    int tile_size;
    Method method;
    Slicing slicing;
    std::uint64_t misses = 0, verdicts = 0, by_rationals = 0, open = 0;
    std::uint64_t entries = 0, exact = 0;

    static double part(std::uint64_t a, std::uint64_t b) {
        return static_cast<double>(a) / static_cast<double>(b);
    }
    double excess() const { return part(entries, exact) - 1; }

    /// Counts misses and excess entries in a grid's cells; list_of(tile) returns the list of a cell.
    template <class ListOf> void add(const ExactPairs& truth, ListOf list_of) {
        verdicts += truth.verdicts, by_rationals += truth.by_rationals, open += truth.open;
        const bool clusters = slicing == Slicing::clusters;
        for (std::size_t tile = 0; tile < truth.tiles.size(); ++tile) {
            const std::span<const std::uint32_t> list = list_of(tile);
            entries += list.size();
            for_each_listed(truth.tiles[tile], list, [&](const Pair& pair, bool listed) {
                exact += (pair.facts & in_cell) != 0;
                misses +=
                    !listed && (pair.facts & (clusters || method != Method::none ? in_cell : in_pyramid));
            });
        }
    }
};

struct Case {
    std::string name;
    std::vector<SeenScene> views;
};

/// A build for each of the methods.
std::vector<BuildLists> builders() {
    const auto loop = std::make_shared<Flat<float>>();
    const auto ranges = std::make_shared<std::vector<lightbin::ListRange>>();
    const auto by_flat_loop = [=](const TiledView& view, const LightSet& lights) -> Built {
        loop->build<true>(view.flat, std::get<Lights>(lights), view.min.data(), view.max.data());
        ranges->clear();
        for (std::size_t i = 0; i + 1 < loop->offsets.size(); ++i)
            ranges->push_back({loop->offsets[i], loop->offsets[i + 1] - loop->offsets[i]});
        return {.ranges = *ranges, .bytes = 0, .ids = loop->indices};
    };
    return {builder<lightbin::Options{}>(), by_flat_loop, builder<lightbin::Options{.depth_test = true}>()};
}

/// The rows of a case, a method each.
std::vector<Row> rows_of(const Case& scene, int tile_size) {
    std::vector<Row> rows;
    for (const Method method : methods)
        rows.push_back({scene.name, scene.views.size(), tile_size, method, Slicing::none});
    const std::vector<BuildLists> builds = builders();
    for (const SeenScene& seen : scene.views) {
        const TiledView view(seen.scene, seen.picture, tile_size);
        const LightSet lights = seen.scene.light_set(0);
        ExactDecider decider(seen.scene.projection, seen.picture.size, tile_size);
        const ExactPairs truth =
            std::visit([&](const auto& any) { return decider.pairs(any, view.bounds()); }, lights);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const bool own = methods[i] != Method::interval;
            const Built built = builds[i](view, own ? lights : LightSet(seen.scene.lights(0)));
            rows[i].add(truth, [&](std::size_t tile) {
                return built.ids.subspan(built.ranges[tile].offset, built.ranges[tile].count);
            });
        }
    }
    return rows;
}

/// Measures clusters of one light set: a row without, and one with, the box test of each cell.
template <bool depth_test>
Row row_of_clusters(const std::string& name, const Lights& lights, ExactDecider& decider) {
    constexpr int tile_size = 64;
    const lightbin::Slices slices = cluster_slices();
    const lightbin::View view = made_view(tile_size);
    lightbin::Binner<lightbin::Options{.depth_test = depth_test, .slicing = Slicing::clusters}> binner;
    const auto grid = *binner.bin(view, lights, {.slices = slices});
    Row row = {name, 1, tile_size, depth_test ? Method::box : Method::none, Slicing::clusters};
    for (int slice = 0; slice < slices.count(); ++slice)
        row.add(pairs_in(decider, view, slices, slice, lights), [&](std::size_t tile) {
            const int x = int(tile) % grid.tiles_x(), y = int(tile) / grid.tiles_x();
            return grid.lights_in(x, y, slice);
        });
    return row;
}

std::vector<Row> rows_of_clusters(bool quick) {
    std::vector<Row> rows;
    ExactDecider decider = made_decider(64);
    for (const auto& [name, median] :
         {std::pair("field4", field4_median), {"field20", field20_median}, {"field200", field200_median}}) {
        const Lights lights = field(quick ? 500 : 4096, median, 1);
        rows.push_back(row_of_clusters<false>(name, lights, decider));
        rows.push_back(row_of_clusters<true>(name, lights, decider));
    }
    return rows;
}

void write(std::FILE* csv, const std::vector<Row>& rows) {
    const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    for (const Row& row : rows)
        std::fprintf(csv, "%s,%zu,%d,%s,%s,%llu,%llu,%llu,%llu,%llu,%llu,%.5f\n", row.scene.c_str(),
                     row.views, row.tile_size, name_of(row.method), to_string(row.slicing),
                     number(row.misses), number(row.verdicts), number(row.by_rationals), number(row.open),
                     number(row.entries), number(row.exact), row.excess());
    std::fflush(csv);
}

std::vector<TableRow> table(const std::vector<Row>& rows) {
    std::vector<TableRow> all = {{"scene", "px", "depth test", "slicing", "excess"}};
    for (const Row& row : rows)
        all.push_back({row.scene, std::to_string(row.tile_size), name_of(row.method), to_string(row.slicing),
                       text("%.1f %%", 100 * row.excess())});
    return all;
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
    std::FILE* const csv = open_report("error.csv", "scene,views,tile_px,depth_test,slicing,misses,verdicts,"
                                                    "by_rationals,open,entries,exact,excess");
    std::vector<int> tile_sizes = {8, 16, 32, 64};
    if (quick) tile_sizes = {32, 64};
    std::vector<Row> rows;
    ShapeErrors spots, boxes;
    const auto add = [&](const std::vector<Row>& its) {
        write(csv, its);
        rows.insert(rows.end(), its.begin(), its.end());
    };
    {
        Progress progress;
        for (const Case& scene : cases(arguments.scenes_or_fixtures()))
            for (const int tile_size : tile_sizes) {
                progress(text("%s, %d px", scene.name.c_str(), tile_size));
                add(rows_of(scene, tile_size));
            }
        progress("clusters");
        add(rows_of_clusters(quick));
        progress("spots by half angle");
        spots = measure_spots(quick ? 100 : 1000);
        progress("boxes");
        boxes = measure_boxes(quick ? 50 : 500);
    }
    std::fclose(csv);
    std::puts("Entries beyond the exact set\n");
    print_table(table(rows));
    std::puts(
        "\nEntries of a spot over exact pairs of a cell and it, by half angle; in brackets those of whole "
        "spheres\n");
    print_table(spots.table);
    std::puts(
        "\nEntries of a box over exact pairs of a cell and it; in brackets those of the sphere around it\n");
    print_table(boxes.table);

    std::uint64_t misses = spots.misses + boxes.misses, open = spots.open, verdicts = 0;
    for (const Row& row : rows) {
        if (row.method != Method::interval) misses += row.misses;
        if (row.method == Method::none && row.slicing == Slicing::none)
            verdicts += row.verdicts, open += row.open;
    }
    conclude({text("%llu entries missed, clusters counted in; %.2g pairs of a tile and a light were decided, "
                   "%llu left open.",
                   static_cast<unsigned long long>(misses), static_cast<double>(verdicts),
                   static_cast<unsigned long long>(open)),
              text("Whole spheres are listed %.1f to %.0f times as often as the spots in them, in the median "
                   "%.1f.",
                   percentile(spots.saved, 0), percentile(spots.saved, 1), median(spots.saved))},
             {"error.csv", "spots_error.csv", "boxes_error.csv"});
    return misses == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
} catch (const std::exception& problem) {
    std::fprintf(stderr, "error: %s\n", problem.what());
    return EXIT_FAILURE;
}
