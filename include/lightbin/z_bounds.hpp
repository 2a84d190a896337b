// SPDX-License-Identifier: MIT
// Stability: settled.
// Z bounds: the minimum and maximum view depth of what is drawn in each tile, reduced from a depth buffer.
#pragma once

#include <lightbin/detail/stages/tile_extremes.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Z bounds: the view depths that bound what is drawn in each tile. Each array has one float per tile, row-major, and
/// at least View::tile_count() of them. An empty span means that lights are not tested against that bound.
///
/// A tile with min > max shows nothing that could be lit, so it gets no lights. A bound that is NaN excludes no light.
struct ZBounds {
    std::span<const float> min = {};
    std::span<const float> max = {};
};

/// Memory that reduce_depth() writes Z bounds to: View::tile_count() floats for each bound that is wanted, else an
/// empty span.
struct ZBoundsBuffers {
    std::span<float> min = {}, max = {};
};

/// The number format of a depth buffer. It decides by how much reduce_depth() widens the bounds to allow for rounding:
/// a stored value may be either of the format's two values next to the fragment's exact window depth, and an integer
/// read as a float either of the two floats next to its value. The bounds do not allow for larger differences, such as
/// in a buffer with fewer bits than the format named, or of depths moved by a polygon offset.
enum class DepthFormat : std::uint8_t {
    float32,  ///< a 32-bit float; denormal numbers may have been flushed to zero
    unorm24,  ///< a 24-bit integer n that stands for the depth n / (2^24 - 1)
    unorm16,  ///< a 16-bit integer n that stands for the depth n / (2^16 - 1)
    /// A 32-bit float that is no window depth but the view depth itself, such as one converted from a logarithmic
    /// depth: within 2^-18 of the fragment's. Background is +inf, and NaN may be any depth, -inf to +inf.
    view_depth,
};

constexpr const char* to_string(DepthFormat format) {
    return detail::name_at(format, {"float32", "unorm24", "unorm16", "view_depth"});
}

/// A depth buffer in main memory that covers the view's viewport and nothing else; with a turned view it is turned, as
/// drawn. Samples are window depths from 0 to 1, as glReadPixels returns them, or view depths.
struct DepthBuffer {
    /// Rows of pixels from the view's window origin on. The samples of one pixel are next to each other.
    std::span<const float> depth = {};
    int samples = 1;            ///< samples per pixel, 1 to 8
    std::size_t row_pitch = 0;  ///< floats from the start of one row to the next; 0: viewport width * samples
    DepthFormat format = DepthFormat::float32;
    /// Treats samples at the far end of the depth range (1, or 0 with reversed Z, or +inf if they are view depths) as
    /// background, where nothing is drawn. Right for buffers that were cleared to that value and drawn with a strict
    /// depth comparison, and for lights of opaque surfaces alone: transparent ones are seen in front of the background,
    /// too.
    bool skip_background = false;
};

namespace detail {

/// Returns the range of view depths of all fragments that can have stored window depths between window.lower and
/// window.upper. Computed in double, because a float sum near 1 would itself be off by one step of the format.
///
/// tilt  where the fragments lie in an image with an oblique near plane: DepthMap::tilts_around()
inline DepthInterval fragment_depths(const DepthMap& map, Extremes window, DepthFormat format, const Tilt& tilt = {}) {
    if (!(window.lower <= window.upper)) return {infinity, -infinity};
    if (format == DepthFormat::view_depth) {
        const auto moved = [](float depth, float outward) {
            return depth * (1 + (depth < 0 ? -outward : outward) * 0x1p-18f * (1 + 0x1p-5f));
        };
        return {moved(window.lower, -1), moved(window.upper, 1)};
    }
    double low = static_cast<double>(window.lower), high = static_cast<double>(window.upper);
    if (format == DepthFormat::float32) {
        // Rounding moves a normal float by at most 2^-23 of itself, but may flush a denormal one to zero.
        constexpr double least_normal = 0x1p-126;
        low = low < least_normal ? 0 : low * (1 - 0x1p-23);
        high = max_of(high * (1 + 0x1p-23), least_normal);
    } else {
        // How far the stored depth can be from the fragment's: one step of the integer format, 1 / (2^n - 1), rounded
        // up, for storing it, and the largest step between floats up to 1, 2^-24, for its conversion to float.
        const double reach = (format == DepthFormat::unorm24 ? 0x1.000002p-24 : 0x1.0002p-16) + 0x1p-24;
        low = low - reach;
        high = high + reach;
    }
    DepthInterval depths = {};
    map.view_depths(min_of(max_of(low, 0.0), 1.0), min_of(max_of(high, 0.0), 1.0), tilt, depths.min, depths.max);
    return depths;
}

/// Reduces one tile of an image with an oblique near plane. There one window depth is another view depth in each pixel,
/// so samples are converted before they are compared.
///
/// x0, x1, y  the tile's columns of pixels, and the row that the first of `rows` is
/// samples    how many a pixel has: more than one may lie anywhere in the pixel, a single one in its middle
inline DepthInterval reduce_oblique_tile(const View& view, const DepthRows& rows, std::size_t x0, std::size_t x1,
                                         std::size_t y, std::size_t samples, float skipped, DepthFormat format) {
    const DepthMap& map = projection_of(view).depth;
    const double width = view.viewport().width, height = view.viewport().height, reach = samples > 1 ? 1 : 0;
    DepthInterval depths = {infinity, -infinity};
    for (std::size_t row = 0; row < rows.rows; ++row)
        for (std::size_t x = x0; x < x1; ++x) {
            const double right = (2 * static_cast<double>(x) + 1) / width - 1,
                         up = (2 * static_cast<double>(y + row) + 1) / height - 1;
            const Tilt tilt = view.turned() ? map.tilts_around(up, right, reach / height, reach / width)
                                            : map.tilts_around(right, up, reach / width, reach / height);
            for (std::size_t i = x * samples; i < (x + 1) * samples; ++i) {
                const float sample = rows.samples[row * rows.pitch + i];
                if (sample <= skipped && sample >= skipped) continue;
                const Extremes window = is_nan(sample) ? Extremes{0, 1} : Extremes{sample, sample};
                const DepthInterval found = fragment_depths(map, window, format, tilt);
                depths = {min_of(depths.min, found.min), max_of(depths.max, found.max)};
            }
        }
    return depths;
}

/// Calls visit(x, y, low, high) for the tiles in which something may be drawn: the tile's column and row, and its Z
/// bounds, infinite where they are not given or NaN. Tiles whose minimum exceeds their maximum are empty.
template <class Visit> void for_each_drawn(const View& view, const ZBounds& bounds, Visit visit) {
    std::size_t tile = 0;
    const auto bound = [&](std::span<const float> side, float unbounded) {
        return side.empty() || is_nan(side[tile]) ? unbounded : side[tile];
    };
    for (int y = 0; y < view.tiles_y(); ++y)
        for (int x = 0; x < view.tiles_x(); ++x, ++tile) {
            const float low = bound(bounds.min, -infinity), high = bound(bounds.max, infinity);
            if (!(low > high)) visit(x, y, low, high);
        }
}

}  // namespace detail

