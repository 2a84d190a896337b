// SPDX-License-Identifier: MIT
// How shader_snippet() makes the text that reads the lists, and shader_slices() the table of slices that it looks up.
#pragma once

#include <lightbin/detail/base/platform.hpp>
#include <lightbin/detail/shaders/writer.hpp>
#include <lightbin/list_format.hpp>
#include <lightbin/shader.hpp>

#include <array>
#include <limits>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

namespace detail {

/// Returns the coefficients a, b, c of an estimate of a depth's slice, a * log2(depth) + b * depth + c. It is the line
/// through the first and the last boundary over depth or over its logarithm, whichever is nearer to the other
/// boundaries; for Slices::linear() and exponential() it is exact but for rounding.
inline std::array<float, 3> slice_estimate(std::span<const float> boundaries) {
    std::array<float, 3> best = {0, 0, 0};
    if (boundaries.empty()) return best;
    double least_error = std::numeric_limits<double>::infinity();
    for (const bool by_log2 : {false, true}) {
        const auto scaled = [&](float depth) {
            return by_log2 ? std::log2(static_cast<double>(depth)) : static_cast<double>(depth);
        };
        const double first = scaled(boundaries.front()), last = scaled(boundaries.back()),
                     steps = static_cast<double>(boundaries.size()) - 1;
        const double slope = !(steps > 0) ? 0 : steps / (last - first), offset = 1 - slope * first;
        double error = 0, index = 0;
        for (const float boundary : boundaries)
            error += std::fabs(slope * scaled(boundary) + offset - ++index);
        if (!(error < least_error)) continue;  // also when NaN: depths of 0 or less have no logarithm
        least_error = error;
        const float factor = static_cast<float>(slope);
        best = {by_log2 ? factor : 0, by_log2 ? 0 : factor, static_cast<float>(offset)};
    }
    return best;
}

}  // namespace detail

inline std::vector<std::uint32_t> shader_slices(const Slices& slices) {
    const std::span<const float> boundaries = slices.boundaries();
    std::vector<std::uint32_t> words;
    for (const float coefficient : detail::slice_estimate(boundaries))
        words.push_back(detail::bit_cast<std::uint32_t>(coefficient));
    words.push_back(static_cast<std::uint32_t>(boundaries.size()));
    for (const float boundary : boundaries) {
        const std::uint32_t bits = detail::bit_cast<std::uint32_t>(boundary), sign = 0x80000000;
        words.push_back(bits & sign ? ~bits : bits | sign);
    }
    return words;
}

