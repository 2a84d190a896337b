// SPDX-License-Identifier: MIT
// Stage 4b: the shader text that reads a light grid. shader.md beside it shows its use.
#pragma once

#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/names.hpp>
#include <lightbin/encode.hpp>
#include <lightbin/shader_text.hpp>
#include <lightbin/view.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lightbin::inline LIGHTBIN_FLAVOUR {

/// Where the lists lie.
enum class ListStorage : std::uint8_t {
    storage_buffer,  ///< GLSL 4.30, Vulkan, ES 3.10: storage buffers; HLSL: StructuredBuffer
    texel_buffer,    ///< buffer textures; HLSL: Buffer (not ES)
    texture_2d,      ///< 2D textures (Tiled Shading, Listing 1)
    uniform_block,   ///< uniform blocks, cbuffers (Tiled Forward Shading, Listing 4.1)
    byte_address,    ///< HLSL: ByteAddressBuffer
};

constexpr const char* to_string(ListStorage value) {
    return detail::name_at(value,
                           {"storage_buffer", "texel_buffer", "texture_2d", "uniform_block", "byte_address"});
}

struct ShaderOptions {
    ShaderLanguage language = ShaderLanguage::glsl_430;
    ListStorage storage = ListStorage::storage_buffer;
    /// What the lists hold: as given to encode(), or where the Binner's own lists are read, {.ids = Options::ids}.
    ListFormat format = {};
    /// offset_count: the table of tiles in a uniform block, whatever `storage` is for the ids.
    bool tiles_in_uniform_block = false;
    /// texel_buffer, texture_2d: narrow ids in 32-bit texels, as the other storages have them, not in texels
    /// of their own width.
    bool packed_ids = false;

    int tile_size = 0;             ///< in pixels, as a constant of the text; 0: a uniform
    bool flip_y = false;           ///< the shader's pixel rows count against those of the view's WindowOrigin
    bool viewport_corner = false;  ///< pixels are the window's, and the viewport's corner a uniform
    bool heat_map = false;         ///< also `count` and `heat`

    std::uint32_t texture_width = 2048;  ///< texture_2d: texels a row, 1 to 16384; a power of two is best
    std::uint32_t max_tiles = 0;         ///< uniform blocks: the most tiles they hold,
    std::uint32_t max_entries = 0;       ///< and offset_count: the most list entries
    std::uint32_t uniform_block_bytes = 16384;  ///< the most that the device allows; every one has 16384

    ShaderSlot tiles = {0}, lists = {1}, grid = {2};
    bool push_constants = false;  ///< Vulkan: `grid` as push constants
    std::string_view prefix = "lightbin_";
};

/// What the text's constants `grid` and `corner` are set to. In a uniform block or push constants: this
/// struct, 16 bytes of it without viewport_corner.
struct ShaderGrid {
    std::uint32_t tile_size, tiles_x, width, height;  ///< grid
    std::int32_t corner_x, corner_y;                  ///< corner
    std::int32_t unused[2] = {};
};
static_assert(sizeof(ShaderGrid) == 32 && sizeof(ListRange) == 8);  // so there is no padding

/// Returns the constants of a view. The corner is the window pixel at the viewport's first column and row, as
/// the shader counts pixels; it is read with viewport_corner only.
inline ShaderGrid shader_grid(const View& view, int corner_x = 0, int corner_y = 0) {
    const Extent size = view.viewport();
    const auto u = [](int n) { return static_cast<std::uint32_t>(n); };
    return {u(view.tile_size()), u(view.tiles_x()), u(size.width), u(size.height), corner_x, corner_y};
}

namespace detail {

inline bool is_prefix(std::string_view prefix) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    char before = '_';
    if (prefix.empty() || !letter(prefix.front()) || prefix.starts_with("gl_")) return false;
    for (const char c : prefix) {
        if (!letter(c) && !(c >= '0' && c <= '9') && (c != '_' || before == '_')) return false;
        before = c;
    }
    return true;
}

/// What holds for every text: the name prefix, the slots and the constants.
inline std::optional<Error> refuse_names(const Dialect& dialect, std::string_view prefix,
                                         std::initializer_list<ShaderSlot> slots, bool push_constants) {
    if (!is_prefix(prefix)) return Error{ErrorCode::not_a_prefix};
    if (push_constants && !dialect.vulkan) return Error{ErrorCode::no_push_constants};
    for (const ShaderSlot& slot : slots)
        if (slot.set != 0 && !dialect.spaces)
            return Error{ErrorCode::no_sets, static_cast<std::uint64_t>(slot.set)};
    return std::nullopt;
}

