// SPDX-License-Identifier: MIT
// The GPU's lists against the Binner's, light by light.
#pragma once

#include "gpu_build.hpp"

#include <lightbin/lightbin.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <vector>

struct Difference {
    std::size_t entries = 0;    ///< of the Binner
    std::size_t missed = 0;     ///< of them, those that the GPU lacks; with z-bins also missed_in_bins()
    std::size_t more = 0;       ///< entries of the GPU alone
    std::size_t unordered = 0;  ///< ids of the GPU not above the one before, and lists that don't join

    Difference& operator+=(const Difference& other) {
        entries += other.entries, missed += other.missed, more += other.more, unordered += other.unordered;
        return *this;
    }
};

/// ranks  with z-bins those of the Binner; else empty
inline Difference compare(const ReadLists& gpu, std::span<const lightbin::ListRange> ranges,
                          std::span<const std::uint32_t> ids, const lightbin::LightRanks& ranks) {
    Difference difference;
    difference.entries = ids.size();
    std::vector<std::uint32_t> ours, theirs;
    std::uint32_t end = 0;
    for (std::size_t cell = 0; cell < ranges.size(); ++cell) {
        const lightbin::ListRange& list = gpu.ranges[cell];
        difference.unordered += list.offset != end;
        end = list.offset + list.count;
        if (end > gpu.ids.size()) {  // the room did not do, or there is nothing to be read
            ++difference.unordered;
            return difference;
        }
        theirs.clear();
        for (std::uint32_t i = list.offset; i < end; ++i) {
            difference.unordered += i > list.offset && gpu.ids[i] <= gpu.ids[i - 1];
            theirs.push_back(gpu.order.empty() ? gpu.ids[i] : gpu.order[gpu.ids[i]]);
        }
        ours.clear();
        for (const std::uint32_t id : ids.subspan(ranges[cell].offset, ranges[cell].count))
            ours.push_back(ranks.order.empty() ? id : ranks.order[id]);
        if (!ranks.order.empty()) {  // the two may rank lights of one depth differently
            std::ranges::sort(ours);
            std::ranges::sort(theirs);
        }
        std::vector<std::uint32_t> both;
        std::ranges::set_intersection(ours, theirs, std::back_inserter(both));
        difference.missed += ours.size() - both.size();
        difference.more += theirs.size() - both.size();
    }
    difference.unordered += end != gpu.totals.entries;
    return difference;
}

/// With z-bins: how many bins lack the rank of a light whose depths, in double precision, reach into the bin. The
/// Binner's own bins are no measure: they have a few lights more.
inline std::size_t missed_in_bins(const ReadLists& gpu, const GpuFrame& frame,
                                  const lightbin::Slices& slices) {
    const auto ends = slices.boundaries();
    const glm::dmat4 to_view = frame.to_view ? glm::dmat4(*frame.to_view) : glm::dmat4(1);
    std::size_t missed = 0;
    for (std::uint32_t rank = 0; rank < gpu.order.size(); ++rank) {
        const glm::vec4& light = frame.lights[gpu.order[rank]];
        const double depth = -(to_view * glm::dvec4(glm::dvec3(light), 1)).z, radius = double(light.w);
        auto bin = std::size_t(std::ranges::upper_bound(ends, depth - radius) - ends.begin());
        const auto last = std::size_t(std::ranges::lower_bound(ends, depth + radius) - ends.begin());
        for (; bin <= last; ++bin)
            missed += rank < gpu.bins[bin].least || rank > gpu.bins[bin].greatest;
    }
    return missed;
}
