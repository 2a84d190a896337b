// SPDX-License-Identifier: MIT
// Every threshold and estimate of time in one place. They choose between ways to the same bytes, and were measured
// with bench/binning on a Zen 4 and a Zen 5.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/isa.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// About how many ns it takes one thread of a fast processor to project lights, as if all were in view.
inline double project_ns(Isa isa, double lights) {
    return lights * (isa == Isa::avx512 ? 2 : isa == Isa::avx2 ? 3 : 7);
}

/// Into how many parts the chunks of lights are cut for so many threads: some a thread, so that a late one costs
/// little. As many where they are not shared, as more take more memory.
inline std::size_t project_parts(std::size_t chunks, std::size_t workers) {
    return workers > 1 ? min_of(chunks, 4 * min_of(chunks, workers)) : 1;
}

/// Whether rectangles with `area` tiles in all are binned sooner by scattering than by blocks. A walk over all blocks costs as much
/// as scattering some entries a tile. Without vectors scattering is always faster.
inline bool scatter_is_faster(Isa isa, std::uint64_t tiles, std::uint64_t area) {
    if (isa == Isa::scalar) return true;
    return area < (isa == Isa::avx512 ? 1 : 3) * tiles;
}

/// About how many ns one thread of a fast processor takes to bin lights by scattering, apart from what each share of the work does
/// again. In shares scattering does more for each light, as it can't predict which lights are in one.
inline double scatter_ns(double lights, double entries) {
    return max_of(0.6 * entries - 8 * lights, 0.0);
}

/// About how many ns one thread of a fast processor takes to bin lights by blocks.
///
/// tested  with a silhouette or a depth test
inline double block_ns(Isa isa, bool tested, double lights, double entries) {
    const double slower = isa == Isa::avx512 ? 1 : isa == Isa::avx2 ? 1.5 : 2;
    return slower * (tested ? 9 * lights + 0.35 * entries : 1.5 * lights + 0.1 * entries);
}

/// The same by the faster way.
template <bool tested> double bin_ns(Isa isa, std::uint64_t tiles, std::uint64_t lights, std::uint64_t area) {
    const double count = static_cast<double>(lights), entries = static_cast<double>(area);
    return !tested && scatter_is_faster(isa, tiles, area) ? scatter_ns(count, entries)
                                                                  : block_ns(isa, tested, count, entries);
}

/// What a row of tiles without lights costs a part of the work, in entries.
inline std::uint64_t empty_row_cost(std::uint64_t tiles) {
    return tiles;
}

/// How many rows of tiles are laid out at a time, for the memory that they take.
inline constexpr unsigned rows_counted_at_once = 512;

/// How many of `height` rows of tiles get their ids at a time. Long lists have cache lines and pages of their own,
/// and of all tiles at once too many: then rows of some 512 tiles at a time are faster, unless reading all lights
/// each time takes longer than putting their ids.
inline std::size_t rows_filled_at_once(std::size_t height, std::size_t width, std::uint64_t lights,
                                  std::uint64_t entries) {
    const std::size_t rows = 512 / width + 1;
    return entries < 256 * std::uint64_t{height} * width + 2 * lights * (height / rows + 1) ? height : rows;
}

/// The most lights that the lists of bands have room for, of all bands that one pass over the lights makes.
inline constexpr std::uint64_t max_band_entries = std::uint64_t{1} << 24;

/// Up to this area the lists have fewer places than 32 bits count, whatever lights it is the area of.
inline constexpr std::uint64_t surely_listed_area = 0xffffffff / 8;

}}}  // namespace lightbin::detail
