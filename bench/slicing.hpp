// SPDX-License-Identifier: MIT
// What cutting depth into slices takes: clusters beside the flat baseline, z-bins beside the same build without.
#pragma once

#include "goals.hpp"
#include "measure.hpp"
#include "reference.hpp"
#include "turns.hpp"

#include <lightbin/binner.hpp>
#include <lightbin/encode.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

struct SlicingResult {
    std::string set;
    std::size_t lights;
    std::string slicing, depth_test, tier;
    double ns_per_light, entries_per_light;
    double ratio;   ///< of the medians: clusters to the flat baseline, z-bins to the build without
    double spread;  ///< 10th to 90th percentile of the turns' own ratios
    double bits;  ///< bitmasks without lists, to building those and encoding them; 0 where that was not timed
};

inline SlicingResult slicing_result(const Turns& turns, const std::string& set, std::size_t lights,
                                    const lightbin::Options& options, std::size_t entries) {
    const double all = double(lights * turns.together);
    return {.set = set,
            .lights = lights,
            .slicing = to_string(options.slicing),
            .depth_test = to_string(options.depth_test),
            .tier = to_string(options.isa),
            .ns_per_light = 1e9 * median(turns.ours) / all,
            .entries_per_light = double(entries) / (all * double(turns.ours.size())),
            .ratio = turns.ratio(),
            .spread = turns.spread(),
            .bits = 0};
}

/// Stops the run unless each slice's lists are those of a grid whose tiles have the slice's ends for Z bounds.
template <class Grid>
void verify_clusters(const Frame& frame, int tile_size, const Grid& grid, lightbin::Options options,
                     const lightbin::Slices& slices) {
    if (options.depth_test == lightbin::DepthTest::none) options.depth_test = lightbin::DepthTest::interval;
    const std::size_t tiles = grid.ranges().size() / std::size_t(grid.slices());
    std::vector<float> ends(slices.boundaries().begin(), slices.boundaries().end());
    ends.insert(ends.begin(), float(frame.lens.near_depth));
    ends.push_back(float(frame.lens.far_depth));
    for (std::size_t slice = 0; slice + 1 < ends.size(); ++slice) {
        const std::vector<float> min(tiles, ends[slice]), max(tiles, ends[slice + 1]);
        const Grid one(grid.tiles_x(), grid.tiles_y(), grid.ranges().subspan(slice * tiles, tiles),
                       grid.ids());
        verify(frame, tile_size, one, options, {.min = min, .max = max});
    }
}

template <lightbin::Options options>
SlicingResult time_clusters(const std::string& set, const std::vector<Frame>& frames, double seconds_a_case) {
    constexpr int tile_size = 64;
    const Lens& lens = frames[0].lens;
    const lightbin::View view = lens.view(tile_size);
    const FlatView flat_view = lens.flat_view(32);
    const lightbin::Slices slices = cluster_slices();
    lightbin::Binner<options> binner;
    Flat<float> flat;
    const auto build = [&](const Frame& frame) {
        return *binner.bin(view, frame.lights, {.slices = slices});
    };
    verify_clusters(frames[0], tile_size, build(frames[0]), options, slices);
    std::size_t entries = 0;
    const Turns turns = take_turns(
        frames, seconds_a_case, [&](const Frame& frame) { entries += build(frame).ids().size(); },
        [&](const Frame& frame) { flat.build<false>(flat_view, frame.lights, nullptr, nullptr); });
    return slicing_result(turns, set, frames[0].lights.size(), options, entries);
}

/// Stops the run unless the lists of ranks hold the same lights as those of ids.
template <class Grid> void verify_ranks(const Grid& ranked, const Grid& plain) {
    std::vector<std::uint32_t> lights;
    for (std::size_t tile = 0; tile < plain.ranges().size(); ++tile) {
        const lightbin::ListRange range = ranked.ranges()[tile], expected = plain.ranges()[tile];
        lights.clear();
        for (const std::uint32_t rank : ranked.ids().subspan(range.offset, range.count))
            lights.push_back(ranked.ranks().order[rank]);
        std::ranges::sort(lights);
        if (std::ranges::equal(lights, plain.ids().subspan(expected.offset, expected.count))) continue;
        std::fprintf(stderr, "binning: wrong lights in tile %zu of z-bins\n", tile);
        std::exit(EXIT_FAILURE);
    }
}

