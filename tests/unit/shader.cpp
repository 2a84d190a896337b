// The snippet's text: options that are off leave no line, and errors name limits. tests/shader tests that it compiles
// and reads the right lists, tests/fuzz/shader.cpp what is refused.
#include <doctest/doctest.h>

#include <lightbin/shader.hpp>
#include <lightbin/shader_cull.hpp>
#include <lightbin/shader_reduce.hpp>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace lightbin;

namespace {
bool has(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

/// Checks that each part is in the text with options, and not in the text without.
void only_in(const std::string& with, const std::string& without, std::initializer_list<const char*> parts) {
    for (const char* part : parts) {
        CAPTURE(part);
        CHECK(has(with, part));
        CHECK(!has(without, part));
    }
}

std::string text_of(const SnippetOptions& options) {
    const Result<ShaderText> shader = shader_snippet(options);
    REQUIRE(shader);
    return shader->text;
}

std::string refusal(const SnippetOptions& options) {
    const Result<ShaderText> shader = shader_snippet(options);
    REQUIRE(!shader);
    return shader.error().message();
}
}  // namespace

TEST_CASE("an option that is off leaves no line") {
    const std::string storage = text_of({});
    CHECK(has(storage, "layout(std430, binding = 0)"));
    CHECK(has(storage, "layout(std430, binding = 1)"));
    for (const char* absent : {"sampler", "#version", "bits", "highp", "set =", "precision"})
        CHECK(!has(storage, absent));
    const std::string all = text_of({.format = {.ids = IdWidth::u16},
                                     .slicing = Slicing::z_bins,
                                     .views = 2,
                                     .flip_y = true,
                                     .viewport_corner = true,
                                     .heat_map = true,
                                     .view_check = true,
                                     .list_check = true,
                                     .window = true});
    only_in(all, storage,
            {"here.y =", "0xffff", "corner", "heat", "count", "slice", "bin.", "image", "depths",
             "check", "missing", "window", "uint view", "view)"});

    const std::string texture = text_of({.language = ShaderLanguage::glsl_330,
                                         .storage = ListStorage::texel_buffer,
                                         .format = {.ids = IdWidth::u16}});
    CHECK(!has(texture, "buffer lightbin"));
    CHECK(!has(texture, "0xffff"));  // an R16UI texture is already one id a texel
    CHECK(!has(text_of({.slicing = Slicing::clusters}), "bins"));
    CHECK(!has(text_of({.tile_size = 16}), "/ lightbin_grid.x"));
    only_in(text_of({.masks = true, .wave_loop = true}), text_of({.masks = true}), {"own", "#extension", "subgroup"});
    CHECK(has(refusal({.language = ShaderLanguage::hlsl_5_0, .masks = true, .wave_loop = true}), "HLSL 6"));
    CHECK(has(refusal({.wave_loop = true}), "masks"));
    // The words of a block's vectors are picked in a function alone: see ShaderWriter::declare(const ShaderBuffer&).
    const std::string blocks = text_of({.storage = ListStorage::uniform_block,
                                        .slicing = Slicing::clusters,
                                        .max_tiles = 9,
                                        .max_entries = 9,
                                        .max_slices = 9});
    std::size_t picks = 0;
    for (std::size_t at = 0; (at = blocks.find(" & 3u]", at)) != blocks.npos; ++at)
        ++picks;
    CHECK(picks == 3);
    for (const char* words : {"lightbin_tiles_word(uint", "lightbin_lists_word(uint", "lightbin_slices_word(uint"})
        CHECK(has(blocks, words));
    const std::string bound = text_of({.tiles = {5}, .lists = {9}});
    CHECK(has(bound, "binding = 5"));
    CHECK(has(bound, "binding = 9"));
}

TEST_CASE("the names that docs/shader.md promises are in the text of each language and storage") {
    std::size_t texts = 0;
    for (const ShaderLanguage language :
         {ShaderLanguage::glsl_430, ShaderLanguage::glsl_330, ShaderLanguage::glsl_vulkan, ShaderLanguage::essl_300,
          ShaderLanguage::essl_310, ShaderLanguage::hlsl_5_0, ShaderLanguage::hlsl_5_1, ShaderLanguage::wgsl})
        for (const ListStorage storage : {ListStorage::storage_buffer, ListStorage::texel_buffer,
                                          ListStorage::texture_2d, ListStorage::uniform_block})
            for (const bool masks : {false, true}) {
                const auto shader = shader_snippet({.language = language,
                                                    .storage = storage,
                                                    .slicing = Slicing::z_bins,
                                                    .masks = masks,
                                                    .heat_map = true,
                                                    .view_check = true,
                                                    .list_check = true,
                                                    .window = true,
                                                    .max_tiles = 9,
                                                    .max_entries = 9,
                                                    .max_slices = 9});
                if (!shader) continue;  // a language has no such storage
                ++texts;
                CAPTURE(shader->text);
                for (const char* function : {"lightbin_begin(", "lightbin_next(", "lightbin_begin_missing(",
                                             "lightbin_next_missing(", "lightbin_count(", "lightbin_heat(",
                                             "lightbin_window(", "lightbin_check_view("})
                    CHECK(has(shader->text, function));
                const bool has_macros = language != ShaderLanguage::wgsl;
                CHECK(has(shader->text, "lightbin_for_each_light(cursor, pixel, view_depth)") == has_macros);
                CHECK(has(shader->text, "lightbin_for_each_missing(cursor, lights, pixel, view_depth)") == has_macros);
                for (const char* member : {has_macros ? " id;" : " id : u32,", has_macros ? " lacked;" : " lacked : bool,"})
                    CHECK(has(shader->text, member));
                // By these names an API without binding numbers finds what is to be bound.
                std::vector<std::string> names;
                for (const ShaderBinding& binding : shader->bindings) {
                    names.push_back(binding.name);
                    CHECK(has(shader->text, names.back().c_str()));
                    if (const auto block = names.back().find("_block"); block != std::string::npos)
                        names.back().resize(block);
                }
                std::sort(names.begin(), names.end());
                std::vector<std::string> promised = {"lightbin_grid", "lightbin_image", "lightbin_slices"};
                if (masks) promised.push_back("lightbin_masks");
                else promised.insert(promised.end(), {"lightbin_bins", "lightbin_lists", "lightbin_tiles"});
                std::sort(promised.begin(), promised.end());
                names.erase(std::remove(names.begin(), names.end(), "lightbin_depths"), names.end());
                CHECK(names == promised);
            }
    CHECK(texts == 54);
}

TEST_CASE("a wrong option set is refused with a sentence that names the limit") {
    const std::string block =
        refusal({.storage = ListStorage::uniform_block, .max_tiles = 2049, .max_entries = 1});
    CHECK(has(block, "16392"));
    CHECK(has(block, "16384"));
    CHECK(has(refusal({.storage = ListStorage::uniform_block}), "max_tiles"));
    // Blocks consist of whole vectors of 16 bytes: 5 tiles are 40 bytes and take 48.
    for (const std::uint32_t bytes : {40u, 47u})
        CHECK(has(refusal({.tiles_in_uniform_block = true, .max_tiles = 5, .uniform_block_bytes = bytes}),
                  "32"));
    CHECK(has(text_of({.tiles_in_uniform_block = true, .max_tiles = 5, .uniform_block_bytes = 48}), "[3]"));
    // 2^64 bytes, which 64 bits hold as 0
    CHECK(has(refusal({.storage = ListStorage::uniform_block,
                       .format = {.encoding = ListEncoding::sentinel, .capacity = 1u << 31},
                       .max_tiles = 1u << 31}),
              "uniform block"));
    CHECK(has(refusal({.tiles = {1}}), "binding 1"));
    CHECK(has(refusal({.storage = ListStorage::texture_2d, .texture_width = 16385}), "16384"));
    CHECK(has(refusal({.tile_size = -1}), "-1"));
    for (const char* prefix : {"", "1a", "gl_a", "GL_", "a__", "a-b", "_a", "vola"})
        CHECK(has(refusal({.prefix = prefix}), "prefix"));
    CHECK(has(refusal({.prefix = std::string(1001, 'a')}), "1000"));
}

TEST_CASE("several views: the constants of each are a ViewConstants, and how many there may be is told") {
    const auto of_views = [](std::uint32_t views) {
        return SnippetOptions{.language = ShaderLanguage::glsl_vulkan, .views = views, .view_check = true};
    };
    const auto bound = shader_snippet(of_views(3))->bindings;
    const auto image = std::find_if(bound.begin(), bound.end(), [](const ShaderBinding& binding) {
        return binding.name == "lightbin_image_block";
    });
    REQUIRE(image != bound.end());
    CHECK(image->bytes == 3 * sizeof(ViewConstants));
    CHECK(has(text_of(of_views(512)), "view < 512u"));
    CHECK(has(refusal(of_views(513)), "1 to 512, and is 513"));
    CHECK(has(refusal(of_views(0)), "is 0"));
    // A block of bins has those of each view.
    const SnippetOptions block = {.storage = ListStorage::uniform_block,
                                 .slicing = Slicing::z_bins,
                                 .views = 2,
                                 .max_tiles = 2,
                                 .max_entries = 4,
                                 .max_slices = 7};
    CHECK(shader_snippet(block)->bindings.back().bytes == 2 * 7 * sizeof(BinRange));
}

TEST_CASE("shader_slices: the last slice, and boundaries as words that ascend as they do") {
    const std::vector<float> boundaries = {-1e30f, -1, -1e-41f, 0, 1e-41f, 1, 1.0000001f, 1e30f};
    const std::vector<std::uint32_t> words = shader_slices(*Slices::from_boundaries(boundaries));
    REQUIRE(words.size() == 4 + boundaries.size());
    CHECK(words[3] == boundaries.size());
    CHECK((std::is_sorted(words.begin() + 4, words.end(), std::less_equal<>())));  // none twice
    CHECK(shader_slices(*Slices::linear(1, 0, 1)) == std::vector<std::uint32_t>{0, 0, 0, 0});
}

TEST_CASE("shader_slices: the guess of a law is right but beside its boundaries") {
    for (const Slices& slices :
         {*Slices::exponential(24, 5, 200), *Slices::linear(1024, 0, 200), *Slices::exponential(256, 0.1f, 1e6f),
          *Slices::linear(32, -40, 70), *Slices::linear(2, 0, 1)}) {
        const std::vector<std::uint32_t> words = shader_slices(slices);
        const auto factor = [&](std::size_t i) { return detail::bit_cast<float>(words[i]); };
        const std::span<const float> ends = slices.boundaries();
        int wrong = 0;
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            const float depth = ends[i] + 0.5f * (ends[i + 1] - ends[i]);
            const float by_log2 = factor(0) != 0 ? factor(0) * std::log2(depth) : 0;
            wrong += static_cast<int>(by_log2 + factor(1) * depth + factor(2)) != slices.slice_at(depth);
        }
        CAPTURE(ends.size());
        CHECK(wrong == 0);
    }
}

