// SPDX-License-Identifier: MIT
#include "gl_program.hpp"

#include <array>
#include <stdexcept>

namespace {

[[noreturn]] void fail(const std::string& log) {
    throw std::runtime_error("OpenGL refuses a shader: " + log.substr(0, log.find('\n')));
}

void attach(GLuint program, GLenum stage, const std::string& text) {
    const GLuint shader = glCreateShader(stage);
    const char* const lines = text.c_str();
    glShaderSource(shader, 1, &lines, nullptr);
    glCompileShader(shader);
    GLint compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) {
        std::array<char, 1024> log{};
        glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
        fail(log.data());
    }
    glAttachShader(program, shader);
    glDeleteShader(shader);  // when the program goes
}

GLuint link(GLuint program) {
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked) {
        std::array<char, 1024> log{};
        glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
        fail(log.data());
    }
    return program;
}

}  // namespace

GLuint link_program(const std::string& vertex_text, const std::string& fragment_text) {
    const GLuint program = glCreateProgram();
    attach(program, GL_VERTEX_SHADER, vertex_text);
    attach(program, GL_FRAGMENT_SHADER, fragment_text);
    return link(program);
}

GLuint link_compute_program(const std::string& text) {
    const GLuint program = glCreateProgram();
    attach(program, GL_COMPUTE_SHADER, text);
    return link(program);
}

GLint uniform(GLuint program, const char* name) {
    const GLint location = glGetUniformLocation(program, name);
    if (location < 0) throw std::runtime_error("a shader has no uniform " + std::string(name));
    return location;
}
