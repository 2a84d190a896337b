// SPDX-License-Identifier: MIT
// Whole builds through lightbin.h over those of the C++ side, in turns in one run, on sets of lights in structs of the
// caller's: what docs/c.md says of speed. `c_side [SECONDS]` takes so long for each case, .5 if not given, and writes a
// line for it: options, lights, what they are, microseconds a build in C++, and the ratio. bench/c_side.awk makes the
// table.
//
// Where arrays happen to lie in a page makes a build up to a twentieth faster or slower, with the same code. So each
// ratio is the median of several placements: both sides start anew in each, with their memory at other addresses.
#include <lightbin/lightbin.h>

#include <lightbin/box.hpp>
#include <lightbin/lightbin.hpp>
#include <lightbin/spot.hpp>

#include "sets.hpp"
#include "turns.hpp"

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/mat4x4.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

using namespace lightbin;

namespace {

constexpr std::size_t page = 4096;
std::mt19937 placing;

/// Returns memory at a random multiple of 16 bytes in a page.
void* place(std::size_t bytes) {
    const std::size_t offset = placing() % (page / 16) * 16;
    void* const memory = std::aligned_alloc(page, (offset + bytes + page - 1) / page * page);
    return memory != nullptr ? static_cast<char*>(memory) + offset : nullptr;
}
void release(void* placed) {
    std::free(reinterpret_cast<void*>(reinterpret_cast<std::uintptr_t>(placed) / page * page));
}

}  // namespace

