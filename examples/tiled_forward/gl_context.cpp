// SPDX-License-Identifier: MIT
#include "gl_context.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

OffscreenContext::OffscreenContext(int wanted_glsl) {
    setenv("EGL_LOG_LEVEL", "fatal", 0);  // what goes wrong is said below, in one line
    // epoxy would abort on a function that is not there, so ask first.
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base") ||
        !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        throw std::runtime_error("no usable OpenGL: this EGL cannot draw without a window system");
    display_ = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr))
        throw std::runtime_error("no usable OpenGL: EGL does not start");

    for (const int glsl : {430, 330, 310, 300}) {
        const bool es = glsl < 330;
        if (wanted_glsl != glsl && (wanted_glsl != 0 || es)) continue;
        eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API);
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     glsl / 100,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     glsl / 10 % 10,
                                     es ? EGL_NONE : EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_NONE};
        context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
        glsl_ = glsl;
        if (context_ != EGL_NO_CONTEXT) break;
    }
    if (context_ == EGL_NO_CONTEXT || !eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
        eglTerminate(display_);
        const std::string wanted = wanted_glsl == 430   ? "4.3 core"
                                   : wanted_glsl == 310 ? "ES 3.1"
                                   : wanted_glsl == 300 ? "ES 3.0"
                                                        : "3.3 core";
        throw std::runtime_error("no usable OpenGL: there is no OpenGL " + wanted + " context here");
    }
}

OffscreenContext::~OffscreenContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_);
}