inline std::optional<Error> refuse(const ShaderOptions& options) {
    const Dialect dialect = detail::dialect(options.language);
    if (auto error = refuse_names(dialect, options.prefix, {options.tiles, options.lists, options.grid},
                                  options.push_constants))
        return error;
    if (options.storage == ListStorage::storage_buffer && !dialect.storage_buffers)
        return Error{ErrorCode::no_storage_buffers};
    if (options.storage == ListStorage::texel_buffer && dialect.es) return Error{ErrorCode::no_texel_buffers};
    if (options.storage == ListStorage::byte_address && !dialect.hlsl)
        return Error{ErrorCode::no_byte_address_buffers};
    if (options.tile_size < 0)
        return Error{ErrorCode::tile_size_out_of_range, static_cast<std::uint64_t>(options.tile_size)};
    if (options.storage == ListStorage::texture_2d &&
        (options.texture_width < 1 || options.texture_width > 16384))
        return Error{ErrorCode::texture_width_out_of_range, options.texture_width, 16384};

    const ListFormat& format = options.format;
    if (const auto error = refuse(format)) return error;

    const bool table = format.encoding == ListEncoding::offset_count;
    const bool tiles_in_block =
                   options.storage == ListStorage::uniform_block || (table && options.tiles_in_uniform_block),
               lists_in_block = options.storage == ListStorage::uniform_block;
    if ((tiles_in_block && options.max_tiles == 0) || (lists_in_block && table && options.max_entries == 0))
        return Error{ErrorCode::block_size_unknown};
    // Blocks are made of whole vectors of 16 bytes.
    const std::uint64_t most = options.uniform_block_bytes > 65536 && dialect.hlsl
                                   ? 65536
                                   : options.uniform_block_bytes / 16 * 16,
                        tile_bytes = table && tiles_in_block ? 8ull * options.max_tiles : 0,
                        list_bytes = lists_in_block
                                         ? encoded_bytes(format, options.max_tiles, options.max_entries)
                                         : 0;
    for (const std::uint64_t bytes : {tile_bytes, list_bytes})
        if (bytes > most) return Error{ErrorCode::uniform_block_too_small, bytes, most};
    return std::nullopt;
}

inline ShaderResource resource(ListStorage storage) {
    using enum ShaderResource;
    constexpr ShaderResource by_storage[] = {storage_buffer, texel_buffer, texture_2d, uniform_block,
                                             byte_address};
    return by_storage[static_cast<std::size_t>(storage)];
}

/// `tile`: the tile of a pixel.
inline void add_tile(ShaderWriter& writer, const ShaderOptions& options) {
    writer.add("\n// The tile that a pixel lies in.\nuvec2 $tile(uvec2 pixel) {\n");
    if (options.viewport_corner) writer.add("    pixel -= uvec2($corner);\n");
    if (options.flip_y) writer.add("    pixel.y = $grid.w - 1u - pixel.y;\n");
    writer.add("    return pixel / " +
               (options.tile_size == 0 ? "$grid.x" : std::to_string(options.tile_size) + "u") + ";\n}\n");
}

/// The expression that reads the id at a place of the lists.
inline std::string read_id(const ShaderWriter& writer, const ShaderBuffer& lists, IdWidth ids) {
    if (ids == IdWidth::u32 || lists.format != TexelFormat::r32ui) return writer.read(lists, "c.at");
    return ids == IdWidth::u16 ? "(" + writer.read(lists, "c.at >> 1u") + " >> ((c.at & 1u) * 16u)) & 0xffffu"
                               : "(" + writer.read(lists, "c.at >> 2u") + " >> ((c.at & 3u) * 8u)) & 0xffu";
}

}  // namespace detail

