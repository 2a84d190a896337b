// SPDX-License-Identifier: MIT
// Saturating sums and products of sizes, for numbers that the caller may choose freely, such as the pitch of a depth
// buffer. Sizes are 64-bit numbers, also on 32-bit machines. The numbers of lights, tiles and entries are below 2^32,
// so that the product of any two of them fits without such a function.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The greatest size, which no memory has. It stands for all sizes that overflow.
inline constexpr std::uint64_t max_size = ~std::uint64_t{0};

/// Returns a + b, or max_size if the sum overflows.
constexpr std::uint64_t sum_of_sizes(std::uint64_t a, std::uint64_t b) {
    return a > max_size - b ? max_size : a + b;
}

/// Returns a * b, or max_size if the product overflows.
constexpr std::uint64_t product_of_sizes(std::uint64_t a, std::uint64_t b) {
    return b != 0 && a > max_size / b ? max_size : a * b;
}

}}}  // namespace lightbin::detail