// What the Buffers of both sides call.
void* operator new[](std::size_t bytes) {
    void* const memory = place(bytes);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
void operator delete[](void* placed) noexcept {
    release(placed);
}
void operator delete[](void* placed, std::size_t) noexcept {
    release(placed);
}

namespace {

struct Lamp {
    float colour[3], position[3], range, axis[3], cosine, half_axes[9];
    int flags;
};

struct Frame {
    std::vector<Lamp> lamps;
    ::Lights lights;
};

/// Returns 48 sets of lights, or 8 of 10,000 lights, which fit in the processor's last cache. Sets that do not fit are read
/// from memory by the same loop on both sides, and how well the processor foresees that depends on where the loop
/// happens to lie in the program: up to a tenth of a build, in favour of either side.
std::vector<Frame> frames_of(std::size_t count) {
    std::vector<Frame> frames;
    for (std::uint32_t seed = 1, sets = count < 10000 ? 48 : 8; seed <= sets; ++seed) {
        Frame frame = {{}, field(count, field20_median, seed)};
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> side(-1, 1);
        for (const glm::vec4& light : frame.lights)
            frame.lamps.push_back({{},
                                   {light.x, light.y, light.z},
                                   light.w,
                                   {side(random), side(random), side(random)},
                                   0.7f,
                                   {light.w * 0.6f, 0, 0, 0, light.w * 0.5f, light.w * 0.2f, 0,
                                    light.w * -0.2f, light.w * 0.5f},
                                   0});
        frames.push_back(std::move(frame));
    }
    return frames;
}

enum class Kind { vec4s, spheres, spots, boxes };

/// Prints the ratio for one set of options.
template <Options options> void measure(const char* name, std::size_t count, Kind kind, double seconds) {
    using Read = typename Binner<options>::Inputs;
    const glm::mat4 lens = glm::perspectiveRH_NO(2 * std::atan(tan_half_fov), aspect, 0.1f, 1000.0f),
                    still(1);
    const float *const projection = &lens[0][0], *const camera = &still[0][0];
    const View cpp_view =
        *View::from_projection(matrix(projection, MatrixLayout::column_major), {1920, 1080});
    const Slices cpp_slices = *Slices::exponential(24, 5, 200);
    std::vector<float> min(cpp_view.tile_count()), max(cpp_view.tile_count());
    for (std::size_t i = 0; i < min.size(); ++i) {
        min[i] = static_cast<float>(i * 37 % 150);
        max[i] = min[i] + 20;
    }
    const ZBounds cpp_bounds = {min, max};
    std::optional<Binner<options>> cpp_binner;

    lightbin_view_options view_options = {};
    view_options.size = sizeof view_options, view_options.width = 1920, view_options.height = 1080;
    view_options.projection.floats = projection;
    lightbin_binner_options binner_options = {};
    binner_options.size = sizeof binner_options;
    binner_options.ids = options.ids == IdWidth::u16 ? LIGHTBIN_U16 : LIGHTBIN_U32;
    binner_options.depth_test = static_cast<std::int32_t>(options.depth_test);
    binner_options.slicing = static_cast<std::int32_t>(options.slicing);
    lightbin_view* view = nullptr;
    lightbin_binner* binner = nullptr;
    lightbin_slices* slices = nullptr;
    if (lightbin_view_create(&view_options, &view).error ||
        lightbin_slices_exponential(24, 5, 200, 0, &slices).error)
        std::abort();
    lightbin_z_bounds bounds = {};
    bounds.size = sizeof bounds, bounds.min = min.data(), bounds.max = max.data(), bounds.tiles = min.size();
    lightbin_inputs inputs = {};
    inputs.size = sizeof inputs;
    if (Read::reads_slices) inputs.slices = slices;
    if (Read::reads_bounds) inputs.bounds = &bounds;

    const auto in_cpp = [&](const Frame& frame) {
        const auto made = [&](const auto& lights) {
            return cpp_binner->bin(cpp_view, lights, inputs_for<options>(cpp_bounds, cpp_slices))
                ->ids()
                .size();
        };
        const auto world = matrix(camera, MatrixLayout::column_major);
        if (kind == Kind::vec4s) return made(world_space(frame.lights, world));
        if (kind == Kind::spheres)
            return made(world_space(frame.lamps, world, [](const Lamp& lamp) {
                return Sphere{lamp.position[0], lamp.position[1], lamp.position[2], lamp.range};
            }));
        if (kind == Kind::boxes)
            return made(world_space(frame.lamps, world, [](const Lamp& lamp) {
                const float x = lamp.position[0], y = lamp.position[1], z = lamp.position[2];
                Box box = {x, y, z, lamp.range, x, y, z, {}, 1};
                std::memcpy(box.half_axes, lamp.half_axes, sizeof box.half_axes);
                return box;
            }));
        return made(world_space(frame.lamps, world, [](const Lamp& lamp) {
            return Spot{lamp.position[0], lamp.position[1], lamp.position[2], lamp.range,
                        lamp.axis[0],     lamp.axis[1],     lamp.axis[2],     lamp.cosine};
        }));
    };
    const auto in_c = [&](const Frame& frame) -> std::size_t {
        const Lamp& lamp = frame.lamps[0];
        lightbin_lights lights = {};
        lights.size = sizeof lights;
        lights.view_matrix.floats = camera;
        if (kind == Kind::vec4s)
            lights.spheres = {count, {&frame.lights[0].x, 16}, {&frame.lights[0].w, 16}};
        else if (kind == Kind::spheres)
            lights.spheres = {count, {lamp.position, sizeof lamp}, {&lamp.range, sizeof lamp}};
        else if (kind == Kind::boxes)
            lights.boxes = {count,
                            {lamp.position, sizeof lamp},
                            {&lamp.range, sizeof lamp},
                            {lamp.position, sizeof lamp},
                            {lamp.half_axes, sizeof lamp},
                            {}};
        else
            lights.spots = {count,
                            {lamp.position, sizeof lamp},
                            {&lamp.range, sizeof lamp},
                            {lamp.axis, sizeof lamp},
                            {&lamp.cosine, sizeof lamp}};
        lightbin_grid grid = {};
        grid.size = sizeof grid;
        if (lightbin_bin(binner, view, &lights, &inputs, &grid).error) std::abort();
        return static_cast<std::size_t>(grid.id_count);
    };
    const std::vector<Frame> frames = frames_of(count);
    std::vector<double> ratios, times;
    constexpr int placements = 16;
    for (int placement = 0; placement < placements; ++placement) {
        cpp_binner.emplace();
        if (lightbin_binner_create(&binner_options, &binner).error) std::abort();
        for (const Frame& frame : frames)  // so that neither side allocates in the turns
            if (in_cpp(frame) != in_c(frame)) std::abort();
        const Turns turns = take_turns<Frame>(frames, seconds / placements, {in_cpp, in_c}).in_pairs();
        ratios.push_back(turns.ratio(1, 0));
        times.push_back(turns.seconds_a_frame(0));
        lightbin_binner_destroy(binner);
    }
    const char* const kinds[] = {"vec4s", "spheres in structs", "spots in structs", "boxes in structs"};
    std::printf("%s,%zu,%s,%.2f,%.4f\n", name, count, kinds[static_cast<int>(kind)], 1e6 * median(times),
                median(ratios));
    lightbin_slices_destroy(slices);
    lightbin_view_destroy(view);
}

}  // namespace

int main(int count, char** words) {
    const double seconds = count > 1 ? std::atof(words[1]) : 0.5;
    for (const std::size_t lights : {100u, 1000u, 10000u}) {
        measure<Options{}>("rectangles", lights, Kind::vec4s, seconds);
        measure<Options{}>("rectangles", lights, Kind::spheres, seconds);
        measure<Options{}>("rectangles", lights, Kind::spots, seconds);
        measure<Options{.ids = IdWidth::u16}>("rectangles with 16-bit ids", lights, Kind::spheres, seconds);
        measure<Options{.depth_test = true}>("box", lights, Kind::spheres, seconds);
        measure<Options{.depth_test = true}>("box", lights, Kind::spots, seconds);
        measure<Options{.depth_test = true}>("box", lights, Kind::boxes, seconds);
        measure<Options{.slicing = Slicing::clusters}>("clusters", lights, Kind::spheres, seconds);
        measure<Options{.depth_test = true, .slicing = Slicing::clusters}>("clusters with box", lights,
                                                                           Kind::spots, seconds);
        measure<Options{.depth_test = true, .slicing = Slicing::clusters}>("clusters with box", lights,
                                                                           Kind::boxes, seconds);
        measure<Options{.slicing = Slicing::z_bins}>("z-bins", lights, Kind::spheres, seconds);
    }
}
