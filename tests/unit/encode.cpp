// The encodings of a light grid against the grid itself, read back bit by bit.
#include <doctest/doctest.h>

#include <lightbin/encode.hpp>
#include <lightbin/lightbin.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <random>
#include <string>
#include <vector>

using namespace lightbin;

namespace {

// A grid made without a Binner: `tiles` lists of up to `longest` ids below `lights`.
struct MadeGrid {
    std::vector<ListRange> tiles;
    std::vector<std::uint32_t> ids;

    MadeGrid(std::size_t count, std::uint32_t longest, std::uint32_t lights) {
        std::mt19937 engine(7);
        const auto below = [&](std::uint32_t end) { return static_cast<std::uint32_t>(engine() % end); };
        for (std::size_t tile = 0; tile < count; ++tile) {
            std::vector<std::uint32_t> list;
            for (std::uint32_t i = below(longest + 1); i > 0; --i)
                list.push_back(below(lights));
            std::sort(list.begin(), list.end());
            list.erase(std::unique(list.begin(), list.end()), list.end());
            tiles.push_back(
                {static_cast<std::uint32_t>(ids.size()), static_cast<std::uint32_t>(list.size())});
            ids.insert(ids.end(), list.begin(), list.end());
        }
    }

    LightGrid<std::uint32_t> grid() const { return {static_cast<int>(tiles.size()), 1, tiles, ids}; }
};

std::uint32_t number_at(const std::vector<std::byte>& bytes, std::size_t at, IdWidth width) {
    const unsigned size = static_cast<unsigned>(width);
    std::uint32_t value = 0;
    for (unsigned i = 0; i < size; ++i) {
        const unsigned place = std::endian::native == std::endian::little ? i : size - 1 - i;
        value |= std::to_integer<std::uint32_t>(bytes.at(at * size + place)) << 8 * i;
    }
    return value;
}

std::vector<std::uint32_t> decoded(const std::vector<std::byte>& bytes, const ListFormat& format,
                                   std::size_t tile, ListRange range) {
    std::vector<std::uint32_t> list;
    if (format.encoding == ListEncoding::offset_count)
        for (std::uint32_t i = 0; i < range.count; ++i)
            list.push_back(number_at(bytes, range.offset + i, format.ids));
    if (format.encoding == ListEncoding::sentinel)
        for (std::uint32_t i = 0; i < format.capacity; ++i) {
            const std::uint32_t id = number_at(bytes, tile * format.capacity + i, format.ids);
            if (id == (std::uint64_t{1} << 8 * static_cast<unsigned>(format.ids)) - 1) break;
            list.push_back(id);
        }
    return list;
}

}  // namespace

TEST_CASE(
    "an encoded list is the grid's, or its lowest ids where the capacity cuts it, and the cut is counted") {
    for (const std::uint32_t lights : {1u, 32u, 33u, 255u}) {
        const MadeGrid made(41, 12, lights);
        const auto grid = made.grid();
        for (const ListEncoding encoding : {ListEncoding::offset_count, ListEncoding::sentinel})
            for (const IdWidth ids : {IdWidth::u8, IdWidth::u16, IdWidth::u32})
                for (const std::uint32_t capacity : {1u, 7u, 12u, 13u}) {
                    const ListFormat format{encoding, ids, capacity};
                    const std::size_t size =
                        static_cast<std::size_t>(encoded_bytes(format, made.tiles.size(), made.ids.size()));
                    std::vector<std::byte> bytes(size + 4, std::byte{0xa5});
                    const auto result = encode(grid, format, std::span(bytes).first(size));
                    REQUIRE(result);
                    CHECK(size % 4 == 0);
                    CHECK(number_at(bytes, size / 4, IdWidth::u32) == 0xa5a5a5a5);
                    std::uint64_t cut = 0;
                    std::uint32_t cut_tiles = 0, longest = 0;
                    for (std::size_t tile = 0; tile < made.tiles.size(); ++tile) {
                        const auto list = grid.lights_in(static_cast<int>(tile), 0);
                        const bool limited = encoding == ListEncoding::sentinel && list.size() > capacity;
                        const std::vector<std::uint32_t> expected(
                            list.begin(), limited ? list.begin() + capacity : list.end());
                        CHECK(decoded(bytes, format, tile, made.tiles[tile]) == expected);
                        cut += list.size() - expected.size();
                        cut_tiles += limited;
                        longest = (std::max)(longest, static_cast<std::uint32_t>(list.size()));
                    }
                    CHECK(result->entries_cut == cut);
                    CHECK(result->tiles_cut == cut_tiles);
                    CHECK(result->capacity_needed == longest);
                }
    }
}

