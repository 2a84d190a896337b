// SPDX-License-Identifier: MIT
// Stability: settled.
//
// lightbin: finds the lights that can reach each screen tile. Header-only C++20, standard library only.
//
// What it does. From a projection matrix and N light spheres it makes, for each screen tile, the list of the lights
// that can reach what the tile shows: {offset, count} per tile and one light index list. A forward, deferred or compute
// pass reads these buffers. No light is missed, whatever the camera and the numbers, and nothing is dropped silently.
// It has no lighting, shadows, GPU calls, threads or file formats: it fills memory and writes shader text.
//
// Step by step
//   1. View::from_projection(projection, {width, height}, {.tile_size = 32, ...})              view.hpp
//        Call it whenever the camera or the window's size changes. It takes any perspective or orthographic matrix, and
//        returns a Result, since a matrix may be refused by name. A View also tells the pixel and the tile of a point.
//   2. Optional: reduce_depth(view, {.depth = pixels}, {.min = min, .max = max}), or your      z_bounds.hpp
//        own Z bounds.
//   3. Make a Binner<Options{...}> binner once. Then, each frame:                              binner.hpp
//        binner.bin(view, lights), or with a depth test binner.bin(view, lights, {.bounds = *bounds}). To use several
//        threads, add a Parallel as the last argument.                                         parallel.hpp
//        lights is an array of vec4, Sphere, Spot or Box in view space, or view_space(array, to_light), or
//        world_space(array, view_matrix[, to_light]), where to_light makes one of an element,  lights.hpp
//        or lights(spheres, spots, boxes). A Spot is listed where its cone reaches, a Box
//        where a sphere and an oriented box intersect.                                         sphere.hpp
//   4. Upload grid->ranges() and grid->ids(), or let grid->copy_to(ranges, ids) write to       light_grid.hpp
//        mapped buffers.
//      To cover all depths without a depth buffer (no pre-pass, fog, glass), make Slices       slices.hpp
//        once, such as Slices::exponential(24, 5, 200), use Options{.slicing = Slicing::clusters} or z_bins, and call
//        binner.bin(view, lights, {.slices = *slices}).
//   5. Include <lightbin/shader.hpp>, put shader_snippet({...})->text into your shader, and bind the resources that its
//        bindings list. docs/README.md leads on, graphics API by graphics API.
//
// This header includes steps 1 to 4. Further headers, to be included by name:
//   spot.hpp          to bin Spots: their kernels. And spheres around spots, tubes and rectangles
//   box.hpp           to bin Boxes: their kernels. And boxes around decals, probes, rooms, projectors and tubes
//   shader.hpp        shader text that reads the lists, in GLSL, HLSL and WGSL
//   masks.hpp         masks of the columns and rows of tiles, in place of lists
//   encode.hpp        the lists in other formats: 8-bit ids, sentinel-terminated lists
//   budget.hpp        lists limited to a number of lights per cell or per frame, by weights
//   shader_reduce.hpp  shader text that does step 2 on the GPU
//   shader_cull.hpp   shader text that does step 3 on the GPU, of lights there
//   dump.hpp          a frame as JSON text, for bug reports: its view, options, lights and lists
//   advise.hpp        advise(view, lights, costs[, bounds]) measures which tile size and options are best
//
// Building. No compiler flags are needed. The kernels for the widest instruction set (isa.hpp) that the machine has are
// chosen at run time, and all give the same bytes; g++ and clang without optimisation compile the scalar ones alone.
// Define LIGHTBIN_NO_SIMD to leave the vector kernels out, LIGHTBIN_NO_SCALAR to leave out the scalar ones where every
// machine has vectors (docs/install.md), and LIGHTBIN_ASSERT to replace the assertions. -ffast-math is an error where
// the compiler tells of it (docs/limits.md says where it does not), and so is x87 arithmetic, the default of some
// 32-bit compilers. The caller's rounding mode, traps and flushing of denormal numbers do not change the results. The
// files of a program may be compiled for different processors: the library's inline namespace is named after the
// instruction set, so these files share no functions. Its types cannot be passed between such files (a linker error),
// nor be declared without its headers.
//
// Stability, on the second line of each header in this folder. Settled: later versions compile the source that uses it,
// and give it the same meaning. May change: a new minor version may rename or remove things; the CHANGELOG then says
// what to write instead. The folder detail/ is no interface.
//
// Sources: Olsson and Assarsson, "Tiled Shading", JGT 15(4), 2011. Billeter, Olsson and Assarsson, "Tiled Forward
// Shading", GPU Pro 4, 2013. Pettineo, "Light Indexed Deferred Rendering", 2012.
#pragma once

#include <lightbin/binner.hpp>
#include <lightbin/version.hpp>
