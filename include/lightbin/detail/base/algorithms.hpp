// SPDX-License-Identifier: MIT
// Stand-ins for parts of <algorithm>, which takes 50 ms to compile.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Returns the lesser of two values; `a` if they are equal or if either is NaN.
template <class T> constexpr T min_of(T a, T b) {
    return b < a ? b : a;
}
/// Returns the greater of two values; `a` if they are equal or if either is NaN.
template <class T> constexpr T max_of(T a, T b) {
    return a < b ? b : a;
}

template <class T> void fill_items(T* to, std::uint64_t count, std::type_identity_t<T> value) {
    for (const T* const end = to + count; to != end; ++to)
        *to = value;
}

/// Copies `count` items between arrays that do not overlap. With a count of 0 the pointers may be null.
template <class T> void copy_items(const T* from, std::uint64_t count, T* to) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count > 0) std::memcpy(static_cast<void*>(to), from, static_cast<std::size_t>(count) * sizeof *to);
}

/// Binary search: returns the first item for which is_before(item) is false, or `end`. The items must be sorted so that
/// is_before is true for a first part of them and false for the rest.
template <class T, class IsBefore> const T* first_not(const T* begin, const T* end, IsBefore is_before) {
    while (begin < end) {
        const T* const middle = begin + (end - begin) / 2;
        if (is_before(*middle))
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
}

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