TEST_CASE("reduction and cull shaders: what is off leaves no line") {
    const std::string reduction = reduce_shader({})->text, project = cull_shader(CullPass::project, {})->text;
    for (const char* absent : {"corner", "pixel.y =", "#version"})
        CHECK(!has(reduction, absent));
    only_in(reduce_shader({.samples = 4})->text, reduction, {"sampler2DMS"});
    only_in(reduce_shader({.skip_background = true})->text, reduction, {"== 0x3f800000u) { return"});
    only_in(reduce_shader({.reversed_z = true, .skip_background = true})->text, reduction, {"== 0u) { return"});
    only_in(cull_shader(CullPass::project, {.world_space = true})->text, project, {"column_x"});
    only_in(cull_shader(CullPass::project, {.count_in_buffer = true})->text, project, {"light_count"});
    only_in(cull_shader(CullPass::project, {.slicing = Slicing::clusters})->text, project, {"slices"});
    const std::string count = cull_shader(CullPass::count, {})->text;
    only_in(cull_shader(CullPass::count, {.depth_test = true})->text, count, {"z_bounds"});
    only_in(cull_shader(CullPass::fill, {})->text, count, {"lists["});
}

TEST_CASE("reduction and cull shaders need no more than every device has") {
    // Vulkan and OpenGL ES 3.1 guarantee 128 invocations and 4 storage buffers; ES only bindings 0 to 3.
    int texts = 0, sizes = 0;
    const auto check = [&](const Result<ShaderText>& made) {
        if (!made) return;
        ++texts;
        int buffers = 0;
        for (const ShaderBinding& binding : made->bindings) {
            const bool writable = binding.resource == ShaderResource::writable_buffer;
            if (!writable && binding.resource != ShaderResource::storage_buffer) continue;
            ++buffers;
            CHECK(binding.slot.binding < 4);
        }
        CHECK(buffers <= 4);
        for (const std::string size : {"@workgroup_size(", "[numthreads(", "local_size_x = "}) {
            const std::size_t at = made->text.find(size);
            if (at == made->text.npos) continue;
            ++sizes;
            CHECK(std::stoi(made->text.substr(at + size.size())) <= 128);
        }
    };
    for (int i = 0; i <= static_cast<int>(ShaderLanguage::wgsl); ++i) {
        const auto language = static_cast<ShaderLanguage>(i);
        check(reduce_shader({.language = language}));
        for (const Slicing slicing : {Slicing::none, Slicing::clusters, Slicing::z_bins})
            for (const bool test : {false, true})
                for (const CullPass pass : cull_passes)
                    check(cull_shader(pass, {.language = language,
                                             .world_space = true,
                                             .count_in_buffer = true,
                                             .depth_test = test,
                                             .slicing = slicing}));
    }
    CHECK(texts == 6 * (1 + 2 * 5 + 2 * 5));
    CHECK(sizes == texts);
}

