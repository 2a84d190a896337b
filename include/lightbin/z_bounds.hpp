// SPDX-License-Identifier: MIT
// Stage 2b: depth buffer -> per-tile minimum and maximum view depth of what is drawn there.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/checked_sizes.hpp>
#include <lightbin/detail/base/enum_names.hpp>
#include <lightbin/detail/base/float_environment.hpp>
#include <lightbin/detail/base/rounding.hpp>
#include <lightbin/detail/tiers/kernels.hpp>
#include <lightbin/isa.hpp>
#include <lightbin/result.hpp>
#include <lightbin/view.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Z bounds: the view depths between which a tile has anything to light. One float a tile, row-major, at
/// least View::tile_count() of them; each side from its own source, and an empty span for a side that is not
/// tested.
///
/// A tile with min > max has nothing to light and gets no lights. A NaN bound tests nothing.
struct ZBounds {
    std::span<const float> min = {};
    std::span<const float> max = {};
    /// For DepthTest::split_box, both or neither: nothing is drawn in the tile at depths strictly between
    /// gap_min and gap_max. A tile with gap_min >= gap_max, or NaN, has no gap.
    std::span<const float> gap_min = {};
    std::span<const float> gap_max = {};
    /// For Binner::bin_transparency(): the maximum with the background counted in, so the far plane wherever a pixel
    /// of the tile shows it. What is transparent is seen before the background too. Empty: `max` is it.
    std::span<const float> transparent_max = {};
    /// The other sides leave out the background. bin_transparency() then wants transparent_max.
    bool background_skipped = false;
};

/// Where reduce_depth() writes Z bounds: View::tile_count() floats a side, or none where a side is not wanted. Gaps are
/// written both or not at all.
struct ZBoundsBuffers {
    std::span<float> min = {}, max = {};
    std::span<float> gap_min = {}, gap_max = {};
    std::span<float> transparent_max = {};
};

/// How a depth buffer stores depth, and so how far a sample may be from the window depth of the fragment that wrote it.
/// Bounds hold for every rounding that graphics APIs allow: the stored value is either of the format's two values next to
/// the fragment's, so the depth may be rounded to nearest, down or up; an integer that is read as a float is either of the
/// two floats next to what it stands for. Bounds don't hold for what is further off, as where the buffer has fewer bits
/// than the format that is named, or a polygon offset has moved its depths.
enum class DepthFormat : std::uint8_t {
    float32,  ///< a 32-bit float; denormal numbers may have been flushed to zero
    unorm24,  ///< a 24-bit integer n that stands for the depth n / (2^24 - 1)
    unorm16,  ///< a 16-bit integer n that stands for the depth n / (2^16 - 1)
};

constexpr const char* to_string(DepthFormat format) {
    return detail::name_at(format, {"float32", "unorm24", "unorm16"});
}

/// A depth buffer in main memory: window depth in 0..1 (as glReadPixels gives it), the view's viewport only.
struct DepthBuffer {
    /// Pixels row by row from the view's window origin, the samples of a pixel side by side.
    std::span<const float> depth = {};
    int samples = 1;            ///< samples a pixel, 1 to 8
    std::size_t row_pitch = 0;  ///< floats from one row to the next; 0: viewport width * samples
    DepthFormat format = DepthFormat::float32;
    /// A sample at the far end of the depth range (1, or 0 with reversed Z) means that nothing is drawn
    /// there, so it does not count, but for ZBounds::transparent_max. Right for buffers cleared to that value
    /// and drawn with a strict depth comparison. When false, such a sample is something drawn at the far plane.
    bool skip_background = false;
};

namespace detail {

/// Smallest and largest of some numbers; lower > upper if there are none.
struct Extremes {
    float lower = infinity, upper = -infinity;