template <lightbin::Options options>
SlicingResult time_z_bins(const std::string& set, const std::vector<Frame>& frames, double seconds_a_case) {
    constexpr lightbin::Options without = [] {
        lightbin::Options plain = options;
        plain.slicing = lightbin::Slicing::none;
        return plain;
    }();
    const lightbin::View view = frames[0].lens.view(32);
    const lightbin::Slices slices = z_bin_slices();
    lightbin::Binner<options> binner;
    lightbin::Binner<without> plain;
    const auto build = [&](const Frame& frame) {
        return *binner.bin(view, frame.lights, {.slices = slices});
    };
    verify_ranks(build(frames[0]), *plain.bin(view, frames[0].lights));
    std::size_t entries = 0;
    const Turns turns = take_turns(
        frames, seconds_a_case, [&](const Frame& frame) { entries += build(frame).ids().size(); },
        [&](const Frame& frame) { static_cast<void>(*plain.bin(view, frame.lights)); });
    SlicingResult result = slicing_result(turns, set, frames[0].lights.size(), options, entries);
    if (frames[0].lights.size() > 1024) return result;

    const lightbin::ListFormat format = {.encoding = lightbin::ListEncoding::bitmask, .max_lights = 1024};
    std::vector<std::uint32_t> bits(lightbin::encoded_bytes(format, view.tile_count(), 0) / 4),
        encoded = bits;
    const auto write = [&](const Frame& frame) {
        static_cast<void>(*binner.bin_bits(view, frame.lights, format.max_lights, bits, {.slices = slices}));
    };
    const auto encode = [&](const Frame& frame) {
        static_cast<void>(
            *lightbin::encode(build(frame), format, std::as_writable_bytes(std::span(encoded))));
    };
    write(frames[0]);
    encode(frames[0]);
    if (bits != encoded) {
        std::fprintf(stderr, "binning: other bitmasks than from lists\n");
        std::exit(EXIT_FAILURE);
    }
    const Turns of_bits = take_turns(frames, seconds_a_case, write, encode);
    result.bits = of_bits.ratio();
    return result;
}

inline void write_slicing_csv(const std::vector<SlicingResult>& results, const char* path) {
    std::FILE* const csv =
        open_report(path, "set,n,slicing,depth_test,tier,ns_per_light,ratio,spread,entries,bits");
    for (const SlicingResult& r : results)
        std::fprintf(csv, "%s,%zu,%s,%s,%s,%.3f,%.4f,%.4f,%.3f,%.3f\n", r.set.c_str(), r.lights,
                     r.slicing.c_str(), r.depth_test.c_str(), r.tier.c_str(), r.ns_per_light, r.ratio,
                     r.spread, r.entries_per_light, r.bits);
    std::fclose(csv);
}

/// The worst of each goal, for the two tiers that have one.
inline void add_slicing_goals(const std::vector<SlicingResult>& results, Goals& goals) {
    const auto add = [&](const char* tier, const char* slicing, const char* depth_test, std::size_t least,
                         std::size_t most, Goal goal) {
        double worst = 0;
        for (const SlicingResult& r : results)
            if (r.tier == tier && r.slicing == slicing && r.depth_test == depth_test && r.set == "field20" &&
                r.lights >= least && r.lights <= most)
                worst = std::max(worst, r.ratio);
        const char* const group =
            std::string_view(slicing) == "clusters" ? "clusters to the flat loop" : "z-bins to none";
        const std::string what =
            text("%s, %zu%s lights of field20", depth_test, least, most > least ? " and more" : "");
        goals.add(group, what, tier, goal, worst);
    };
    for (const bool wide : {true, false}) {
        const char* const tier = wide ? "avx512" : "avx2";
        for (const char* const test : {"none", "box"}) {
            add(tier, "clusters", test, 256, 256, wide ? Goal{1.4, 0.8} : Goal{2, 1});
            add(tier, "clusters", test, 1000, 1000, wide ? Goal{0.8, 0.4} : Goal{1.1, 0.6});
            add(tier, "clusters", test, 4096, 10000, wide ? Goal{0.5, 0.25} : Goal{0.8, 0.45});
        }
        add(tier, "z_bins", "none", 10000, 10000, wide ? Goal{1.5, 1.25} : Goal{1.3, 1.15});
    }
}
