// SPDX-License-Identifier: MIT
// Bytes to the options of one of the shader generators: refused for a reason that the options have, and only
// then, or a text that is sound as far as can be told without a compiler (tests/shader has those): brackets
// pair, every name that others see has the prefix, and what is to be bound is what the options ask for. And to the plan
// of the passes that make light grids: refused in the same way, or numbers within the limits that are documented.
#include "bytes.hpp"

#include <lightbin/shader.hpp>
#include <lightbin/shader_cull.hpp>
#include <lightbin/shader_reduce.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

using namespace lightbin;

namespace {

void require(bool condition, const char* what, const std::string& text) {
    if (condition) return;
    std::fprintf(stderr, "%s:\n%s\n", what, text.c_str());
    std::abort();
}

template <class Enum> Enum take_enum(Bytes& bytes, Enum last) {
    return static_cast<Enum>(bytes.byte() % (static_cast<unsigned>(last) + 1));
}

/// Small numbers and powers of two as often as any.
std::uint32_t take_size(Bytes& bytes) {
    const unsigned kind = bytes.byte();
    return (kind & 1) != 0   ? bytes.byte()
           : (kind & 2) != 0 ? 1u << bytes.byte() % 32
                             : bytes.take<std::uint32_t>();
}

/// Sets a slot, which may be negative; 0 leaves it at the default, which must be unused.
void take_slot(Bytes& bytes, ShaderSlot& slot) {
    slot.binding ^= static_cast<int>(bytes.byte());
    const unsigned kind = bytes.byte();
    if ((kind & 1) != 0) slot.set = static_cast<int>(bytes.byte());
    if (kind >> 4 == 15) slot.binding = ~slot.binding;
    if (kind >> 4 == 14) slot.set = ~slot.set;
}

std::string take_prefix(Bytes& bytes) {
    if (!bytes.flag()) return "lightbin_";
    std::string prefix;
    for (unsigned n = bytes.byte() % 20; n > 0; --n)
        prefix += static_cast<char>(bytes.byte());
    return prefix;
}

/// What the languages have.
struct Language {
    explicit Language(ShaderLanguage language)
        : hlsl(language == ShaderLanguage::hlsl_5_0 || language == ShaderLanguage::hlsl_5_1),
          vulkan(language == ShaderLanguage::glsl_vulkan), wgsl(language == ShaderLanguage::wgsl),
          old(language == ShaderLanguage::glsl_330 || language == ShaderLanguage::essl_300),
          es(language == ShaderLanguage::essl_300 || language == ShaderLanguage::essl_310),
          sets(vulkan || wgsl || language == ShaderLanguage::hlsl_5_1) {}
    bool hlsl, vulkan, wgsl;
    bool old;  ///< has no compute shaders or storage buffers, and no bindings in the text
    bool es, sets;
};

/// A binding that a text must have, and which of its properties the options determine.
struct Wanted {
    std::string name;
    ShaderSlot slot;
    std::uint32_t bytes = 0;  ///< size of a block; 0 if it is no block or may have any size up to the limit
};

/// A generator's options, and what its answer must be.
struct Question {
    ShaderLanguage language = ShaderLanguage::glsl_430;
    std::string prefix;
    bool push_constants = false;
    std::vector<ShaderSlot> slots;  ///< all slots in the options, also those that the text does not use
    std::set<ErrorCode> reasons;    ///< errors with which the options may be refused
    /// The resources that a shader text must declare, in its order, without the constants at its beginning
    std::vector<Wanted> wanted;
    std::vector<std::string> constants = {"grid"};
    ShaderSlot constants_slot;
    bool constants_in_block = false;  ///< the constants are in a block in OpenGL, too
    bool view_check = false;          ///< whether it has constants for a check of the view
    ShaderSlot view_slot;
    std::uint32_t block_bytes = 0;   ///< size limit of a block that does not hold constants
    std::vector<std::string> names;  ///< that the text must have, without the prefix
};

/// Fills in the options that all generators have, and the expectations that follow from them.
template <class Options>
void take_rest(Bytes& bytes, Options& options, std::initializer_list<ShaderSlot*> slots, Question& question) {
    for (ShaderSlot* slot : slots) {
        take_slot(bytes, *slot);
        question.slots.push_back(*slot);
    }
    question.prefix = take_prefix(bytes);
    options.prefix = question.prefix;
    question.language = options.language;
    if constexpr (requires { options.push_constants; }) question.push_constants = options.push_constants;
    question.constants_slot = options.grid;
}

bool of_a_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Words of the shader languages that may stand outside of functions, with a space around each.
const std::string language_words =
    " uniform layout buffer readonly restrict struct highp const uint uvec2 uvec4 ivec2 int bool"
    " float vec3 void uint2 uint4 int2 float3 cbuffer register StructuredBuffer Texture2D inout"
    " static Buffer in out usampler2D usamplerBuffer utextureBuffer ByteAddressBuffer utexture2D vk"
    " push_constant ConstantBuffer flat precision mediump main shared groupshared writeonly vec2"
    " vec4 float2 float4 sampler2D sampler2DMS Texture2DMS RWStructuredBuffer SV_Target"
    " enable subgroups diagnostic group binding var storage read read_write array texture_2d "
    "texture_multisampled_2d"
    " fn u32 f32 vec2u vec4u vec2i vec2f vec3f vec4f workgroup atomic compute fragment workgroup_size "
    "location ";

/// Checks that brackets pair, and that global names, also of members of blocks, begin with the prefix.
void check_text(const std::string& text, const std::string& prefix) {
    require(text.find('$') == std::string::npos, "a placeholder is left", text);
    std::string open, word;
    bool in_block = false, in_comment = false, in_macro = false;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        require(c == '\n' || (c >= ' ' && c <= '~'), "not a printable character", text);
        if (c == '\n' && (at == 0 || text[at - 1] != '\\')) {
            in_comment = false;
            in_macro = false;
        }
        if (in_comment || in_macro) continue;
        if (text.compare(at, 2, "//") == 0) in_comment = true;
        if (c == '#') in_macro = true;
        require(text.compare(at, 8, "#define ") != 0 || text.compare(at + 8, prefix.size(), prefix) == 0,
                "a macro without the prefix", text);
        if (in_comment || in_macro) continue;
        if (of_a_name(c)) {
            word += c;
            continue;
        }
        if (!word.empty()) {
            const bool outer = open.empty() || (in_block && open == "{");
            const bool number = std::isdigit(static_cast<unsigned char>(word.front())) != 0;
            if (outer && !number && language_words.find(" " + word + " ") == std::string::npos)
                require(word.compare(0, prefix.size(), prefix) == 0, ("no prefix: " + word).c_str(), text);
            if (open.empty()) {
                if (word == "buffer" || word == "uniform" || word == "cbuffer") in_block = true;
                if (word == "struct") in_block = false;
            }
            word.clear();
        }
        const std::size_t bracket = std::string_view("()[]{}").find(c);
        if (bracket == std::string_view::npos) {
            if (c == ';' && open.empty()) in_block = false;
        } else if (bracket % 2 == 0) {
            open += c;
        } else {
            require(!open.empty() && open.back() == "([{"[bracket / 2], "brackets do not pair", text);
            open.pop_back();
        }
    }
    require(open.empty(), "a bracket is left open", text);
}

