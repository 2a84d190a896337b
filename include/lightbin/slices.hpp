// SPDX-License-Identifier: MIT
// Depth slices: what makes clusters of tiles (Olsson, Billeter, Assarsson, "Clustered Deferred and Forward Shading",
// HPG 2012).
#pragma once

#include <lightbin/detail/buffer.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/math.hpp>
#include <lightbin/detail/plain.hpp>
#include <lightbin/result.hpp>

#include <cstddef>
#include <span>
#include <utility>

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
            return static_cast<double>(first) * detail::power_of(ratio, (i - 1.0) / (count - 1.0));
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
        Slices slices(boundaries.size());
        for (std::size_t i = 0; i < boundaries.size(); ++i)
            slices.boundaries_.data()[i] = boundaries[i] + 0.0f;  // not -0
        return checked(std::move(slices));
    }

    Slices(const Slices& other) : Slices(other.boundary_count_) {
        detail::copy_items(other.boundaries_.data(), boundary_count_, boundaries_.data());
    }
    Slices(Slices&& other) noexcept { swap(other); }
    Slices& operator=(Slices other) noexcept {
        swap(other);
        return *this;
    }
    ~Slices() = default;

    int count() const { return static_cast<int>(boundary_count_) + 1; }

    /// count() - 1 of them, ascending: slice i is from boundary i - 1 to boundary i. (A template as Error::message().)
    template <class Float = float> std::span<const Float> boundaries() const& {
        return {boundaries_.data(), boundary_count_};
    }
    void boundaries() && = delete;  // would dangle

    /// Returns the slice of a depth that is not NaN; of a boundary the one behind it.
    int slice_at(float depth) const {
        const float* const first = boundaries_.data();
        return static_cast<int>(detail::first_not(first, first + boundary_count_,
                                                  [=](float boundary) { return boundary <= depth; }) -
                                first);
    }

private:
    explicit Slices(std::size_t boundary_count) : boundary_count_(boundary_count) {
        boundaries_.reserve(boundary_count);
    }

    template <class Law> static Result<Slices> from_law(int count, Law boundary) {
        if (count < 1) return Error{ErrorCode::no_slices, static_cast<std::uint64_t>(std::int64_t{count})};
        Slices slices(static_cast<std::size_t>(count) - 1);
        for (int i = 1; i < count; ++i)
            slices.boundaries_.data()[i - 1] = static_cast<float>(boundary(i)) + 0.0f;  // not -0
        return checked(std::move(slices));
    }

    void swap(Slices& other) noexcept {
        boundaries_.swap(other.boundaries_);
        std::swap(boundary_count_, other.boundary_count_);
    }

    static Result<Slices> checked(Slices slices) {
        const float* const boundaries = slices.boundaries_.data();
        for (std::size_t i = 0; i < slices.boundary_count_; ++i)
            if (!detail::is_finite(boundaries[i]) || (i > 0 && !(boundaries[i - 1] < boundaries[i])))
                return Error{ErrorCode::slices_do_not_ascend, i};
        return slices;
    }

    detail::Buffer<float> boundaries_;
    std::size_t boundary_count_ = 0;
};

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR

#include <lightbin/detail/warnings_on.inl>
