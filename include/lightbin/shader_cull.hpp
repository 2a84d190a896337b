// SPDX-License-Identifier: MIT
// Stability: may change.
// Compute shaders that make the whole light grid on the GPU, or masks, from lights in a buffer on the GPU:
// cull_shader() returns the text of each pass, and plan_cull() what a program needs to dispatch them. docs/gpu.md shows
// their use.
#pragma once

#include <lightbin/cull_options.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/shader.hpp>

#include <vector>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Returns the text of one pass, a whole compute shader except for `#version`, with the buffers to bind; or an
/// Error that names the limit that the options exceed. The name of a binding is the prefix, the buffer's name in
/// CullOptions and, in GLSL, `_block`; that of the constants ends in `grid_block`.
///
/// After cull_passes, the buffers hold what a Binner's LightGrid has in ranges() and ids(): the shader text of
/// shader_snippet() reads them. No light that reaches a cell is missing in its list, on the conditions of
/// docs/limits.md, and ids ascend. Lists also have lights that do not reach the cell, a few others than the Binner's:
/// see docs/gpu.md. The same input gives the same bytes on every run.
///
/// If the lists have more entries than there is room for (CullCapacity::entries), those that do not fit are left out:
/// the list of the first tile that does not fit is cut, and the lists after it are empty. CullTotals::entries is
/// what was needed.
///
/// After cull_mask_passes, the buffer `lists` holds LightMasks::words() without bins, for the shader text with
/// SnippetOptions::masks. There ids()[i] is i for all lights that there is room for, and lights out of view have no
/// bits. Columns and rows have the lights of a MaskBinner, and the few more that lists have. The depth test and
/// clusters have no part in masks.
inline Result<ShaderText> cull_shader(CullPass pass, const CullOptions& options = {});

/// Returns the constants, buffer sizes and group counts for a view. Where only the camera moves, not the viewport,
/// the tile size or the room, only CullPlan::constants changes.
///
/// options   of the texts; language, slots and prefix are not read
/// slices    with clusters, else null. The buffer `slices` holds shader_slices(*slices). With a depth test, `z_bounds`
///           holds shader_slabs(*slices) and behind it shader_edges(view)
/// to_view   with options.world_space the matrix from world space to view space, else null
///
/// Without clusters, `z_bounds` holds the minimum and maximum of each tile, as reduce_shader() (shader_reduce.hpp)
/// writes them, and with a depth test behind them shader_edges(view). With CullOptions::bounded it holds
/// shader_slabs(*slices), shader_edges(view), and behind them those of each tile.
///
/// Errors: what the options refuse; the matrix is not close enough to a rotation with a uniform scale; more than 65,535
/// slices; too many lights for the ids; `scratch` or the masks would have more than 2^32 - 1 words.
inline Result<CullPlan> plan_cull(const View& view, const CullOptions& options, const CullCapacity& room,
                                  const Slices* slices = nullptr, const Matrix* to_view = nullptr);

/// Returns the two sides of each tile column and then of each tile row, which the passes read with a depth test.
inline std::vector<ShaderEdges> shader_edges(const View& view);

/// Returns the depths of the slices, which the passes read with clusters and a depth test. They include the slices'
/// margin (see Slices::with_margin()).
inline std::vector<ShaderEdges> shader_slabs(const Slices& slices);

}}  // namespace lightbin

// The definitions.
#include <lightbin/detail/shaders/cull.hpp>