TEST_CASE("view_constants: where a View has a point, and how near it may be") {
    glm::mat4 off_centre = glm::perspective(1.0f, 1.5f, 0.1f, 100.0f);
    off_centre[2][0] = 0.3f;
    off_centre[2][1] = -0.2f;
    const glm::mat4 orthographic = glm::ortho(-3.0f, 8.0f, -2.0f, 9.0f, -5.0f, 50.0f);
    for (const glm::mat4& projection : {off_centre, orthographic})
        for (const WindowOrigin origin : {WindowOrigin::lower_left, WindowOrigin::upper_left}) {
            const auto view =
                View::from_projection(projection, {1919, 1079}, {.tile_size = 7, .origin = origin});
            for (const int columns : {1, 16}) {
                const auto counted = View::from_projection(projection, {1919, 1079},
                                                           {.columns = columns, .rows = 9, .origin = origin});
                CHECK(view_constants(*counted).scale_y == doctest::Approx(view_constants(*view).scale_y));
                CHECK(view_constants(*counted).offset_x == doctest::Approx(view_constants(*view).offset_x));
            }
            const ViewConstants shader = view_constants(*view, 3);
            const ImagePoint there = view->image_point({0.4, -0.3, -2});
            const float depth = shader.forward * -2, by = shader.perspective > 0 ? depth : 1;
            CHECK(static_cast<double>(depth) == there.depth);
            CHECK(static_cast<double>(shader.scale_x * 0.4f / by + shader.offset_x) ==
                  doctest::Approx(there.x));
            CHECK(static_cast<double>(shader.scale_y * -0.3f / by + shader.offset_y) ==
                  doctest::Approx(there.y));
            CHECK(shader.tolerance == 3);
            CHECK(shader.nearest < view->near_depth());
            CHECK(shader.nearest > view->near_depth() - 0.1f);
        }
}

