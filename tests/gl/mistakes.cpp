// SPDX-License-Identifier: MIT
// Makes every mistake in the table of docs/troubleshooting.md, and checks that exactly the diagnostics that the page
// names report it. Where nothing is wrong, none reports anything.
#include <stdexcept>

struct AssertionFailed : std::logic_error {
    using logic_error::logic_error;
};
#define LIGHTBIN_ASSERT(condition) ((condition) ? void() : throw AssertionFailed(#condition))

#include "frame_buffer.hpp"
#include "gl_context.hpp"
#include "gl_program.hpp"
#include "set_ups.hpp"

#include <epoxy/gl.h>

#include <doctest/doctest.h>

#include <glm/gtc/type_ptr.hpp>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

using lightbin::detail::replaced;

struct Seen {
    std::set<std::string> by;  // what tells
    int drawn = 0, misplaced = 0, unlit = 0, lit = 0;
};

const char* const vertex_text = R"(#version 330 core
uniform mat4 view;
uniform mat4 projection;
layout(location = 0) in vec3 point;
SAMPLING out vec3 position;
void main() {
    position = vec3(view * vec4(point, 1.0));
    gl_Position = projection * vec4(position, 1.0);
}
)";

// Red: a little where something is drawn, and the view check; green: the list check; blue: what the list's lights give.
const char* const fragment_text = R"(
uniform vec4 spheres[48];
uniform uint lights;
SAMPLING in vec3 position;
out vec4 colour;

float shade(uint id) {
    vec4 sphere = spheres[id];
    float apart = distance(sphere.xyz, position);
    return WINDOW / (1.0 + apart * apart);
}

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    colour = vec4(0.1, 0.0, 0.0, 1.0);
    if (!lightbin_check_view(pixel, position)) colour.r = 1.0;
    lightbin_for_each_missing(light, lights, pixel, DEPTH)
        if (shade(light.id) > 0.0) colour.g = 1.0;
    lightbin_for_each_light(light, pixel, DEPTH)
        if (light.id < 48u) colour.b += shade(light.id);
}
)";

// Returns the triangles of a floor, a wall behind it, and a small board just before the eye.
std::vector<glm::vec3> triangles(const Setup& setup) {
    std::vector<glm::vec3> points;
    const auto board = [&](const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b) {
        for (const glm::vec3& point :
             {corner, corner + a, corner + b, corner + b, corner + a, corner + a + b})
            points.push_back(point);
    };
    const float s = setup.floor_size;
    board({-s, -1, s}, {2 * s, 0, 0}, {0, 0, -2 * s});
    board({-20, -1, -14}, {40, 0, 0}, {0, 4, 0});
    const glm::vec3 corner = before_eye(0.02f, 0.0f, -0.25f);
    board(corner, before_eye(0.12f, 0.0f, -0.35f) - corner, before_eye(0.02f, 0.05f, -0.25f) - corner);
    return points;
}

class Stage {
public:
    Stage() {
        GLuint vertices = 0;
        glGenVertexArrays(1, &vertices);
        glBindVertexArray(vertices);
        glGenBuffers(1, &corners_);
        glBindBuffer(GL_ARRAY_BUFFER, corners_);
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
        glGenBuffers(4, buffers_);
        glGenTextures(4, textures_);
        glEnable(GL_DEPTH_TEST);
    }

    Seen draw(const Setup& setup) {
        Seen seen;
        const auto snippet = lightbin::shader_snippet(setup.shader);
        const auto view =
            lightbin::View::from_projection(setup.given_projection, setup.given_size, setup.view_options);
        if (setup.looked_at && (!snippet || !view)) return {.by = {"error"}};
        const lightbin::ViewSummary summary = view->summary();
        if (summary.looks_transposed || summary.looks_like_view_matrix || summary.looks_turned ||
            summary.pixels_not_square)
            seen.by.insert("summary");
        const bool binned =
            setup.shader.slicing == lightbin::Slicing::clusters ? bin(clusters_, setup, *view, seen)
            : setup.shader.slicing == lightbin::Slicing::z_bins ? bin(z_bins_, setup, *view, seen)
            : setup.narrow_ids                                  ? bin(narrow_, setup, *view, seen)
                                                                : bin(wide_, setup, *view, seen);
        if (!binned) return {.by = {"error"}};
        const auto picture = [&] {
            start(setup, snippet->text);
            set_constants(setup, *view);
            glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(triangles(setup).size()));
        };
        picture();
        if (setup.logarithmic) {  // the first was for its depths
            bin(tested_, setup, *view, seen, bounds_of_logarithms(*view, *setup.logarithmic));
            picture();
        }
        count(setup, seen);
        return seen;
    }

