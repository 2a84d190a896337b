// SPDX-License-Identifier: MIT
// What clusters list too much: each pair of a cell and a light of the field sets, decided exactly.
#pragma once

#include "console.hpp"
#include "exact_pairs.hpp"
#include "lens.hpp"
#include "measure.hpp"

#include <lightbin/binner.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

struct ClusterError {
    lightbin::DepthTest depth_test;
    std::uint64_t misses = 0, verdicts = 0, by_rationals = 0, entries = 0, exact = 0;
    std::uint64_t unrounded = 0;  ///< entries in exact arithmetic
};

/// Every pair of a cell of this slice and a light, as of tiles with the slice's boundaries for Z bounds.
template <class Any>
ExactPairs pairs_in(ExactDecider& decider, const lightbin::View& view, const lightbin::Slices& slices,
                    int slice, const std::vector<Any>& lights) {
    constexpr float endless = std::numeric_limits<float>::infinity();
    const auto boundary = [&](int i) { return slices.boundaries()[std::size_t(i)]; };
    const std::vector<float> min(view.tile_count(), slice == 0 ? -endless : boundary(slice - 1)),
        max(view.tile_count(), slice + 1 == slices.count() ? endless : boundary(slice));
    return decider.pairs(lights, {.min = min, .max = max});
}

/// The slab of each slice, and beside it the box of each cell.
class ClusterErrors {
public:
    ClusterErrors()
        : lens_(), projection_(lens_.projection()), slices_(cluster_slices()),
          view_(*lightbin::View::from_projection(projection_, lens_.screen, {.tile_size = tile_size})),
          decider_(projection_, lens_.screen, tile_size) {}

    std::array<ClusterError, 2> of(const Lights& lights) {
        std::array<ClusterError, 2> errors = {
            {{.depth_test = lightbin::DepthTest::none}, {.depth_test = lightbin::DepthTest::box}}};
        const auto slabs = *slabs_.bin(view_, lights, {.slices = slices_}),
                   boxes = *boxes_.bin(view_, lights, {.slices = slices_});
        for (int slice = 0; slice < slices_.count(); ++slice) {
            const ExactPairs truth = pairs_in(decider_, view_, slices_, slice, lights);
            count(truth, slabs, slice, by_interval, errors[0]);
            count(truth, boxes, slice, by_box, errors[1]);
        }
        return errors;
    }

private:
    static constexpr int tile_size = 64;
    template <lightbin::DepthTest depth_test>
    using Clusters =
        lightbin::Binner<lightbin::Options{.depth_test = depth_test, .slicing = lightbin::Slicing::clusters}>;

    static void count(const ExactPairs& truth, const lightbin::LightGrid<std::uint32_t>& grid, int slice,
                      Fact kept, ClusterError& error) {
        error.verdicts += truth.verdicts;
        error.by_rationals += truth.by_rationals;
        for (std::size_t tile = 0; tile < truth.tiles.size(); ++tile) {
            const int x = int(tile) % grid.tiles_x(), y = int(tile) / grid.tiles_x();
            const auto list = grid.lights_in(x, y, slice);
            error.entries += list.size();
            for_each_listed(truth.tiles[tile], list, [&](const Pair& pair, bool listed) {
                const bool met = (pair.facts & in_cell) != 0;
                error.exact += met;
                error.unrounded += (pair.facts & kept) != 0;
                error.misses += met && !listed;
            });
        }
    }

    Lens lens_;
    glm::mat4 projection_;
    lightbin::Slices slices_;
    lightbin::View view_;
    ExactDecider decider_;
    Clusters<lightbin::DepthTest::none> slabs_;
    Clusters<lightbin::DepthTest::box> boxes_;
};

/// Writes cluster_error.csv. Returns the number of misses, and a row of excess for each depth test.
inline std::uint64_t report_cluster_errors(bool quick, std::vector<TableRow>& table) {
    std::FILE* const csv =
        open_report("cluster_error.csv",
                    "set,lights,depth_test,misses,verdicts,by_rationals,entries,exact,excess,margin");
    const std::size_t lights = quick ? 500 : 4096;
    std::uint64_t misses = 0;
    ClusterErrors errors;
    table = {{text("%d clusters of 64 px", cluster_slices().count())}, {"none"}, {"box"}};
    for (const auto& [set, median] :
         {std::pair("field4", field4_median), {"field20", field20_median}, {"field200", field200_median}}) {
        table[0].push_back(set);
        for (const ClusterError& error : errors.of(field(lights, median, 1))) {
            const double entries = double(error.entries), excess = entries / double(error.exact) - 1;
            const char* const test = to_string(error.depth_test);
            const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
            std::fprintf(csv, "%s,%zu,%s,%llu,%llu,%llu,%llu,%llu,%.5f,%.6f\n", set, lights, test,
                         number(error.misses), number(error.verdicts), number(error.by_rationals),
                         number(error.entries), number(error.exact), excess,
                         entries / double(error.unrounded));
            table[error.depth_test == lightbin::DepthTest::box ? 2 : 1].push_back(
                text("%.0f %%", 100 * excess));
            misses += error.misses;
        }
    }
    std::fclose(csv);
    return misses;
}
