// SPDX-License-Identifier: MIT
// What every tier (the kernels of one instruction set) includes: the headers that the kernels' texts (.inl) need, the
// types of the kernels, and a table of the shuffles that move chosen elements to the front of a vector.
#pragma once

#include <lightbin/detail/depth/slice_table.hpp>
#include <lightbin/detail/engine/scatter.hpp>
#include <lightbin/detail/project/sphere_around.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

// What kernels.inl hands out of each tier.
using ProjectKernel = void (*)(const Camera& camera, const LightSource& source, std::uint32_t first,
                               std::uint32_t count, const FootprintArrays& out, ProjectCounts& counts);
using DepthBucketsKernel = void (*)(const DepthBuckets& to, float z_sign, const FootprintArrays& lights,
                                   const std::uint32_t* ids, std::uint32_t count, LightDepths& out);
using DepthKernel = void (*)(const DepthRows& depth, float skipped, float* lower, float* upper);
template <class Id>
using BinKernel = std::uint64_t (*)(const BinJob& job, Scratch& scratch, const BinShare<Id>& share);

/// Projects in double light i of a chunk, a sphere for which float has no error bound: one that crosses the near plane
/// or contains the eye, a tiny, huge or infinite one, or bad input, which it counts. Stores its rectangle, and returns
/// whether it is in view. No tier has vectors for these few lights: see project/spheres_in_double.hpp.
///
/// sphere  the light in view space
bool project_in_double(const Camera& camera, const Sphere& sphere, std::uint32_t i, ChunkRects& rects,
                       ProjectCounts& counts);

/// Projects in double light i of a chunk, a box for which float has no error bound. Sets the light's bit in
/// chunk.visible if it is in view.
///
/// ball   the sphere that cuts the box, in view space after the camera's signs
/// given  the box as it is given
/// to     where to store the box in view space, but for ViewBox::around; may be null
void project_box_in_double(const Camera& camera, const WorldToView* to_view, const Sphere& ball, const Box& given,
                           std::uint32_t i, ProjectedChunk& chunk, ViewBox* to);

/// For each value of a byte, the positions of its set bits in ascending order, one in each byte of a word. As indices
/// of a shuffle they compact eight elements: they move the elements whose bit is set to the front.
struct SetBits {
    std::uint64_t of[256];
};
inline constexpr SetBits set_bits = [] {
    SetBits table = {};
    for (unsigned byte = 1; byte < 256; ++byte)
        table.of[byte] = table.of[byte & (byte - 1)] << 8 | static_cast<unsigned>(std::countr_zero(byte));
    return table;
}();

}}}  // namespace lightbin::detail
