// SPDX-License-Identifier: MIT
// Single passes over memory, to compare the times of builds with.
#pragma once

#include "sets.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>

/// Makes the compiler store a value, and all memory that others can reach, as if it were read here.
template <class Value> void keep(const Value& value) {
    __asm__ volatile("" : : "r"(&value) : "memory");
}

/// Writes the memory once, in order, with the machine's widest stores.
inline void fill(char* memory, std::size_t size) {
    std::memset(memory, 0, size);
    keep(*memory);
}

/// Reads all of the lights once, with loads as wide as the compiler makes them.
inline void read(const Lights& lights) {
    typedef std::uint32_t Wide [[gnu::vector_size(64), gnu::may_alias, gnu::aligned(4)]];
    const std::size_t count = lights.size() / 16;
    const Wide* const all = reinterpret_cast<const Wide*>(lights.data());
    Wide sums[4] = {};
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            sums[j] += all[4 * i + j];
    keep(sums);
}