/// Checks that a text has the expected bindings, and that the line that declares each has its slot and no other.
void check_bindings(const ShaderText& made, const Question& question) {
    const Language language(question.language);
    const std::string& text = made.text;
    std::vector<Wanted> wanted;
    const auto bytes = static_cast<std::uint32_t>(16 * question.constants.size());
    const bool block = language.hlsl || language.vulkan || language.wgsl || question.constants_in_block;
    if (block) wanted.push_back({question.constants.front(), question.constants_slot, bytes});
    for (std::size_t i = 0; i < question.constants.size() && !block; ++i)
        wanted.push_back({question.constants[i], {}, question.constants[i] == "corner" ? 8u : 16u});
    const std::size_t grid_constants = wanted.size();
    if (question.view_check && block) wanted.push_back({"image", question.view_slot, 32});
    if (question.view_check && !block) wanted.insert(wanted.end(), {{"image", {}, 16}, {"depths", {}, 16}});
    wanted.insert(wanted.end(), question.wanted.begin(), question.wanted.end());
    require(made.bindings.size() == wanted.size(), "not the bindings wanted", text);

    std::set<std::string> places;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const ShaderBinding& binding = made.bindings[i];
        const std::string name = question.prefix + wanted[i].name;
        require(binding.name == name || binding.name == name + "_block", "another binding's name", text);
        require(binding.slot.binding == wanted[i].slot.binding && binding.slot.set == wanted[i].slot.set,
                "another slot", text);
        const bool constant = i < wanted.size() - question.wanted.size(),
                   push = i < grid_constants && question.push_constants;
        require(constant ? binding.bytes == wanted[i].bytes : binding.bytes <= question.block_bytes,
                "a block of another size, or larger than allowed", text);

        std::size_t at = text.find(binding.name);
        while (at != std::string::npos &&
               (of_a_name(text[at - 1]) || of_a_name(text[at + binding.name.size()])))
            at = text.find(binding.name, at + 1);
        require(at != std::string::npos, "a binding that is not in the text", text);
        const std::size_t begin = text.rfind('\n', at) + 1;
        const std::string line = text.substr(begin, text.find('\n', at) - begin),
                          number = std::to_string(binding.slot.binding),
                          set = std::to_string(binding.slot.set);
        if (push) require(line.find("(push_constant)") != std::string::npos, "no push constants", text);
        if (push || language.old || (constant && !block)) {
            require(line.find("binding =") == std::string::npos, "bound in vain", text);
            continue;
        }
        const std::string place = language.hlsl     ? number + (language.sets ? ", space" + set : "") + ")"
                                  : language.wgsl   ? "@group(" + set + ") @binding(" + number + ") var"
                                  : language.vulkan ? "set = " + set + ", binding = " + number + ")"
                                                    : "binding = " + number + ")";
        const std::size_t found = line.find(place);
        require(found != std::string::npos, "bound elsewhere", text);
        // The binding's kind if slots are counted for each kind: HLSL's register letter, or OpenGL's kind of object.
        const std::string kind = language.vulkan || language.wgsl ? ""
                                 : language.hlsl                  ? line.substr(found - 1, 1)
                                                                  : line.substr(0, line.find("binding"));
        require(places.insert(kind + place).second, "two of them in one place", text);
    }
}

