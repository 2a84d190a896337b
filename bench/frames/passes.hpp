// SPDX-License-Identifier: MIT
// Passes that techniques share.
#pragma once

#include "shading.hpp"
#include "stage.hpp"

#include <lightbin/lightbin.hpp>

#include <cstdint>
#include <vector>

/// Clears and binds the picture and its depth buffer.
void begin_picture(Stage& stage);
/// Depth alone, of the opaque surfaces.
void depth_pre_pass(Stage& stage);
/// Draws the opaque surfaces and lights each fragment as it is drawn.
void shade_forward(Stage& stage, const LightLookup& lights);

/// A target of the G-buffer's width.
GLuint surface_target(Stage& stage, const char* name);
/// Draws surfaces to the four textures of the G-buffer and to the depth texture `depth`.
void fill_g_buffer(Stage& stage, GLuint depth);
void read_g_buffer(Stage& stage, GLuint depth);
/// Lights each pixel of the G-buffer once.
void shade_deferred(Stage& stage, const LightLookup& lights);

/// The least and greatest depth in each tile, made from the depth texture.
class DepthBounds {
public:
    /// Runs the shader of lightbin::reduce_shader() and reads back two depths for each tile.
    lightbin::ZBounds reduce(Stage& stage);

private:
    std::vector<float> depth_, min_, max_;
};

/// Lists by the papers' depth test: a tile's list has the lights whose depths overlap the depths drawn in the tile.
class IntervalLists {
public:
    /// Valid until the next call.
    lightbin::LightGrid<std::uint32_t> bin(Stage& stage, const lightbin::ZBounds& bounds);

private:
    lightbin::Binner<> binner_;
    std::vector<lightbin::ListRange> ranges_;
    std::vector<std::uint32_t> ids_;
};

/// Uploads the lists to the buffers that the shaders of listed_lights() read.
void upload_lists(Stage& stage, const lightbin::LightGrid<std::uint32_t>& grid);
/// Uploads the depth slices and, for lists of ranks, the range of ranks in each slice.
void upload_slices(Stage& stage, const lightbin::Slices& slices, const lightbin::LightRanks& ranks);
/// As deep as any light reaches.
float depth_of_lights(const Stage& stage);
