// SPDX-License-Identifier: MIT
// What a frame is drawn to: colour and depth, of one or several samples a pixel.
#pragma once

#include "picture.hpp"

#include <epoxy/gl.h>

class FrameBuffer {
public:
    // `glsl`: as OffscreenContext::glsl()
    explicit FrameBuffer(int glsl);

    // Makes it anew, unless it is as wanted, and binds it. Throws std::runtime_error with one line that names
    // what this OpenGL lacks.
    void resize(int width, int height, int samples, GLenum colour_format);

    // Whether the fragment shader runs for each sample, gl_FragCoord being the sample's, or once a pixel. Throws as resize().
    void shade_samples(bool each) const;

    // What is drawn goes here.
    void bind() const;

    // Binds the depths to the active texture unit, for a sampler2D, or with several samples a sampler2DMS.
    void bind_depth() const;

    int width() const { return width_; }
    int height() const { return height_; }
    int samples() const { return samples_; }

    // The picture: of each pixel the mean of its samples.
    Picture read() const;
    void show() const;  // in the window

private:
    void bind_resolved() const;

    int glsl_;
    int width_ = 0, height_ = 0, samples_ = 0;
    GLenum colour_format_ = 0;
    GLuint framebuffer_ = 0, colour_ = 0, depth_ = 0;
    GLuint resolved_framebuffer_ = 0, resolved_ = 0;  // one sample a pixel, where colour_ has several
};

// A texture that is drawn to and fetched from, in place of an older one.
GLuint new_texture(GLuint old, GLenum format, int width, int height, int samples = 1);