void check(const Result<ShaderText>& made, Question question) {
    static const std::regex name("[A-Za-z](_?[A-Za-z0-9])*_?");
    const Language language(question.language);
    if (!std::regex_match(question.prefix, name) || question.prefix.starts_with("gl_") ||
        question.prefix.starts_with("GL_") || question.prefix == "vola")
        question.reasons.insert(ErrorCode::not_a_prefix);
    if (question.push_constants && !language.vulkan) question.reasons.insert(ErrorCode::no_push_constants);
    for (const ShaderSlot slot : question.slots) {
        if (slot.binding < 0 || slot.set < 0) question.reasons.insert(ErrorCode::slot_out_of_range);
        if (slot.set != 0 && !language.sets) question.reasons.insert(ErrorCode::no_sets);
    }
    if (!made) {
        const ErrorCode code = made.error().code;
        const std::string message = made.error().message();
        require(message.size() > 10 && message != "unknown error", "refused without a text", "");
        bool reason = question.reasons.contains(code);
        if (code == ErrorCode::bindings_overlap)
            for (const ShaderSlot& a : question.slots)
                for (const ShaderSlot& b : question.slots)
                    reason = reason || (&a < &b && a.binding == b.binding && a.set == b.set);
        require(reason, "refused without reason", message);
        return;
    }
    require(question.reasons.empty(), "not refused", made->text);
    check_text(made->text, question.prefix);
    check_bindings(*made, question);
    for (const std::string& wanted : question.names)
        require(made->text.find(question.prefix + wanted) != std::string::npos, "a name is missing",
                made->text);
}

