// SPDX-License-Identifier: MIT
// Depth slices: what makes clusters of tiles (Olsson, Billeter, Assarsson, "Clustered Deferred and Forward Shading",
// HPG 2012).
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/detail/base/float_environment.hpp>
#include <lightbin/detail/base/math.hpp>
#include <lightbin/detail/base/rounding.hpp>
#include <lightbin/detail/depth/slice_table.hpp>
#include <lightbin/result.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

class Slices;

namespace detail {

/// Where depths are in the slices.
const SliceTable& table_of(const Slices& slices);

}  // namespace detail

/// Intervals of view depth, one behind another without a gap: the first begins at the near plane, the last one ends at
/// the far plane, and between two lies a boundary.
class Slices {
public:
    /// Returns slices of which the first ends at depth `first`, and each of the others is as many times as deep as the
    /// one before it as make the last one end at `last`; it is open all the same. So cells are about as deep as wide.
    ///
    /// count  from 1 on. Errors: it is less; where there are two slices or more: not 0 < first < last, last is infinite,
    ///        or two boundaries round to the same float
    static Result<Slices> exponential(int count, float first, float last) {
        if (count > 1 && !(0 < first && first < last && detail::is_finite(last)))
            return Error{ErrorCode::slice_range_empty};
        return from_law(count, [=](std::size_t i) {
            const double begin = static_cast<double>(first), ratio = static_cast<double>(last) / begin;
            return begin * detail::power_of(ratio, static_cast<double>(i) / (count - 1.0));
        });
    }

    /// Returns slices that are equally deep from depth `begin` to `end`; the last one is open.
    ///
    /// count  from 1 on. Errors: it is less; where there are two slices or more: not begin < end, one of them is infinite,
    ///        or two boundaries round to the same float
    static Result<Slices> linear(int count, float begin, float end) {
        if (count > 1 && !(begin < end && detail::is_finite(begin) && detail::is_finite(end)))
            return Error{ErrorCode::slice_range_empty};
        return from_law(count, [=](std::size_t i) {
            return static_cast<double>(begin) + (static_cast<double>(end) - static_cast<double>(begin)) *
                                                    static_cast<double>(i + 1) / count;
        });
    }

    /// Returns one slice more than there are boundaries. Errors: they do not ascend, or one is NaN or infinite.
    static Result<Slices> from_boundaries(std::span<const float> boundaries) {
        return from_law(static_cast<std::int64_t>(boundaries.size()) + 1,
                        [=](std::size_t i) { return boundaries[i]; });
    }

    /// Returns the same slices for readers that may look up another depth than d in place of d, from d - margin |d| to
    /// d + margin |d|: by a formula of their own, which rounds, or by a rounded depth. A light is then listed in every slice
    /// that one of its depths may be looked up in. Readers that use slice_at() or shader_slices() need no margin.
    ///
    /// margin  from 0 to 1/2; docs/depth.md says which is enough
    Slices with_margin(float margin) const {
        LIGHTBIN_ASSERT(0 <= margin && margin <= 0.5f);
        const double exact = static_cast<double>(margin);
        Slices result(*this);
        // What is looked up at a depth lies within margin / (1 - margin) of it. A little more is for rounding.
        result.table_.margin = detail::float_above(exact / (1 - exact) * (1 + 0x1p-20));
        return result;
    }

    Slices(const Slices& other) : Slices(other.table_.boundaries()) { table_.margin = other.table_.margin; }
    Slices& operator=(Slices other) noexcept {
        std::swap(table_, other.table_);
        return *this;
    }
    ~Slices() = default;

    int count() const { return static_cast<int>(table_.boundaries().size()) + 1; }

    /// count() - 1 of them, ascending: slice i is from boundary i - 1 to boundary i. (A template as Error::message().)
    template <class Float = float> std::span<const Float> boundaries() const& {
        return {table_.boundaries().first, table_.boundaries().count};
    }
    void boundaries() && = delete;  // would dangle

    /// Returns the slice of a depth that is not NaN; of a boundary the one behind it.
    int slice_at(float depth) const {
        const detail::Items<const float> all = table_.boundaries();
        return static_cast<int>(
            detail::first_not(all.begin(), all.end(), [=](float boundary) { return boundary <= depth; }) -
            all.begin());
    }

private:
    friend const detail::SliceTable& detail::table_of(const Slices& slices);

    explicit Slices(detail::Items<const float> boundaries) : table_(boundaries) {}

    template <class Law> static Result<Slices> from_law(std::int64_t count, Law boundary) {
        const detail::DefaultFloatEnvironment environment;
        if (count < 1) return Error{ErrorCode::no_slices, static_cast<std::uint64_t>(count)};
        detail::Buffer<float> memory;
        float* const boundaries = memory.reserve(static_cast<std::uint64_t>(count));
        for (std::size_t i = 0; i < static_cast<std::size_t>(count) - 1; ++i) {
            boundaries[i] = static_cast<float>(boundary(i)) + 0.0f;  // not -0
            if (!detail::is_finite(boundaries[i]) || (i > 0 && !(boundaries[i - 1] < boundaries[i])))
                return Error{ErrorCode::slices_do_not_ascend, i};
        }
        return Slices({boundaries, static_cast<std::size_t>(count) - 1});
    }

    detail::SliceTable table_;
};

inline const detail::SliceTable& detail::table_of(const Slices& slices) {
    return slices.table_;
}

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
