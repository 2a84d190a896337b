// SPDX-License-Identifier: MIT
// What the core takes of <algorithm>, <functional> and <span>, in a few lines. The first two take every file that includes
// the core a tenth of a second each to compile, and a std::span another 7 ms for each type of items that one is made of:
// functions that return one are templates, which only their callers compile.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Some items in a row. As std::span, which the core takes and hands out.
template <class T> struct Items {
    T* first;
    std::size_t count;

    T* begin() const { return first; }
    T* end() const { return first + count; }
    std::size_t size() const { return count; }
    T& operator[](std::size_t i) const { return first[i]; }
};

/// With NaN, or equal numbers, `a`: so is max_of().
template <class T> constexpr T min_of(T a, T b) {
    return b < a ? b : a;
}
template <class T> constexpr T max_of(T a, T b) {
    return a < b ? b : a;
}

template <class T> void fill_items(T* to, std::uint64_t count, std::type_identity_t<T> value) {
    for (const T* const end = to + count; to != end; ++to)
        *to = value;
}

/// Of memory that does not overlap. No count, no pointers needed.
template <class T> void copy_items(const T* from, std::uint64_t count, T* to) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count > 0) std::memcpy(static_cast<void*>(to), from, static_cast<std::size_t>(count) * sizeof *to);
}

/// The first item of which `is_before` is false, as it is of all behind it; or `end`.
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
