// SPDX-License-Identifier: MIT
// Tests that the shaders on the page docs/glsl_120.md draw the picture of every light in every fragment:
//   glsl_120 PAGE.md
#include <lightbin/lightbin.hpp>
#include <lightbin/shader.hpp>

#include "frame_buffer.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

namespace {

constexpr int width = 320, height = 200, light_count = 300;

[[noreturn]] void fail(const std::string& why) {
    std::fprintf(stderr, "%s\n", why.c_str());
    std::exit(1);
}

/// Returns the page's code blocks that are whole files, in order: vertex shader, fragment shader, look-up.
std::vector<std::string> files_in(const char* page) {
    std::ifstream file(page);
    const std::string text(std::istreambuf_iterator<char>(file), {}), begin = "```glsl\n";
    std::vector<std::string> files;
    for (std::size_t at = 0; (at = text.find(begin, at)) != std::string::npos;) {
        at += begin.size();
        files.push_back(text.substr(at, text.find("```", at) - at));
    }
    if (files.size() != 3) fail("the page has " + std::to_string(files.size()) + " shaders");
    return files;
}

/// Returns `text` with its first line, the #version, replaced by `other`.
std::string with_first_line(const std::string& text, const std::string& other) {
    return other + text.substr(text.find('\n') + 1);
}

GLuint link(const std::string& vertex, const std::vector<std::string>& fragments) {
    const GLuint program = glCreateProgram();
    char log[1000] = "";
    const auto attach = [&](GLenum stage, const std::string& text) {
        const GLuint shader = glCreateShader(stage);
        const char* begin = text.c_str();
        glShaderSource(shader, 1, &begin, nullptr);
        glCompileShader(shader);
        glGetShaderInfoLog(shader, sizeof log, nullptr, log);
        if (log[0] != '\0') fail(log + text);
        glAttachShader(program, shader);
    };
    attach(GL_VERTEX_SHADER, vertex);
    for (const std::string& fragment : fragments)
        attach(GL_FRAGMENT_SHADER, fragment);
    glLinkProgram(program);
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    if (log[0] != '\0') fail(log);
    return program;
}

/// A buffer texture at a unit.
template <class Elements> void bind(int unit, GLenum format, const Elements& elements) {
    GLuint buffer = 0, texture = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_TEXTURE_BUFFER, buffer);
    glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(elements.size_bytes()), elements.data(),
                 GL_STATIC_DRAW);
    glGenTextures(1, &texture);
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_BUFFER, texture);
    glTexBuffer(GL_TEXTURE_BUFFER, format, buffer);
}

/// Draws a floor and pillars as programs of GLSL 1.20's time do.
std::vector<std::uint8_t> draw(const FrameBuffer& target, GLuint program,
                               const lightbin::GridConstants& constants, const glm::mat4& projection,
                               const glm::mat4& camera) {
    glUseProgram(program);
    const auto at = [&](const char* name) { return glGetUniformLocation(program, name); };
    glUniform1i(at("lightbin_tiles"), 0);
    glUniform1i(at("lightbin_lists"), 1);
    glUniform1i(at("lights"), 2);
    glUniform1f(at("light_count"), light_count);
    glUniform4uiv(at("lightbin_grid"), 1, &constants.tile_size);
    glMatrixMode(GL_PROJECTION);
    glLoadMatrixf(glm::value_ptr(projection));
    glMatrixMode(GL_MODELVIEW);
    glLoadMatrixf(glm::value_ptr(camera));
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glBegin(GL_QUADS);
    glColor3f(0.3f, 0.3f, 0.25f);
    glNormal3f(0, 1, 0);
    for (const float x : {-30.0f, 30.0f})
        for (const float z : {-x, x})
            glVertex3f(x, 0, z);
    for (int i = 0; i < 100; ++i) {
        const auto x = static_cast<float>(i % 10 * 5 - 22), z = static_cast<float>(i / 10 * 5 - 22);
        glColor3f(0.2f, 0.2f + 0.03f * static_cast<float>(i % 7), 0.3f);
        glNormal3f(0, 0, 1);
        glVertex3f(x, 0, z);
        glVertex3f(x + 1.5f, 0, z);
        glVertex3f(x + 1.5f, 4, z);
        glVertex3f(x, 4, z);
    }
    glEnd();
    return target.read().rgb;
}

}  // namespace

