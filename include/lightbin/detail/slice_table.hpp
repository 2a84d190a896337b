// SPDX-License-Identifier: MIT
// From a depth to its slice: the bits of a float, which ascend with it, begin with what a logarithm would say.
#pragma once

#include <lightbin/detail/flavour.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// The slices of one list of boundaries, which ascend, are finite and not -0.
class SliceTable {
public:
    void set(std::span<const float> boundaries) {
        if (!boundaries_.empty() &&
            std::equal(boundaries.begin(), boundaries.end(), boundaries_.begin(), boundaries_.end() - 1))
            return;
        boundaries_.assign(boundaries.begin(), boundaries.end());
        boundaries_.push_back(std::numeric_limits<float>::quiet_NaN());  // neither before nor behind anything
        least_ = boundaries.empty() ? 0 : ascending(boundaries.front());
        most_ = boundaries.empty() ? 0 : ascending(boundaries.back());
        const std::uint32_t span = beyond_least(most_);
        // Some ten places a boundary, so that few depths share theirs with one; no fewer than are in the cache anyway.
        const int bits = (std::max)(static_cast<int>(std::bit_width(boundaries.size())) + 3, 9);
        shift_ = (std::max)(static_cast<int>(std::bit_width(span)) - bits, 0);
        before_.clear();
        for (std::uint32_t place = 0, before = 0; place <= span >> shift_; ++place) {
            while (before < boundaries.size() &&
                   beyond_least(ascending(boundaries[before])) >> shift_ < place)
                ++before;
            before_.push_back(before);
        }
    }

    /// Returns how many boundaries are less than a depth that is not NaN.
    std::uint32_t before(float depth) const {
        std::uint32_t slice = surely_before(depth);
        slice += boundaries_[slice] < depth;  // rarely more than one, so the loop's branch is predicted
        while (boundaries_[slice] < depth)
            ++slice;
        return slice;
    }
    /// The same of those that are not greater.
    std::uint32_t up_to(float depth) const {
        std::uint32_t slice = surely_before(depth);
        slice += boundaries_[slice] <= depth;
        while (boundaries_[slice] <= depth)
            ++slice;
        return slice;
    }

private:
    /// The bits of a float as a number that ascends with it; that of -0 is just less than that of 0.
    static std::int32_t ascending(float value) {
        const std::int32_t bits = std::bit_cast<std::int32_t>(value);
        return bits ^ (bits >> 31 & 0x7fffffff);
    }
    std::uint32_t beyond_least(std::int32_t bits) const {
        return static_cast<std::uint32_t>(bits) - static_cast<std::uint32_t>(least_);
    }
    std::uint32_t surely_before(float depth) const {
        return before_[beyond_least(std::clamp(ascending(depth), least_, most_)) >> shift_];
    }

    std::vector<float> boundaries_;      ///< and NaN
    std::vector<std::uint32_t> before_;  ///< by the upper bits of what depths are beyond the first boundary
    std::int32_t least_ = 0, most_ = 0;
    int shift_ = 0;
};

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR::detail
