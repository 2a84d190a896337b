// SPDX-License-Identifier: MIT
// From a depth to its slice: by a table of places, which are equally long in depth, or in the bits of a float, which
// ascend with it and begin with what a logarithm would say.
#pragma once

#include <lightbin/detail/buffer.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/math.hpp>
#include <lightbin/detail/plain.hpp>
#include <lightbin/detail/platform.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// From a depth to its place in a table.
struct SlicePlaces {
    float begin = 0, scale = 0, last = 0;
    bool by_bits = false;

    /// Ascends with the depth.
    float coordinate(float depth) const {
        if (!by_bits) return depth;
        const std::int32_t bits = bit_cast<std::int32_t>(depth + 0.0f);  // not -0
        return static_cast<float>(bits ^ (bits >> 31 & 0x7fffffff));
    }
    /// Each step rounds the same everywhere and is monotone, so a depth in a later place is greater.
    std::size_t of(float depth) const {
        const float place = (coordinate(depth) - begin) * scale;
        return static_cast<std::size_t>(static_cast<std::int32_t>(
            place > 0 ? min_of(place, last) : 0));  // NaN, of an infinite depth, is of one place only
    }
};

/// The depths of some lights, and the places of those; written in whole vectors.
struct PlacedDepths {
    static constexpr std::uint32_t size = 64;
    float nearest[size], farthest[size];
    std::uint16_t first[size], last[size];
};

/// The slices of one list of boundaries, which ascend and are finite.
class SliceTable {
public:
    void set(std::span<const float> boundaries) {
        if (same(boundaries)) return;
        count_ = 0;  // until there is a table, should there be no memory
        float* const to = boundaries_.reserve(boundaries.size() + 1);
        // Linear slices are alike in depth, exponential ones in their bits.
        fill_places(boundaries, false);
        const std::size_t shared_by_depth = shared_;
        fill_places(boundaries, true);
        if (shared_ > shared_by_depth) fill_places(boundaries, false);
        copy_items(boundaries.data(), boundaries.size(), to);
        to[boundaries.size()] =
            std::numeric_limits<float>::quiet_NaN();  // neither before nor behind anything
        count_ = boundaries.size() + 1;
    }

    /// Calls found(i, first, last) for each light i of the runs: its depths, ends included, meet the slices first..last.
    /// Where `roughly`, these may be one more at either end, if that is sooner known.
    ///
    /// kernel  slice_places() of a tier
    template <class Kernel, class Found>
    void find(Kernel kernel, bool roughly, float z_sign, const FootprintArrays& lights, Items<const FootprintRun> runs,
              Found found) const {
        roughly = roughly && shared_ == 0 && places_.last < most_places - 1;
        for (const FootprintRun& run : runs) {
            fill_items(lights.ids + run.end, 16, lights.ids[run.begin]);  // whole vectors of lights are read
            for (std::uint32_t i = run.begin; i < run.end; i += PlacedDepths::size) {
                const std::uint32_t count = min_of(run.end - i, PlacedDepths::size);
                PlacedDepths at;
                kernel(places_, z_sign, lights, lights.ids + i, count, at);
                for (std::uint32_t j = 0; j < count && roughly; ++j)
                    found(i + j, before_.data()[at.first[j]], before_.data()[at.last[j] + 1u]);
                for (std::uint32_t j = 0; j < count && !roughly; ++j)
                    found(i + j, before(at.first[j], at.nearest[j]), up_to(at.last[j], at.farthest[j]));
            }
        }
    }

private:
    static constexpr std::size_t most_places = 0x8000;  // 15 bits number them

    /// Returns how many boundaries are less than a depth that is not NaN, from its place on.
    std::uint32_t before(std::size_t place, float depth) const {
        const float* const boundaries = boundaries_.data();
        std::uint32_t slice = before_.data()[place];
        slice += boundaries[slice] < depth;  // rarely more than one, so the loop's branch is predicted
        while (boundaries[slice] < depth)
            ++slice;
        return slice;
    }
    /// The same of those that are not greater.
    std::uint32_t up_to(std::size_t place, float depth) const {
        const float* const boundaries = boundaries_.data();
        std::uint32_t slice = before_.data()[place];
        slice += boundaries[slice] <= depth;
        while (boundaries[slice] <= depth)
            ++slice;
        return slice;
    }

    bool same(std::span<const float> boundaries) const {
        if (count_ != boundaries.size() + 1) return false;
        for (std::size_t i = 0; i < boundaries.size(); ++i)
            if (boundaries_.data()[i] < boundaries[i] || boundaries[i] < boundaries_.data()[i]) return false;
        return true;
    }

    /// Finds how many boundaries are before each place.
    void fill_places(std::span<const float> boundaries, bool by_bits) {
        places_.by_bits = by_bits;
        // So many that few boundaries share one; no fewer than are in the cache anyway.
        const std::size_t places = min_of(max_of(std::bit_ceil(4 * boundaries.size()), std::size_t{512}), most_places);
        places_.last = static_cast<float>(places - 1);
        places_.begin = boundaries.empty() ? 0 : places_.coordinate(boundaries.front());
        const float span = boundaries.empty() ? 0 : places_.coordinate(boundaries.back()) - places_.begin;
        places_.scale = places_.last / span;
        if (!is_finite(places_.scale)) places_.scale = 0;  // there is one at most, or as good as one

        std::uint32_t* const before = before_.reserve(places + 1);
        fill_items(before, places + 1, 0);
        for (const float boundary : boundaries)
            ++before[places_.of(boundary) + 1];
        shared_ = 0;
        for (std::size_t i = 1; i <= places; ++i) {
            shared_ += before[i] > 1 ? before[i] - 1 : 0;
            before[i] += before[i - 1];
        }
    }

    Buffer<float> boundaries_;      ///< and NaN
    std::size_t count_ = 0;         ///< of those, NaN too; 0: there is no table
    Buffer<std::uint32_t> before_;  ///< how many boundaries are before a place, and in all of them
    std::size_t shared_ = 0;        ///< boundaries that are in the place of another
    SlicePlaces places_;
};

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR::detail
