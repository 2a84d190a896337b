// SPDX-License-Identifier: MIT
// Stage 4b: the shader text that reads a light grid. docs/shader.md shows its use.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/enum_names.hpp>
#include <lightbin/encode.hpp>
#include <lightbin/options.hpp>
#include <lightbin/shader_checks.hpp>
#include <lightbin/shader_slices.hpp>
#include <lightbin/shader_text.hpp>
#include <lightbin/view.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Where the lists lie.
enum class ListStorage : std::uint8_t {
    storage_buffer,  ///< GLSL 4.30, Vulkan, ES 3.10, WGSL: storage buffers; HLSL: StructuredBuffer
    texel_buffer,    ///< buffer textures; HLSL: Buffer (not ES, not WGSL)
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

    Slicing slicing = Slicing::none;  ///< as Options::slicing of the Binner

    int tile_size = 0;             ///< in pixels, as a constant of the text; 0: a uniform
    bool flip_y = false;           ///< the shader's pixel rows count against those of the view's WindowOrigin
    bool viewport_corner = false;  ///< pixels are the window's, and the viewport's corner a uniform
    bool heat_map = false;         ///< also `count` and `heat`
    /// The lanes of a wave go through the lights of all their lists together, so that what is read of a light is
    /// read once for all of them (Drobot 2017). GLSL 4.30, ES 3.10: with GL_KHR_shader_subgroup_arithmetic;
    /// Vulkan 1.1; HLSL 6.0; WGSL: with the device's feature `subgroups`.
    bool wave_loop = false;
    bool view_check = false;  ///< also `check_view`, whose constants are at `view`
    bool list_check = false;  ///< also `for_each_missing`
    bool window = false;      ///< also `window`, as light_window()

    std::uint32_t texture_width = 2048;  ///< texture_2d: texels a row, 1 to 16384; a power of two is best
    std::uint32_t max_tiles = 0;         ///< uniform blocks: the most tiles they hold, those of all slices,
    std::uint32_t max_entries = 0;       ///< and offset_count: the most list entries,
    std::uint32_t max_slices = 0;        ///< and slicing: the most slices
    std::uint32_t uniform_block_bytes = 16384;  ///< the most that the device allows; every one has 16384

