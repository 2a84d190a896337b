// SPDX-License-Identifier: MIT
// Sizes are counted in 64 bits, on machines of 32 bits too. There are fewer than 2^32 lights, tiles and entries, so
// sums and products of these fit. Numbers that a caller may choose freely are added and multiplied here.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

inline constexpr std::uint64_t most_size = ~std::uint64_t{0};

/// The sum, or most_size, which no memory has.
constexpr std::uint64_t sum_of_sizes(std::uint64_t a, std::uint64_t b) {
    return a > most_size - b ? most_size : a + b;
}

/// The product, or most_size.
constexpr std::uint64_t product_of_sizes(std::uint64_t a, std::uint64_t b) {
    return b != 0 && a > most_size / b ? most_size : a * b;
}

}}}  // namespace lightbin::detail
