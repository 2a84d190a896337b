// SPDX-License-Identifier: MIT
// Shader texts to a program.
#pragma once

#include <epoxy/gl.h>

#include <string>

// Throws std::runtime_error with the first line of the compiler's message.
GLuint link_program(const std::string& vertex_text, const std::string& fragment_text);
GLuint link_compute_program(const std::string& text);

// The place of a uniform. One that the program does not have is a mistake in this program: it throws too.
GLint uniform(GLuint program, const char* name);
