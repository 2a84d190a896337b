// SPDX-License-Identifier: MIT
// Passes that techniques share.
#pragma once

#include "shading.hpp"
#include "stage.hpp"

#include <lightbin/lightbin.hpp>

#include <cstdint>
#include <vector>

/// The picture and its depth, cleared and bound.
void begin_picture(Stage& stage);
/// Depth alone, of the opaque surfaces.
void depth_pre_pass(Stage& stage);
/// Lights opaque surfaces as they are drawn.
void shade_forward(Stage& stage, const LightLookup& lights);

/// A target of the G-buffer's width.
GLuint surface_target(Stage& stage, const char* name);
/// Surfaces to four of them; `depth`: a target.
void fill_g_buffer(Stage& stage, GLuint depth);
void read_g_buffer(Stage& stage, GLuint depth);
/// Lights the G-buffer's pixels, each once.
void shade_deferred(Stage& stage, const LightLookup& lights);

/// Z bounds from the depth target, in memory of their own.
class DepthBounds {
public:
    /// By lightbin::reduce_shader(), reading back two depths a tile.
    lightbin::ZBounds reduce(Stage& stage);

private:
    std::vector<float> depth_, min_, max_;
};

/// Lists by the papers' depth test: of a tile's lights those whose depths, from nearest to farthest, meet its Z bounds.
class IntervalLists {
public:
    /// Valid until the next call.
    lightbin::LightGrid<std::uint32_t> bin(Stage& stage, const lightbin::ZBounds& bounds);

private:
    lightbin::Binner<> binner_;
    std::vector<lightbin::ListRange> ranges_;
    std::vector<std::uint32_t> ids_;
};

/// The lists, for the shaders of listed_lights().
void upload_lists(Stage& stage, const lightbin::LightGrid<std::uint32_t>& grid);
/// The slices, and the bins of lists of ranks.
void upload_slices(Stage& stage, const lightbin::Slices& slices, const lightbin::LightRanks& ranks);
/// As deep as any light reaches.
float depth_of_lights(const Stage& stage);
