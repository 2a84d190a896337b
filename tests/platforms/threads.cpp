// SPDX-License-Identifier: MIT
// threads: Binners with every kind of options, each on a thread of its own, for two Views, the same lights, Z bounds and
// Slices, while another one's work is shared by a pool of threads. Every grid must be the one that is made alone; the
// thread sanitizer says whether they shared more than that.
#include "bench/pool.hpp"

#include <lightbin/lightbin.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <thread>
#include <vector>

namespace {

using namespace lightbin;

struct Scene {
    View views[2];
    Slices slices;
    std::vector<Sphere> lights{};
    std::vector<float> min{}, max{};
};

Scene make_scene() {
    double projection[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, -1}, {0, 0, -0.2, 0}};
    const auto view = [&](double shift) {  // an eye's, off-centre
        projection[2][0] = shift;
        return *View::from_projection(projection, {512, 512}, {.tile_size = 16});
    };
    Scene scene = {{view(-0.1), view(0.1)}, *Slices::linear(12, 0, 60)};
    std::uint32_t state = 1;
    const auto between = [&](float low, float high) {
        state = state * 1664525 + 1013904223;
        return low + (high - low) * (static_cast<float>(state >> 8) * 0x1p-24f);
    };
    for (int i = 0; i < 1500; ++i) {
        const float x = between(-50, 50), y = between(-50, 50), z = between(-70, 10);
        scene.lights.push_back({x, y, z, between(0.5f, 6)});
    }
    for (std::size_t tile = 0; tile < scene.views[0].tile_count(); ++tile) {
        scene.min.push_back(between(1, 20));
        scene.max.push_back(between(20, 60));
    }
    return scene;
}

/// The grids that a Binner makes in some frames, one after another.
template <Options options, int view = 0>
std::vector<std::uint32_t> build(const Scene& scene, const Parallel& parallel) {
    const double to_view[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    const auto inputs = inputs_for<options>({scene.min, scene.max}, scene.slices);
    Binner<options> binner;
    std::vector<std::uint32_t> all;
    for (int frame = 0; frame < 20; ++frame) {
        const auto grid = binner.bin(scene.views[view], world_space(scene.lights, to_view), inputs, parallel);
        if (!grid) return {};
        for (const ListRange range : grid->ranges())
            all.insert(all.end(), {range.offset, range.count});
        all.insert(all.end(), grid->ids().begin(), grid->ids().end());
    }
    return all;
}

struct Job {
    std::vector<std::uint32_t> (*build)(const Scene& scene, const Parallel& parallel);
    Parallel parallel;
    std::vector<std::uint32_t> made;
};

}  // namespace

int main() {
    const Scene scene = make_scene();
    Pool pool(3), other_pool(2);
    const auto clusters = build<Options{.depth_test = true, .slicing = Slicing::clusters}>;
    std::vector<Job> jobs = {
        {build<Options{}>, {}, {}},
        {build<Options{}, 1>, {}, {}},
        {build<Options{.ids = IdWidth::u16, .depth_test = true}>, {}, {}},
        {build<Options{.depth_test = true, .slicing = Slicing::z_bins}>, {}, {}},
        {clusters, {}, {}},
        {clusters, Parallel(3, pool), {}},
        {build<Options{.depth_test = true}>, Parallel(2, other_pool), {}}};
    std::vector<std::thread> running;
    for (Job& job : jobs)
        running.emplace_back([&] { job.made = job.build(scene, job.parallel); });
    for (std::thread& thread : running)
        thread.join();

    int wrong = 0;
    for (const Job& job : jobs)
        wrong += job.made.size() < 100000 || job.made != job.build(scene, {});
    std::printf("%zu Binners at once, %d of them wrong\n", jobs.size(), wrong);
    return wrong == 0 ? 0 : 1;
}
