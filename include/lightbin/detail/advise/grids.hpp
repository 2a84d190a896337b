// SPDX-License-Identifier: MIT
// The grids on which advise() measures plans: the view's own tiles and larger ones, with their Z bounds.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Returns one side of a tile's Z bounds, or `unbounded` if that side is not given or NaN.
inline float bound(std::span<const float> side, std::size_t tile, float unbounded) {
    return side.empty() || std::isnan(side[tile]) ? unbounded : side[tile];
}

/// Calls visit(x, y, tile, low, high) for the tiles in which something may be drawn: the tile's first pixel, its index, and
/// its Z bounds. Tiles whose minimum exceeds their maximum are empty.
template <class Visit> void for_each_drawn(const View& view, const ZBounds& bounds, Visit visit) {
    const auto [width, height] = view.viewport();
    const int size = view.tile_size();
    std::size_t tile = 0;
    for (int y = 0; y < height; y += size)
        for (int x = 0; x < width; x += size, ++tile) {
            const float low = bound(bounds.min, tile, -infinity), high = bound(bounds.max, tile, infinity);
            if (!(low > high)) visit(x, y, tile, low, high);
        }
}

/// The caller's view with its tiles, or with tiles each of which consists of several of them.
struct WeighedGrid {
    View view;
    ZBounds bounds;  ///< spans of the caller's arrays, or of the vectors below where the caller gave that side
    std::vector<float> lowest, highest, gap_begin, gap_end;

    /// Merges the Z bounds of the fine tiles. Each is taken to be drawn everywhere between its bounds but in its gap. So the
    /// merged gap, around the middle of the merged bounds, is at most as wide as the one that reduce_depth() would find.
    WeighedGrid(const View& fine, const ZBounds& of_fine, int tile_size)
        : view(*fine.with_tile_size(tile_size)), bounds(of_fine), lowest(view.tile_count(), infinity),
          highest(view.tile_count(), -infinity), gap_begin(highest), gap_end(lowest) {
        if (tile_size == fine.tile_size()) return;
        const auto tile_at = [&](int x, int y) {
            return static_cast<std::size_t>(y / tile_size * view.tiles_x() + x / tile_size);
        };
        for_each_drawn(fine, of_fine, [&](int x, int y, std::size_t, float low, float high) {
            const std::size_t tile = tile_at(x, y);
            lowest[tile] = (std::min)(lowest[tile], low);
            highest[tile] = (std::max)(highest[tile], high);
        });
        for_each_drawn(fine, of_fine, [&](int x, int y, std::size_t from, float low, float high) {
            const std::size_t tile = tile_at(x, y);
            const float middle = 0.5f * std::clamp(lowest[tile], -FLT_MAX, FLT_MAX) +
                                 0.5f * std::clamp(highest[tile], -FLT_MAX, FLT_MAX);
            const auto draw = [&](float nearest, float farthest) {
                if (nearest <= middle)
                    gap_begin[tile] = (std::max)(gap_begin[tile], (std::min)(farthest, middle));
                if (farthest >= middle)
                    gap_end[tile] = (std::min)(gap_end[tile], (std::max)(nearest, middle));
            };
            const float end = bound(of_fine.gap_min, from, infinity),
                        begin = bound(of_fine.gap_max, from, -infinity);
            draw(low, end < begin ? end : high);
            draw(end < begin ? begin : low, high);
        });
        const auto merged = [](std::span<const float> given, const std::vector<float>& side) {
            return given.empty() ? given : std::span<const float>(side);
        };
        bounds = {.min = merged(of_fine.min, lowest),
                  .max = merged(of_fine.max, highest),
                  .gap_min = merged(of_fine.gap_min, gap_begin),
                  .gap_max = merged(of_fine.gap_max, gap_end)};
    }
    WeighedGrid(WeighedGrid&&) = default;  // the spans of a copy would point into the original
};

/// Returns the grids with tiles of the view's size, of 2, 4 and 8 times that size while that is smaller than the screen,
/// and with one tile as large as the screen.
inline std::vector<WeighedGrid> weighed_grids(const View& view, const ZBounds& bounds) {
    std::vector<WeighedGrid> grids;
    const int whole = (std::max)({view.viewport().width, view.viewport().height, view.tile_size()});
    for (int size = view.tile_size(); size < whole && grids.size() < 4;
         size = size > whole / 2 ? whole : 2 * size)
        grids.emplace_back(view, bounds, size);
    grids.emplace_back(view, bounds, whole);
    return grids;
}

}}}  // namespace lightbin::detail