private:
    // Z bounds of what was drawn, by way of a logarithmic depth buffer.
    lightbin::ZBounds bounds_of_logarithms(const lightbin::View& view, lightbin::DepthFormat format) {
        std::vector<float> depths(width * height);
        glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
        const float scale = std::log2(1 + view.far_depth());
        for (float& depth : depths) {
            depth = std::log2(1 + view.view_depths(static_cast<double>(depth), static_cast<double>(depth)).min) / scale;
            if (format == lightbin::DepthFormat::view_depth) depth = std::exp2(depth * scale) - 1;
        }
        for (std::vector<float>& side : bounds_)
            side.resize(view.tile_count());
        return *lightbin::reduce_depth(view, {.depth = depths, .format = format}, {bounds_[0], bounds_[1]});
    }

    // Uploads the lists of lights. Returns whether there are any.
    template <lightbin::Options options>
    bool bin(lightbin::Binner<options>& binner, const Setup& setup, const lightbin::View& view, Seen& seen,
             const lightbin::ZBounds& bounds = {}) {
        const auto as_is = [](const lightbin::Sphere& light) { return light; };
        const auto slices = *lightbin::Slices::exponential(16, 0.3f, 25);
        const auto grid = binner.bin(view, lightbin::world_space(setup.given_lights, setup.given_view, as_is),
                                     lightbin::inputs_for<options>(bounds, slices));
        if (setup.looked_at && !grid) return false;
        if (grid->light_counts().rejected > 0) seen.by.insert("counts");
        if (setup.tiles_uploaded) upload(0, grid->ranges().data(), grid->ranges().size_bytes());
        upload(1, grid->ids().data(), grid->ids().size_bytes());
        const std::vector<std::uint32_t> words = lightbin::shader_slices(slices);
        upload(2, words.data(), 4 * words.size());
        upload(3, grid->ranks().bins.data(), grid->ranks().bins.size_bytes());
        order_.assign(grid->ranks().order.begin(), grid->ranks().order.end());
        return true;
    }

    void upload(int which, const void* data, std::size_t bytes) const {
        glBindBuffer(GL_TEXTURE_BUFFER, buffers_[which]);
        glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(bytes + 16), nullptr, GL_STREAM_DRAW);
        glBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(which));
        glBindTexture(GL_TEXTURE_BUFFER, textures_[which]);
        const auto format = which % 3 == 0 ? lightbin::TexelFormat::rg32ui : lightbin::TexelFormat::r32ui;
        glTexBuffer(GL_TEXTURE_BUFFER, lightbin::gl_format(format).internal, buffers_[which]);
    }

    void start(const Setup& setup, const std::string& snippet) {
        const std::string sampling = setup.centroid ? "centroid" : "",
                          window = setup.windowed ? "lightbin_window(apart, sphere.w)" : "1.0";
        std::string text = replaced(replaced(fragment_text, "SAMPLING", sampling), "WINDOW", window);
        text = "#version 330 core\n" + snippet +
               replaced(text, "DEPTH", setup.depth_grows ? "-position.z" : "position.z");
        GLuint& program = programs_[text + sampling];
        if (program == 0) program = link_program(replaced(vertex_text, "SAMPLING", sampling), text);
        program_ = program;
        glUseProgram(program);
        target_.resize(2 * width, 2 * height, setup.samples, GL_RGBA8);
        glViewport(setup.corner[0], setup.corner[1], width, height);
        const bool reversed = setup.projection[3][2] > 0 && setup.projection[2][3] != 0;
        glDepthFunc(reversed ? GL_GREATER : GL_LESS);
        glClearDepth(reversed ? 0 : 1);
        glClearColor(0, 0, 0, 0);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        const std::vector<glm::vec3> points = triangles(setup);
        glBindBuffer(GL_ARRAY_BUFFER, corners_);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(points.size() * sizeof points[0]),
                     points.data(), GL_STREAM_DRAW);
    }

    // Uniforms that are not set are 0, as in a program that was just linked.
    void set_constants(const Setup& setup, const lightbin::View& view) const {
        const lightbin::GridConstants grid = setup.grid_set
                                              ? lightbin::grid_constants(view, setup.corner[0], setup.corner[1])
                                              : lightbin::GridConstants{};
        const lightbin::ViewConstants image =
            setup.image_set ? lightbin::view_constants(view) : lightbin::ViewConstants{};
        const auto place = [&](const char* name) { return glGetUniformLocation(program_, name); };
        glUniform4uiv(place("lightbin_grid"), 1, &grid.tile_size);
        glUniform2iv(place("lightbin_corner"), 1, &grid.corner_x);
        glUniform4fv(place("lightbin_image"), 1, &image.scale_x);
        glUniform4fv(place("lightbin_depths"), 1, &image.forward);
        glUniform1i(place("lightbin_tiles"), 0);
        glUniform1i(place("lightbin_lists"), setup.samplers_set ? 1 : 0);
        glUniform1i(place("lightbin_slices"), 2);
        glUniform1i(place("lightbin_bins"), 3);
        glUniformMatrix4fv(place("view"), 1, GL_FALSE, glm::value_ptr(setup.view));
        glUniformMatrix4fv(place("projection"), 1, GL_FALSE, glm::value_ptr(setup.projection));
        std::vector<glm::vec4> spheres;
        for (const lightbin::Sphere& light : setup.lights)
            spheres.push_back(
                {glm::vec3(setup.view * glm::vec4(light.x, light.y, light.z, 1)), light.radius});
        // Sorts the lights by rank in depth. Lights out of view follow; no list has them.
        const std::vector<glm::vec4> unordered = spheres;
        for (std::size_t rank = 0; setup.ranked && rank < order_.size(); ++rank)
            spheres[rank] = unordered[order_[rank]];
        glUniform1ui(place("lights"), static_cast<GLuint>(order_.empty() ? light_count : order_.size()));
        glUniform4fv(place("spheres"), light_count, glm::value_ptr(spheres[0]));
    }

    void count(const Setup& setup, Seen& seen) {
        const Picture picture = target_.read();
        const auto column = static_cast<std::size_t>(setup.corner[0]),
                   row = static_cast<std::size_t>(setup.corner[1]);
        for (std::size_t y = row; y < row + height; ++y)
            for (std::size_t x = column; x < column + width; ++x) {
                const std::uint8_t* const pixel = &picture.rgb[3 * (y * 2 * width + x)];
                seen.drawn += pixel[0] > 0;
                seen.misplaced += pixel[0] > 30;
                seen.unlit += pixel[1] > 0;
                seen.lit += pixel[2] > 0;
            }
        if (seen.misplaced > 0) seen.by.insert("view check");
        if (seen.unlit > 0) seen.by.insert("list check");
        if (glGetError() != GL_NO_ERROR) throw std::runtime_error("OpenGL reports an error");
    }

    GLuint corners_ = 0, program_ = 0;
    GLuint buffers_[4] = {}, textures_[4] = {};  // tiles, lists, slices, bins
    FrameBuffer target_{330};
    std::map<std::string, GLuint> programs_;
    std::vector<std::uint32_t> order_;  // of the lights, with z-bins
    std::vector<float> bounds_[2];
    lightbin::Binner<> wide_;
    lightbin::Binner<lightbin::Options{.depth_test = true}> tested_;
    lightbin::Binner<lightbin::Options{.ids = lightbin::IdWidth::u16}> narrow_;
    lightbin::Binner<lightbin::Options{.slicing = lightbin::Slicing::clusters}> clusters_;
    lightbin::Binner<lightbin::Options{.slicing = lightbin::Slicing::z_bins}> z_bins_;
};

