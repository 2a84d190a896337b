// SPDX-License-Identifier: MIT
// Makes the masks of columns and rows: for each column and each row of tiles, the set of the lights whose rectangles
// reach it. The code is the same for all instruction sets.
#pragma once

#include <lightbin/detail/project/footprint_arrays.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Writes the masks of all columns, an empty mask, and the masks of all rows, one after another, `each` words a mask.
/// Bit b of word w tells whether light 32 w + b reaches the column or row. Bits beyond the last light are 0.
///
/// runs, footprint_of  the lights in their order: footprint_of(i) is the index of a footprint, for each i of the runs
/// to                  room for one mask more, which becomes undefined
///
/// Two neighbouring columns differ in a light's bit only where its rectangle begins, and behind its end. These
/// differences, two a light, are written first, and then summed without carry from column to column, 32 lights a word.
/// Behind the last column, where the empty mask is, every light has ended, so the sum goes on with the rows.
template <class FootprintOf>
void make_masks(const FootprintArrays& lights, std::span<const FootprintRun> runs, FootprintOf footprint_of,
                std::size_t columns, std::size_t rows, std::size_t each, std::uint32_t* to) {
    const std::uint16_t *const x0 = lights.x0, *const x1 = lights.x1, *const y0 = lights.y0, *const y1 = lights.y1;
    const std::size_t first_row = (columns + 1) * each, end = first_row + rows * each;
    std::memset(to, 0, (end + each) * sizeof *to);
    std::uint32_t bit = 1, *in_column = to, *in_row = to + first_row;
    for (const FootprintRun& run : runs)
        for (std::uint32_t i = run.begin; i < run.end;) {
            for (; bit != 0 && i < run.end; ++i, bit <<= 1) {
                const std::uint32_t light = footprint_of(i);
                in_column[x0[light] * each] ^= bit;
                in_column[(x1[light] + std::size_t{1}) * each] ^= bit;
                in_row[y0[light] * each] ^= bit;
                in_row[(y1[light] + std::size_t{1}) * each] ^= bit;
            }
            if (bit != 0) continue;
            bit = 1;
            ++in_column;
            ++in_row;
        }
    for (std::uint32_t* word = to + each; word < to + end; ++word)
        *word ^= *(word - each);
}

}}}  // namespace lightbin::detail
