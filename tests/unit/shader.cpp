// The snippet's text: what is off leaves no line. That it compiles and reads the right lists is tested in
// tests/shader.
#include <doctest/doctest.h>

#include <lightbin/shader.hpp>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/mat4x4.hpp>

#include <string>

using namespace lightbin;

namespace {
bool has(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}
}  // namespace

TEST_CASE("each option brings its own lines and no others") {
    const std::string storage = shader_snippet();
    CHECK(has(storage, "layout(std430, binding = 0)"));
    CHECK(has(storage, "layout(std430, binding = 1)"));
    CHECK(!has(storage, "sampler"));
    CHECK(!has(storage, "pixel.y ="));
    CHECK(!has(storage, "0xffff"));
    CHECK(!has(storage, "#version"));

    const std::string texture = shader_snippet({.language = ShaderLanguage::glsl_330, .index = Index::u16});
    CHECK(has(texture, "uniform usamplerBuffer lightbin_tiles;"));
    CHECK(!has(texture, "buffer lightbin"));
    CHECK(!has(texture, "0xffff"));  // an R16UI texture is already one id a texel

    CHECK(has(shader_snippet({.index = Index::u16}), "0xffff"));
    CHECK(has(shader_snippet({.origin = WindowOrigin::upper_left}), "pixel.y ="));
    const std::string bound = shader_snippet({.tiles_binding = 5, .indices_binding = 9});
    CHECK(has(bound, "binding = 5"));
    CHECK(has(bound, "binding = 9"));
}

TEST_CASE("every name declared carries the prefix") {
    for (const ShaderLanguage language : {ShaderLanguage::glsl_330, ShaderLanguage::glsl_430}) {
        const std::string text = shader_snippet({.language = language, .prefix = "my_"});
        CHECK(!has(text, "lightbin"));
        for (const char* name : {"my_grid", "my_tiles", "my_indices", "my_list(", "my_light("})
            CHECK(has(text, name));
    }
}

TEST_CASE("shader_grid") {
    const auto view =
        View::from_projection(glm::perspective(1.0f, 1.5f, 0.1f, 100.0f), {1919, 1079}, {.tile_size = 16});
    CHECK(shader_grid(*view) == std::array<std::uint32_t, 4>{16, 120, 1919, 1079});
}