    void take(float low, float high) {
        lower = min_of(lower, low);
        upper = max_of(upper, high);
    }
};

/// The view depths of fragments that may have left window depths from `lower` to `upper` in a buffer. In double: a float
/// sum near 1 would be off by a step of its own.
inline DepthInterval fragment_depths(const View& view, Extremes window, DepthFormat format) {
    if (!(window.lower <= window.upper)) return {infinity, -infinity};
    double low = static_cast<double>(window.lower), high = static_cast<double>(window.upper);
    if (format == DepthFormat::float32) {
        // A denormal depth is rounded by up to all of itself, or to zero.
        constexpr double least_normal = 0x1p-126;
        low = low < least_normal ? 0 : low * (1 - 0x1p-23);
        high = max_of(high * (1 + 0x1p-23), least_normal);
    } else {
        // A little more than a step of the format, and the largest one of floats up to 1.
        const double reach = (format == DepthFormat::unorm24 ? 0x1.000002p-24 : 0x1.0002p-16) + 0x1p-24;
        low = low - reach;
        high = high + reach;
    }
    return view.view_depths(min_of(max_of(low, 0.0), 1.0), min_of(max_of(high, 0.0), 1.0));
}

/// In four chains, so that they need not wait for each other.
inline Extremes extremes(const float* lower, const float* upper, std::size_t count, Extremes so_far) {
    Extremes chains[4] = {so_far, so_far, so_far, so_far};
    std::size_t i = 0;
    for (; i + 4 <= count; i += 4)
        for (std::size_t chain = 0; chain < 4; ++chain)
            chains[chain].take(lower[i + chain], upper[i + chain]);
    for (; i < count; ++i)
        chains[0].take(lower[i], upper[i]);
    for (std::size_t chain = 1; chain < 4; ++chain)
        chains[0].take(chains[chain].lower, chains[chain].upper);
    return chains[0];
}

/// Reduces a row of tiles, `tile_columns` columns each, in blocks: calls finish(tile, extremes) for each tile.
///
/// by_split  see column_extremes(); `splits` has a number a tile
template <bool by_split, class Finish>
void reduce_tile_row(Isa isa, const DepthRows& row, std::size_t tile_columns, float skipped,
                     const float* splits, Finish finish) {
    constexpr std::size_t most = 512;
    const std::size_t block = tile_columns < most ? most / tile_columns * tile_columns : most;
    float lower[most], upper[most], split[by_split ? most : 1];
    Extremes tile;
    for (std::size_t first = 0; first < row.columns; first += block) {
        const std::size_t end = min_of(first + block, row.columns);
        const DepthRows part = {row.samples + first, row.pitch, row.rows, end - first};
        for (std::size_t column = first; by_split && column < end;) {
            const std::size_t stop = min_of((column / tile_columns + 1) * tile_columns, end);
            fill_items(split + (column - first), stop - column, splits[column / tile_columns]);
            column = stop;
        }
        depth_kernel<by_split>(isa, part.columns)(part, skipped, split, lower, upper);
        for (std::size_t column = first; column < end;) {
            const std::size_t index = column / tile_columns;
            const std::size_t tile_end = min_of((index + 1) * tile_columns, row.columns);
            const std::size_t stop = min_of(tile_end, end);
            tile = extremes(lower + (column - first), upper + (column - first), stop - column, tile);
            if (stop == tile_end) {
                finish(index, tile);
                tile = {};
            }
            column = stop;
        }
    }
}

}  // namespace detail