void fuzz_snippet(Bytes& bytes) {
    SnippetOptions options;
    Question question;
    options.language = take_enum(bytes, ShaderLanguage::wgsl);
    options.storage = take_enum(bytes, ListStorage::uniform_block);
    options.format.encoding = take_enum(bytes, ListEncoding::sentinel);
    options.format.ids = static_cast<IdWidth>(1u << bytes.byte() % 3);
    options.format.capacity = take_size(bytes);
    const unsigned flags = bytes.byte();
    options.tiles_in_uniform_block = (flags & 1) != 0;
    options.packed_ids = (flags & 2) != 0;
    options.flip_y = (flags & 4) != 0;
    options.viewport_corner = (flags & 8) != 0;
    options.heat_map = (flags & 16) != 0;
    options.push_constants = (flags & 32) != 0;
    options.tile_size = static_cast<int>(take_size(bytes));
    options.texture_width = take_size(bytes);
    options.max_tiles = take_size(bytes);
    options.max_entries = take_size(bytes);
    if ((flags & 64) != 0) options.uniform_block_bytes = take_size(bytes);
    take_rest(bytes, options, {&options.tiles, &options.lists, &options.grid}, question);
    options.slicing = take_enum(bytes, Slicing::z_bins);
    options.max_slices = take_size(bytes);
    const unsigned more_flags = bytes.byte();
    options.wave_loop = (more_flags & 1) != 0;
    options.view_check = (more_flags & 2) != 0;
    options.list_check = (more_flags & 4) != 0;
    options.window = (more_flags & 8) != 0;
    if ((more_flags & 16) != 0) take_slot(bytes, options.view);
    options.masks = (more_flags & 32) != 0;
    options.columns_and_rows = (more_flags & 64) != 0;
    options.turned = (more_flags & 128) != 0;
    for (const ShaderSlot slot : {options.slices, options.bins, options.view})
        question.slots.push_back(slot);

    const ListFormat& format = options.format;
    const Language language(options.language);
    const bool masks = options.masks, table = !masks && format.encoding == ListEncoding::offset_count,
               lists_in_block = options.storage == ListStorage::uniform_block,
               tiles_in_block = table && (lists_in_block || options.tiles_in_uniform_block);
    const auto refuse_if = [&](bool condition, ErrorCode code) {
        if (condition) question.reasons.insert(code);
    };
    refuse_if(options.storage == ListStorage::storage_buffer && language.old, ErrorCode::no_storage_buffers);
    refuse_if(options.storage == ListStorage::texel_buffer && (language.es || language.wgsl),
              ErrorCode::no_texel_buffers);
    refuse_if(options.wave_loop && (!masks || language.old || options.language == ShaderLanguage::hlsl_5_0),
              ErrorCode::no_wave_operations);
    refuse_if(options.tile_size < 0, ErrorCode::tile_size_out_of_range);
    refuse_if(masks && options.slicing == Slicing::clusters, ErrorCode::no_such_slicing_shader);
    refuse_if(options.storage == ListStorage::texture_2d &&
                  (options.texture_width == 0 || options.texture_width > 16384),
              ErrorCode::texture_width_out_of_range);
    // Sizes are computed in double: those that a double cannot hold exactly are far beyond the limits.
    const double id_bytes = static_cast<double>(format.ids), tiles = options.max_tiles;
    refuse_if(!masks && format.encoding == ListEncoding::sentinel && format.capacity == 0,
              ErrorCode::capacity_unknown);
    refuse_if((lists_in_block || tiles_in_block) && !masks && tiles == 0, ErrorCode::block_size_unknown);
    refuse_if(lists_in_block && masks && options.uniform_block_bytes < 16, ErrorCode::block_size_unknown);
    refuse_if(lists_in_block && table && options.max_entries == 0, ErrorCode::block_size_unknown);
    const bool sliced = options.slicing != Slicing::none, binned = !masks && options.slicing == Slicing::z_bins;
    refuse_if(lists_in_block && sliced && options.max_slices == 0, ErrorCode::block_size_unknown);
    const double list_bytes = table ? options.max_entries * id_bytes : tiles * format.capacity * id_bytes;
    question.block_bytes =
        language.hlsl ? std::min(options.uniform_block_bytes, 65536u) : options.uniform_block_bytes;
    const auto too_large = [&](double size) { return std::ceil(size / 16) * 16 > question.block_bytes; };
    const double slices = options.max_slices;
    refuse_if((tiles_in_block && too_large(8 * tiles)) ||
                  (lists_in_block && !masks && too_large(list_bytes)) ||
                  (lists_in_block && sliced && too_large(4 * (slices + 3))) ||
                  (lists_in_block && binned && too_large(8 * slices)),
              ErrorCode::uniform_block_too_small);

    if (options.viewport_corner) question.constants.push_back("corner");
    if (table) question.wanted.push_back({"tiles", options.tiles});
    question.wanted.push_back({masks ? "masks" : "lists", options.lists});
    if (sliced) question.wanted.push_back({"slices", options.slices});
    if (binned) question.wanted.push_back({"bins", options.bins});
    question.names = {"tile", "cursor", "begin", "next"};
    if (!language.wgsl) question.names.push_back("for_each_light");
    if (options.heat_map) question.names.insert(question.names.end(), {"count", "heat"});
    if (options.view_check) question.names.push_back("check_view(");
    if (options.list_check) question.names.push_back(language.wgsl ? "next_missing(" : "for_each_missing(");
    if (options.window) question.names.push_back("window(");
    question.view_check = options.view_check;
    question.view_slot = options.view;
    check(shader_snippet(options), question);
}

