// SPDX-License-Identifier: MIT
//
// lightbin: lights a scene with thousands of lights. Header-only C++20, standard library only.
//
// What it does. From a projection matrix and N light spheres it makes, for each screen tile, the list of
// lights that can touch what the tile shows: {offset, count} a tile and one light index list, two flat
// buffers that a forward, deferred or compute pass reads. It misses no light, whatever the camera or the
// numbers, and drops nothing in silence.
//
// What it does not do. No lighting model, no shadows, no GPU calls, no threads, no file formats: it fills
// memory and makes text.
//
// Step by step
//   1. View::from_projection(projection, {width, height}, {.tile_size = 32, ...})              view.hpp
//        Whenever the camera or the window's size changes. Any perspective or orthographic matrix; a Result,
//        as a matrix may be refused by name. It also tells the pixel and the tile of a point.
//   2. Optionally reduce_depth(view, {.depth = pixels}, {.min = min, .max = max}), or Z       z_bounds.hpp
//      bounds of your own
//   3. Binner<Options{...}> binner; once. Then each frame                                      binner.hpp
//        binner.bin(view, lights), with a depth test binner.bin(view, lights, {.bounds = *bounds}); and your
//        threads, if you lend some, last.
//        lights: vec4, Sphere or Spot array in view space, or view_space(yours, to_light),
//        or world_space(yours, view_matrix[, to_light])                                       lights.hpp
//        to_light makes a Sphere of a light, or a Spot, which is listed where its cone reaches   spot.hpp
//   4. Upload grid->ranges() and grid->ids(), or have grid->copy_to(ranges, ids)               light_grid.hpp
//      write them to buffers of yours.
//   For all depths without a depth buffer (no pre-pass, fog, glass): Slices::exponential(24, 5, 200)  slices.hpp
//      once, a Binner<Options{.slicing = Slicing::clusters}> or z_bins, and binner.bin(view, lights, {.slices = *slices}).
//   5. #include <lightbin/shader.hpp>. Put shader_snippet({...})->text in your shader, and bind what its
//      bindings list. docs/README.md leads to the steps, API by API.
//
// This header includes steps 1 to 4. What else there is, one include each:
//   shader.hpp        the shader text that reads the lists, in GLSL, HLSL and WGSL
//   encode.hpp        the lists in other forms: 8-bit ids, sentinel-terminated lists, bitmasks
//   shader_build.hpp  shaders that do the same as steps 2 and 3 on the GPU
//   advise.hpp        which tile size and options? advise(view, lights, costs[, bounds]) measures them
//
// Building. No compiler flags are needed. With gcc or clang there are kernels for SSE2, AVX2 and AVX-512 on
// x86-64, of which the machine's own is picked at run time, and for NEON on 64-bit ARM; elsewhere the scalar
// ones run. All give the same bytes. Define LIGHTBIN_NO_SIMD to leave them out, LIGHTBIN_ASSERT to take over the
// assertions. -ffast-math is refused where the compiler tells of it; docs/limits.md says where it does not. So is x87
// arithmetic, which 32-bit compilers may default to. Rounding modes, traps and flushed denormal numbers change nothing.
//
// Files of one program may be compiled for different processors. They share none of this library's functions: its names
// lie in an inline namespace that says what the file is compiled for. So its types can't be handed from one such file
// to another (a linker error says so), nor be declared without its headers.
//
// Sources: Olsson and Assarsson, "Tiled Shading", JGT 15(4), 2011. Billeter, Olsson and Assarsson, "Tiled
// Forward Shading", GPU Pro 4, 2013. Pettineo, "Light Indexed Deferred Rendering", 2012.
#pragma once

#include <lightbin/binner.hpp>
#include <lightbin/isa.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/options.hpp>
#include <lightbin/parallel.hpp>
#include <lightbin/result.hpp>
#include <lightbin/slices.hpp>
#include <lightbin/spot.hpp>
#include <lightbin/version.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>