    ShaderSlot tiles = {0}, lists = {1}, grid = {2}, slices = {3}, bins = {4}, view = {5};
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

/// Whether every name that begins so can be declared in every language. The longest has 1024 signs in ES; macros of GLSL
/// can't begin with GL_. Of all reserved words of the languages one alone ends as a name of the texts does: volatile, as
/// `tile`.
inline bool is_prefix(std::string_view prefix) {
    constexpr std::string_view signs = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    return !prefix.empty() && prefix.size() <= 1000 && prefix.find_first_not_of(signs) == prefix.npos &&
           prefix.find_first_of("0123456789_") != 0 && prefix.find("__") == prefix.npos &&
           !prefix.starts_with("gl_") && !prefix.starts_with("GL_") && prefix != "vola";
}

/// What holds for every text: the name prefix, the slots and the constants.
template <class ShaderOptions>
std::optional<Error> refuse_names(const ShaderOptions& options, std::initializer_list<ShaderSlot> places) {
    const Dialect dialect = detail::dialect(options.language);
    if (!is_prefix(options.prefix)) return Error{ErrorCode::not_a_prefix};
    if (options.push_constants && !dialect.vulkan) return Error{ErrorCode::no_push_constants};
    for (const ShaderSlot& slot : places)
        for (const int number : {slot.binding, slot.set})
            if (number < 0) return Error{ErrorCode::slot_out_of_range, static_cast<std::uint64_t>(number)};
    for (const ShaderSlot& slot : places)
        if (slot.set != 0 && !dialect.spaces)
            return Error{ErrorCode::no_sets, static_cast<std::uint64_t>(slot.set)};
    return std::nullopt;
}

/// The texels of the lists: as wide as the ids where texels are read.
inline TexelFormat list_texels(const ShaderOptions& options) {
    const bool typed =
        !options.packed_ids && options.format.encoding != ListEncoding::bitmask &&
        (options.storage == ListStorage::texel_buffer || options.storage == ListStorage::texture_2d);
    return typed && options.format.ids == IdWidth::u8    ? TexelFormat::r8ui
           : typed && options.format.ids == IdWidth::u16 ? TexelFormat::r16ui
                                                         : TexelFormat::r32ui;
}

/// What a text reads.
inline std::vector<ShaderBuffer> list_buffers(const ShaderOptions& options) {
    using enum ShaderResource;
    constexpr ShaderResource by_storage[] = {storage_buffer, texel_buffer, texture_2d, uniform_block,
                                             byte_address};
    const ShaderResource there = by_storage[static_cast<std::size_t>(options.storage)];
    const std::uint32_t width = there == texture_2d ? options.texture_width : 0;
    std::vector<ShaderBuffer> buffers;
    if (options.format.encoding == ListEncoding::offset_count)
        buffers.push_back({"tiles", options.tiles_in_uniform_block ? uniform_block : there, options.tiles,
                           TexelFormat::rg32ui, 8ull * options.max_tiles, 0});
    buffers.push_back({"lists", there, options.lists, list_texels(options),
                       encoded_bytes(options.format, options.max_tiles, options.max_entries), width});
    if (options.slicing != Slicing::none)
        buffers.push_back(
            {"slices", there, options.slices, TexelFormat::r32ui, slice_bytes(options.max_slices), width});
    if (options.slicing == Slicing::z_bins)
        buffers.push_back(
            {"bins", there, options.bins, TexelFormat::rg32ui, 8ull * options.max_slices, width});
    return buffers;
}

inline std::optional<Error> refuse(const ShaderOptions& options) {
    const Dialect dialect = detail::dialect(options.language);
    if (auto error = refuse_names(options, {options.tiles, options.lists, options.grid, options.slices,
                                            options.bins, options.view}))
        return error;
    if (options.storage == ListStorage::storage_buffer && !dialect.storage_buffers)
        return Error{ErrorCode::no_storage_buffers};
    if (options.storage == ListStorage::texel_buffer && (dialect.es || dialect.wgsl))
        return Error{ErrorCode::no_texel_buffers};
    if (options.storage == ListStorage::byte_address && !dialect.hlsl)
        return Error{ErrorCode::no_byte_address_buffers};
    if (options.wave_loop && (!dialect.storage_buffers || options.language == ShaderLanguage::hlsl_5_0))
        return Error{ErrorCode::no_wave_operations};
    if (options.tile_size < 0)
        return Error{ErrorCode::tile_size_out_of_range, static_cast<std::uint64_t>(options.tile_size)};
    if (options.storage == ListStorage::texture_2d &&
        (options.texture_width < 1 || options.texture_width > 16384))
        return Error{ErrorCode::texture_width_out_of_range, options.texture_width, 16384};

    if (const auto error = refuse(options.format)) return error;
    // Blocks are made of whole vectors of 16 bytes.
    const std::uint64_t most =
        options.uniform_block_bytes > 65536 && dialect.hlsl ? 65536 : options.uniform_block_bytes / 16 * 16;
    const std::vector<ShaderBuffer> buffers = list_buffers(options);
    for (const ShaderBuffer& buffer : buffers)
        if (buffer.resource == ShaderResource::uniform_block && buffer.bytes == 0)
            return Error{ErrorCode::block_size_unknown};
    for (const ShaderBuffer& buffer : buffers)
        if (buffer.resource == ShaderResource::uniform_block && buffer.bytes > most)
            return Error{ErrorCode::uniform_block_too_small, buffer.bytes, most};
    return std::nullopt;
}

inline std::string number_text(std::uint64_t number) {
    return std::to_string(number) + "u";
}

/// The side of a tile.
inline std::string tile_size_text(const ShaderOptions& options) {
    return options.tile_size == 0 ? "$grid.x" : number_text(static_cast<std::uint64_t>(options.tile_size));
}

/// Lines that turn `pixel`, as the shader counts it, to `here`, as the view does. What lies outside of the viewport stays
/// outside: numbers below 0 wrap to large ones.
inline std::string to_grid_lines(const ShaderOptions& options) {
    return std::string("    uvec2 here = pixel") + (options.viewport_corner ? " - uvec2($corner)" : "") +
           ";\n" + (options.flip_y ? "    here.y = $grid.w - 1u - here.y;\n" : "");
}

/// `tile`: the tile of a pixel. Unset constants divide by 1, not by 0.
inline void add_tile(ShaderWriter& writer, const ShaderOptions& options) {
    const std::string size = tile_size_text(options);
    writer.add("\n// The tile that a pixel lies in.\nuvec2 $tile(uvec2 pixel) {\n" + to_grid_lines(options) +
               "    return here / " + (options.tile_size == 0 ? "max(" + size + ", 1u)" : size) + ";\n}\n");
}

/// `id_at`: the id at a place of the lists.
inline void add_id_at(ShaderWriter& writer, const ShaderOptions& options) {
    const IdWidth ids = options.format.ids;
    const bool whole = ids == IdWidth::u32 || list_texels(options) != TexelFormat::r32ui;
    writer.add("\nuint $id_at(uint at) {\n    return " +
               (whole ? writer.read("lists", "at")
                : ids == IdWidth::u16
                    ? "(" + writer.read("lists", "at >> 1u") + " >> ((at & 1u) * 16u)) & 0xffffu"
                    : "(" + writer.read("lists", "at >> 2u") + " >> ((at & 3u) * 8u)) & 0xffu") +
               ";\n}\n");
}

/// `cursor` and `begin`. Nothing is read and nothing divided for a pixel that the grid has no tile for: its constants
/// are unset, or those of a smaller picture or of other tiles.
inline void add_begin(ShaderWriter& writer, const ShaderOptions& options) {
    const ListFormat& format = options.format;
    const bool table = format.encoding == ListEncoding::offset_count,
               bits = format.encoding == ListEncoding::bitmask, binned = options.slicing == Slicing::z_bins;
    writer.add("\nstruct $own_cursor {\n    uint id;\n    uint at;\n    uint end;\n");
    if (bits) writer.add("    uint bits;\n");
    if (binned) writer.add("    uint last;\n");
    writer.add("};\n\n$own_cursor $own_begin(uvec2 pixel, float view_depth) {\n" + to_grid_lines(options) +
               "    $own_cursor c;\n    c.at = 0u;\n    c.end = 0u;\n" +
               (bits && !binned ? "    c.id = 0xffffffe0u;  // 32 before the first\n" : "    c.id = 0u;\n"));
    if (bits) writer.add("    c.bits = 0u;\n");
    if (binned) writer.add("    c.last = 0u;\n");
    const std::string tile_size = tile_size_text(options);
    writer.add("    if (here.x < $grid.z && here.y < $grid.w" +
               (options.tile_size == 0 ? "" : " && $grid.x == " + tile_size) +
               ") {\n        uvec2 tile = here / " + tile_size + ";\n");
    if (options.slicing != Slicing::none) writer.add("        uint slice = $slice(view_depth);\n");
    if (options.slicing == Slicing::clusters)
        writer.add("        tile.y += slice * (($grid.w - 1u) / " + tile_size + " + 1u);\n");
    if (binned)
        writer.add("        uvec2 bin = " + writer.read("bins", "slice") + ";\n        c.last = bin.y;\n");
    writer.add("        uint place = tile.y * $grid.y + tile.x;\n");
    const std::string each = number_text(places_a_tile(format));
    if (table)
        writer.add("        uvec2 list = " +
                   (options.storage == ListStorage::texture_2d && !options.tiles_in_uniform_block
                        ? writer.read_texel("$tiles", "ivec2(int(tile.x), int(tile.y))") + ".xy"
                        : writer.read("tiles", "place")) +
                   ";\n        c.at = list.x;\n        c.end = list.x + list.y;\n");
    else
        writer.add("        c.at = place * " + each + ";\n        c.end = c.at + " +
                   (bits && binned ? "(bin.y >> 5u) + 1u" : each) + ";\n");
    // The list is entered at the bin's first light. Words end with that of the bin's last one.
    if (binned && bits)
        writer.add("        c.at += bin.x >> 5u;\n        c.id = bin.x & ~31u;\n        c.bits = " +
                   writer.read("lists", "c.at") +
                   " & (0xffffffffu << (bin.x & 31u));\n        c.at += 1u;\n");
    else if (binned && table)
        writer.add(R"(        uint end = c.end;
        while (c.at < end) {
            uint middle = c.at + ((end - c.at) >> 1u);
            if ($id_at(middle) < bin.x) { c.at = middle + 1u; }
            else { end = middle; }
        }
)");
    else if (binned)
        writer.add("        while (c.at < c.end && $id_at(c.at) < bin.x) { c.at += 1u; }\n");
    writer.add("    }\n    return c;\n}\n");
}

/// `next`. One return: fxc's shader model 5.1 takes a second one for a value that was not set.
inline void add_next(ShaderWriter& writer, const ShaderOptions& options) {
    writer.add("\nbool $own_next(inout $own_cursor c) {\n");
    if (options.format.encoding == ListEncoding::bitmask) {
        // id is that of the word's bit 0, less what was passed: kept in its upper 27 bits.
        writer.add("    c.id &= ~31u;\n    while (c.bits == 0u && c.at < c.end) {\n        c.bits = " +
                   writer.read("lists", "c.at") +
                   ";\n        c.at += 1u;\n        c.id += 32u;\n    }\n"
                   "    bool more = c.bits != 0u;\n    if (more) {\n        c.id += " +
                   (writer.dialect().storage_buffers
                        ? "uint(findLSB(c.bits))"
                        : "(floatBitsToUint(float(c.bits & (~c.bits + 1u))) >> 23u) - 127u") +
                   ";\n        c.bits &= c.bits - 1u;\n");
    } else {
        writer.add("    bool more = c.at < c.end;\n    if (more) {\n        c.id = $id_at(c.at);\n        "
                   "c.at += 1u;\n");
        if (options.format.encoding == ListEncoding::sentinel)
            writer.add("        more = c.id != " + number_text(countable_lights(options.format)) + ";\n");
    }
    if (options.slicing == Slicing::z_bins) writer.add("        more = more && c.id <= c.last;\n");
    writer.add("    }\n    return more;\n}\n");
}

/// `cursor`, `begin` and `next` of a wave: its next light is the least of those that its lanes have next.
inline void add_wave_cursor(ShaderWriter& writer) {
    writer.add(R"(
struct $cursor {
    uint id;
    bool own;
    bool more;
    $own_cursor ahead;
};

$cursor $begin(uvec2 pixel, float view_depth) {
    $cursor c;
    c.id = 0u;
    c.own = false;
    $own_cursor ahead = $own_begin(pixel, view_depth);
    c.more = $own_next(&ahead);
    c.ahead = ahead;
    return c;
}

bool $next(inout $cursor c) {
    $own_cursor ahead = c.ahead;
    if (c.own) { c.more = $own_next(&ahead); }
    c.ahead = ahead;
    uint own = 0xffffffffu;
    if (c.more) { own = ahead.id; }
    c.id = subgroupMin(own);
    c.own = c.more && own == c.id;
    return c.id != 0xffffffffu;
}
)");
}

/// `count` and `heat`.
inline void add_heat_map(ShaderWriter& writer, const ShaderOptions& options) {
    const bool counted =
        options.format.encoding == ListEncoding::offset_count && options.slicing != Slicing::z_bins;
    writer.add("\nuint $count(uvec2 pixel, float view_depth) {\n"
               "    $own_cursor c = $own_begin(pixel, view_depth);\n");
    writer.add(counted
                   ? "    return c.end - c.at;\n"
                   : "    uint count = 0u;\n    while ($own_next(&c)) { count += 1u; }\n    return count;\n");
    writer.add(R"(}

vec3 $heat(uvec2 pixel, float view_depth, float most) {
    float heat = float($count(pixel, view_depth)) / most;
    vec3 colour = vec3(4.0 * heat - 2.0, min(4.0 * heat, 4.0 - 4.0 * heat), 2.0 - 4.0 * heat);
    return clamp(colour, vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 1.0));
}
)");
}