void fuzz_reduction(Bytes& bytes) {
    ReduceOptions options;
    Question question;
    options.language = take_enum(bytes, ShaderLanguage::wgsl);
    options.fragment = bytes.byte() % 2 != 0;
    options.format = take_enum(bytes, DepthFormat::unorm16);
    options.samples = static_cast<int>(bytes.byte() % 12) - 1;
    const unsigned flags = bytes.byte();
    options.reversed_z = (flags & 1) != 0;
    options.orthographic = (flags & 2) != 0;
    options.skip_background = (flags & 4) != 0;
    options.flip_y = (flags & 8) != 0;
    options.viewport_corner = (flags & 16) != 0;
    options.push_constants = (flags & 32) != 0;
    take_rest(bytes, options, {&options.depth, &options.z_bounds, &options.grid}, question);

    const bool compute = !options.fragment;
    if (compute && Language(options.language).old) question.reasons.insert(ErrorCode::no_storage_buffers);
    if (options.samples < 1 || options.samples > 8) question.reasons.insert(ErrorCode::samples_out_of_range);
    if (options.samples > 1 && options.language == ShaderLanguage::essl_300)
        question.reasons.insert(ErrorCode::no_multisample_textures);
    question.constants.push_back("planes");
    if (options.viewport_corner) question.constants.push_back("corner");
    question.wanted.push_back({"depth", options.depth});
    if (compute) question.wanted.push_back({"z_bounds", options.z_bounds});
    question.names = {"sample", "view_depths", "pixel", compute ? "run" : "reduce"};
    check(reduce_shader(options), question);
}

/// Returns the buffers that a pass of cull_shader() binds, in the order in which its text declares them.
std::vector<Wanted> buffers_of(CullPass pass, const CullOptions& options) {
    std::vector<Wanted> wanted;
    const auto want = [&](bool condition, const char* name, ShaderSlot slot) {
        if (condition) wanted.push_back({name, slot});
    };
    const bool project = pass == CullPass::project, fill = pass == CullPass::fill;
    want(project, "lights", options.lights);
    want((pass == CullPass::count || fill) && options.depth_test, "z_bounds", options.z_bounds);
    want(true, "scratch", options.scratch);
    want(project && options.slicing != Slicing::none, "slices", options.slices);
    want(project && options.count_in_buffer, "light_count", options.light_count);
    want(fill, "tiles", options.tiles);
    want(fill || pass == CullPass::masks, "lists", options.lists);
    return wanted;
}