inline Result<ShaderText> shader_snippet(const SnippetOptions& options) {
    using namespace detail;
    ShaderWriter writer(options.language, options.prefix);
    const Dialect& dialect = writer.dialect;
    const ListFormat& format = options.format;
    const bool textures = options.storage == ListStorage::texture_2d;
    const bool masks = options.masks;
    // Every device allows a uniform block of 16384 bytes. It holds the constants of `check_view` for so many views.
    const std::uint32_t max_views = masks ? 1 : 16384 / sizeof(ViewConstants);
    if (const auto error = refuse_common(
            options, {options.tiles, options.lists, options.grid, options.slices, options.bins, options.view},
            {{options.storage == ListStorage::storage_buffer && !dialect.storage_buffers,
              {ErrorCode::no_storage_buffers}},
             {options.storage == ListStorage::texel_buffer && (dialect.es || dialect.webgpu),
              {ErrorCode::no_texel_buffers}},
             {options.wave_loop &&
                  (!masks || !dialect.storage_buffers || options.language == ShaderLanguage::hlsl_5_0),
              {ErrorCode::no_wave_operations}},
             {options.views < 1 || options.views > max_views,
              {ErrorCode::views_out_of_range, options.views, max_views}},
             {masks && options.slicing == Slicing::clusters, {ErrorCode::no_such_slicing_shader}},
             {options.tile_size < 0,
              {ErrorCode::tile_size_out_of_range, static_cast<std::uint64_t>(options.tile_size)}},
             {textures && (options.texture_width < 1 || options.texture_width > 16384),
              {ErrorCode::texture_width_out_of_range, options.texture_width, 16384}}}))
        return *error;
    if (!masks)
        if (const auto error = refuse(format)) return *error;
    // A uniform block is declared as an array of 16-byte vectors, of which Direct3D allows 4096.
    const std::uint64_t limit =
        options.uniform_block_bytes > 65536 && dialect.hlsl ? 65536 : options.uniform_block_bytes / 16 * 16;
    using enum ShaderResource;
    constexpr ShaderResource by_storage[] = {storage_buffer, texel_buffer, texture_2d, uniform_block};
    const ShaderResource resource = by_storage[static_cast<std::size_t>(options.storage)];
    const bool table = !masks && format.encoding == ListEncoding::offset_count;
    // In buffer textures and textures each id has a texel unless ids are packed.
    const bool one_id = !options.packed_ids && (resource == texel_buffer || textures);
    const TexelFormat texel = one_id && format.ids == IdWidth::u8    ? TexelFormat::r8ui
                              : one_id && format.ids == IdWidth::u16 ? TexelFormat::r16ui
                                                                     : TexelFormat::r32ui;
    const bool sliced = options.slicing != Slicing::none, binned = options.slicing == Slicing::z_bins;
    const std::uint32_t width = textures ? options.texture_width : 0;
    const bool several = options.views > 1, counted = options.columns_and_rows, turned = options.turned,
               fixed = options.tile_size != 0 && !counted;
    // The first two bits of the constant `grid`, by which GridConstants tells the kinds of views apart.
    const std::uint32_t kind = (counted ? 2u : 0u) + (turned ? 1u : 0u),
                        size = min_of(static_cast<std::uint32_t>(options.tile_size), most_tile_size);
    std::vector<ShaderBuffer> buffers;
    if (table)
        buffers.push_back({"tiles", options.tiles_in_uniform_block ? uniform_block : resource, options.tiles,
                           TexelFormat::rg32ui, 8ull * options.max_tiles, 0});
    if (masks)
        buffers.push_back({"masks", resource, options.lists, TexelFormat::r32ui, limit, width});
    else
        buffers.push_back({"lists", resource, options.lists, texel,
                           encoded_bytes(format, options.max_tiles, options.max_entries), width});
    if (sliced)
        buffers.push_back({"slices", resource, options.slices, TexelFormat::r32ui,
                           options.max_slices == 0 ? 0 : 4 * (options.max_slices + 3ull), width});
    if (binned && !masks)
        buffers.push_back({"bins", resource, options.bins, TexelFormat::rg32ui,
                           8ull * options.max_slices * options.views, width});
    for (const ShaderBuffer& buffer : buffers)
        if (buffer.resource == uniform_block && buffer.bytes == 0)
            return Error{ErrorCode::block_size_unknown};
    for (const ShaderBuffer& buffer : buffers)
        if (buffer.resource == uniform_block && buffer.bytes > limit)
            return Error{ErrorCode::uniform_block_too_small, buffer.bytes, limit};

    writer.set({{"masks", masks}, {"table", table}, {"sliced", sliced}, {"binned", binned},
                {"clusters", sliced && !binned}, {"several", several}, {"fixed", fixed}, {"flip_y", options.flip_y},
                {"counted", counted}, {"turned", turned},
                {"viewport_corner", options.viewport_corner}, {"has_findLSB", dialect.storage_buffers},
                {"tiles_in_texture", textures && !options.tiles_in_uniform_block},
                {"length_known", table && !binned}, {"searched", masks && binned},
                {"ids_of_32", one_id || format.ids == IdWidth::u32},
                {"ids_of_16", !one_id && format.ids == IdWidth::u16},
                {"ids_of_8", !one_id && format.ids == IdWidth::u8}});
    writer.set("size", fixed ? std::to_string(size) + "u" : kind == 0 ? "$grid.x" : "($grid.x & 0x3fffffffu)");
    writer.set("is_grid", fixed ? "$grid.x == " + std::to_string(kind << 30 | size) + "u"
                                : "($grid.x >> 30u) == " + std::to_string(kind) + "u");
    writer.set("rows", counted ? "@size" : "(($grid.w - 1u) / @size + 1u)");
    writer.set("centre", "(2u * here + uvec2(1u, 1u)) * uvec2($grid.y, @size)");
    writer.set("sentinel", std::to_string(countable_lights(format)) + "u");
    writer.set("capacity", std::to_string(format.capacity) + "u");
    writer.set("texel_of_tile", writer.read_texel("$tiles", "ivec2(int(tile.x), int(tile.y))"));
    writer.set("guess_by_depth", "uintBitsToFloat($slices[1u]) * view_depth + uintBitsToFloat($slices[2u])");
    // With several views, functions that read a view's lists or constants take the view's number as last parameter.
    writer.set("view_parameter", several ? ", uint view" : "");
    writer.set("view_argument", several ? ", view" : "");
    writer.set("is_view", several ? " && view < " + std::to_string(options.views) + "u" : "");
    writer.set("last_view", std::to_string(options.views - 1) + "u");
    writer.set("image", several ? "image" : "$image");
    writer.set("depths", several ? "depths" : "$depths");
    writer.set("if_own", options.wave_loop ? " if (cursor.own)" : "");

    // The loop ends for all lanes of a wave at once. WGSL compilers can't prove that, and would refuse subgroupMin.
    if (options.wave_loop && dialect.webgpu)
        writer.add("enable subgroups;\ndiagnostic(off, subgroup_uniformity);\n");
    else if (options.wave_loop && !dialect.hlsl)
        writer.add("#extension GL_KHR_shader_subgroup_arithmetic : require\n");
    std::vector<ShaderConstant> constants = {{"uvec4", "grid"}};
    if (options.viewport_corner) constants.push_back({"ivec2", "corner"});
    writer.declare_constants(constants, options.grid, options.push_constants);
    if (options.view_check && several)
        writer.declare_constants({{"vec4", "image"}}, options.view, false, 2 * options.views);
    else if (options.view_check)
        writer.declare_constants({{"vec4", "image"}, {"vec4", "depths"}}, options.view, false);
    for (const ShaderBuffer& buffer : buffers)
        writer.declare(buffer);

    // Converts a pixel, as the shader counts pixels, to the view's. A pixel left of or above the viewport wraps around
    // to a large unsigned number, and so stays outside.
    const std::string here = R"(    uvec2 here = pixel;                      @if !viewport_corner
    uvec2 here = pixel - uvec2($corner);     @if viewport_corner
    here.y = $grid.w - 1u - here.y;          @if flip_y !turned
    here.y = $grid.z - 1u - here.y;          @if flip_y turned
    here = here.yx;                          @if turned
)";
    // `tile` divides by at least 1: until the program sets `grid`, it is 0. TileSplit::tile_of() is the same.
    //
    // `slice` starts from the estimate, in which a device may round the logarithm as it likes, and steps from there
    // until the boundaries enclose the depth. They are compared as integers in the same order as the floats, because
    // devices may flush denormal floats to zero.
    //
    // `id_at` returns one id of the lists; from packed lists it extracts the byte or half word.
    writer.add(R"(
// The tile that a pixel lies in.
uvec2 $tile(uvec2 pixel) {
)" + here + R"(    return here / @size;                                    @if fixed
    return here / max(@size, 1u);                           @if !fixed !counted
    return @centre / max(2u * $grid.zw, uvec2(1u, 1u));     @if counted
}
)");
    if (sliced)
        writer.add(R"(
// The slice that a view depth lies in.
uint $slice(float view_depth) {
    float guess = uintBitsToFloat($slices[0u]) * log2(max(view_depth, 1e-37)) + @guess_by_depth;
    uint last = $slices[3u];
    uint slice = min(uint(clamp(guess, 0.0, 1e9)), last);
    uint bits = floatBitsToUint(view_depth);
    uint key = bits | 0x80000000u;
    if (bits > 0x80000000u) { key = ~bits; }
    while (slice > 0u && key < $slices[slice + 3u]) { slice -= 1u; }
    while (slice < last && key >= $slices[slice + 4u]) { slice += 1u; }
    return slice;
}
)");
    if (!masks)
        writer.add(R"(
uint $id_at(uint at) {
    return $lists[at];                                              @if ids_of_32
    return ($lists[at >> 1u] >> ((at & 1u) * 16u)) & 0xffffu;       @if ids_of_16
    return ($lists[at >> 2u] >> ((at & 3u) * 8u)) & 0xffu;          @if ids_of_8
}
)");
    writer.add(R"(
struct $own_cursor {
    uint id;
    uint at;
    uint end;
    uint bits;      @if masks
    uvec2 masks;    @if masks
    uint ids;       @if masks
    uvec2 bin;      @if masks binned
    uint last;      @if !masks binned
};
)");
    // For a pixel outside of the grid, `begin` reads no buffer and makes no division: the constants may be unset, or
    // describe a smaller image or other tiles. With several views, the cells of all views are stored one view after
    // another, and so are their bins.
    //
    // With masks, the cursor's `at` and `end` count words of the masks, and `masks` is where the masks of the column
    // and of the row begin: see LightMasks::words(). A bin without lights has the range {1, 0}, of which no bit is
    // left.
    //
    // With z-bins the ids of lists are ranks, places of the lights in order of depth. The cursor skips ids below the
    // bin's least rank: in a list of known length by binary search, in one that a sentinel ends by linear search.
    writer.add(R"(
$own_cursor $own_begin(uvec2 pixel, float view_depth@view_parameter) {
)" + here + R"(    $own_cursor c;
    c.at = 0u;
    c.end = 0u;
    c.id = 0u;
    c.bits = 0u;                 @if masks
    c.masks = uvec2(0u, 0u);     @if masks
    c.ids = 0u;                  @if masks
    c.bin = uvec2(0u, 0u);       @if masks binned
    c.last = 0u;                 @if !masks binned
    if (here.x < $grid.z && here.y < $grid.w && @is_grid@is_view) {
        uvec2 tile = here / @size;                                  @if !counted
        uvec2 tile = @centre / (2u * $grid.zw);                     @if counted
        uint slice = $slice(view_depth);                            @if sliced
        slice += view * ($slices[3u] + 1u);                         @if sliced several
        tile.y += slice * @rows;                                    @if clusters
        tile.y += view * @rows;                                     @if !clusters several
        uint words = $masks[0u];                                                        @if masks
        c.masks = uvec2(1u + tile.x * words, 1u + ($grid.y + 1u + tile.y) * words);     @if masks
        c.ids = 1u + ($grid.y + 1u + @rows) * words;                                    @if masks
        uint bin = c.ids + 32u * words + 2u * slice;                                    @if masks binned
        c.bin = uvec2($masks[bin], $masks[bin + 1u]);                                   @if masks binned
        c.at = c.bin.x >> 5u;                                                           @if masks binned
        c.end = (c.bin.y >> 5u) + 1u;                                                   @if masks binned
        c.end = words;                                                                  @if masks !binned
        uvec2 bin = $bins[slice];                                                       @if !masks binned
        c.last = bin.y;                                                                 @if !masks binned
        uint place = tile.y * $grid.y + tile.x;                                         @if !masks
        uvec2 list = @texel_of_tile.xy;                                                 @if table tiles_in_texture
        uvec2 list = $tiles[place];                                                     @if table !tiles_in_texture
        c.at = list.x;                                                                  @if table
        c.end = list.x + list.y;                                                        @if table
        c.at = place * @capacity;                                                       @if !masks !table
        c.end = c.at + @capacity;                                                       @if !masks !table
        uint end = c.end;                                                               @if table binned
        while (c.at < end) {                                                            @if table binned
            uint middle = c.at + ((end - c.at) >> 1u);                                  @if table binned
            if ($id_at(middle) < bin.x) { c.at = middle + 1u; }                         @if table binned
            else { end = middle; }                                                      @if table binned
        }                                                                               @if table binned
        while (c.at < c.end && $id_at(c.at) < bin.x) { c.at += 1u; }                    @if !masks !table binned
    }
    return c;
}
)");
    // The next light of masks. Without findLSB the exponent of the lowest bit, converted to float, is its index.
    const std::string next_bit = R"(    bool more = c.bits != 0u;
    if (more) {
        uint bit = uint(findLSB(c.bits));                                                   @if has_findLSB
        uint bit = (floatBitsToUint(float(c.bits & (~c.bits + 1u))) >> 23u) - 127u;         @if !has_findLSB
        c.bits &= c.bits - 1u;
        c.id = $masks[c.ids + 32u * (c.at - 1u) + bit];
)";
    // `lights_at` returns the bits of the word that a cursor is at; with z-bins only those of the bin's range. `next`
    // has a single return statement, because in shader model 5.1 the compiler fxc complains of a result that was not
    // set where a function returns early.
    //
    // With wave_loop all lanes of a wave go through the same words of masks, those that any lane needs, and in each
    // word through the lights that any lane has.
    if (masks)
        writer.add(R"(
uint $lights_at($own_cursor c) {
    uint bits = $masks[c.masks.x + c.at] & $masks[c.masks.y + c.at];
    if (c.at == c.bin.x >> 5u) { bits &= 0xffffffffu << (c.bin.x & 31u); }              @if binned
    if (c.at == c.bin.y >> 5u) { bits &= 0xffffffffu >> (31u - (c.bin.y & 31u)); }      @if binned
    return bits;
}

bool $own_next(inout $own_cursor c) {
    while (c.bits == 0u && c.at < c.end) {
        c.bits = $lights_at(c);
        c.at += 1u;
    }
)" + next_bit + R"(    }
    return more;
}
)");
    else
        writer.add(R"(
bool $own_next(inout $own_cursor c) {
    bool more = c.at < c.end;
    if (more) {
        c.id = $id_at(c.at);
        c.at += 1u;
        more = c.id != @sentinel;           @if !table
        more = more && c.id <= c.last;      @if binned
    }
    return more;
}
)");
    if (options.wave_loop)
        writer.add(R"(
struct $cursor {
    uint id;
    bool own;
    uint at;
    uint end;
    uint bits;
    uint ids;
    $own_cursor lane;
};

$cursor $begin(uvec2 pixel, float view_depth) {
    $cursor c;
    c.id = 0u;
    c.own = false;
    c.bits = 0u;
    $own_cursor lane = $own_begin(pixel, view_depth);
    c.lane = lane;
    uint first = 0xffffffffu;
    if (lane.at < lane.end) { first = lane.at; }
    c.at = subgroupMin(first);
    c.end = subgroupMax(lane.end);
    c.ids = subgroupMax(lane.ids);
    return c;
}

bool $next(inout $cursor c) {
    $own_cursor lane = c.lane;
    while (c.bits == 0u && c.at < c.end) {
        lane.bits = 0u;
        if (c.at == lane.at && lane.at < lane.end) {
            lane.bits = $lights_at(lane);
            lane.at += 1u;
        }
        c.bits = subgroupOr(lane.bits);
        c.at += 1u;
    }
    c.lane = lane;
)" + next_bit + R"(        c.own = ((lane.bits >> bit) & 1u) != 0u;
    }
    return more;
}
)");
    if (!dialect.webgpu)
        writer.add("\n#define $for_each_light(cursor, pixel, view_depth@view_argument) for ($cursor cursor = "
                   "$begin(pixel, view_depth@view_argument); $next(cursor);)@if_own\n");
    if (options.heat_map)
        writer.add(R"(
uint $count(uvec2 pixel, float view_depth@view_parameter) {
    $own_cursor c = $own_begin(pixel, view_depth@view_argument);
    return c.end - c.at;                            @if length_known
    uint count = 0u;                                @if !length_known
    while ($own_next(&c)) { count += 1u; }          @if !length_known
    return count;                                   @if !length_known
}

vec3 $heat(uvec2 pixel, float view_depth, float most@view_parameter) {
    float heat = float($count(pixel, view_depth@view_argument)) / most;
    vec3 colour = vec3(4.0 * heat - 2.0, min(4.0 * heat, 4.0 - 4.0 * heat), 2.0 - 4.0 * heat);
    return clamp(colour, vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 1.0));
}
)");
    if (options.window)  // the shader's light_window()
        writer.add(R"(
// 1 at a light, falling smoothly to 0 at its range and beyond.
float $window(float apart, float range) {
    float x = apart / range;
    float w = 0.0;
    if (apart < range) { w = 1.0 - x * x * x * x; }
    return w * w;
}
)");
    // The constants of view v are elements 2v and 2v + 1 of an array. A view number that is too large is clamped to the
    // last view's, so that no element beyond the array is read.
    if (options.view_check)
        writer.add(R"(
// Whether the View has a position of view space in this pixel, and not before its near plane.
bool $check_view(uvec2 pixel, vec3 position@view_parameter) {
)" + here + R"(    uint first = 2u * min(view, @last_view);    @if several
    vec4 image = $image[first];                 @if several
    vec4 depths = $image[first + 1u];           @if several
    float depth = @depths.x * position.z;
    float w = 1.0;
    if (@depths.y > 0.0) { w = depth; }
    vec2 at = @image.xy * position.xy / w + @image.zw;
    vec2 apart = abs(at - (vec2(here) + 0.5));
    return apart.x < @depths.w && apart.y < @depths.w && depth >= @depths.z@is_view;
}
)");
    // As a list's ids ascend, one pass over all ids, with the list's cursor beside it, finds those that the list lacks.
    // Masks with z-bins have an order of their own, and are searched for each id.
    if (options.list_check)
        writer.add(R"(
// A light, and whether the pixel's masks lack it.      @if searched
// A light, and whether the pixel's list lacks it.      @if !searched
struct $missing {
    uint id;
    bool lacked;
    bool more;              @if !searched
    $own_cursor listed;     @if !searched
    $own_cursor first;      @if searched
};

$missing $begin_missing(uvec2 pixel, float view_depth@view_parameter) {
    $own_cursor listed = $own_begin(pixel, view_depth@view_argument);       @if !searched
    $missing m;
    m.id = 0xffffffffu;
    m.lacked = false;
    m.more = $own_next(&listed);                                            @if !searched
    m.listed = listed;                                                      @if !searched
    m.first = $own_begin(pixel, view_depth@view_argument);                  @if searched
    return m;
}

bool $next_missing(inout $missing m, uint lights) {
    m.id += 1u;
    $own_cursor listed = m.first;                                           @if searched
    bool more = $own_next(&listed);                                         @if searched
    while (more && listed.id != m.id) { more = $own_next(&listed); }        @if searched
    m.lacked = !more;                                                       @if searched
    $own_cursor listed = m.listed;                                          @if !searched
    m.lacked = !(m.more && listed.id == m.id);                              @if !searched
    if (!m.lacked) { m.more = $own_next(&listed); }                         @if !searched
    m.listed = listed;                                                      @if !searched
    return m.id < lights;
}
)");
    if (options.list_check && !dialect.webgpu)
        writer.add("\n#define $for_each_missing(cursor, lights, pixel, view_depth@view_argument) for ($missing cursor "
                   "= $begin_missing(pixel, view_depth@view_argument); $next_missing(cursor, lights);) "
                   "if (cursor.lacked)\n");
    // In the text, names of what reads the list of one lane begin with `$own_`, where `$` is the prefix of all names.
    // With wave_loop this tells them from those of the loop that a wave shares. Without wave_loop `own_` is left out.
    return writer.finish(options.wave_loop ? "$own_" : "$");
}

}}  // namespace lightbin
