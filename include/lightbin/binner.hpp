// SPDX-License-Identifier: MIT
// Binner: the one easy call. It owns the scratch memory of the stages and, if wanted, the lists.
#pragma once

#include <lightbin/bin.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/scratch.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/options.hpp>
#include <lightbin/parallel.hpp>
#include <lightbin/project.hpp>
#include <lightbin/result.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <lightbin/detail/warnings_off.inl>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

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

/// Bins lights into screen tiles. Keeps its memory: the same input again allocates nothing, another one only where
/// it outgrows the earlier ones, or where another kernel or number of threads takes it. After an exception in a call,
/// there is no grid, and the next call is as any other. Not thread-safe: one Binner a thread.
template <Options options = Options{}> class Binner {
    static constexpr bool with_depth = options.depth_test != DepthTest::none;

public:
    using Id = std::conditional_t<options.index == Index::u16, std::uint16_t, std::uint32_t>;

    Binner() = default;
    /// Takes over the other's memory and grid. The other is as new.
    Binner(Binner&& other) noexcept { swap(other); }
    Binner& operator=(Binner&& other) noexcept {
        Binner(std::move(other)).swap(*this);
        return *this;
    }

    /// Returns the light grid of `lights` in `view`, in the Binner's memory: valid until its next call.
    ///
    /// lights  a contiguous range of vec4 (x, y, z, radius) or Sphere in view space, view_space(...) or
    ///         world_space(...)
    ///
    /// After it, every tile lists every light whose sphere meets the tile's cell (no miss), in ascending
    /// order. Errors: more lights than Id can number; more than 2^32 - 1 entries, or pairs of a light
    /// and a block of 8x8 tiles; a world_space() matrix that is not affine.
    ///
    /// parallel  a Parallel: threads to share the work among. The grid is the same with any number of them.
    template <class LightRange, std::convertible_to<Parallel> Threads = Serial>
    requires(!with_depth) Result<LightGrid<Id>> bin(const View& view, const LightRange& lights,
                                                    const Threads& parallel = {}) {
        return bin_owned(view, lights, {}, parallel);
    }

    /// The same with Z bounds, minimum, maximum or both; also an error: a side is shorter than
    /// view.tile_count().
    template <class LightRange, std::convertible_to<Parallel> Threads = Serial>
    requires(with_depth) Result<LightGrid<Id>> bin(const View& view, const LightRange& lights,
                                                   const ZBounds& bounds, const Threads& parallel = {}) {
        return bin_owned(view, lights, bounds, parallel);
    }

    /// Builds the light grid in the Binner's memory and returns its sizes, ready for emit(). Errors as bin().
    template <class LightRange, std::convertible_to<Parallel> Threads = Serial>
    requires(!with_depth) Result<GridSize> count(const View& view, const LightRange& lights,
                                                 const Threads& parallel = {}) {
        return count_all(view, lights, {}, parallel);
    }

    /// The same with Z bounds.
    template <class LightRange, std::convertible_to<Parallel> Threads = Serial>
    requires(with_depth) Result<GridSize> count(const View& view, const LightRange& lights,
                                                const ZBounds& bounds, const Threads& parallel = {}) {
        return count_all(view, lights, bounds, parallel);
    }

    /// Writes the grid that count() sized to the caller's memory, once after each count(). Only writes there,
    /// in order, so it may be a mapped GPU buffer. Errors: a buffer is smaller than GridSize says; then
    /// nothing is written, and emit() may be called again. No count() came before, or another call between.
    Result<LightGrid<Id>> emit(std::span<Tile> tiles, std::span<Id> indices) {
        if (!counted_) return Error{ErrorCode::nothing_counted};
        const LightGrid<Id> grid = *counted_;
        if (tiles.size() < grid.tiles().size())
            return Error{ErrorCode::tile_buffer_too_small, grid.tiles().size(), tiles.size()};
        if (indices.size() < grid.indices().size())
            return Error{ErrorCode::index_buffer_too_small, grid.indices().size(), indices.size()};
        std::ranges::copy(grid.tiles(), tiles.begin());
        std::ranges::copy(grid.indices(), indices.begin());
        counted_.reset();
        return LightGrid<Id>(grid.tiles_x(), grid.tiles_y(), tiles.first(grid.tiles().size()),
                             indices.first(grid.indices().size()), grid.rejected());
    }

    /// Returns both grids of a scene with transparent geometry from one projection, valid until the Binner's
    /// next call. Errors as bin(), and bounds that leave out the background without a transparent_max. Statistics are
    /// those of the opaque grid.
    ///
    /// bounds  of the opaque geometry; transparent lights are pruned by transparent_max or, without it, by max
    template <class LightRange, std::convertible_to<Parallel> Threads = Serial>
    requires(with_depth) Result<TransparencyGrids<Id>> bin_transparency(const View& view,
                                                                        const LightRange& lights,
                                                                        const ZBounds& bounds,
                                                                        const Threads& parallel = {}) {
        const bool own_max = !bounds.transparent_max.empty();
        if (bounds.background_skipped && !bounds.max.empty() && !own_max)
            return Error{ErrorCode::no_transparent_max};
        if (const auto error = project(view, lights, parallel)) return *error;
        const ZBounds in_front = {.max = own_max ? bounds.transparent_max : bounds.max};
        const auto transparent = build(transparent_, view, in_front, parallel);
        if (!transparent) return transparent.error();
        const auto opaque = build(lists_, view, bounds, parallel);
        if (!opaque) return opaque.error();
        if constexpr (options.statistics) gather_statistics(*opaque);
        return TransparencyGrids<Id>{*opaque, *transparent};
    }

    /// Statistics of the last bin(), count() or bin_transparency() that succeeded.
    const Statistics& statistics() const requires(options.statistics) { return statistics_; }

private:
    using Lists = GridLists<Id, options.footprint, options.depth_test>;
    struct Nothing {};

    template <class LightRange, class Threads>
    Result<LightGrid<Id>> bin_owned(const View& view, const LightRange& lights, const ZBounds& bounds,
                                    const Threads& parallel) {
        if (const auto error = project(view, lights, parallel)) return *error;
        const auto grid = build(lists_, view, bounds, parallel);
        if constexpr (options.statistics)
            if (grid) gather_statistics(*grid);
        return grid;
    }

    template <class LightRange, class Threads>
    Result<GridSize> count_all(const View& view, const LightRange& lights, const ZBounds& bounds,
                               const Threads& parallel) {
        const Result<LightGrid<Id>> grid = bin_owned(view, lights, bounds, parallel);
        if (!grid) return grid.error();
        counted_ = *grid;
        return GridSize{grid->tiles().size(), grid->indices().size()};
    }

    template <class LightRange>
    std::optional<Error> project(const View& view, const LightRange& lights, const Parallel& parallel) {
        counted_.reset();
        const auto& source = detail::as_lights(lights);
        if (const auto error = detail::refuse(source, options.index == Index::u16 ? 0x10000 : 0xffffffff))
            return error;
        if (scratch_.empty()) scratch_.resize(1);
        isa_ = detail::machine_isa(options.isa);
        footprints_.project(isa_, view, source, parallel, lists_.shared());
        return std::nullopt;
    }

    template <class Threads>
    Result<LightGrid<Id>> build(Lists& lists, const View& view, const ZBounds& bounds,
                                const Threads& parallel) {
        if (const auto error = lists.build(isa_, view, footprints_, bounds, scratch_, parallel))
            return *error;
        return LightGrid<Id>(view.tiles_x(), view.tiles_y(), lists.tiles(), lists.indices(),
                             footprints_.rejected());
    }

    void swap(Binner& other) noexcept {
        std::swap(isa_, other.isa_);
        scratch_.swap(other.scratch_);
        std::swap(footprints_, other.footprints_);
        std::swap(lists_, other.lists_);
        std::swap(transparent_, other.transparent_);
        std::swap(statistics_, other.statistics_);
        counted_.swap(other.counted_);
    }

    void gather_statistics(const LightGrid<Id>& grid) {
        statistics_ = {};
        statistics_.lights = footprints_.lights();
        statistics_.rejected = footprints_.rejected();
        statistics_.culled = footprints_.lights() - footprints_.visible() - footprints_.rejected();
        statistics_.entries = grid.indices().size();
        for (const Tile& tile : grid.tiles()) {
            statistics_.longest_list = (std::max)(statistics_.longest_list, tile.count);
            ++statistics_.histogram[static_cast<std::size_t>(std::bit_width(tile.count))];
        }
    }

    Isa isa_ = Isa::scalar;
    std::vector<detail::Scratch> scratch_;  ///< one a worker
    Footprints<options.footprint, with_depth> footprints_;
    Lists lists_;
    std::conditional_t<with_depth, Lists, Nothing> transparent_;
    std::conditional_t<options.statistics, Statistics, Nothing> statistics_;
    std::optional<LightGrid<Id>> counted_;  ///< what emit() has to write, in lists_
};

}  // namespace lightbin

#include <lightbin/detail/warnings_on.inl>