/// Returns text to insert before its use and after `#version`, or an Error that names the limit that the
/// options break. `lightbin_` stands for options.prefix, with which every name begins:
///
///     uvec2 lightbin_tile(uvec2 pixel);                   // the tile that a pixel lies in
///     struct lightbin_cursor { uint id; ... };            // a light of a list
///     lightbin_cursor lightbin_begin(uvec2 pixel);        // before the first light of the pixel's tile
///     bool lightbin_next(inout lightbin_cursor cursor);   // moves on to the next light; false: there is none
///     #define lightbin_for_each_light(cursor, pixel)      // the loop
///     uint lightbin_count(uvec2 pixel);                   // with heat_map: the length of the list, and as
///     vec3 lightbin_heat(uvec2 pixel, float most);        // a colour: blue, cyan, green, yellow, red = most
///
/// The same in every language and for every encoding and storage:
///
///     lightbin_for_each_light(light, uvec2(gl_FragCoord.xy)) { colour += shade(light.id, position); }
///
/// `break`, `continue` and `return` work in the loop's body, and loops nest. A pixel must lie in the
/// viewport. Ids come in ascending order, each once.
inline Result<ShaderText> shader_snippet(const ShaderOptions& options = {}) {
    using namespace detail;
    if (const auto error = refuse(options)) return *error;
    ShaderWriter writer(options.language, options.prefix);
    const ListFormat& format = options.format;
    const bool table = format.encoding == ListEncoding::offset_count,
               bits = format.encoding == ListEncoding::bitmask;
    const bool typed =
        !options.packed_ids && !bits &&
        (options.storage == ListStorage::texel_buffer || options.storage == ListStorage::texture_2d);

    const ListStorage tile_storage =
        options.tiles_in_uniform_block ? ListStorage::uniform_block : options.storage;
    const TexelFormat texels = typed && format.ids == IdWidth::u8    ? TexelFormat::r8ui
                               : typed && format.ids == IdWidth::u16 ? TexelFormat::r16ui
                                                                     : TexelFormat::r32ui;
    const std::uint64_t bytes = encoded_bytes(format, options.max_tiles, options.max_entries);
    const std::uint32_t vectors = static_cast<std::uint32_t>((bytes + 15) / 16);
    const ShaderBuffer tiles = {
        "tiles", resource(tile_storage), options.tiles, TexelFormat::rg32ui, (options.max_tiles + 1) / 2, 0};
    const ShaderBuffer lists = {"lists", resource(options.storage), options.lists, texels,
                                vectors, options.texture_width};
    std::vector<ShaderConstant> constants = {{"uvec4", "grid"}};
    if (options.viewport_corner) constants.push_back({"ivec2", "corner"});
    writer.declare_constants(constants, options.grid, options.push_constants);
    if (table) writer.declare(tiles);
    writer.declare(lists);
    add_tile(writer, options);

    const std::string index = "tile.y * $grid.y + tile.x";
    const auto number = [](std::uint64_t n) { return std::to_string(n) + "u"; };
    writer.add("\nstruct $cursor {\n    uint id;\n    uint at;\n    uint end;\n");
    if (bits) writer.add("    uint bits;\n");
    writer.add("};\n\n$cursor $begin(uvec2 pixel) {\n    uvec2 tile = $tile(pixel);\n    $cursor c;\n");
    if (table) {
        writer.add("    uvec2 list = " +
                   (tiles.resource == ShaderResource::texture_2d
                        ? writer.read_texel(tiles, "int(tile.x), int(tile.y)")
                        : writer.read(tiles, "(" + index + ")")) +
                   ";\n    c.id = 0u;\n    c.at = list.x;\n    c.end = list.x + list.y;\n");
    } else {
        const std::string each = number(places_a_tile(format));
        writer.add(std::string("    c.id = ") + (bits ? "0u - 32u" : "0u") + ";\n    c.at = (" + index +
                   ") * " + each + ";\n    c.end = c.at + " + each + ";\n");
        if (bits) writer.add("    c.bits = 0u;\n");
    }
    // One return: fxc's shader model 5.1 takes a second one for a value that was not set.
    writer.add("    return c;\n}\n\nbool $next(inout $cursor c) {\n");
    if (bits) {
        // id is that of the word's bit 0, less what was passed: kept in its upper 27 bits.
        writer.add("    c.id &= ~31u;\n    while (c.bits == 0u && c.at < c.end) {\n        c.bits = " +
                   writer.read(lists, "c.at") +
                   ";\n        c.at += 1u;\n        c.id += 32u;\n    }\n"
                   "    bool more = c.bits != 0u;\n    if (more) {\n        c.id += " +
                   (writer.dialect().storage_buffers
                        ? "uint(findLSB(c.bits))"
                        : "(floatBitsToUint(float(c.bits & (~c.bits + 1u))) >> 23u) - 127u") +
                   ";\n        c.bits &= c.bits - 1u;\n    }\n    return more;\n}\n");
    } else {
        writer.add("    bool more = c.at < c.end;\n    if (more) {\n        c.id = " +
                   read_id(writer, lists, format.ids) + ";\n        c.at += 1u;\n" +
                   (table ? "" : "        more = c.id != " + number(countable_lights(format)) + ";\n") +
                   "    }\n    return more;\n}\n");
    }
    writer.add("\n#define $for_each_light(cursor, pixel) for ($cursor cursor = $begin(pixel); "
               "$next(cursor);)\n");

    if (options.heat_map)
        writer.add(std::string("\nuint $count(uvec2 pixel) {\n    $cursor c = $begin(pixel);\n") +
                   (table ? "    return c.end - c.at;\n"
                          : "    uint count = 0u;\n    while ($next(c)) count += 1u;\n    return count;\n") +
                   R"(}

vec3 $heat(uvec2 pixel, float most) {
    float heat = float($count(pixel)) / most;
    return clamp(vec3(4.0 * heat - 2.0, min(4.0 * heat, 4.0 - 4.0 * heat), 2.0 - 4.0 * heat), 0.0, 1.0);
}
)");
    return writer.finish();
}

}  // namespace lightbin
