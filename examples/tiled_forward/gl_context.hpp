// SPDX-License-Identifier: MIT
// An OpenGL context without a window, current on this thread from the start.
#pragma once

#include <epoxy/egl.h>

// What a context is asked for: 430 (storage buffers), 330 (texture buffers only), 310 or 300 (OpenGL ES), or
// 0: the best one there is but ES. Returns the GLSL version to write shaders in. Throws std::runtime_error with one line if there is no
// usable OpenGL.
class OffscreenContext {
public:
    explicit OffscreenContext(int wanted_glsl);
    ~OffscreenContext();
    OffscreenContext(const OffscreenContext&) = delete;
    OffscreenContext& operator=(const OffscreenContext&) = delete;

    int glsl() const { return glsl_; }

private:
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
    int glsl_ = 0;
};