/// Reduces a depth buffer to Z bounds in the memory of `out`, and returns them. The view depth of every sample lies
/// within its tile's bounds, which are rounded outward and widened by the rounding of the DepthFormat. A tile where
/// nothing is drawn has min = +inf and max = -inf. Window depths outside 0..1 are clamped; a NaN makes its tile reach
/// from the near to the far plane. With an oblique near plane this takes longer, as each sample is converted by itself.
///
/// isa  use no wider instructions than these; the result is the same
///
/// Errors: a sample count outside 1 to 8; a row pitch shorter than a row; too few samples; an `out` span that is
/// neither empty nor as long as View::tile_count().
///
/// Source: Tiled Shading, section 6.3.
inline Result<ZBounds> reduce_depth(const View& view, const DepthBuffer& buffer, const ZBoundsBuffers& out,
                                    Isa isa = compiled_isa) {
    const detail::DefaultFloatEnvironment environment;
    const ImageSize viewport = view.viewport();
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
    for (const std::span<float> side : {out.min, out.max})
        if (!side.empty() && side.size() < tiles)
            return Error{ErrorCode::z_bounds_too_small, tiles, side.size()};

    const bool converted = buffer.format == DepthFormat::view_depth;
    const float skipped = !buffer.skip_background ? std::numeric_limits<float>::quiet_NaN()
                          : converted             ? detail::infinity
                          : view.reversed_z()     ? 0.0f
                                                  : 1.0f;
    // Tiles follow each other across the viewport, which with a turned projection is down a column of tiles.
    const detail::Camera& camera = detail::camera_of(view);
    const detail::DepthMap& map = detail::projection_of(view).depth;
    const detail::TileSplit &across = (view.turned() ? camera.y : camera.x).split,
                            &down = (view.turned() ? camera.x : camera.y).split;
    const std::size_t tiles_x = static_cast<std::size_t>(view.tiles_x()), next_across = view.turned() ? tiles_x : 1,
                      next_down = view.turned() ? 1 : tiles_x;
    isa = machine_isa(isa);
    for (int tile_row = 0; tiles > 0 && tile_row < down.count(); ++tile_row) {
        const auto first = static_cast<std::size_t>(down.first_pixel(tile_row)),
                   end = static_cast<std::size_t>(down.first_pixel(tile_row + 1));
        const detail::DepthRows samples = {buffer.depth.data() + (first < end ? first : 0) * pitch, pitch, end - first,
                                           row};
        const auto store = [&](std::size_t tile, DepthInterval depths) {
            const std::size_t at = static_cast<std::size_t>(tile_row) * next_down + tile * next_across;
            if (!out.min.empty()) out.min[at] = depths.min;
            if (!out.max.empty()) out.max[at] = depths.max;
        };
        for (int tile = 0; map.oblique() && !converted && tile < across.count(); ++tile)
            store(static_cast<std::size_t>(tile),
                  detail::reduce_oblique_tile(view, samples, static_cast<std::size_t>(across.first_pixel(tile)),
                                              static_cast<std::size_t>(across.first_pixel(tile + 1)), first,
                                              samples_a_pixel, skipped, buffer.format));
        if (!map.oblique() || converted)
            detail::reduce_tile_row(isa, samples, across, samples_a_pixel, skipped,
                                    [&](std::size_t tile, detail::Extremes range) {
                                        store(tile, detail::fragment_depths(map, range, buffer.format));
                                    });
    }
    const auto given = [&](std::span<float> side) {
        return side.empty() ? std::span<const float>{} : std::span<const float>(side.data(), tiles);
    };
    return ZBounds{.min = given(out.min), .max = given(out.max)};
}

}}  // namespace lightbin