/// Checks that a plan has the numbers that were asked for, and sizes and groups within the documented limits.
void check_plan(const CullPlan& plan, const View& view, const CullOptions& options,
                const CullCapacity& room, std::uint32_t slices) {
    const auto holds = [](bool condition, const char* what) { require(condition, what, ""); };
    const CullConstants& made = plan.constants;
    const auto columns = static_cast<std::uint32_t>(view.tiles_x()),
               rows = static_cast<std::uint32_t>(view.tiles_y());
    holds(made.tiles_x == columns && made.tiles_y == rows && made.slices == slices &&
              made.lights == room.lights + room.spots + room.boxes && made.entries == room.entries,
          "a plan of something else");
    const std::uint64_t cells = std::uint64_t{columns} * rows * slices, lights = made.lights;
    const auto sized = [&](std::uint64_t bytes, std::uint64_t least) {
        holds(bytes % 4 == 0 && bytes >= 16 && bytes >= least && bytes < least + 20,
              "a buffer of another size");
    };
    sized(plan.bytes.tiles, 8 * cells);
    sized(plan.bytes.lists, std::uint64_t{room.entries} * static_cast<unsigned>(options.ids));
    const std::uint64_t mask_words = (lights + 31) / 32, of_each = columns + rows + 33;
    sized(plan.bytes.masks, 4 * (1 + of_each * mask_words));
    holds(plan.bytes.masks < std::uint64_t{1} << 34, "more words of masks than numbers");
    const bool few = lights < 1025 && options.slicing != Slicing::clusters && !options.depth_test;
    holds(plan.masks_suit == few, "masks for many lights, or lists for few");

    // The arrays in `scratch` lie one after another, with the sizes in docs/gpu.md.
    const std::uint64_t words = plan.bytes.scratch / 4;
    const std::uint64_t places[] = {made.masks, made.counts, made.ranges, made.sums, made.groups, words};
    holds(words < std::uint64_t{1} << 32, "more words than numbers");
    holds(std::is_sorted(std::begin(places), std::end(places)), "arrays that overlap");
    holds(made.masks >= 4 + 2 * lights, "too little room for lights");
    holds(made.ranges - made.counts >= cells * made.segments && made.sums - made.ranges >= 2 * cells,
          "too little room for cells");
    const std::uint64_t blocks =
        std::uint64_t{made.blocks_x} * made.blocks_y * (((slices - 1) >> made.slice_shift) + 1);
    holds(blocks >= 1 && blocks <= 1024 && std::uint64_t{made.blocks_x} << made.block_shift >= columns &&
              std::uint64_t{made.blocks_y} << made.block_shift >= rows,
          "blocks that don't cover the tiles, or too many");
    holds((made.counts - made.masks) * std::uint64_t{32} >= lights * blocks, "too little room for masks");
    holds(made.segments >= 1 && made.segments <= 32 &&
              std::uint64_t{made.segments} * made.steps * 1024 >= lights,
          "segments that don't hold the lights");
    for (std::size_t i = 0; i < std::size(plan.groups); ++i) {
        const auto pass = static_cast<CullPass>(i);
        const CullGroups groups = plan.groups_of(pass);
        holds(groups.x >= 1 && groups.y >= 1 && groups.x <= 65535 && groups.y <= 65535,
              "more work groups than devices have");
        const std::uint64_t needed = pass == CullPass::project ? (lights + 63) / 64
                                     : pass == CullPass::sums  ? (cells + 127) / 128
                                     : pass == CullPass::masks ? mask_words * ((of_each + 127) / 128)
                                                               : 1;
        holds(std::uint64_t{groups.x} * groups.y >= needed, "too few work groups");
    }
}

