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

/// Whether rectangles with `area` tiles in all are binned sooner by scattering than by supertiles. A walk over all
/// supertiles costs as much as scattering some entries a tile; putting a light in their lists, where neither
/// compress nor scanning does it, as scattering it to 48 tiles.
inline bool scatter_is_faster(Isa isa, std::uint64_t tiles, std::uint64_t lights, std::uint64_t area) {
    switch (isa) {
    case Isa::scalar:
        return true;
    case Isa::avx512:
        return area <= tiles && lights < tiles / 16;
    case Isa::avx2:
        return area < 3 * tiles;
    case Isa::sse2:
    case Isa::neon:
        return area < 6 * tiles + 48 * lights;
    }
    return true;
}

/// About how many ns one thread of a fast processor takes to bin lights by scattering, apart from what each part of
/// the work does again. In parts it does more for each light, as it can't predict which lights are in one.
inline double scatter_ns(double lights, double entries) {
    return max_of(0.6 * entries - 8 * lights, 0.0);
}

/// The same by supertiles. with_words: with row spans or a depth test.
inline double supertile_ns(Isa isa, bool with_words, double lights, double entries) {
    const double slower = isa == Isa::avx512 ? 1 : isa == Isa::avx2 ? 1.5 : 2;
    return slower * (with_words ? 9 * lights + 0.35 * entries : 1.5 * lights + 0.1 * entries);
}

/// Whether a row of a supertile, with a list of `lights` of which `in_row` are in the row, is emitted sooner from a
/// list of those. In instructions of the AVX2 tier: picking takes 17 for 8 lights, and for 64 picked ones some 60 for
/// their words; a tile 9 for 8 lights, of 8 tiles. What a list takes beside, with a branch or two mispredicted,
/// is 200.
inline bool picking_is_faster(std::uint64_t lights, std::uint64_t in_row) {
    return (9 * 8 - 17) * lights > (9 * 8 + 8) * in_row + 8 * 200;
}

/// What a row of tiles without lights costs a part of the work, in entries.
inline std::uint64_t empty_row_cost(std::uint64_t tiles) {
    return tiles;
}

/// How many rows of tiles are laid out at a time, for the memory that they take.
inline constexpr unsigned rows_laid_out = 512;

/// How many of `height` rows of tiles get their ids at a time. Long lists have cache lines and pages of their own,
/// and of all tiles at once too many: then rows of some 512 tiles at a time are faster, unless reading all lights
/// each time takes longer than putting their ids.
inline std::size_t rows_scattered(std::size_t height, std::size_t width, std::uint64_t lights,
                                  std::uint64_t entries) {
    const std::size_t rows = 512 / width + 1;
    return entries < 256 * std::uint64_t{height} * width + 2 * lights * (height / rows + 1) ? height : rows;
}

/// The most lights that the lists of bands have room for, of all bands that one pass over the lights makes.
inline constexpr std::uint64_t most_band_places = std::uint64_t{1} << 24;

/// Up to this area the lists have fewer places than 32 bits count, whatever lights it is the area of.
inline constexpr std::uint64_t surely_listed_area = 0xffffffff / 8;

}}}  // namespace lightbin::detail