TEST_CASE("what a format can't hold is an error that tells what it would take, and nothing is written") {
    const std::vector<ListRange> tiles = {{0, 2}, {2, 1}, {3, 0}, {3, 1}};
    const auto with_largest = [&](std::uint32_t largest, ListFormat format, std::size_t size) {
        const std::vector<std::uint32_t> ids = {0, 7, largest, 5};
        std::vector<std::byte> bytes(size, std::byte{0xa5});
        const auto result = encode(LightGrid<std::uint32_t>(4, 1, tiles, ids), format, bytes);
        if (!result) CHECK(std::count(bytes.begin(), bytes.end(), std::byte{0xa5}) == std::ssize(bytes));
        return result ? std::string() : result.error().message();
    };
    CHECK(with_largest(255, {.ids = IdWidth::u8}, 4) == "");
    CHECK(with_largest(256, {.ids = IdWidth::u8}, 4).find("numbers 256 lights and 257") != std::string::npos);
    CHECK(with_largest(999, {ListEncoding::sentinel, IdWidth::u8, 4}, 16).find("1000") != std::string::npos);
    CHECK(with_largest(254, {ListEncoding::sentinel, IdWidth::u8, 4}, 16) == "");
    CHECK(with_largest(255, {ListEncoding::sentinel, IdWidth::u8, 4}, 16) != "");
    CHECK(with_largest(65535, {.ids = IdWidth::u16}, 8) == "");
    CHECK(with_largest(65536, {.ids = IdWidth::u16}, 8) != "");
    CHECK(with_largest(9, {.ids = IdWidth::u32}, 15).find("holds 15 bytes and 16") != std::string::npos);
    for (const std::size_t size : {0u, 4096u})
        CHECK(with_largest(9, {.encoding = ListEncoding::sentinel}, size) ==
              std::string(Error{ErrorCode::capacity_unknown}.message()));
}

TEST_CASE("sizes are exact as far as 64 bits count, and do not wrap beyond") {
    constexpr std::uint64_t largest = ~std::uint64_t{0}, most = largest - 3, half = std::uint64_t{1} << 32;
    const ListFormat words{ListEncoding::sentinel, IdWidth::u32, std::uint32_t{1} << 27};
    CHECK(encoded_bytes(words, 3, 0) == std::uint64_t{3} << 29);
    CHECK(encoded_bytes(words, 0xffffffff, 0) == std::uint64_t{0xffffffff} << 29);
    CHECK(encoded_bytes(words, std::uint64_t{1} << 34, 0) == std::uint64_t{1} << 63);
    CHECK(encoded_bytes(words, std::uint64_t{1} << 35, 0) == most);
    CHECK(encoded_bytes(words, std::uint64_t{1} << 37, 0) == most);
    CHECK(encoded_bytes(words, largest, 0) == most);
    const ListFormat bytes{ListEncoding::sentinel, IdWidth::u8, 0xffffffff};
    CHECK(encoded_bytes(bytes, half + 1, 0) == most);  // 2^64 - 1 ids
    CHECK(encoded_bytes(bytes, half, 0) == largest - half + 1);
    CHECK(encoded_bytes(bytes, half + 2, 0) == most);
    CHECK(encoded_bytes({ListEncoding::sentinel, IdWidth::u32, 0xffffffff}, half / 4 + 1, 0) == most);
    CHECK(encoded_bytes({.ids = IdWidth::u8}, 0, most) == most);
    CHECK(encoded_bytes({.ids = IdWidth::u8}, 0, most - 4) == most - 4);
    CHECK(encoded_bytes({.ids = IdWidth::u32}, 0, largest) == most);
}
