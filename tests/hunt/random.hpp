// SPDX-License-Identifier: MIT
// Random numbers that are the same on every platform.
#pragma once

#include "../split_mix.hpp"

#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>

namespace hunt {

inline constexpr float infinite = std::numeric_limits<float>::infinity();

class Random : public SplitMix {
public:
    using SplitMix::SplitMix;

    /// 0 to n - 1.
    int below(int n) { return static_cast<int>((bits() >> 32) * static_cast<std::uint64_t>(n) >> 32); }
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(static_cast<double>(n) * 0.999999999 * unit()); }
    int from_to(int first, int last) { return first + below(last - first + 1); }
    bool one_in(int n) { return below(n) == 0; }
    bool coin() { return (bits() >> 63) != 0; }

    /// 0 to 1.
    double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
    double between(double least, double most) { return least + (most - least) * unit(); }
    /// Returns a positive number; each power of two between the limits is as likely.
    double log_between(double least, double most) { return std::exp2(between(std::log2(least), std::log2(most))); }
    double sign() { return coin() ? 1 : -1; }

    template <class T> T pick(std::initializer_list<T> from) {
        return from.begin()[below(static_cast<int>(from.size()))];
    }
};

/// Returns a float that few users would pass: signed zeros, denormals, powers of two, FLT_MAX, infinity, NaN.
inline float nasty_float(Random& random) {
    using Limits = std::numeric_limits<float>;
    const float value = random.pick({0.0f, Limits::denorm_min(), Limits::min(), Limits::max(), Limits::infinity(),
                                     Limits::quiet_NaN(), 1.0f, Limits::epsilon(), Limits::max() / 2,
                                     static_cast<float>(random.log_between(0x1p-149, 0x1p127)),
                                     static_cast<float>(random.log_between(0x1p-20, 0x1p20))});
    return random.coin() ? value : -value;
}

/// Returns the nearest float that is not below (or not above) a number, in any rounding mode.
inline float float_up(long double value) {
    const float nearest = static_cast<float>(value);
    return static_cast<long double>(nearest) < value ? std::nextafter(nearest, infinite) : nearest;
}
inline float float_down(long double value) {
    return -float_up(-value);
}

}  // namespace hunt