int main(int, char** words) {
    // The context that a program gets by default: the compatibility profile.
    const EGLDisplay display =
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) fail("no usable OpenGL");
    const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
    if (!context || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
        fail("no OpenGL context");
    std::printf("%s, OpenGL %s\n", glGetString(GL_RENDERER), glGetString(GL_VERSION));

    const std::vector<std::string> files = files_in(words[1]);
    const auto snippet = lightbin::shader_snippet(
        {.language = lightbin::ShaderLanguage::glsl_330, .storage = lightbin::ListStorage::texel_buffer});
    const std::string &vertex = files[0], &engine = files[1],
                      look_up = with_first_line(files[2], "#version 330 compatibility\n" + snippet->text);
    const GLuint three_files = link(vertex, {engine, look_up});
    // The look-up's lines stand before the engine's text, whose version line moves up and becomes 3.30.
    const GLuint two_files = link(vertex, {look_up + with_first_line(engine, "")});
    const auto every = [&](int count) {
        const std::string loop =
            "for (int i = 0; i < " + std::to_string(count) + "; ++i) sum += shade(float(i));";
        return link(vertex, {engine, "#version 120\nvec3 shade(float light);\n"
                                     "vec3 sum_of_lights(float view_depth) { vec3 sum = vec3(0.0); " +
                                         loop + " return sum; }\n"});
    };

    const glm::mat4 projection = glm::perspective(1.0f, static_cast<float>(width) / height, 0.5f, 100.0f);
    const glm::mat4 camera = glm::lookAt(glm::vec3(10, 12, 30), glm::vec3(0, 0, 0), glm::vec3(0, 1, 0));
    std::minstd_rand random(3);
    const auto any = [&](float low, float high) { return std::uniform_real_distribution(low, high)(random); };
    std::vector<glm::vec4> lights(2 * light_count), spheres(light_count);
    for (int i = 0; i < light_count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        spheres[at] =
            glm::vec4(glm::vec3(camera * glm::vec4(any(-28, 28), any(0.2f, 3), any(-28, 28), 1)), any(2, 4));
        lights[2 * at] = spheres[at];
        lights[2 * at + 1] = glm::vec4(any(0, 1), any(0, 1), any(0, 1), 0);
    }
    const auto view = lightbin::View::from_projection(projection, {width, height});
    lightbin::Binner<> binner;
    const auto grid = binner.bin(*view, spheres);

    FrameBuffer target(330);
    target.resize(width, height, 1, GL_RGBA8);
    glViewport(0, 0, width, height);
    glEnable(GL_DEPTH_TEST);
    GLuint texture = 0;
    bind(0, GL_RG32UI, grid->ranges());
    bind(1, GL_R32UI, grid->ids());
    glGenTextures(1, &texture);
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, 2, light_count, 0, GL_RGBA, GL_FLOAT, lights.data());

    const auto picture = [&](GLuint program) {
        return draw(target, program, lightbin::grid_constants(*view), projection, camera);
    };
    const std::vector<std::uint8_t> all = picture(every(light_count));
    const auto bright =
        std::count_if(all.begin(), all.end(), [](int byte) { return 20 < byte && byte < 250; });
    const bool fewer_differ = picture(every(light_count - 20)) != all;
    const bool same[2] = {picture(three_files) == all, picture(two_files) == all};
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        fail("OpenGL error " + std::to_string(error));
    std::printf("%td bytes lit; without 20 lights: %s; a file more: %s; one fragment shader: %s\n", bright,
                fewer_differ ? "different" : "the same", same[0] ? "identical" : "DIFFERENT",
                same[1] ? "identical" : "DIFFERENT");
    return bright > 20000 && fewer_differ && same[0] && same[1] ? 0 : 1;
}
