// SPDX-License-Identifier: MIT
#include "frame_buffer.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace {

bool has_sample_shading() {
    if (epoxy_is_desktop_gl())
        return epoxy_gl_version() >= 40 || epoxy_has_gl_extension("GL_ARB_sample_shading");
    return epoxy_gl_version() >= 32 || epoxy_has_gl_extension("GL_OES_sample_shading");
}

GLenum target_of(int samples) {
    return samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
}

}  // namespace

GLuint new_texture(GLuint old, GLenum format, int width, int height, int samples) {
    glDeleteTextures(1, &old);
    GLuint made = 0;
    glGenTextures(1, &made);
    glBindTexture(target_of(samples), made);
    if (samples > 1) {
        if (epoxy_is_desktop_gl())  // OpenGL 3.3 has only this, OpenGL ES only the other
            glTexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, samples, format, width, height, GL_TRUE);
        else
            glTexStorage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, samples, format, width, height, GL_TRUE);
        return made;
    }
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0,
                 format == GL_RG32F ? GL_RG : GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return made;
}

FrameBuffer::FrameBuffer(int glsl) : glsl_(glsl) {
    glGenFramebuffers(1, &framebuffer_);
    glGenRenderbuffers(1, &colour_);
    glGenFramebuffers(1, &resolved_framebuffer_);
    glGenRenderbuffers(1, &resolved_);
}

void FrameBuffer::resize(int width, int height, int samples, GLenum colour_format) {
    const bool same =
        width == width_ && height == height_ && samples == samples_ && colour_format == colour_format_;
    if (same) return bind();

    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    GLint largest = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    if (std::max(width, height) > largest)
        throw std::runtime_error("this OpenGL draws at most " + std::to_string(largest) + " pixels a side");
    const bool many = samples > 1;
    if (many && glsl_ == 300)
        throw std::runtime_error("GLSL ES 3.00 has no multisampled textures, which --msaa needs for depths");
    glBindRenderbuffer(GL_RENDERBUFFER, colour_);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, many ? samples : 0, colour_format, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
    depth_ = new_texture(depth_, GL_DEPTH_COMPONENT32F, width, height, samples);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, target_of(samples), depth_, 0);
    GLint given = 0;  // OpenGL may give more samples than asked for: Z bounds would not be over all of them
    glGetIntegerv(GL_SAMPLES, &given);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE || (many && given != samples))
        throw std::runtime_error("this OpenGL cannot draw a picture of " + std::to_string(width) + " x " +
                                 std::to_string(height) + " pixels" +
                                 (many ? " with " + std::to_string(samples) + " samples each" : ""));
    if (many) {
        glBindFramebuffer(GL_FRAMEBUFFER, resolved_framebuffer_);
        glBindRenderbuffer(GL_RENDERBUFFER, resolved_);
        glRenderbufferStorage(GL_RENDERBUFFER, colour_format, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, resolved_);
    }
    width_ = width;
    height_ = height;
    samples_ = samples;
    colour_format_ = colour_format;
    bind();
}

void FrameBuffer::shade_samples(bool each) const {
    if (!each) {
        if (has_sample_shading()) glDisable(GL_SAMPLE_SHADING);
        return;
    }
    if (!has_sample_shading())
        throw std::runtime_error(
            "this OpenGL has no sample shading, which --msaa needs with Z bounds or --shade-samples");
    glEnable(GL_SAMPLE_SHADING);
    glMinSampleShading(1);
}

void FrameBuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glViewport(0, 0, width_, height_);
}

void FrameBuffer::bind_depth() const {
    glBindTexture(target_of(samples_), depth_);
}

// Binds what can be read. The samples are averaged as they are displayed, so that edges look even.
void FrameBuffer::bind_resolved() const {
    if (samples_ == 1) return;  // it is bound
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_framebuffer_);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_framebuffer_);
}

Picture FrameBuffer::read() const {
    Picture picture{width_, height_, {}};
    const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    std::vector<std::uint8_t> rgba(4 * pixels);  // OpenGL ES gives no RGB
    bind_resolved();
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    bind();
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) picture.rgb.push_back(rgba[i]);
    return picture;
}

void FrameBuffer::show() const {
    bind_resolved();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}
