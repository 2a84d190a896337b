// SPDX-License-Identifier: MIT
#include "gl_context.hpp"

#include <cstdlib>
#include <initializer_list>
#include <stdexcept>
#include <string>

namespace {

// epoxy would abort on a function that is not there, so ask first.
bool has(std::initializer_list<const char*> extensions) {
    for (const char* const name : extensions)
        if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, name)) return false;
    return true;
}

bool starts(EGLDisplay display) {
    return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr);
}

// Mesa lists the CPU as a device, too.
bool is_cpu(EGLDeviceEXT device) {
    const char* const extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
    return extensions && std::string(extensions).find("EGL_MESA_device_software") != std::string::npos;
}

// Without a window system: a GPU, or Mesa's way, which takes the CPU where Mesa itself drives no GPU. So GPUs are asked for
// first: their drivers need not be Mesa's.
EGLDisplay open_display() {
    const bool surfaceless = has({"EGL_EXT_platform_base", "EGL_MESA_platform_surfaceless"}),
               devices = has({"EGL_EXT_platform_base", "EGL_EXT_platform_device",
                              "EGL_EXT_device_enumeration", "EGL_EXT_device_query"});
    if (!surfaceless && !devices)
        throw std::runtime_error("no usable OpenGL: this EGL cannot draw without a window system");
    EGLDeviceEXT found[16];
    EGLint count = 0;
    if (devices && eglQueryDevicesEXT(16, found, &count))
        for (const EGLDeviceEXT* device = found; device != found + count; ++device) {
            if (is_cpu(*device)) continue;
            const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, *device, nullptr);
            if (starts(display)) return display;
        }
    if (surfaceless) {
        const EGLDisplay display =
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (starts(display)) return display;
    }
    throw std::runtime_error("no usable OpenGL: EGL does not start");
}

}  // namespace

OffscreenContext::OffscreenContext(int wanted_glsl) {
    setenv("EGL_LOG_LEVEL", "fatal", 0);  // what goes wrong is said below, in one line
    display_ = open_display();
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
