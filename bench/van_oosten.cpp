// SPDX-License-Identifier: MIT
// van_oosten [--quick]: the two tables of times by number of lights of J. van Oosten, "Volume Tiled Forward Shading",
// MSc thesis, Utrecht University, 2017, chapter "Results" (Sponza, 1920x1080), beside builds of lights with the same
// statistics. The lists of the two smallest sets are compared with the exact ones. Writes van_oosten.csv.
//
// His columns are milliseconds on a GeForce GTX Titan X: `tiled` culls lights against 32-pixel tiles between their
// least and greatest depth, `volume` tests every light against every cell of 64-pixel tiles and slices that has a
// sample in it, and `BVH` is sort + build + assign (without two passes that he does not print). The configuration of
// his program has the camera, the range of the lights and the box that they are in. What it does not have is made up:
// the seeds; how the box grows (here in proportion, about its middle); Sponza (here a hall of about its size, with
// columns). Half of his lights were spots; here all are spheres.
#include "arguments.hpp"
#include "console.hpp"
#include "exact_pairs.hpp"
#include "gpu/measure.hpp"
#include "tiled_view.hpp"
#include "turns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using lightbin::Options;
using lightbin::Slicing;

/// Both test boxes around cells, as his passes do.
constexpr Options tile_options = {.depth_test = true},
                  cluster_options = {.depth_test = true, .slicing = Slicing::clusters};

/// A row of his tables, in milliseconds; 0 is what he did not measure.
struct Published {
    bool grows;  ///< whether the box grows with the number of lights: there is one in a unit of volume
    std::size_t lights;
    double tiled, volume, sort, build, assign;

    double bvh() const { return sort + build + assign; }
};
constexpr Published published[] = {
    {false, 1024, 0.768, 0.353, 0.177, 0.035, 0.361},    {false, 2048, 1.202, 0.769, 0.224, 0.034, 0.447},
    {false, 4096, 1.922, 1.409, 0.290, 0.050, 0.609},    {false, 8192, 3.348, 2.695, 0.365, 0.052, 0.798},
    {false, 16384, 6.026, 5.369, 0.448, 0.051, 1.000},   {false, 32768, 11.679, 10.611, 0.535, 0.055, 1.281},
    {false, 65536, 0, 21.804, 0.774, 0.072, 1.791},      {false, 131072, 0, 0, 1.188, 0.166, 2.692},
    {true, 30000, 7.555, 9.135, 0.342, 0.053, 0.617},    {true, 100000, 25.375, 30.901, 0.825, 0.158, 0.596},
    {true, 200000, 50.633, 62.746, 1.361, 0.230, 0.643}, {true, 500000, 0, 200.852, 3.310, 0.468, 0.608},
    {true, 1000000, 0, 0, 5.691, 0.840, 0.681},          {true, 2000000, 0, 0, 12.018, 2.476, 1.014},
    {true, 4000000, 0, 0, 21.492, 6.203, 0.968},         {true, 7000000, 0, 0, 41.238, 11.817, 1.069},
};

Lens his_lens() {
    Lens lens;
    lens.tan_half_height = std::tan(glm::radians(22.5));
    return lens;
}

/// His slices are as deep as a tile is high: each ends at 1 + 2 tan(22.5 degrees) / 17 times the depth where it begins.
lightbin::Slices his_slices() {
    const Lens lens = his_lens();
    const double ratio = 1 + 2 * lens.tan_half_height / 17;
    const int count = static_cast<int>(std::log(lens.far_depth / lens.near_depth) / std::log(ratio));
    return *lightbin::Slices::exponential(count, float(lens.near_depth * ratio),
                                          float(lens.near_depth * std::pow(ratio, count)));
}

BenchScene hall(std::size_t lights, bool grows) {
    const glm::dvec3 eye(-9.2456, 1.5235, -0.4296), ahead(0.99993, -0.01138, 0.00373);
    SceneBuilder world(eye, eye + ahead);
    world.box({-19, 0, -11.5f}, {18, 15, 11.5f});
    for (int i = 0; i < 9; ++i)
        for (const float z : {-5.0f, 4.0f})
            world.box({float(4 * i) - 16, 0, z}, {float(4 * i) - 15, 15, z + 1});
    const glm::vec3 low(-15, 0.01f, -15), high(15), middle = 0.5f * (low + high);
    const double volume = 30 * 14.99 * 30;
    const glm::vec3 half = (grows ? float(std::cbrt(double(lights) / volume)) : 1.0f) * (high - middle);
    BenchScene scene = std::move(world).scene("", lights, [=](Dice& dice, std::size_t) {
        const glm::vec3 at = dice.between(middle - half, middle + half);
        return glm::vec4(at, dice.between(2.24f, 3.69f));
    });
    scene.projection = glm::mat4(his_lens().projection());
    return scene;
}

/// Builds of lights in his view. Of the clusters, `seen` are those with a sample in them, by the tile's Z bounds.
struct Builds {
    SeenScene scene = see(hall(1, false));
    TiledView tiles{scene.scene, scene.picture, 32}, clusters{scene.scene, scene.picture, 64};
    lightbin::Slices slices = his_slices();
    lightbin::Binner<tile_options> tile_binner;
    lightbin::Binner<cluster_options> seen_binner, all_binner;

