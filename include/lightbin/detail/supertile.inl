// SPDX-License-Identifier: MIT
// Binning by supertiles of 8x8 tiles, for tiers without a compress instruction. Included within a tier, after
// its vectors.
//
//   1. Each light is put in the lists of the supertiles that its rectangle meets, with a byte of the columns
//      and a byte of the rows it covers there. A difference array has sized the lists.
//   2. A supertile's list is turned round, 64 lights at a time: for each column and each row a word with a
//      bit a light.
//   3. The lights of tile (row, column) are  rows[row] & columns[column].  Tiles are taken in row-major
//      order, so the index list is written strictly in sequence: no count pass over tiles, no scatter, no
//      sort.
//
// With Z bounds step 2 makes a word for each of the 64 tiles: the light's tiles as one 64-bit mask, and-ed
// with the tiles whose bounds it meets, turned round by rows.

/// Bits of the tiles first..last of an 8-tile span that begins at tile `begin`, for a light that meets it.
LIGHTBIN_TARGET inline unsigned covered(unsigned first, unsigned last, unsigned begin) {
    const unsigned low = first > begin ? first - begin : 0, high = last - begin < 7 ? last - begin : 7;
    return ((2u << high) - 1) & (~0u << low);
}

/// Step 1. Lists are aligned to 64 and followed by at least one free place.
template <class Id>
LIGHTBIN_TARGET void fill_lists(const BinJob<Id>& job, Scratch& scratch, std::size_t pitch,
                                std::size_t height) {
    const FootprintArrays& lights = job.lights;
    const std::size_t count = pitch * height;
    std::int32_t* corners = scratch.corners.room(count);
    std::memset(corners, 0, count * sizeof *corners);
    for (std::uint32_t i = 0; i < job.count; ++i) {
        const unsigned left = lights.x0[i] / 8u, right = lights.x1[i] / 8u + 1;
        const std::size_t top = lights.y0[i] / 8u * pitch, bottom = (lights.y1[i] / 8u + 1) * pitch;
        ++corners[top + left];
        --corners[top + right];
        --corners[bottom + left];
        ++corners[bottom + right];
    }
    std::uint32_t* begin = scratch.list_begin.room(count);
    std::uint32_t* size = scratch.list_size.room(count);
    std::uint32_t* cursors = scratch.cursors.room(count);
    std::uint32_t total = 0;
    for (std::size_t y = 0; y < height; ++y) {
        std::uint32_t row = 0;
        for (std::size_t x = 0; x < pitch; ++x) {
            const std::size_t list = y * pitch + x;
            row += static_cast<std::uint32_t>(corners[list]);
            size[list] = row + (y > 0 ? size[list - pitch] : 0);
            begin[list] = cursors[list] = total;
            total += (size[list] + 64) & ~63u;
        }
    }
    std::uint32_t* ids = scratch.list_ids.room(total + 64);
    std::uint8_t* columns = scratch.list_columns.room(total + 64);
    std::uint8_t* rows = scratch.list_rows.room(total + 64);
    const auto put = [=](std::uint32_t place, std::uint32_t id, unsigned column_bits, unsigned row_bits) {
        ids[place] = id;
        columns[place] = static_cast<std::uint8_t>(column_bits);
        rows[place] = static_cast<std::uint8_t>(row_bits);
    };
    for (std::uint32_t i = 0; i < job.count; ++i) {
        const unsigned x0 = lights.x0[i], x1 = lights.x1[i], y0 = lights.y0[i], y1 = lights.y1[i];
        const unsigned left = x0 / 8, top = y0 / 8, more_x = x1 / 8 - left, more_y = y1 / 8 - top;
        const std::uint32_t id = lights.ids[i];
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

/// Returns the number of entries. May write BinJob::slack elements past the end of both arrays.
template <bool with_depth, class Id>
LIGHTBIN_TARGET std::uint64_t bin_supertiles(const BinJob<Id>& job, Scratch& scratch) {
    const unsigned tiles_x = static_cast<unsigned>(job.tiles_x), tiles_y = static_cast<unsigned>(job.tiles_y);
    const unsigned width = (tiles_x + 7) / 8, height = (tiles_y + 7) / 8;
    // One more column and row: the difference array closes there, and branch-free writes may go there.
    const std::size_t pitch = width + 2;
    fill_lists(job, scratch, pitch, height + 2);
    if constexpr (with_depth) arrange_bounds(job, scratch, pitch, height);
    const std::uint32_t* begin = scratch.list_begin.data();
    const std::uint32_t* size = scratch.list_size.data();
    std::uint8_t* columns = scratch.list_columns.data();
    std::uint8_t* rows = scratch.list_rows.data();

    Id* out = job.indices;
    for (unsigned y = 0; y < height; ++y) {
        std::size_t groups = 0;
        for (unsigned x = 0; x < width; ++x)
            groups += (size[y * pitch + x] + 63) / 64;
        std::uint64_t* words = scratch.words.room(groups * Words<with_depth>::size);
        for (unsigned x = 0; x < width; ++x) {
            const std::size_t list = y * pitch + x;
            const std::uint32_t count = size[list], end = (count + 63) & ~63u;
            std::memset(columns + begin[list] + count, 0, end - count);
            for (std::uint32_t i = 0; i < end; i += 64, words += Words<with_depth>::size) {
                const std::uint32_t first = begin[list] + i;
                if constexpr (!with_depth) {
                    split_bits(columns + first, words);
                    split_bits(rows + first, words + 8);
                } else {
                    alignas(64) std::uint8_t by_row[8][64] = {};
                    const std::uint32_t used = count - i < 64 ? count - i : 64;
                    for (std::uint32_t light = 0; light < used; ++light) {
                        std::uint64_t tiles =
                            tiles_met(scratch.tile_min.data() + list * 64,
                                      scratch.tile_max.data() + list * 64,
                                      job.bounds.of(load_sphere(job.lights.spheres +
                                                                scratch.list_ids.data()[first + light]))) &
                            scratch.lit_tiles.data()[list];
                        const unsigned row_bits = rows[first + light], column_bits = columns[first + light];
                        for (unsigned row = 0; row < 8; ++row, tiles >>= 8)
                            by_row[row][light] =
                                static_cast<std::uint8_t>(tiles & (row_bits >> row & 1 ? column_bits : 0));
                    }
                    for (unsigned row = 0; row < 8; ++row)
                        split_bits(by_row[row], words + 8 * row);
                }
            }
        }
        const unsigned last_row = tiles_y - 8 * y < 8 ? tiles_y - 8 * y : 8;
        for (unsigned row = 0; row < last_row; ++row) {
            std::uint32_t* offset = job.offsets + (8 * y + row) * std::size_t{tiles_x};
            const std::uint64_t* word = scratch.words.data();
            for (unsigned x = 0; x < width; ++x) {
                const std::uint32_t count = size[y * pitch + x];
                const std::uint32_t* ids = scratch.list_ids.data() + begin[y * pitch + x];
                const unsigned last_column = tiles_x - 8 * x < 8 ? tiles_x - 8 * x : 8;
                for (unsigned column = 0; column < last_column; ++column) {
                    *offset++ = static_cast<std::uint32_t>(out - job.indices);
                    if (count == 0) continue;
                    if (count <= 8) {  // the usual length of a list: no loop to predict
                        const std::uint64_t lit = Words<with_depth>::of_tile(word, row, column);
                        out += append(out, ids, static_cast<unsigned>(lit & 0xff));
                        continue;
                    }
                    for (std::uint32_t i = 0; i < count; i += 64) {
                        std::uint64_t lit =
                            Words<with_depth>::of_tile(word + i / 64 * Words<with_depth>::size, row, column);
                        const std::uint32_t used = count - i < 64 ? count - i : 64;
                        for (std::uint32_t j = 0; j < used; j += 8, lit >>= 8)
                            out += append(out, ids + i + j, static_cast<unsigned>(lit & 0xff));
                    }
                }
                word += (count + 63) / 64 * Words<with_depth>::size;
            }
        }
    }
    return static_cast<std::uint64_t>(out - job.indices);
}
