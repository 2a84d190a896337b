// SPDX-License-Identifier: MIT
// What to_string() of an enum returns.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstddef>
#include <initializer_list>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The name at a value's place: the names of an enum's values, in their order. "?" where there is none.
template <class Enum> constexpr const char* name_at(Enum value, std::initializer_list<const char*> names) {
    const std::size_t place = static_cast<std::size_t>(value);
    return place < names.size() ? names.begin()[place] : "?";
}

}}}  // namespace lightbin::detail
