// SPDX-License-Identifier: MIT
// Binning by supertiles of 8x8 tiles, for tiers without a compress instruction. Included once a tier, after its
// vectors and tile_masks.inl.
//
//   1. Each light is put in the lists of the supertiles that its rectangle meets, with a byte of the columns
//      and a byte of the rows it covers there. A difference array has sized the lists. (AVX2 scans: scan.inl.)
//   2. A supertile's list is turned round, 64 lights at a time: for each column and each row a word with a
//      bit a light.
//   3. The lights of tile (row, column) are  rows[row] & columns[column].  Tiles are taken in row-major
//      order, so the index list is written strictly in sequence: no count pass over tiles, no scatter, no
//      sort.
//
// With row spans or Z, step 2 makes a word a light instead, a bit a tile (tile_masks.inl), drops the lights
// without a bit, and turns the words round, 8 lights at a time: a byte a tile, a bit a light.

/// Step 1. Lists are aligned to 64 and followed by at least one free place. They hold ids, or, where lights get
/// words, visible indices.
template <bool with_words, class Id>
LIGHTBIN_TARGET void fill_lists(const BinJob<Id>& job, Scratch& scratch, const BandJob<Id>& bands,
                                std::size_t pitch) {
    const FootprintArrays& lights = job.lights;
    const std::size_t count = pitch * ((bands.end - bands.begin + 7) / 8 + 2);
    std::uint32_t* corners = scratch.corners.room(count);
    std::memset(corners, 0, count * sizeof *corners);
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            const unsigned y0 = (std::max<unsigned>)(lights.y0[i], bands.begin),
                           y1 = (std::min<unsigned>)(lights.y1[i], bands.end - 1);
            if (y0 > y1) continue;
            const std::size_t left = lights.x0[i] / 8u, right = lights.x1[i] / 8u + 1;
            const std::size_t top = (y0 - bands.begin) / 8 * pitch,
                              bottom = ((y1 - bands.begin) / 8 + 1) * pitch;
            ++corners[top + left];
            --corners[top + right];
            --corners[bottom + left];
            ++corners[bottom + right];
        }
    std::uint32_t* begin = scratch.list_begin.room(count);
    std::uint32_t* size = scratch.list_size.room(count);
    std::uint32_t* cursors = scratch.cursors.room(count);
    std::uint32_t total = 0;
    for (std::size_t list = 0; list < count; ++list) {
        std::uint32_t here = corners[list];  // sums wrap, and come out right
        if (list > 0) here += size[list - 1];
        if (list >= pitch) here += size[list - pitch];
        if (list > pitch) here -= size[list - pitch - 1];
        size[list] = here;
        begin[list] = cursors[list] = total;
        total += (here + 64) & ~63u;
    }
    const std::uint64_t room = std::uint64_t{total} + 64;
    std::uint32_t* ids = scratch.list_ids.room(room);
    std::uint8_t* columns = scratch.list_columns.room(room);
    std::uint8_t* rows = scratch.list_rows.room(room);
    const auto put = [=](std::uint32_t place, std::uint32_t id, unsigned column_bits, unsigned row_bits) {
        ids[place] = id;
        columns[place] = static_cast<std::uint8_t>(column_bits);
        rows[place] = static_cast<std::uint8_t>(row_bits);
    };
    for (const FootprintRun& run : job.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            const unsigned x0 = lights.x0[i], x1 = lights.x1[i];
            unsigned y0 = (std::max<unsigned>)(lights.y0[i], bands.begin),
                     y1 = (std::min<unsigned>)(lights.y1[i], bands.end - 1);
            if (y0 > y1) continue;
            y0 -= bands.begin;
            y1 -= bands.begin;
            const unsigned left = x0 / 8, top = y0 / 8, more_x = x1 / 8 - left, more_y = y1 / 8 - top;
            const std::uint32_t id = with_words ? i : lights.ids[i];
            std::uint32_t* list = cursors + top * pitch + left;
            if ((more_x | more_y) <= 1) {
                // Most lights: written to all four supertiles, kept in those they meet, without a branch.
                const unsigned column_bits = ((2u << (x1 - 8 * left)) - 1) & (~0u << x0 % 8);
                const unsigned row_bits = ((2u << (y1 - 8 * top)) - 1) & (~0u << y0 % 8);
                put(list[0]++, id, column_bits, row_bits);
                put(list[1], id, column_bits >> 8, row_bits);
                list[1] += more_x;
                put(list[pitch], id, column_bits, row_bits >> 8);
                list[pitch] += more_y;
                put(list[pitch + 1], id, column_bits >> 8, row_bits >> 8);
                list[pitch + 1] += more_x & more_y;
                continue;
            }
            for (unsigned y = top; y <= top + more_y; ++y, list += pitch)
                for (unsigned x = left; x <= left + more_x; ++x)
                    put(list[x - left]++, id, covered(x0, x1, 8 * x), covered(y0, y1, 8 * y));
        }
}

/// Appends those of `count` ids, up to 64, whose bit is set. Returns the end.
template <class Id, class Ids>
LIGHTBIN_TARGET inline Id* append_64(Id* out, const Ids* ids, std::uint64_t chosen, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; i += 16, chosen >>= 16) {
        out += append(out, ids + i, static_cast<unsigned>(chosen & 0xff));
        out += append(out, ids + i + 8, static_cast<unsigned>(chosen >> 8 & 0xff));
    }
    return out;
}

