// SPDX-License-Identifier: MIT
// Stability: settled.
// Depth slices: intervals of view depth that divide each tile's cell into clusters (Olsson, Billeter, Assarsson,
// "Clustered Deferred and Forward Shading", HPG 2012) or serve as z-bins.
#pragma once

#include <lightbin/detail/depth/slice_table.hpp>
#include <lightbin/result.hpp>

#include <span>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Adjacent intervals of view depth without a gap between them. The first slice begins at the near plane, the last one
/// ends at the far plane, and a boundary separates each slice from the next.
class Slices {
public:
    /// Returns slices whose depth grows geometrically, so that perspective cells are about as deep as they are wide.
    /// The first slice ends at depth `first`. Each further slice ends at the depth where it begins times a constant,
    /// chosen so that the last one would end at depth `last`; in fact the last slice reaches to the far plane.
    /// Errors: count is less than 1. With two slices or more: not 0 < first < last, `last` is infinite, or two
    /// boundaries round to the same float.
    static Result<Slices> exponential(int count, float first, float last) {
        if (count > 1 && !(0 < first && first < last && detail::is_finite(last)))
            return Error{ErrorCode::slice_range_empty};
        return from_law(count, [=](std::size_t i) {
            const double begin = static_cast<double>(first), ratio = static_cast<double>(last) / begin;
            return begin * detail::power_of(ratio, static_cast<double>(i) / (count - 1.0));
        });
    }

    /// Returns slices that divide the depths from `begin` to `end` into equal parts. The first slice still begins at
    /// the near plane, and the last one reaches to the far plane. Errors: count is less than 1. With two slices or
    /// more: not begin < end, one of these is infinite, or two boundaries round to the same float.
    static Result<Slices> linear(int count, float begin, float end) {
        if (count > 1 && !(begin < end && detail::is_finite(begin) && detail::is_finite(end)))
            return Error{ErrorCode::slice_range_empty};
        return from_law(count, [=](std::size_t i) {
            return static_cast<double>(begin) + (static_cast<double>(end) - static_cast<double>(begin)) *
                                                    static_cast<double>(i + 1) / count;
        });
    }

    /// Returns the slices between the given boundaries, one slice more than there are boundaries. Errors: the
    /// boundaries do not strictly ascend, or one of them is NaN or infinite.
    static Result<Slices> from_boundaries(std::span<const float> boundaries) {
        return from_law(static_cast<std::int64_t>(boundaries.size()) + 1,
                        [=](std::size_t i) { return boundaries[i]; });
    }

    /// Returns these slices for readers whose lookup is inexact: shaders that compute the slice by a rounding formula
    /// of their own, or from a rounded depth, and so may find for a depth d the slice of any depth from d - margin |d|
    /// to d + margin |d|. Lights are then listed in every slice that may be found for one of their depths. Readers that
    /// use slice_at() or shader_slices() need no margin.
    ///
    /// margin  from 0 to 1/2; docs/depth.md says which is enough
    Slices with_margin(float margin) const {
        LIGHTBIN_ASSERT(0 <= margin && margin <= 0.5f);
        const double exact = static_cast<double>(margin);
        Slices result(*this);
        // If a depth d is looked up as e, with |e - d| <= margin |d|, then d lies within margin / (1 - margin) |e| of
        // e. The factor 1 + 2^-20 covers rounding.
        result.table_.margin = detail::float_above(exact / (1 - exact) * (1 + 0x1p-20));
        result.margin_ = margin;
        return result;
    }

    Slices(const Slices& other) : Slices(other.table_.boundaries()) {
        table_.margin = other.table_.margin;
        margin_ = other.margin_;
    }
    Slices& operator=(Slices other) noexcept {
        std::swap(table_, other.table_);
        std::swap(margin_, other.margin_);
        return *this;
    }

    float margin() const { return margin_; }  ///< what with_margin() was given, or 0
    int count() const { return static_cast<int>(table_.boundaries().size()) + 1; }

    /// Returns the count() - 1 boundaries in ascending order, valid as long as the Slices. Slice i ends at boundary i.
    std::span<const float> boundaries() const& { return table_.boundaries(); }
    void boundaries() && = delete;  // the span would dangle

    /// Returns the index of the slice that contains a depth, not NaN. A boundary itself belongs to the slice behind it.
    int slice_at(float depth) const {
        const float *const begin = table_.boundaries().data(), *const end = begin + table_.boundaries().size();
        return static_cast<int>(detail::first_not(begin, end, [=](float boundary) { return boundary <= depth; }) - begin);
    }

private:
    /// Returns the lookup table from depths to slices. It is not public: the library's own binning stages read it.
    friend const detail::SliceTable& table_of(const Slices& slices) { return slices.table_; }

    explicit Slices(std::span<const float> boundaries) : table_(boundaries) {}

    /// Returns `count` slices whose boundary i is at the depth boundary(i).
    template <class Law> static Result<Slices> from_law(std::int64_t count, Law boundary) {
        const detail::DefaultFloatEnvironment environment;
        if (count < 1) return Error{ErrorCode::no_slices, static_cast<std::uint64_t>(count)};
        detail::Buffer<float> memory;
        float* const boundaries = memory.reserve(static_cast<std::uint64_t>(count));
        for (std::size_t i = 0; i < static_cast<std::size_t>(count) - 1; ++i) {
            boundaries[i] = static_cast<float>(boundary(i)) + 0.0f;  // makes -0 a +0
            if (!detail::is_finite(boundaries[i]) || (i > 0 && !(boundaries[i - 1] < boundaries[i])))
                return Error{ErrorCode::slices_do_not_ascend, i};
        }
        return Slices({boundaries, static_cast<std::size_t>(count) - 1});
    }

    detail::SliceTable table_;
    float margin_ = 0;
};

}}  // namespace lightbin