std::vector<std::string> split(const std::string& text, const std::string& between) {
    std::vector<std::string> parts;
    std::size_t at = 0;
    for (std::size_t end; (end = text.find(between, at)) != text.npos; at = end + between.size())
        parts.push_back(text.substr(at, end - at));
    parts.push_back(text.substr(at));
    return parts;
}

// A row of the page.
struct Row {
    std::string picture;
    std::set<std::string> by;
};

// Returns the rows of the page's table, by their cell "What is wrong".
std::map<std::string, Row> rows_of(const char* path) {
    std::map<std::string, Row> rows;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        const std::vector<std::string> cells = split(line, " | ");
        if (cells.size() != 4 || cells[1] == "What is wrong") continue;
        const std::vector<std::string> by = split(cells[2], ", ");
        rows[cells[1]] = {cells[0].substr(2), {by.begin(), by.end()}};  // after the first "| "
    }
    rows.erase("---");
    return rows;
}

// Returns whether the picture is black, wrong or right, as the row says.
bool looks_so(const std::string& picture, const Seen& seen, int lit_when_right) {
    const bool dark = 10 * seen.lit < lit_when_right;
    return picture == "-"                                                        ? seen.drawn == 0
           : picture.starts_with("right")                                        ? seen.unlit == 0 && !dark
           : picture.starts_with("black") || picture.starts_with("nearly black") ? seen.drawn > 0 && dark
                                                                                 : !dark || seen.drawn == 0;
}

}  // namespace

TEST_CASE("every mistake of the page is told of by what the page says, and where there is none, nothing is") {
    const OffscreenContext context(330);
    Stage stage;
    std::map<std::string, Row> rows = rows_of(LIGHTBIN_PAGE);
    int lit_when_right = 0;
    const auto draw = [&](const Case& each) {
        Setup setup;
        each.change(setup);
        try {
            return stage.draw(setup);
        } catch (const AssertionFailed&) {
            return Seen{.by = {"assertion"}};
        }
    };
    for (const Case& each : right_ones()) {
        CAPTURE(each.name);
        const Seen seen = draw(each);
        if (each.name == "plain") lit_when_right = seen.lit;
        CHECK(seen.by.empty());
        CHECK(seen.drawn >= width * height / 3);
        CHECK(seen.lit >= seen.drawn / 2);
    }
    for (const Case& each : mistakes()) {
        CAPTURE(each.name);
        const Seen seen = draw(each);
        REQUIRE(rows.count(each.name) == 1);
        const Row& row = rows[each.name];
        CHECK(row.by == (seen.by.empty() ? std::set<std::string>{"nothing"} : seen.by));
        CAPTURE(row.picture);
        CHECK(looks_so(row.picture, seen, lit_when_right));
        rows.erase(each.name);
    }
    for (const auto& row : rows)
        FAIL_CHECK("on the page, and not made here: ", row.first);
}
