// SPDX-License-Identifier: MIT
// From a depth to its slice: by a table of places, which are equally long in depth, or in the bits of a float, which
// ascend with it and begin with what a logarithm would say.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/detail/base/float_environment.hpp>
#include <lightbin/detail/base/math.hpp>
#include <lightbin/detail/base/platform.hpp>
#include <lightbin/detail/base/rounding.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// From a depth to its place in a table.
struct DepthBuckets {
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
struct LightDepths {
    static constexpr std::uint32_t size = 64;
    float nearest[size], farthest[size];
    std::uint16_t first[size], last[size];
};

/// The slices of one list of boundaries, which ascend and are finite.
class SliceTable {
public:
    explicit SliceTable(Items<const float> boundaries) : count_(boundaries.size()) {
        const DefaultFloatEnvironment environment;
        float* const to = boundaries_.reserve(count_ + std::uint64_t{1});
        copy_items(boundaries.first, count_, to);
        to[count_] = std::numeric_limits<float>::quiet_NaN();  // neither before nor behind anything
        // Linear slices are alike in depth, exponential ones in their bits.
        fill_places(false);
        const std::size_t shared_by_depth = shared_;
        fill_places(true);
        if (shared_ > shared_by_depth) fill_places(false);
    }

    Items<const float> boundaries() const { return {boundaries_.data(), count_}; }

    /// How far the depths of lights and slices are widened, as a share of themselves: see Slices::with_margin().
    float margin = 0;

    /// Returns a depth lowered or raised by the margin and rounded outward: where a widened interval begins or ends.
    float nearer(float depth) const { return margin > 0 ? float_below(moved(depth, -margin)) : depth; }
    float farther(float depth) const { return margin > 0 ? float_above(moved(depth, margin)) : depth; }

    /// Calls found(i, first, last) for each light i of the runs: its depths, ends included, meet the slices first..last.
    /// Where `roughly`, these may be one more at either end, if that is sooner known.
    ///
    /// kernel        find_depth_buckets() of a tier
    /// lights, runs  FootprintArrays and FootprintRuns
    template <class Kernel, class Lights, class Runs, class Found>
    void find(Kernel kernel, bool roughly, float z_sign, const Lights& lights, Runs runs, Found found) const {
        roughly = roughly && shared_ == 0 && places_.last < most_places - 1;
        for (const auto& run : runs) {
            fill_items(lights.ids + run.end, 16, lights.ids[run.begin]);  // whole vectors of lights are read
            for (std::uint32_t i = run.begin; i < run.end; i += LightDepths::size) {
                const std::uint32_t count = min_of(run.end - i, LightDepths::size);
                LightDepths at;
                kernel(places_, z_sign, lights, lights.ids + i, count, at);
                if (margin > 0) widen(at, count);
                for (std::uint32_t j = 0; j < count && roughly; ++j)
                    found(i + j, before_.data()[at.first[j]], before_.data()[at.last[j] + 1u]);
                for (std::uint32_t j = 0; j < count && !roughly; ++j) {
                    const float nearest = at.nearest[j], farthest = at.farthest[j];
                    found(i + j, before(at.first[j], [=](float boundary) { return boundary < nearest; }),
                          before(at.last[j], [=](float boundary) { return boundary <= farthest; }));
                }
            }
        }
    }

private:
    static constexpr std::size_t most_places = 0x8000;  // 15 bits number them

    static double moved(float depth, float share) {
        const double exact = static_cast<double>(depth);
        return exact + abs_of(exact) * static_cast<double>(share);  // of floats, so the product is exact
    }

    void widen(LightDepths& at, std::uint32_t count) const {
        for (std::uint32_t i = 0; i < count; ++i) {
            at.nearest[i] = nearer(at.nearest[i]);
            at.farthest[i] = farther(at.farthest[i]);
            at.first[i] = static_cast<std::uint16_t>(places_.of(at.nearest[i]));
            at.last[i] = static_cast<std::uint16_t>(places_.of(at.farthest[i]));
        }
    }

    /// Returns how many boundaries are before a depth, from its place on.
    template <class IsBefore> std::uint32_t before(std::size_t place, IsBefore is_before) const {
        const float* const boundaries = boundaries_.data();
        std::uint32_t slice = before_.data()[place];
        slice += is_before(boundaries[slice]);  // rarely more than one, so the loop's branch is predicted
        while (is_before(boundaries[slice]))
            ++slice;
        return slice;
    }

    /// Finds how many boundaries are before each place.
    void fill_places(bool by_bits) {
        const Items<const float> all = boundaries();
        places_.by_bits = by_bits;
        // So many that few boundaries share one; no fewer than are in the cache anyway.
        const std::size_t places = min_of(max_of(std::bit_ceil(4 * count_), std::size_t{512}), most_places);
        places_.last = static_cast<float>(places - 1);
        places_.begin = count_ == 0 ? 0 : places_.coordinate(all[0]);
        const float span = count_ == 0 ? 0 : places_.coordinate(all[count_ - 1]) - places_.begin;
        places_.scale = places_.last / span;
        if (!is_finite(places_.scale)) places_.scale = 0;  // there is one at most, or as good as one

        std::uint32_t* const counts = before_.reserve(places + 1);
        fill_items(counts, places + 1, 0);
        for (const float boundary : all)
            ++counts[places_.of(boundary) + 1];
        shared_ = 0;
        for (std::size_t i = 1; i <= places; ++i) {
            shared_ += counts[i] > 1 ? counts[i] - 1 : 0;
            counts[i] += counts[i - 1];
        }
    }

    Buffer<float> boundaries_;      ///< and NaN
    std::size_t count_;             ///< of those without it
    Buffer<std::uint32_t> before_;  ///< how many boundaries are before a place, and in all of them
    std::size_t shared_ = 0;        ///< boundaries that are in the place of another
    DepthBuckets places_;
};

}}}  // namespace lightbin::detail