/// `window`, as light_window().
inline void add_window(ShaderWriter& writer) {
    writer.add(R"(
// 1 at a light, falling smoothly to 0 at its range and beyond.
float $window(float apart, float range) {
    float x = apart / range;
    float w = 0.0;
    if (apart < range) { w = 1.0 - x * x * x * x; }
    return w * w;
}
)");
}

}  // namespace detail

/// Returns text to insert before its use and after `#version`, or an Error that names the limit that the
/// options break. `lightbin_` stands for options.prefix, with which every name begins:
///
///     uvec2 lightbin_tile(uvec2 pixel);                   // the tile that a pixel lies in
///     uint lightbin_slice(float view_depth);              // with slicing: the slice that a depth lies in
///     struct lightbin_cursor { uint id; ... };            // a light of a list
///     lightbin_cursor lightbin_begin(uvec2 pixel, float view_depth);  // before the first light of the pixel's list
///     bool lightbin_next(inout lightbin_cursor cursor);   // moves on to the next light; false: there is none
///     #define lightbin_for_each_light(cursor, pixel, view_depth)      // the loop
///     uint lightbin_count(uvec2 pixel, float view_depth);             // with heat_map: the number of lights, and as
///     vec3 lightbin_heat(uvec2 pixel, float view_depth, float most);  // a colour: blue, cyan, green, yellow, red = most
///     float lightbin_window(float apart, float range);                // with window: as light_window()
///     bool lightbin_check_view(uvec2 pixel, vec3 position);           // with view_check, see below
///     #define lightbin_for_each_missing(cursor, lights, pixel, view_depth)  // with list_check, see below
///
/// The same in every language and for every encoding, storage and slicing:
///
///     lightbin_for_each_light(light, uvec2(gl_FragCoord.xy), depth) { colour += shade(light.id, position); }
///
/// but for WGSL, which has no macros: there the loops are written out, and the second function takes a pointer.
///
///     var light = lightbin_begin(vec2u(pixel.xy), depth);
///     while (lightbin_next(&light)) { colour += shade(light.id, position); }
///     var other = lightbin_begin_missing(vec2u(pixel.xy), depth);
///     while (lightbin_next_missing(&other, light_count)) { if (other.lacked) { ... } }
///
/// view_depth is the depth of what is lit, as in Slices; it is read with slicing only. With clusters the list is
/// that of the tile in the depth's slice; with z_bins that of the tile from the least to the greatest rank of the
/// depth's bin.
///
/// `break`, `continue` and `return` work in the loops' bodies, and loops nest. The list is empty of a pixel outside
/// of the viewport, and of every pixel where `grid` is not set, or its tiles are not of options.tile_size: no place
/// outside of the table of tiles that `grid` tells of is read. Tiles and lists must be of one build: a table that
/// points beyond the lists reads there what the graphics API has it read (Direct3D: 0; WebGPU: 0 or one of theirs;
/// OpenGL, Vulkan: robust access is a setting). Ids come in ascending order, each once. With wave_loop no `else`
/// can follow the body, and what depends on the id alone is the same in the whole wave (WGSL: the text goes first
/// in its module); `begin` and `next` then give the wave's lights, and cursor.own tells whether one is the lane's
/// own.
///
/// Two checks, to colour what is wrong:
///
///     if (!lightbin_check_view(pixel, position)) colour = magenta;
///     lightbin_for_each_missing(light, light_count, pixel, depth) { if (shade(light.id) > 0) colour = magenta; }
///
/// The first is whether the View has `position`, in view space, in this pixel (within ShaderView's tolerance) and not
/// before its near plane. The second is a loop over every light below light_count that the pixel's list lacks, whatever
/// the encoding; no `else` can follow its body. Both are for looking for mistakes: the loop goes through all lights.
inline Result<ShaderText> shader_snippet(const ShaderOptions& options = {}) {
    using namespace detail;
    if (const auto error = refuse(options)) return *error;
    ShaderWriter writer(options.language, options.prefix);
    // A wave's loop ends for all of its lanes at once, which no compiler of WGSL sees.
    if (options.wave_loop && writer.dialect().wgsl)
        writer.add("enable subgroups;\ndiagnostic(off, subgroup_uniformity);\n");
    else if (options.wave_loop && !writer.dialect().hlsl)
        writer.add("#extension GL_KHR_shader_subgroup_arithmetic : require\n");
    std::vector<ShaderConstant> constants = {{"uvec4", "grid"}};
    if (options.viewport_corner) constants.push_back({"ivec2", "corner"});
    writer.declare_constants(constants, options.grid, options.push_constants);
    if (options.view_check)
        writer.declare_constants({{"vec4", "image"}, {"vec4", "depths"}}, options.view, false);
    for (const ShaderBuffer& buffer : list_buffers(options))
        writer.declare(buffer);

    add_tile(writer, options);
    if (options.slicing != Slicing::none) add_slice(writer);
    if (options.format.encoding != ListEncoding::bitmask) add_id_at(writer, options);
    add_begin(writer, options);
    add_next(writer, options);
    if (options.wave_loop) add_wave_cursor(writer);
    writer.add_macro("for_each_light(cursor, pixel, view_depth)",
                     std::string("for ($cursor cursor = $begin(pixel, view_depth); $next(cursor);)") +
                         (options.wave_loop ? " if (cursor.own)" : ""));
    if (options.heat_map) add_heat_map(writer, options);
    if (options.window) add_window(writer);
    if (options.view_check) add_view_check(writer, to_grid_lines(options));
    if (options.list_check) add_list_check(writer);
    // `own_`: what a lane of a wave has beside the wave's.
    if (!options.wave_loop) writer.replace("$own_", "$");
    return writer.finish();
}

}}  // namespace lightbin
