// SPDX-License-Identifier: MIT
// The output: the light grid of Tiled Shading, Figure 1 - offset and count a tile, and one light index list.
#pragma once

#include <lightbin/detail/flavour.hpp>
#include <lightbin/result.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

/// Type of a light id.
enum class Index : std::uint8_t {
    u16,  ///< up to 65,536 lights, half the memory
    u32,
};

/// One tile's part of the light index list: `count` ids from `offset` on. 8 bytes, as a GPU's uvec2.
struct Tile {
    std::uint32_t offset, count;
};

/// A finished light grid. It does not own its memory: see the call that returned it for how long that lives.
template <class Id> class LightGrid {
public:
    LightGrid(int tiles_x, int tiles_y, std::span<const Tile> tiles, std::span<const Id> indices,
              std::uint32_t rejected)
        : tiles_(tiles), indices_(indices), tiles_x_(tiles_x), tiles_y_(tiles_y), rejected_(rejected) {}

    int tiles_x() const { return tiles_x_; }
    int tiles_y() const { return tiles_y_; }

    /// tiles_x() * tiles_y() tiles, row-major; offsets ascend and leave no gap.
    std::span<const Tile> tiles() const { return tiles_; }

    /// The light index list. A light's id is its position in the caller's array; ids ascend within a tile.
    std::span<const Id> indices() const { return indices_; }

    /// Returns the ids of the lights of tile (x, y), 0 <= x < tiles_x(), 0 <= y < tiles_y().
    std::span<const Id> lights_in(int x, int y) const {
        LIGHTBIN_ASSERT(x >= 0 && x < tiles_x_ && y >= 0 && y < tiles_y_);
        const Tile tile = tiles_[static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles_x_) +
                                 static_cast<std::size_t>(x)];
        return indices_.subspan(tile.offset, tile.count);
    }

    /// Lights that were skipped as bad input, see Sphere.
    std::uint32_t rejected() const { return rejected_; }

private:
    std::span<const Tile> tiles_;
    std::span<const Id> indices_;
    int tiles_x_, tiles_y_;
    std::uint32_t rejected_;
};

}  // namespace lightbin
