// SPDX-License-Identifier: MIT
// Bytes make a camera, lights and depths of tiles; every instruction set's lists are checked by exact arithmetic.
#include "../oracle/judge.hpp"
#include "bytes.hpp"

#include <lightbin/z_bounds.hpp>

#include <cstdio>
#include <cstdlib>

using namespace oracle;

namespace {

Camera take_camera(Bytes& bytes) {
    const unsigned flags = bytes.byte();
    Camera camera;
    camera.zero_to_one = (flags & 1) != 0;
    camera.upper_left = (flags & 2) != 0;
    camera.reversed = (flags & 4) != 0;
    camera.tile = 1 + static_cast<int>(bytes.below(300));
    camera.width = 1 + static_cast<int>(bytes.below(static_cast<unsigned>(40 * camera.tile)));
    camera.height = 1 + static_cast<int>(bytes.below(static_cast<unsigned>(40 * camera.tile)));
    if ((flags & 8) != 0) {  // the entries that may be other than 0, as they come
        const bool orthographic = (flags & 16) != 0;
        const auto entry = [&] { return static_cast<double>(bytes.take<float>()); };
        Matrix& m = camera.m;
        m[0][0] = entry(), m[1][1] = entry(), m[2][2] = entry(), m[3][2] = entry();
        m[orthographic ? 3 : 2][0] = entry(), m[orthographic ? 3 : 2][1] = entry();
        m[orthographic ? 3 : 2][3] = entry();
    } else {
        Random random(bytes.take<std::uint16_t>());
        const double aspect = aspect_of({camera.width, camera.height, camera.tile, camera.upper_left});
        Lens lens = families::any_lens(aspect, random);
        const int k = static_cast<int>(bytes.below(140)) - 70;
        lens.near_plane = std::ldexp(lens.near_plane, k), lens.far_plane = std::ldexp(lens.far_plane, k);
        if (lens.orthographic)
            for (double* side : {&lens.left, &lens.right, &lens.bottom, &lens.top})
                *side = std::ldexp(*side, k);
        const Camera made =
            camera_of("", lens, {camera.width, camera.height, camera.tile, camera.upper_left});
        camera.m = made.m, camera.doubles = made.doubles;
        camera.zero_to_one = made.zero_to_one, camera.reversed = made.reversed;
    }
    return camera;
}

Light take_light(Bytes& bytes, const Aim& aim) {
    const auto& sets = sphere_sets();
    const unsigned kind = bytes.byte();
    if (kind < 64) return bytes.take<Light>();
    Random random(bytes.byte());
    Light light = sets[kind % sets.size()].one(aim, random);
    if (kind < 128) {  // one number other than aimed at
        float* numbers[] = {&light.x, &light.y, &light.z, &light.w};
        *numbers[kind % 4] = bytes.take<float>();
    }
    return light;
}

/// Fills a tile's or pixel's values with a few different ones.
void fill(std::vector<float>& values, std::size_t count, Bytes& bytes, const Aim& aim) {
    std::vector<float> palette;
    Random random(bytes.byte());
    for (unsigned i = bytes.below(12) + 1; i > 0; --i)
        palette.push_back(bytes.flag() ? bytes.take<float>() : static_cast<float>(aim.depth(random)));
    for (std::size_t i = 0; i < count; ++i)
        values.push_back(palette[random.bits() % palette.size()]);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    Scene scene;
    scene.camera = take_camera(bytes);
    bytes.byte();
    const auto made = library_view(scene.camera);
    if (!made) return 0;
    const lightbin::View& view = *made;
    const Aim aim(scene.camera);
    const auto pixels = static_cast<std::size_t>(scene.camera.width) * static_cast<std::size_t>(scene.camera.height);
    if (bytes.byte() % 4 == 3 && pixels < 5000) {
        std::vector<float> depth;
        const bool skip_background = bytes.flag();
        fill(depth, pixels, bytes, aim);
        scene.min.resize(view.tile_count()), scene.max.resize(view.tile_count());
        if (!lightbin::reduce_depth(view, {.depth = depth, .skip_background = skip_background},
                                    {scene.min, scene.max}))
            std::abort();
    } else {
        for (auto* side : {&scene.min, &scene.max})
            fill(*side, view.tile_count(), bytes, aim);
    }
    while (!bytes.empty() && scene.lights.size() < 200)
        scene.lights.push_back(take_light(bytes, aim));

    Verdicts verdicts;
    judge_scene(scene, view, verdicts);
    for (const std::string& report : verdicts.reports)
        std::fprintf(stderr, "%s\n", report.c_str());
    if (!verdicts.reports.empty()) std::abort();
    return 0;
}
