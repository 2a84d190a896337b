// SPDX-License-Identifier: MIT
// The common implementation of to_string() for enums.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstddef>
#include <initializer_list>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Returns names[value], or "?" if the value is not an index of `names`.
template <class Enum> constexpr const char* name_at(Enum value, std::initializer_list<const char*> names) {
    const std::size_t index = static_cast<std::size_t>(value);
    return index < names.size() ? names.begin()[index] : "?";
}

}}}  // namespace lightbin::detail