TEST_CASE("light_window: 1 at the light, 0 at the range, beyond it and for what is no distance") {
    const float endless = std::numeric_limits<float>::infinity(),
                no_number = std::numeric_limits<float>::quiet_NaN();
    CHECK(light_window(0, 4) == 1);
    CHECK(light_window(2, 4) == doctest::Approx(0.87890625));
    CHECK(light_window(1e30f, endless) == 1);
    for (const float range : {1e-30f, 0.1f, 3.0f, 1e30f}) {
        CHECK(light_window(range, range) == 0);
        CHECK(light_window(std::nextafter(range, endless), range) == 0);
        CHECK(light_window(0.999f * range, range) > 0);
    }
    for (const float range : {0.0f, -1.0f, no_number})
        CHECK(light_window(0, range) == 0);
    CHECK(light_window(no_number, 1) == 0);
}

TEST_CASE("texture_rows") {
    static_assert(texture_rows(0, 2048) == 1 && texture_rows(1, 2048) == 1 && texture_rows(2048, 2048) == 1);
    static_assert(texture_rows(2049, 2048) == 2 && texture_rows(4096, 2048) == 2 && texture_rows(5, 1) == 5);
    CHECK(texture_rows(~std::size_t{0}, 1) == ~std::size_t{0});
}
