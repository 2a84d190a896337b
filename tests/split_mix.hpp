// SPDX-License-Identifier: MIT
// Random numbers that are the same with every standard library: the standard distributions are not.
#pragma once

#include <cstdint>

/// SplitMix64.
class SplitMix {
public:
    explicit SplitMix(std::uint64_t seed) : state_(seed) {}
    std::uint64_t bits() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    int integer(int low, int high) {  ///< both ends included
        return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
    }

private:
    std::uint64_t state_;
};