    auto in_tiles(const Lights& lights) {
        return *tile_binner.bin(tiles.view, lights, {.bounds = tiles.bounds()});
    }
    auto in_seen(const Lights& lights) {
        return *seen_binner.bin(clusters.view, lights, {.slices = slices, .bounds = clusters.bounds()});
    }
    auto in_all(const Lights& lights) { return *all_binner.bin(clusters.view, lights, {.slices = slices}); }
};

/// Lists against the exact set.
struct Check {
    std::size_t exact = 0, more = 0, wrong = 0;

    void add(std::span<const Pair> pairs, std::span<const std::uint32_t> list) {
        std::size_t met = 0, met_and_listed = 0;
        for_each_listed(pairs, list, [&](const Pair& pair, bool listed) {
            if (!(pair.facts & in_cell)) return;
            ++met;
            met_and_listed += listed;
        });
        exact += met, wrong += met - met_and_listed, more += list.size() - met_and_listed;
    }

    /// Decides for every tile and every cell which lights meet it. Cells without a sample must list none.
    void add(Builds& builds, const Lights& lights) {
        const glm::mat4& projection = builds.scene.scene.projection;
        ExactDecider of_tiles(projection, screen, 32), of_clusters(projection, screen, 64);
        const auto tiles = builds.in_tiles(lights);
        const ExactPairs in_tiles = of_tiles.pairs(lights, builds.tiles.bounds());
        for (std::size_t tile = 0; tile < in_tiles.tiles.size(); ++tile)
            add(in_tiles.tiles[tile],
                tiles.lights_in(int(tile) % tiles.tiles_x(), int(tile) / tiles.tiles_x()));

        const auto seen = builds.in_seen(lights), all = builds.in_all(lights);
        const lightbin::Slices& slices = builds.slices;
        for (int slice = 0; slice < slices.count(); ++slice) {
            const ExactPairs in_cells = pairs_in(of_clusters, builds.clusters.view, slices, slice, lights);
            for (std::size_t tile = 0; tile < in_cells.tiles.size(); ++tile) {
                const int x = int(tile) % all.tiles_x(), y = int(tile) / all.tiles_x();
                const auto list = all.lights_in(x, y, slice), seen_list = seen.lights_in(x, y, slice);
                const bool sample = slice >= slices.slice_at(builds.clusters.min[tile]) &&
                                    slice <= slices.slice_at(builds.clusters.max[tile]);
                add(in_cells.tiles[tile], list);
                wrong += !(sample ? std::ranges::equal(list, seen_list) : seen_list.empty());
            }
        }
    }
};

/// Our milliseconds; 0 is what was not measured.
struct Row {
    Published his;
    double tiles, clusters, all_cells, gpu_tiles = 0, gpu_all_cells = 0;
    double entries;  ///< of `clusters`, per light
};

class Measuring {
public:
    explicit Measuring(bool quick) : quick_(quick) {
        try {
            gpu_.emplace();
        } catch (const std::exception& problem) {
            gpu_said_ = text("No GPU was timed: %s.", problem.what());
        }
        if (gpu_ && gpu_->is_software())
            gpu_said_ = text("No GPU was timed: %s is the CPU.", gpu_->name().c_str());
    }

    /// Times one row. Compares its lists with the exact ones if it is to be `checked`.
    Row row(const Published& his, bool checked) {
        progress_(text("%zu lights", his.lights));
        const BenchScene scene = hall(his.lights, his.grows);
        const auto frames = frames_in_turn(his.lights, [&](std::uint32_t seed) -> Frame {
            return {his_lens(), scene.lights(seed)};
        });
        if (checked) check_.add(builds_, frames[0].lights);

        const std::vector<Work<Frame>> works = {
            [&](const Frame& frame) { return builds_.in_tiles(frame.lights).ids().size(); },
            [&](const Frame& frame) { return builds_.in_seen(frame.lights).ids().size(); },
            [&](const Frame& frame) { return builds_.in_all(frame.lights).ids().size(); }};
        const Turns turns = take_turns(frames, quick_ ? 0.1 : 1, works);
        const auto ms = [&](std::size_t work) { return 1e3 * turns.seconds_a_frame(work); };
        Row row = {.his = his,
                   .tiles = ms(0),
                   .clusters = ms(1),
                   .all_cells = ms(2),
                   .entries = turns.made_a_frame(1) / double(his.lights)};
        if (gpu_ && (checked || !gpu_->is_software())) {
            const LightSource source = {"", 0, {{his_lens(), frames[0].lights, {}}}};
            row.gpu_tiles = on_gpu<tile_options>(source, 32, builds_.tiles.bounds());
            row.gpu_all_cells = on_gpu<cluster_options>(source, 64, {});
        }
        return row;
    }

