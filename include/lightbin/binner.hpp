// SPDX-License-Identifier: MIT
// Binner: the one easy call. It owns the scratch memory of the stages and, if wanted, the lists.
#pragma once

#include <lightbin/bin.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/project.hpp>
#include <lightbin/result.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace lightbin {

/// What keeps a light out of a tile beside its rectangle.
enum class DepthTest : std::uint8_t {
    none,      ///< nothing: no Z bounds are needed
    interval,  ///< its depths z - r to z + r must meet the tile's Z bounds (Tiled Shading, section 3)
};

/// What a Binner does, fixed at compile time: what is off leaves no code.
struct Options {
    Index index = Index::u32;
    DepthTest depth_test = DepthTest::none;
    bool statistics = false;  ///< keep Statistics; costs a pass over the tiles
};

/// Number of elements that Binner::emit writes.
struct GridSize {
    std::size_t tiles, indices;
};

/// The two grids of Tiled Forward Shading, Listing 4.2: `opaque` is pruned by minimum and maximum depth;
/// `transparent` by the maximum alone, as transparent geometry may lie anywhere in front of the opaque.
template <class Id> struct TransparencyGrids { LightGrid<Id> opaque, transparent; };

/// What the last grid came from and looks like. lights = rejected + culled + those in at least one tile's
/// rectangle.
struct Statistics {
    std::uint64_t lights = 0;
    std::uint64_t rejected = 0;  ///< bad input, see Sphere
    std::uint64_t culled = 0;    ///< out of the view
    std::uint64_t entries = 0;   ///< length of the light index list
    std::uint32_t longest_list = 0;
    /// [0]: tiles without lights; [k]: tiles with 2^(k-1) to 2^k - 1 lights.
    std::array<std::uint64_t, 33> histogram = {};
};

