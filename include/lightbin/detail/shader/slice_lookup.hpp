// SPDX-License-Identifier: MIT
// How a shader finds the slice of a view depth: the content of the buffer `slices`, and the function `slice` that reads it.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/platform.hpp>
#include <lightbin/detail/shader/writer.hpp>
#include <lightbin/slices.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

namespace detail {

/// The coefficients of an estimate of a depth's slice: by_log2 * log2(depth) + by_depth * depth + offset.
struct SliceGuess {
    float by_log2, by_depth, offset;
};

/// Returns the line through the first and the last boundary, over the depth or over its logarithm, whichever is nearer to
/// the other boundaries. But for rounding it is exact for the boundaries of Slices::linear() and Slices::exponential().
inline SliceGuess best_guess(std::span<const float> boundaries) {
    SliceGuess best = {0, 0, 0};
    if (boundaries.empty()) return best;
    double least_error = std::numeric_limits<double>::infinity();
    for (const bool by_log2 : {false, true}) {
        const auto scaled = [&](float depth) {
            const double exact = static_cast<double>(depth);
            return by_log2 ? std::log2(exact) : exact;
        };
        const double first = scaled(boundaries.front()), last = scaled(boundaries.back());
        const double slope =
            boundaries.size() == 1 ? 0 : (static_cast<double>(boundaries.size()) - 1) / (last - first);
        const double offset = 1 - slope * first;
        double error = 0;
        for (std::size_t i = 0; i < boundaries.size(); ++i)
            error += std::fabs(slope * scaled(boundaries[i]) + offset - static_cast<double>(i + 1));
        if (!(error < least_error)) continue;  // also when NaN: depths of 0 or less have no logarithm
        least_error = error;
        const float factor = static_cast<float>(slope);
        best = {by_log2 ? factor : 0, by_log2 ? 0 : factor, static_cast<float>(offset)};
    }
    return best;
}

/// Returns the size of shader_slices() in bytes for a number of slices; 0 if there are none.
inline std::uint64_t slice_bytes(std::uint64_t slices) {
    return slices == 0 ? 0 : 4 * (slices + 3);
}

/// Adds the function `slice`, which returns the slice of a view depth. It starts from the estimate, in which a device may
/// round the logarithm as it likes, and steps from there until the boundaries enclose the depth. Boundaries and depth are
/// compared as integers that are in the order of the floats, because devices may flush denormal floats to zero.
inline void add_slice(ShaderWriter& writer) {
    const auto word = [&](const std::string& index) { return writer.read("slices", index); };
    const auto number = [&](const std::string& index) { return "uintBitsToFloat(" + word(index) + ")"; };
    writer.add(
        "\n// The slice that a view depth lies in.\nuint $slice(float view_depth) {\n    float guess = " +
        number("0u") + " * log2(max(view_depth, 1e-37)) + " + number("1u") + " * view_depth + " +
        number("2u") + ";\n    uint last = " + word("3u") +
        R"(;
    uint slice = min(uint(clamp(guess, 0.0, 1e9)), last);
    uint bits = floatBitsToUint(view_depth);
    uint key = bits | 0x80000000u;
    if (bits > 0x80000000u) { key = ~bits; }
    while (slice > 0u && key < )" +
        word("slice + 3u") + R"() { slice -= 1u; }
    while (slice < last && key >= )" +
        word("slice + 4u") + R"() { slice += 1u; }
    return slice;
}
)");
}

}  // namespace detail

inline std::vector<std::uint32_t> shader_slices(const Slices& slices) {
    const std::span<const float> boundaries = slices.boundaries();
    const detail::SliceGuess guess = detail::best_guess(boundaries);
    std::vector<std::uint32_t> words = {
        detail::bit_cast<std::uint32_t>(guess.by_log2), detail::bit_cast<std::uint32_t>(guess.by_depth),
        detail::bit_cast<std::uint32_t>(guess.offset), static_cast<std::uint32_t>(boundaries.size())};
    for (const float boundary : boundaries) {
        const std::uint32_t bits = detail::bit_cast<std::uint32_t>(boundary), sign = 0x80000000;
        words.push_back(bits & sign ? ~bits : bits | sign);
    }
    return words;
}

}}  // namespace lightbin
