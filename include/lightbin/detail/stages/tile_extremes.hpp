// SPDX-License-Identifier: MIT
// Reduces rows of depth samples to the extreme samples of each tile.
#pragma once

#include <lightbin/detail/dispatch/kernels.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The least and the greatest of some numbers; lower > upper if there are no numbers.
struct Extremes {
    float lower = infinity, upper = -infinity;

    void take(float low, float high) {
        lower = min_of(lower, low);
        upper = max_of(upper, high);
    }
};

/// Reduces one row of tiles and calls finish(tile, extremes) for each tile. The kernel first reduces each column of
/// samples to its extremes, as many columns as fit in a buffer on the stack; then each tile's columns are reduced.
///
/// split    how the row's pixels are divided into tiles
/// samples  samples per pixel
/// skipped  samples of this value are left out; NaN: none are
template <class Finish>
void reduce_tile_row(Isa isa, const DepthRows& row, const TileSplit& split, std::size_t samples, float skipped,
                     Finish finish) {
    constexpr std::size_t buffer_size = 512;
    float lower[buffer_size], upper[buffer_size];
    std::size_t begin = 0, end = 0;  // the columns in the buffer
    for (int index = 0; index < split.count(); ++index) {
        Extremes tile;
        const std::size_t tile_end = static_cast<std::size_t>(split.first_pixel(index + 1)) * samples;
        for (std::size_t column = static_cast<std::size_t>(split.first_pixel(index)) * samples; column < tile_end;
             ++column) {
            if (column == end) {
                begin = end;
                end = min_of(begin + buffer_size, row.columns);
                const DepthRows part = {row.samples + begin, row.pitch, row.rows, end - begin};
                depth_kernel(isa, part.columns)(part, skipped, lower, upper);
            }
            tile.take(lower[column - begin], upper[column - begin]);
        }
        finish(static_cast<std::size_t>(index), tile);
    }
}

}}}  // namespace lightbin::detail
