// SPDX-License-Identifier: MIT
// Compares the lists that the GPU made with the Binner's, light by light.
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
    std::size_t missed = 0;     ///< entries of the Binner that the GPU lacks
    std::size_t more = 0;       ///< entries that only the GPU has
    std::size_t unordered = 0;  ///< ids that do not ascend, and lists that do not begin where the one before ends

    bool right() const { return missed == 0 && unordered == 0; }
    Difference& operator+=(const Difference& other) {
        entries += other.entries, missed += other.missed, more += other.more, unordered += other.unordered;
        return *this;
    }
};

inline Difference compare(const ReadLists& gpu, std::span<const lightbin::ListRange> ranges,
                          std::span<const std::uint32_t> ids) {
    Difference difference;
    difference.entries = ids.size();
    std::uint32_t end = 0;
    for (std::size_t cell = 0; cell < ranges.size(); ++cell) {
        const lightbin::ListRange& list = gpu.ranges[cell];
        difference.unordered += list.offset != end;
        end = list.offset + list.count;
        if (end > gpu.ids.size()) {  // the room did not do, or there is nothing to be read
            ++difference.unordered;
            return difference;
        }
        for (std::uint32_t i = list.offset + 1; i < end; ++i)
            difference.unordered += gpu.ids[i] <= gpu.ids[i - 1];
        const auto theirs = std::span(gpu.ids).subspan(list.offset, list.count),
                   ours = ids.subspan(ranges[cell].offset, ranges[cell].count);
        std::vector<std::uint32_t> both;
        std::ranges::set_intersection(ours, theirs, std::back_inserter(both));
        difference.missed += ours.size() - both.size();
        difference.more += theirs.size() - both.size();
    }
    difference.unordered += end != gpu.totals.entries;
    return difference;
}
