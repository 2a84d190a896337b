// SPDX-License-Identifier: MIT
// Depth slices: what makes clusters of tiles (Olsson, Billeter, Assarsson, "Clustered Deferred and Forward Shading",
// HPG 2012).
#pragma once

#include <lightbin/detail/flavour.hpp>
#include <lightbin/result.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

/// Intervals of view depth, one behind another without a gap: the first begins at the near plane, the last one ends at
/// the far plane, and between two lies a boundary.
class Slices {
public:
    /// Returns slices of which the first ends at depth `first`, and each of the others is as many times as deep as the
    /// one before it as make the last one end at `last`; it is open all the same. So cells are about as deep as wide.
    ///
    /// count  from 1 on. Errors: it is less; not 0 < first < last, where there are two slices or more
    static Result<Slices> exponential(int count, float first, float last) {
        if (count > 1 && !(0 < first && first < last)) return Error{ErrorCode::slices_do_not_ascend};
        const double ratio = static_cast<double>(last) / static_cast<double>(first);
        return from_law(count, [=](int i) {
            return static_cast<double>(first) * std::pow(ratio, (i - 1.0) / (count - 1.0));
        });
    }

    /// Returns slices that are equally deep from depth `begin` to `end`; the last one is open.
    ///
    /// count  from 1 on. Errors: it is less; not begin < end, where there are two slices or more
    static Result<Slices> linear(int count, float begin, float end) {
        if (count > 1 && !(begin < end)) return Error{ErrorCode::slices_do_not_ascend};
        return from_law(count, [=](int i) {
            return static_cast<double>(begin) +
                   (static_cast<double>(end) - static_cast<double>(begin)) * i / count;
        });
    }

    /// Returns one slice more than there are boundaries. Errors: they do not ascend, or one is NaN or infinite.
    static Result<Slices> from_boundaries(std::span<const float> boundaries) {
        for (std::size_t i = 0; i < boundaries.size(); ++i)
            if (!std::isfinite(boundaries[i]) || (i > 0 && !(boundaries[i - 1] < boundaries[i])))
                return Error{ErrorCode::slices_do_not_ascend, i};
        std::vector<float> own(boundaries.begin(), boundaries.end());
        for (float& boundary : own)
            boundary += 0.0f;  // not -0
        return Slices(std::move(own));
    }

    int count() const { return static_cast<int>(boundaries_.size()) + 1; }

    /// count() - 1 of them, ascending: slice i is from boundary i - 1 to boundary i.
    std::span<const float> boundaries() const& { return boundaries_; }
    std::span<const float> boundaries() && = delete;  // would dangle

    /// Returns the slice of a depth that is not NaN; of a boundary the one behind it.
    int slice_at(float depth) const {
        return static_cast<int>(std::ranges::upper_bound(boundaries_, depth) - boundaries_.begin());
    }

private:
    explicit Slices(std::vector<float> boundaries) : boundaries_(std::move(boundaries)) {}

    template <class Law> static Result<Slices> from_law(int count, Law boundary) {
        if (count < 1) return Error{ErrorCode::no_slices, static_cast<std::uint64_t>(std::int64_t{count})};
        std::vector<float> boundaries;
        for (int i = 1; i < count; ++i)
            boundaries.push_back(static_cast<float>(boundary(i)));
        return from_boundaries(boundaries);
    }

    std::vector<float> boundaries_;
};

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR

#include <lightbin/detail/warnings_on.inl>
