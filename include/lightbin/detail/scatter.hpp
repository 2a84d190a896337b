// SPDX-License-Identifier: MIT
// Binning by count, prefix and fill (Tiled Shading, section 3), for all tiers: small lights, nearly empty grids.
// A rectangle costs four corners of a difference array, whose sums along both axes are the counts.
#pragma once

#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/scratch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace lightbin::detail {
inline namespace LIGHTBIN_FLAVOUR {

/// Bins the tile rows of `bands`. Returns the number of entries. Never writes past them.
template <class Id>
std::uint64_t bin_scatter(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands) {
    const FootprintArrays& lights = job.lights;
    const std::size_t width = static_cast<std::size_t>(job.camera->x.tiles), pitch = width + 1;
    const std::size_t first = 8 * std::size_t{bands.begin},
                      end = (std::min)(8 * std::size_t{bands.end},
                                       static_cast<std::size_t>(job.camera->y.tiles));
    const std::size_t height = end - first;

    // A row's corners are cleared when the first is put there, so rows without are never touched.
    std::uint32_t* put = scratch.cursors.room(height + 1);  // corners in a row
    std::fill_n(put, height + 1, 0u);
    std::int32_t* corners = scratch.corners.room(pitch * (height + 2));
    const auto corner_row = [=](std::size_t row) {
        if (put[row]++ == 0) std::fill_n(corners + row * pitch, pitch, 0);
        return corners + row * pitch;
    };
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            const std::size_t y0 = (std::max<std::size_t>)(lights.y0[i], first),
                              y1 = (std::min<std::size_t>)(lights.y1[i] + 1u, end);
            if (y0 >= y1) continue;
            std::int32_t *top = corner_row(y0 - first), *bottom = corner_row(y1 - first);
            ++top[lights.x0[i]];
            --top[lights.x1[i] + 1u];
            --bottom[lights.x0[i]];
            ++bottom[lights.x1[i] + 1u];
        }

    // The counts of a row are the sums of the row's steps, which are the sums of the corners above.
    std::int32_t* steps = corners + pitch * (height + 1);
    std::fill_n(steps, pitch, 0);
    std::uint32_t at = bands.at;
    Tile* tile = job.tiles + first * width;
    std::uint32_t in_row = 0;  // entries of the row above
    for (std::size_t row = 0; row < height; ++row) {
        if (put[row] != 0)
            for (std::size_t x = 0; x < pitch; ++x)
                steps[x] += corners[row * pitch + x];
        else if (row > 0 && in_row == 0) {
            std::copy_n(tile - width, width, tile);
            tile += width;
            continue;
        }
        const std::uint32_t before = at;
        std::uint32_t count = 0;
        for (std::size_t x = 0; x < width; ++x) {
            count += static_cast<std::uint32_t>(steps[x]);
            *tile++ = {at, 0};
            at += count;
        }
        in_row = at - before;
    }

    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            const std::size_t y0 = (std::max<std::size_t>)(lights.y0[i], first),
                              y1 = (std::min<std::size_t>)(lights.y1[i] + 1u, end);
            for (std::size_t y = y0; y < y1; ++y)
                for (Tile *here = job.tiles + y * width + lights.x0[i],
                          *last = job.tiles + y * width + lights.x1[i];
                     here <= last; ++here)
                    bands.out[here->offset + here->count++ - bands.at] = static_cast<Id>(lights.ids[i]);
        }
    return at - bands.at;
}

}  // namespace LIGHTBIN_FLAVOUR
}  // namespace lightbin::detail
