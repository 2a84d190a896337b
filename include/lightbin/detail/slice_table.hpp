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
        span_ = boundaries.empty() ? 0 : static_cast<std::uint32_t>(ascending(boundaries.back()) - least_);
        shift_ = (std::max)(static_cast<int>(std::bit_width(span_)) - 9, 0);
        before_.clear();
        for (std::uint32_t place = 0, before = 0; place <= span_ >> shift_; ++place) {
            while (before < boundaries.size() &&
                   static_cast<std::uint64_t>(ascending(boundaries[before]) - least_) < std::uint64_t{place}
                                                                                            << shift_)
                ++before;
            before_.push_back(before);
        }
    }

    /// Returns how many boundaries are less than a depth that is not NaN.
    std::uint32_t before(float depth) const {
        std::uint32_t slice = surely_before(depth);
        while (boundaries_[slice] < depth)
            ++slice;
        return slice;
    }
    /// The same of those that are not greater.
    std::uint32_t up_to(float depth) const {
        std::uint32_t slice = surely_before(depth);
        while (boundaries_[slice] <= depth)
            ++slice;
        return slice;
    }

private:
    static std::int64_t ascending(float value) {
        const std::int32_t bits = std::bit_cast<std::int32_t>(value + 0.0f);  // not -0
        return bits < 0 ? std::int64_t{-0x7fffffff} - 1 - bits : bits;
    }
    std::uint32_t surely_before(float depth) const {
        const std::int64_t beyond = std::clamp<std::int64_t>(ascending(depth) - least_, 0, span_);
        return before_[static_cast<std::size_t>(beyond >> shift_)];
    }

    std::vector<float> boundaries_;      ///< and NaN
    std::vector<std::uint32_t> before_;  ///< by the upper bits of what depths are beyond the first boundary
    std::int64_t least_ = 0;
    std::uint32_t span_ = 0;
    int shift_ = 0;
};

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR::detail