/// Bins the tile rows of `bands`. Returns the number of entries. May write BandJob::slack elements past them.
/// Without an index list (bands.out null) it counts the entries only.
template <Footprint footprint, DepthTest depth_test, class Id>
LIGHTBIN_TARGET std::uint64_t bin_supertiles(const BinJob<Id>& job, Scratch& scratch,
                                             const BandJob<Id>& bands) {
    constexpr bool with_words = masked<footprint, depth_test>;
    const unsigned tiles_x = static_cast<unsigned>(job.camera->x.tiles);
    const unsigned width = (tiles_x + 7) / 8;
    // One more column and row: the difference array closes there, and branch-free writes may go there.
    const std::size_t pitch = width + 2;
    const bool scan = scans_lists && tiles_x <= 240;  // a byte counts the columns
    if (!scan) fill_lists<with_words>(job, scratch, bands, pitch);

    Id* out = bands.out;
    std::uint64_t entries = 0;
    std::size_t list = 0;
    for (unsigned top = bands.begin; top < bands.end; top += 8) {
        if constexpr (scans_lists)
            if (scan) scan_lists<with_words>(job, scratch, top, (std::min)(top + 8, bands.end), width);
        const std::uint32_t* begin = scratch.list_begin.data() + list;
        std::uint32_t* size = scratch.list_size.data() + list;
        std::uint8_t* columns = scratch.list_columns.data();
        std::uint8_t* rows = scratch.list_rows.data();
        if (!scan) list += pitch;
        const std::uint32_t room = begin[width] - begin[0];
        // Per 64 lights 16 words, or a word a light and then 64 words.
        std::uint64_t* words = scratch.words.room(room / 64 * 16);
        std::uint8_t* bytes = nullptr;
        if constexpr (with_words) bytes = scratch.tile_bytes.room(std::uint64_t{room} * 8);
        Packed<Id>* packed = nullptr;
        if constexpr (packs_ids)
            packed = reinterpret_cast<Packed<Id>*>(
                scratch.packed_ids.room(std::uint64_t{room} * sizeof(Packed<Id>)));
        for (unsigned x = 0; x < width; ++x) {
            const std::uint32_t count = size[x], end = (count + 63) & ~63u;
            if (count == 0) continue;
            if constexpr (!with_words) {
                std::memset(columns + begin[x] + count, 0, end - count);
                for (std::uint32_t i = begin[x]; i < begin[x] + end; i += 64, words += 16) {
                    split_bits(columns + i, words);
                    split_bits(rows + i, words + 8);
                }
            } else {
                [[maybe_unused]] float arranged[cell_planes<depth_test> * 64];
                const float* cells = nullptr;
                std::uint64_t lit = ~std::uint64_t{0};
                if constexpr (depth_test != DepthTest::none) {
                    lit = arrange_cells<depth_test>(job, x, top, arranged);
                    cells = arranged;
                }
                std::uint64_t* masks = scratch.masks.room(end);
                size[x] = mask_lights<footprint, depth_test>(
                    job, x, top, cells, lit, scratch.list_ids.data() + begin[x], 0, columns + begin[x],
                    rows + begin[x], count, masks);
                if (out == nullptr)
                    for (std::uint32_t i = 0; i < size[x]; ++i)
                        entries += static_cast<unsigned>(std::popcount(masks[i]));
                else
                    for (std::uint32_t i = 0; i < size[x]; i += 8, bytes += 64)
                        turn_words(masks + i, (std::min)(size[x] - i, 8u), bytes);
            }
            if constexpr (packs_ids)
                pack(scratch.list_ids.data() + begin[x], size[x], packed + (begin[x] - begin[0]));
        }
        if (out == nullptr) continue;
        for (unsigned row = 0; row < 8 && top + row < bands.end; ++row) {
            if (top + row == bands.spare_row) out = bands.spare;
            Tile* tile = job.tiles + (top + row) * std::size_t{tiles_x};
            const std::uint64_t* word = scratch.words.data();
            const std::uint8_t* byte = nullptr;
            if constexpr (with_words) byte = scratch.tile_bytes.data() + row * 8;
            for (unsigned x = 0; x < width; ++x) {
                const std::uint32_t count = size[x];
                const Packed<Id>* ids;
                if constexpr (packs_ids)
                    ids = packed + (begin[x] - begin[0]);
                else
                    ids = scratch.list_ids.data() + begin[x];
                const unsigned last_column = tiles_x - 8 * x < 8 ? tiles_x - 8 * x : 8;
                for (unsigned column = 0; column < last_column; ++column) {
                    Id* const from = out;
                    // The usual lengths of a list: no loop to predict.
                    if (count == 0) {
                    } else if (count <= 16) {
                        unsigned low, high = 0;
                        if constexpr (with_words) {
                            low = byte[column];
                            if (count > 8) high = byte[64 + column];
                        } else {
                            const std::uint64_t chosen = word[column] & word[8 + row];
                            low = chosen & 0xff;
                            high = static_cast<unsigned>(chosen >> 8);
                        }
                        out += append(out, ids, low);
                        if (count > 8) out += append(out, ids + 8, high);
                    } else if constexpr (with_words) {
                        for (std::size_t i = 0; i < count; i += 8)
                            out += append(out, ids + i, byte[i * 8 + column]);
                    } else if (count <= 64) {
                        out = append_64(out, ids, word[column] & word[8 + row], count);
                    } else {
                        for (std::uint32_t i = 0; i < count; i += 64) {
                            const std::uint64_t* group = word + i / 4;
                            out = append_64(out, ids + i, group[column] & group[8 + row],
                                            (std::min)(count - i, 64u));
                        }
                    }
                    const std::uint32_t length = static_cast<std::uint32_t>(out - from);
                    *tile++ = {bands.at + static_cast<std::uint32_t>(entries), length};
                    entries += length;
                }
                if constexpr (with_words)
                    byte += (count + 7) / 8 * 64;
                else
                    word += (count + 63) / 64 * 16;
            }
        }
    }
    return entries;
}
