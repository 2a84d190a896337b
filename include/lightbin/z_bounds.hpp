// SPDX-License-Identifier: MIT
// Stage 2b: depth buffer -> per-tile minimum and maximum view depth of what is drawn there.
#pragma once

#include <lightbin/detail/rounding.hpp>
#include <lightbin/result.hpp>
#include <lightbin/view.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lightbin {

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
};

/// How a depth buffer stores depth: how far the stored value can be from that of the fragment that wrote it.
enum class DepthFormat : std::uint8_t {
    float32,  ///< one unit in the last place is allowed for
    unorm24,  ///< one step of 1 / (2^24 - 1)
    unorm16,  ///< one step of 1 / (2^16 - 1)
};

/// A depth buffer in main memory: window depth in 0..1 (as glReadPixels gives it), the view's viewport only.
struct DepthBuffer {
    /// Pixels row by row from the view's window origin, the samples of a pixel side by side.
    std::span<const float> depth = {};
    int samples = 1;            ///< samples a pixel, 1 to 8
    std::size_t row_pitch = 0;  ///< floats from one row to the next; 0: viewport width * samples
    DepthFormat format = DepthFormat::float32;
    /// A sample at the far end of the depth range (1, or 0 with reversed Z) means that nothing is drawn
    /// there, so it does not count. Right for buffers cleared to that value and drawn with a strict depth
    /// comparison. When false, such a sample is something drawn at the far plane.
    bool skip_background = false;
};

namespace detail {

/// Smallest and largest of a tile's samples; lower > upper where no sample counts.
struct DepthRange {
    float lower = infinity, upper = -infinity;
    bool unknown = false;  ///< a sample is NaN
};

inline void extend(DepthRange& range, std::span<const float> samples, bool skip, float background) {
    for (const float depth : samples) {
        if (skip && depth == background) continue;
        range.lower = (std::min)(range.lower, depth);  // keeps its first argument when the second is NaN
        range.upper = (std::max)(range.upper, depth);
        range.unknown |= std::isnan(depth);
    }
}

/// View depths of the samples in `range` and of the fragments that may have written them. In double: a float
/// sum near 1 would be off by a step of its own.
inline DepthInterval view_depths(const View& view, const DepthRange& range, DepthFormat format) {
    if (range.unknown) return view.view_depths(0, 1);
    if (range.lower > range.upper) return {infinity, -infinity};
    const double step = format == DepthFormat::unorm24   ? 0x1.000002p-24
                        : format == DepthFormat::unorm16 ? 0x1.0002p-16
                                                         : 0.0;
    const double ulp = format == DepthFormat::float32 ? 0x1p-23 : 0.0;
    return view.view_depths(std::clamp(static_cast<double>(range.lower) * (1 - ulp) - step, 0.0, 1.0),
                            std::clamp(static_cast<double>(range.upper) * (1 + ulp) + step, 0.0, 1.0));
}

}  // namespace detail

/// Reduces a depth buffer to Z bounds in `min` and `max`, which the result then refers to. Either span may be
/// empty where that side is not wanted; otherwise it takes view.tile_count() floats.
///
/// After it, the view depth of every sample lies within its tile's bounds, which are rounded outward and
/// widened by the format's step. A tile where nothing is drawn (see skip_background) has min = +inf, max =
/// -inf. Samples outside 0..1 are clamped; a NaN sample makes its tile reach from the near to the far plane.
///
/// Source: Tiled Shading, section 3 (minimum and maximum depth a tile).
inline Result<ZBounds> reduce_depth(const View& view, const DepthBuffer& buffer, std::span<float> min,
                                    std::span<float> max) {
    const Extent viewport = view.viewport();
    const std::size_t tiles = view.tile_count();
    if (buffer.samples < 1 || buffer.samples > 8)
        return Error{ErrorCode::samples_out_of_range, static_cast<std::uint64_t>(buffer.samples), 8};
    const std::size_t samples = static_cast<std::size_t>(buffer.samples);
    const std::size_t row = static_cast<std::size_t>(viewport.width) * samples;
    const std::size_t pitch = buffer.row_pitch == 0 ? row : buffer.row_pitch;
    if (pitch < row) return Error{ErrorCode::row_pitch_too_small, row, pitch};
    const std::size_t needed = tiles == 0 ? 0 : pitch * static_cast<std::size_t>(viewport.height - 1) + row;
    if (buffer.depth.size() < needed)
        return Error{ErrorCode::depth_buffer_too_small, needed, buffer.depth.size()};
    for (const std::span<float> side : {min, max})
        if (!side.empty() && side.size() < tiles)
            return Error{ErrorCode::z_bounds_too_small, tiles, side.size()};

    const float background = view.reversed_z() ? 0.0f : 1.0f;
    std::size_t tile = 0;
    for (int ty = 0; ty < view.tiles_y(); ++ty) {
        const int y0 = ty * view.tile_size(), y1 = (std::min)(viewport.height - y0, view.tile_size()) + y0;
        for (int tx = 0; tx < view.tiles_x(); ++tx, ++tile) {
            const int x0 = tx * view.tile_size(), x1 = (std::min)(viewport.width - x0, view.tile_size()) + x0;
            detail::DepthRange range;
            for (int y = y0; y < y1; ++y)
                detail::extend(range,
                               buffer.depth.subspan(static_cast<std::size_t>(y) * pitch +
                                                        static_cast<std::size_t>(x0) * samples,
                                                    static_cast<std::size_t>(x1 - x0) * samples),
                               buffer.skip_background, background);
            const DepthInterval depths = detail::view_depths(view, range, buffer.format);
            if (!min.empty()) min[tile] = depths.min;
            if (!max.empty()) max[tile] = depths.max;
        }
    }
    return ZBounds{min.empty() ? std::span<const float>{} : min.first(tiles),
                   max.empty() ? std::span<const float>{} : max.first(tiles)};
}

}  // namespace lightbin
