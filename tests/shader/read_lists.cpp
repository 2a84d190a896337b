// SPDX-License-Identifier: MIT
// The snippet executed: every pixel reads its list, and it must be the CPU's list of the tile that the pixel
// lies in.
#include "texts.hpp"

#include "gl_context.hpp"
#include "gl_program.hpp"
#include "shaders.hpp"

#include <lightbin/lightbin.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

namespace {

struct Case {
    int width, height, tile_size;
};

// Where the viewport sits in the picture, which is a little larger.
constexpr int corner_x = 3, corner_y = 5;

const float projection[4][4] = {{1.2f, 0, 0, 0}, {0, 1.7f, 0, 0}, {0, 0, -1.01f, -1}, {0, 0, -0.2f, 0}};

std::vector<lightbin::Sphere> some_lights() {
    std::mt19937 engine(5);
    const auto number = [&](float low, float high) {
        return low + (high - low) * static_cast<float>(engine() >> 8) / 16777216.0f;
    };
    std::vector<lightbin::Sphere> lights;
    for (int i = 0; i < 300; ++i) {
        const float z = -number(0.5f, 20);
        lights.push_back({number(-1, 1) * z, number(-1, 1) * z, z, number(0.1f, 3)});
    }
    return lights;
}

// The buffers in the form that the snippet's comment asks for.
void bind(GLuint program, const SnippetForm& form, const std::vector<lightbin::Tile>& tiles,
          const std::vector<std::uint8_t>& ids) {
    const auto make_buffer = [](const void* data, std::size_t bytes) {
        GLuint buffer = 0;
        glGenBuffers(1, &buffer);
        glBindBuffer(GL_TEXTURE_BUFFER, buffer);
        glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_STATIC_DRAW);
        return buffer;
    };
    const GLuint tile_buffer = make_buffer(tiles.data(), tiles.size() * sizeof(lightbin::Tile));
    const GLuint id_buffer = make_buffer(ids.data(), ids.size());
    if (form.glsl >= 430) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(form.options.tiles.binding),
                         tile_buffer);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(form.options.lists.binding),
                         id_buffer);
        return;
    }
    const auto bind_texture = [&](GLenum unit, GLenum format, GLuint buffer, const char* name) {
        GLuint texture = 0;
        glGenTextures(1, &texture);
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_BUFFER, texture);
        glTexBuffer(GL_TEXTURE_BUFFER, format, buffer);
        glUniform1i(uniform(program, (std::string(form.options.prefix) + name).c_str()),
                    static_cast<int>(unit));
    };
    bind_texture(0, GL_RG32UI, tile_buffer, "tiles");
    bind_texture(1, form.options.format.ids == lightbin::IdWidth::u16 ? GL_R16UI : GL_R32UI, id_buffer,
                 "lists");
}

template <lightbin::Index index> void check_form(const SnippetForm& form, const Case& size) {
    const auto view =
        lightbin::View::from_projection(projection, {size.width, size.height},
                                        {.tile_size = size.tile_size,
                                         .origin = form.options.flip_y ? lightbin::WindowOrigin::upper_left
                                                                       : lightbin::WindowOrigin::lower_left});
    REQUIRE(view);
    lightbin::Binner<lightbin::Options{.index = index}> binner;
    const auto grid = binner.bin(*view, some_lights());
    REQUIRE(grid);
    REQUIRE(!grid->indices().empty());

    const GLuint program = link_program(overlay_vertex_shader(form.glsl), list_reader(form));
    glUseProgram(program);
    const auto words = lightbin::shader_grid(*view);
    glUniform4uiv(uniform(program, (std::string(form.options.prefix) + "grid").c_str()), 1, &words.tile_size);
    glUniform2f(uniform(program, "corner"), corner_x, corner_y);

    const std::vector<lightbin::Tile> tiles(grid->tiles().begin(), grid->tiles().end());
    const auto id_bytes = std::as_bytes(grid->indices());
    std::vector<std::uint8_t> ids((id_bytes.size() + 3) / 4 * 4);
    std::memcpy(ids.data(), id_bytes.data(), id_bytes.size());
    bind(program, form, tiles, ids);

    const int full_width = size.width + corner_x, full_height = size.height + corner_y;
    GLuint framebuffer = 0, picture = 0;
    glGenFramebuffers(1, &framebuffer);
    glGenRenderbuffers(1, &picture);
    glBindRenderbuffer(GL_RENDERBUFFER, picture);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32UI, full_width, full_height);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, picture);
    REQUIRE(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE);
    glViewport(corner_x, corner_y, size.width, size.height);
    GLuint vertex_array = 0;
    glGenVertexArrays(1, &vertex_array);
    glBindVertexArray(vertex_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<std::array<std::uint32_t, 4>> pixels(static_cast<std::size_t>(size.width) *
                                                     static_cast<std::size_t>(size.height));
    glReadPixels(corner_x, corner_y, size.width, size.height, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                 pixels.data());
    REQUIRE(glGetError() == GL_NO_ERROR);

    // OpenGL's row 0 is the lowest; the view's is at its window origin.
    int wrong = 0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const int row = form.options.flip_y ? size.height - 1 - y : y;
            const int tx = x / size.tile_size, ty = row / size.tile_size;
            std::uint32_t hash = 2166136261u, sum = 0, place = 0;
            for (const std::uint32_t id : grid->lights_in(tx, ty)) {
                hash = (hash ^ id) * 16777619u;
                sum += ++place * id;
            }
            const std::array<std::uint32_t, 4> expected = {static_cast<std::uint32_t>(tx | ty << 16), place,
                                                           hash, sum};
            if (pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                       static_cast<std::size_t>(x)] != expected)
                ++wrong;
        }
    CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("each pixel reads the list of its tile") {
    for (const SnippetForm& form : snippet_forms()) {
        CAPTURE(form.name);
        for (const Case& size : {Case{333, 217, 16}, Case{64, 48, 8}, Case{101, 67, 13}, Case{37, 29, 1},
                                 Case{1, 1, 32}, Case{50, 30, 64}}) {
            CAPTURE(size.width);
            CAPTURE(size.tile_size);
            const OffscreenContext context(form.glsl);
            if (form.options.format.ids == lightbin::IdWidth::u16)
                check_form<lightbin::Index::u16>(form, size);
            else
                check_form<lightbin::Index::u32>(form, size);
        }
    }
}