/// Reduces a depth buffer to Z bounds in the caller's buffers, which the result then refers to.
///
/// After it, the view depth of every sample lies within its tile's bounds, which are rounded outward and
/// widened by what DepthFormat allows for. A tile where nothing is drawn (see skip_background) has min = +inf, max =
/// -inf. Samples outside 0..1 are clamped; a NaN sample makes its tile reach from the near to the far plane.
/// A tile's gap is the one between its samples on either side of its middle view depth.
///
/// isa  use no wider instructions than these. The result is the same.
///
/// Source: Tiled Shading, section 6.3 (minimum and maximum depth a tile); Harada, "A 2.5D Culling for Forward+",
/// SIGGRAPH Asia 2012 (depths with a gap).
///
/// (A template as Error::message().)
template <class = void>
Result<ZBounds> reduce_depth(const View& view, const DepthBuffer& buffer, const ZBoundsBuffers& out,
                             Isa isa = compiled_isa) {
    const detail::DefaultFloatEnvironment environment;
    const Extent viewport = view.viewport();
    const std::size_t tiles = view.tile_count();
    if (buffer.samples < 1 || buffer.samples > 8)
        return Error{ErrorCode::samples_out_of_range, static_cast<std::uint64_t>(buffer.samples), 8};
    const std::size_t samples_a_pixel = static_cast<std::size_t>(buffer.samples);
    const std::size_t row = static_cast<std::size_t>(viewport.width) * samples_a_pixel;
    const std::size_t pitch = buffer.row_pitch == 0 ? row : buffer.row_pitch;
    if (pitch < row) return Error{ErrorCode::row_pitch_too_small, row, pitch};
    const std::uint64_t before_last =
        detail::product_of_sizes(pitch, static_cast<std::uint64_t>(viewport.height) - 1);
    const std::uint64_t needed = tiles == 0 ? 0 : detail::sum_of_sizes(before_last, row);
    if (buffer.depth.size() < needed)
        return Error{ErrorCode::depth_buffer_too_small, needed, buffer.depth.size()};
    for (const std::span<float> side : {out.min, out.max, out.gap_min, out.gap_max, out.transparent_max})
        if (!side.empty() && side.size() < tiles)
            return Error{ErrorCode::z_bounds_too_small, tiles, side.size()};

    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    const float skipped = !buffer.skip_background ? none : view.reversed_z() ? 0.0f : 1.0f;
    const bool gaps = !out.gap_min.empty() && !out.gap_max.empty();
    // As one of the viewport's size, a larger tile has a number of columns that can be counted.
    const std::size_t size = static_cast<std::size_t>(
        detail::min_of(view.tile_size(), detail::max_of(viewport.width, viewport.height)));
    const std::size_t tiles_x = static_cast<std::size_t>(view.tiles_x());
    const std::size_t height = static_cast<std::size_t>(viewport.height);
    isa = machine_isa(isa);
    for (std::size_t y = 0, first_tile = 0; first_tile < tiles; y += size, first_tile += tiles_x) {
        const detail::DepthRows samples = {buffer.depth.data() + y * pitch, pitch,
                                           detail::min_of(size, height - y), row};
        detail::reduce_tile_row<false>(
            isa, samples, size * samples_a_pixel, skipped, nullptr,
            [&](std::size_t tile, detail::Extremes range) {
                const DepthInterval depths = detail::fragment_depths(view, range, buffer.format);
                if (!out.min.empty()) out.min[first_tile + tile] = depths.min;
                if (!out.max.empty()) out.max[first_tile + tile] = depths.max;
                // For now, where to split the tile; NaN: nowhere, as a sample is NaN.
                const double middle =
                    0.5 * (static_cast<double>(depths.min) + static_cast<double>(depths.max));
                if (gaps)
                    out.gap_min[first_tile + tile] =
                        range.lower > -detail::infinity ? view.window_depth(middle) : none;
            });
        const auto set_transparent_max = [&](std::size_t tile, detail::Extremes range) {
            out.transparent_max[first_tile + tile] = detail::fragment_depths(view, range, buffer.format).max;
        };
        if (!out.transparent_max.empty())
            detail::reduce_tile_row<false>(isa, samples, size * samples_a_pixel, none, nullptr,
                                           set_transparent_max);
        if (!gaps) continue;
        detail::reduce_tile_row<true>(
            isa, samples, size * samples_a_pixel, skipped, out.gap_min.data() + first_tile,
            [&](std::size_t tile, detail::Extremes next) {
                // The fragments next to the gap, in window depth.
                DepthInterval below = {-detail::infinity, detail::infinity}, above = below;  // no gap
                if (next.upper > -detail::infinity && next.lower < detail::infinity) {
                    below = detail::fragment_depths(view, {next.upper, next.upper}, buffer.format);
                    above = detail::fragment_depths(view, {next.lower, next.lower}, buffer.format);
                }
                if (view.reversed_z()) std::swap(below, above);
                out.gap_min[first_tile + tile] = below.max;
                out.gap_max[first_tile + tile] = above.min;
            });
    }
    const auto given = [&](std::span<float> side) {
        return side.empty() ? std::span<const float>{} : std::span<const float>(side.first(tiles));
    };
    return ZBounds{.min = given(out.min),
                   .max = given(out.max),
                   .gap_min = gaps ? given(out.gap_min) : given({}),
                   .gap_max = gaps ? given(out.gap_max) : given({}),
                   .transparent_max = given(out.transparent_max),
                   .background_skipped = buffer.skip_background};
}

}}  // namespace lightbin