/// Bins lights into screen tiles. Allocates only when the input outgrows every earlier one. Not thread-safe:
/// one Binner a thread.
template <Options options = Options{}> class Binner {
    static constexpr bool with_depth = options.depth_test != DepthTest::none;

public:
    using Id = std::conditional_t<options.index == Index::u16, std::uint16_t, std::uint32_t>;

    /// Returns the light grid of `lights` in `view`, in the Binner's memory: valid until its next call.
    ///
    /// lights  a contiguous range of vec4 (x, y, z, radius) or Sphere in view space, or view_space(...) or
    /// world_space(...)
    ///
    /// After it, every tile lists every light whose sphere meets the tile's cell (no miss), in ascending
    /// order. Errors: more lights than Id can number; more than 2^32 - 1 entries; a world_space() matrix that
    /// is not affine.
    template <class LightRange>
    requires(!with_depth) Result<LightGrid<Id>> bin(const View& view, const LightRange& lights) {
        return bin_owned(view, lights, {});
    }

    /// The same with Z bounds, minimum, maximum or both; also an error: a side is shorter than
    /// view.tile_count().
    template <class LightRange>
    requires(with_depth) Result<LightGrid<Id>> bin(const View& view, const LightRange& lights,
                                                   const ZBounds& bounds) {
        return bin_owned(view, lights, bounds);
    }

    /// Returns the sizes of the light grid, ready for emit(). Errors as bin().
    template <class LightRange>
    requires(!with_depth) Result<GridSize> count(const View& view, const LightRange& lights) {
        return count_all(view, lights, {});
    }

    /// The same with Z bounds, which must live until emit().
    template <class LightRange>
    requires(with_depth) Result<GridSize> count(const View& view, const LightRange& lights,
                                                const ZBounds& bounds) {
        return count_all(view, lights, bounds);
    }

    /// Writes the grid that count() sized to the caller's memory, once after each count(). Only writes there,
    /// so it may be a mapped GPU buffer. Error: a buffer is smaller than GridSize says; then nothing is
    /// written, and emit() may be called again.
    Result<LightGrid<Id>> emit(std::span<Tile> tiles, std::span<Id> indices) {
        LIGHTBIN_ASSERT(counted_);
        auto grid = buckets_.emit(footprints_, tiles, indices);
        counted_ = !grid;
        return grid;
    }

    /// Returns both grids of a scene with transparent geometry from one projection, valid until the Binner's
    /// next call. bounds  of the opaque geometry. Errors as bin(). Statistics are those of the opaque grid.
    template <class LightRange>
    requires(with_depth) Result<TransparencyGrids<Id>> bin_transparency(const View& view,
                                                                        const LightRange& lights,
                                                                        const ZBounds& bounds) {
        if (const auto error = project(view, lights)) return *error;
        const auto transparent = emit_owned(view, {.min = {}, .max = bounds.max}, transparent_);
        if (!transparent) return transparent.error();
        const auto opaque = emit_owned(view, bounds, lists_);
        if (!opaque) return opaque.error();
        return TransparencyGrids<Id>{*opaque, *transparent};
    }

    /// Statistics of the last bin(), count() or bin_transparency() that succeeded.
    const Statistics& statistics() const requires(options.statistics) { return statistics_; }

private:
    struct Lists {
        std::vector<Tile> tiles;
        std::vector<Id> indices;
    };
    struct Nothing {};

    template <class LightRange>
    Result<LightGrid<Id>> bin_owned(const View& view, const LightRange& lights, const ZBounds& bounds) {
        if (const auto error = project(view, lights)) return *error;
        return emit_owned(view, bounds, lists_);
    }

    template <class LightRange>
    Result<GridSize> count_all(const View& view, const LightRange& lights, const ZBounds& bounds) {
        if (const auto error = project(view, lights)) return *error;
        return count_footprints(view, bounds);
    }

    template <class LightRange> std::optional<Error> project(const View& view, const LightRange& lights) {
        counted_ = false;
        const auto& source = detail::as_lights(lights);
        if (!source.valid) return Error{ErrorCode::view_matrix_not_affine};
        const std::uint64_t count = source.array.size(),
                            most = options.index == Index::u16 ? 0x10000 : 0xffffffff;
        if (count > most) return Error{ErrorCode::too_many_lights, count, most};
        footprints_.project(detail::kernels<Id, with_depth>().project, view, source);
        return std::nullopt;
    }

    Result<GridSize> count_footprints(const View& view, const ZBounds& bounds) {
        const Result<std::size_t> entries = buckets_.count(view, footprints_, bounds);
        if (!entries) return entries.error();
        if constexpr (options.statistics) gather_statistics(*entries);
        counted_ = true;
        return GridSize{view.tile_count(), *entries};
    }

    Result<LightGrid<Id>> emit_owned(const View& view, const ZBounds& bounds, Lists& lists) {
        const Result<GridSize> size = count_footprints(view, bounds);
        if (!size) return size.error();
        if (lists.tiles.size() < size->tiles) lists.tiles.resize(size->tiles);
        if (lists.indices.size() < size->indices) lists.indices.resize(size->indices);
        return emit(lists.tiles, lists.indices);
    }

    void gather_statistics(std::size_t entries) {
        statistics_ = {};
        statistics_.lights = footprints_.lights();
        statistics_.rejected = footprints_.rejected();
        statistics_.culled = footprints_.lights() - footprints_.visible() - footprints_.rejected();
        statistics_.entries = entries;
        for (const std::uint32_t count : buckets_.counts()) {
            statistics_.longest_list = (std::max)(statistics_.longest_list, count);
            ++statistics_.histogram[static_cast<std::size_t>(std::bit_width(count))];
        }
    }

    Footprints<with_depth> footprints_;
    Buckets<Id, with_depth> buckets_;
    Lists lists_;
    std::conditional_t<with_depth, Lists, Nothing> transparent_;
    std::conditional_t<options.statistics, Statistics, Nothing> statistics_;
    bool counted_ = false;  ///< emit() has something to write
};

}  // namespace lightbin