    std::string machine() const {
        return std::string(to_string(lightbin::machine_isa())) +
               (gpu_ && !gpu_->is_software() ? "; " + gpu_->name() : "");
    }
    bool right() const { return check_.wrong == 0 && on_gpu_.right(); }
    std::string checked() const {
        return text("Lists: %zu of %zu entries of exact sets are wrong, %.1f %% are more; by shader_cull, "
                    "%zu of %zu are missed, %zu are out of order.\n",
                    check_.wrong, check_.exact, 100 * double(check_.more) / double(check_.exact),
                    on_gpu_.missed, on_gpu_.entries, on_gpu_.unordered) +
               gpu_said_;
    }

private:
    /// Compares the GPU's lists with the CPU's. Returns its milliseconds, 0 if it is no GPU or can't build so many.
    template <Options options>
    double on_gpu(const LightSource& source, int tile_size, const lightbin::ZBounds& bounds) try {
        const bool timed = !gpu_->is_software();
        const GpuRow row = measure<options, false>(*gpu_, source, tile_size,
                                                   timed ? TurnsOf{quick_ ? 15 : 51, 20} : TurnsOf{1, 0},
                                                   builds_.slices, bounds);
        on_gpu_ += row.difference;
        return timed ? row.gpu_ms : 0;
    } catch (const std::runtime_error& problem) {
        gpu_said_ += text(" %zu lights: %s.", source.frames[0].lights.size(), problem.what());
        return 0;
    }

    bool quick_;
    Builds builds_;
    std::optional<GpuDevice> gpu_;
    std::string gpu_said_;
    Check check_;
    Difference on_gpu_;
    Progress progress_;
};

std::string cell(double ms) {
    return ms == 0 ? "-" : text(ms < 1 ? "%.3f" : ms < 100 ? "%.2f" : "%.0f", ms);
}

std::vector<TableRow> table_of(const std::vector<Row>& rows) {
    std::vector<TableRow> table = {{"box", "lights", "his tiled", "his volume", "his BVH", "tiles",
                                    "clusters", "all cells", "GPU tiles", "GPU all cells", "entries a light"}};
    for (const Row& row : rows)
        table.push_back({row.his.grows ? "grows" : "same", std::to_string(row.his.lights),
                         cell(row.his.tiled), cell(row.his.volume), cell(row.his.bvh()), cell(row.tiles),
                         cell(row.clusters), cell(row.all_cells), cell(row.gpu_tiles),
                         cell(row.gpu_all_cells), text("%.1f", row.entries)});
    return table;
}

/// His time over ours, from the least to the most.
std::string ratios(const std::vector<Row>& rows, double Row::*ours, double (*his)(const Published&)) {
    std::vector<double> ratios;
    for (const Row& row : rows)
        if (his(row.his) > 0) ratios.push_back(his(row.his) / (row.*ours));
    return text("%.2g to %.2g", std::ranges::min(ratios), std::ranges::max(ratios));
}

/// Says from which numbers of lights on his BVH takes less time.
std::string bvh_wins(const std::vector<Row>& rows, double Row::*ours) {
    std::string from[] = {"nowhere", "nowhere"};
    for (const bool grows : {false, true})
        for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
            if (row->his.grows != grows) continue;
            if (row->his.bvh() >= (*row).*ours) break;
            from[grows] = text("from %zu lights on", row->his.lights);
        }
    return from[0] + " in the same box, " + from[1] + " in the one that grows";
}

int run(Arguments arguments) {
    const bool quick = arguments.take("--quick");
    if (!arguments.scenes().empty()) throw std::runtime_error("cannot do '" + arguments.scenes()[0] + "'");
    Measuring measuring(quick);
    std::vector<Row> rows;
    for (const Published& his : published)
        if (!quick || his.lights <= (his.grows ? 1000000 : 16384))
            rows.push_back(measuring.row(his, rows.size() < 2));

    const std::vector<TableRow> table = table_of(rows);
    print_table(table);
    std::FILE* const csv = open_report("van_oosten.csv", "# milliseconds; - is what was not measured");
    for (const TableRow& row : table)
        for (std::size_t i = 0; i < row.size(); ++i)
            std::fprintf(csv, "\"%s\"%c", row[i].c_str(), i + 1 < row.size() ? ',' : '\n');
    std::fclose(csv);
    conclude({"Milliseconds: his on a GTX Titan X; ours, medians, on one thread of this machine (" +
                  measuring.machine() + "). The ratios",
              "that follow are of his time to ours on one thread, and so between different machines.",
              "His tiled culling to tiles: " +
                  ratios(rows, &Row::tiles, [](const Published& his) { return his.tiled; }) +
                  ". His volume tiles to clusters: " +
                  ratios(rows, &Row::clusters, [](const Published& his) { return his.volume; }) +
                  ". His BVH to clusters: " +
                  ratios(rows, &Row::clusters, [](const Published& his) { return his.bvh(); }) + ".",
              "His BVH takes less time than clusters " + bvh_wins(rows, &Row::clusters) + ";",
              "less than tiles " + bvh_wins(rows, &Row::tiles) + ".", measuring.checked()},
             {"van_oosten.csv"});
    return measuring.right() ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) try {
    return run(Arguments(argc, argv));
} catch (const std::exception& problem) {
    std::fprintf(stderr, "van_oosten: %s\n", problem.what());
    return EXIT_FAILURE;
}
