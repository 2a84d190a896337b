// SPDX-License-Identifier: MIT
// Stage 3: footprints (+ Z bounds) -> how long each tile's list is, then the lists themselves.
#pragma once

#include <lightbin/detail/kernels.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/project.hpp>
#include <lightbin/result.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace lightbin {

/// Bucketing in two steps, so that sizes are known before anything is written (Tiled Shading, section 3:
/// count, then fill). Keeps its memory from call to call.
template <class Id, bool with_depth> class Buckets {
public:
    /// Counts the lights of each tile. Returns the length of the light index list, or an Error if Z bounds
    /// are shorter than the grid or 32-bit offsets can't reach the list's end. `bounds` must live until
    /// emit().
    Result<std::size_t> count(const View& view, Footprints<with_depth>& footprints, const ZBounds& bounds) {
        const std::size_t tiles = view.tile_count();
        for (const std::span<const float> side : {bounds.min, bounds.max})
            if (!side.empty() && side.size() < tiles)
                return Error{ErrorCode::z_bounds_too_small, tiles, side.size()};
        bounds_ = tile_depths(bounds);
        tiles_x_ = view.tiles_x();
        tiles_y_ = view.tiles_y();
        counts_.assign(tiles, 0);
        kernels().count(footprints.arrays(), footprints.visible(), static_cast<std::size_t>(tiles_x_),
                        bounds_, counts_.data());
        std::uint64_t entries = 0;
        for (const std::uint32_t count : counts_)
            entries += count;
        constexpr std::uint64_t most = (std::numeric_limits<std::uint32_t>::max)();
        if (entries > most) return Error{ErrorCode::too_many_entries, entries, most};
        entries_ = static_cast<std::size_t>(entries);
        return entries_;
    }

    /// The list lengths, row-major, after count() and until emit().
    std::span<const std::uint32_t> counts() const { return counts_; }

    /// Writes what count() counted: once after each count(), with the same footprints. An Error names the
    /// size that is needed, and then nothing is written.
    Result<LightGrid<Id>> emit(Footprints<with_depth>& footprints, std::span<Tile> tiles,
                               std::span<Id> indices) {
        if (tiles.size() < counts_.size())
            return Error{ErrorCode::tile_buffer_too_small, counts_.size(), tiles.size()};
        if (indices.size() < entries_)
            return Error{ErrorCode::index_buffer_too_small, entries_, indices.size()};
        std::uint32_t offset = 0;
        for (std::size_t tile = 0; tile < counts_.size(); ++tile) {
            const std::uint32_t count = counts_[tile];
            tiles[tile] = {offset, count};
            counts_[tile] = offset;  // from here on the tile's cursor
            offset += count;
        }
        kernels().emit(footprints.arrays(), footprints.visible(), static_cast<std::size_t>(tiles_x_), bounds_,
                       counts_.data(), indices.data());
        return LightGrid<Id>(tiles_x_, tiles_y_, tiles.first(counts_.size()), indices.first(entries_),
                             footprints.rejected());
    }

private:
    static const detail::Kernels<Id, with_depth>& kernels() { return detail::kernels<Id, with_depth>(); }

    static detail::TileDepths tile_depths(const ZBounds& bounds) {
        static constexpr float none = -detail::infinity, all = detail::infinity;
        constexpr std::size_t every = ~std::size_t{0};
        return {bounds.min.empty() ? &none : bounds.min.data(), bounds.max.empty() ? &all : bounds.max.data(),
                bounds.min.empty() ? 0 : every, bounds.max.empty() ? 0 : every};
    }

    std::vector<std::uint32_t> counts_;
    detail::TileDepths bounds_ = {};
    std::size_t entries_ = 0;
    int tiles_x_ = 0, tiles_y_ = 0;
};

}  // namespace lightbin