/// Makes a view, slices and the other arguments of plan_cull() from bytes, and checks the plan.
void fuzz_plan(Bytes& bytes, CullOptions options) {
    constexpr float perspective[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, -1}, {0, 0, -0.2f, 0}},
                    flat[4][4] = {{0.1f, 0, 0, 0}, {0, 0.1f, 0, 0}, {0, 0, -0.01f, 0}, {0, 0, -1, 1}};
    options.orthographic = bytes.flag();
    const int width = static_cast<int>(bytes.below(32769)), height = static_cast<int>(bytes.below(32769));
    const auto view = View::from_projection(options.orthographic ? flat : perspective, {width, height},
                                            {.tile_size = static_cast<int>(1 + bytes.byte())});
    if (!view) return;
    CullCapacity room = {take_size(bytes), take_size(bytes)};
    const bool mixed = options.kind == CullKind::mixed;
    if (mixed) room.spots = take_size(bytes), room.boxes = take_size(bytes);
    const std::uint64_t all_lights = std::uint64_t{room.lights} + room.spots + room.boxes;
    const bool sliced = options.slicing != Slicing::none;
    std::uint32_t count = 1;
    if (sliced) count = 1 + take_size(bytes) % 70'000;
    const auto slices = Slices::linear(static_cast<int>(count), 0, 1e6f);
    require(bool(slices), "no slices", "");
    Matrix to_view = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    const bool any = bytes.flag();
    if (any)
        for (double(&column)[4] : to_view.columns)
            for (double& entry : column)
                entry = static_cast<double>(bytes.take<float>());

    std::set<ErrorCode> reasons;
    if (count > 65535) reasons.insert(ErrorCode::too_many_slices);
    if (all_lights > (options.ids == IdWidth::u16 ? 65536 : 0xffffffff)) reasons.insert(ErrorCode::too_many_lights);
    const auto plan = plan_cull(*view, options, room, sliced ? &*slices : nullptr,
                                options.world_space ? &to_view : nullptr);
    if (plan) {
        require(reasons.empty(), "a plan that is not refused", "");
        check_plan(*plan, *view, options, room, count);
        return;
    }
    const Error& error = plan.error();
    if (any && options.world_space)
        for (const ErrorCode code : {ErrorCode::view_matrix_not_affine, ErrorCode::view_matrix_transposed,
                                     ErrorCode::view_matrix_distorts})
            reasons.insert(code);
    if (error.code == ErrorCode::scratch_too_large || error.code == ErrorCode::too_many_entries)
        require(error.needed > error.available, "a plan that would fit", error.message());
    else
        require(reasons.contains(error.code), "a plan is refused without reason", error.message());
}

void fuzz_cull(Bytes& bytes) {
    CullOptions options;
    Question question;
    options.language = take_enum(bytes, ShaderLanguage::wgsl);
    const CullPass pass = take_enum(bytes, CullPass::masks);
    options.depth_test = bytes.flag();
    const unsigned flags = bytes.byte();
    options.max_only = (flags & 1) != 0;
    options.orthographic = (flags & 2) != 0;
    options.world_space = (flags & 4) != 0;
    options.slicing = static_cast<Slicing>((flags >> 3) % 3);
    options.count_in_buffer = (flags & 32) != 0;
    take_rest(bytes, options,
              {&options.lights, &options.z_bounds, &options.scratch, &options.slices, &options.tiles,
               &options.light_count, &options.lists, &options.grid},
              question);
    options.kind = take_enum(bytes, CullKind::mixed);
    options.ids = static_cast<IdWidth>(4u >> bytes.byte() % 3);
    options.lights_at = {take_size(bytes), take_size(bytes), take_size(bytes), take_size(bytes), take_size(bytes),
                         take_size(bytes), take_size(bytes), take_size(bytes), take_size(bytes), take_size(bytes)};
    options.count_at = take_size(bytes);

    if (Language(options.language).old) question.reasons.insert(ErrorCode::no_storage_buffers);
    if (options.ids == IdWidth::u8) question.reasons.insert(ErrorCode::ids_too_narrow);
    if (options.slicing == Slicing::z_bins) question.reasons.insert(ErrorCode::no_such_slicing_shader);
    question.constants_in_block = true;
    question.constants.resize(options.kind == CullKind::mixed ? 14 : options.world_space ? 13 : 8);
    question.wanted = buffers_of(pass, options);
    question.names = {"run"};
    const Result<ShaderText> made = cull_shader(pass, options);
    check(made, question);
    if (made || made.error().code == ErrorCode::bindings_overlap) fuzz_plan(bytes, options);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    void (*const generators[])(Bytes&) = {fuzz_snippet, fuzz_reduction, fuzz_cull};
    generators[bytes.byte() % 3](bytes);
    return 0;
}
