// SPDX-License-Identifier: MIT
// Bitmasks of tiles from the words of step 2 of bin.inl, without lists. Included once a tier that does not compress.
#if !defined(LIGHTBIN_KERNELS)  // opened alone, by an editor: see tiers/in_editor.hpp
#pragma once
#include <lightbin/detail/tiers/in_editor.hpp>
#endif

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail { namespace LIGHTBIN_TIER {

/// Writes bitmasks of the tiles in rows begin..end-1: `each` words a tile, of which bit b of word w is light 32 w + b.
template <Footprint footprint, DepthTest depth_test, class Id, bool spots>
void write_bits(const BinJob<Id>& job, Scratch& scratch, unsigned begin, unsigned end,
                                std::uint32_t* bits, std::size_t each) {
    const unsigned tiles_x = static_cast<unsigned>(job.camera->x.tiles), width = (tiles_x + 7) / 8;
    const std::size_t each_row = tiles_x * each;
    fill_items(bits + begin * each_row, (end - begin) * each_row, 0);
    std::size_t places[64];  // of the words of a supertile's tiles
    for (unsigned tile = 0; tile < 64; ++tile)
        places[tile] = tile / 8 * each_row + tile % 8 * each;
    const BandJob<Id> bands = {begin, end, nullptr, 0};
    ListedBands listed;
    for (unsigned top = begin; top < end; top += 8) {
        const BandLists<ListId> band = make_lists<true>(job, scratch, bands, top, width, listed);
        for (unsigned x = 0; band.lists != nullptr && x < width; ++x) {
            const SupertileList& list = band.lists[x];
            if (list.count == 0) continue;
            const std::uint32_t left =
                mask_lights<footprint, depth_test, spots>(job, scratch, x, top, list, band.ids);
            std::uint32_t* const first = bits + top * each_row + 8 * x * each;
            for (std::uint32_t i = 0; i < left; ++i) {
                const std::uint32_t id = band.ids[list.begin + i];
                for (std::uint64_t rest = scratch.masks.data()[i]; rest != 0; rest &= rest - 1)
                    first[places[std::countr_zero(rest)] + id / 32] |= std::uint32_t{1} << id % 32;
            }
        }
    }
}

}}}}  // namespace lightbin::detail
