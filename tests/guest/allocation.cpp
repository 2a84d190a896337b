// Once warm, nothing allocates.
#include "../unit/scene.hpp"
#include "counted_new.hpp"

#include <lightbin/budget.hpp>
#include <lightbin/masks.hpp>

#include <glm/gtc/matrix_transform.hpp>

#include <cstddef>
#include <random>
#include <vector>

namespace {

using namespace lightbin;

/// Larger lights than test::random_lights(), so that fewer make the library choose the same kernels.
std::vector<glm::vec4> large_lights(std::size_t count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> side(-40, 40), depth(-90, 10), radius(0.5f, 12);
    std::vector<glm::vec4> lights(count);
    for (glm::vec4& light : lights)
        light = {side(random), side(random), depth(random), radius(random)};
    return lights;
}

// Returns the number of allocations in one call of `work`.
std::size_t allocations_in(auto&& work) {
    const std::size_t before = allocations;
    work();
    return allocations - before;
}

// A scene and its lights. A smaller scene has fewer lights and fewer tiles.
struct Scene {
    View view;
    std::vector<glm::vec4> lights;
    std::vector<float> depth, min, max, weights;
    Slices slices = *Slices::exponential(9, 1, 50);

    Scene(int width, int height, std::size_t light_count)
        : view(test::view({width, height}, 32)), lights(large_lights(light_count)),
          depth(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)), min(view.tile_count()),
          max(view.tile_count()), weights(light_count) {
        for (std::size_t i = 0; i < depth.size(); ++i)
            depth[i] = 0.9f + 0.1f * static_cast<float>(i % 97) / 97.0f;
    }

    ZBounds reduce() {
        return *reduce_depth(view, {.depth = depth}, {.min = min, .max = max});
    }
};

// Makes a frame's lists by a Binner and cuts them by a Budget; returns the number of entries.
template <Options options, class Id = typename Binner<options>::Id>
std::size_t frame(Binner<options>& binner, Budget<Id>& budget, Scene& scene,
                  std::vector<ListRange>& ranges, std::vector<Id>& ids) {
    std::size_t entries = 0;
    const ZBounds bounds = scene.reduce();
    const auto use = [&](const auto& lights) {
        const auto grid = binner.bin(scene.view, lights, inputs_for<options>(bounds, scene.slices));
        if (!grid) return;
        entries += grid->ids().size() + longest_list(*grid);
        if (const auto copy = grid->copy_to(ranges, ids)) entries += copy->ids().size();
        if (const auto limited = budget.limit(*grid, scene.weights, {.per_cell = 3, .per_frame = 200}))
            entries += limited->grid.ids().size();
    };
    use(scene.lights);
    use(world_space(scene.lights, glm::mat4(1.0f)));
    return entries;
}

template <Options options> void check_options() {
    Scene scene(640, 360, 500), smaller(320, 200, 300);
    std::vector<ListRange> ranges(scene.view.tile_count() * static_cast<std::size_t>(scene.slices.count()));
    std::vector<typename Binner<options>::Id> ids(500 * ranges.size());
    Binner<options> binner;
    Budget<typename Binner<options>::Id> budget;

    // The first frame must allocate, otherwise the counter does not work.
    std::size_t entries = 0;
    CHECK(allocations_in([&] { entries += frame(binner, budget, scene, ranges, ids); }) > 0);
    entries += frame(binner, budget, scene, ranges, ids);
    CHECK(entries > 0);

    CHECK(allocations_in([&] { entries += frame(binner, budget, scene, ranges, ids); }) == 0);
    CHECK(allocations_in([&] { entries += frame(binner, budget, smaller, ranges, ids); }) == 0);
    CHECK(allocations_in([&] { entries += frame(binner, budget, scene, ranges, ids); }) == 0);
}

}  // namespace

TEST_CASE("a warm Binner does not allocate, nor does a warm Budget") {
    check_options<Options{.ids = IdWidth::u16}>();
    check_options<Options{}>();
    check_options<Options{.ids = IdWidth::u16, .depth_test = true}>();
    check_options<Options{.depth_test = true, .slicing = Slicing::clusters}>();
    check_options<Options{.depth_test = true, .slicing = Slicing::z_bins}>();
    check_options<Options{.depth_test = true}>();
}

TEST_CASE("nor does one that has threads and fewer lights the second time") {
    for (const std::size_t workers : {2u, 5u}) {
        // One light less would give all threads parts of the same size.
        Scene scene(640, 360, workers * 1024);
        const Parallel parallel(workers, test::backwards);
        Binner<> binner;
        (void)*binner.bin(scene.view, scene.lights, {}, parallel);
        scene.lights.pop_back();
        CHECK(allocations_in([&] { (void)*binner.bin(scene.view, scene.lights, {}, parallel); }) == 0);
    }
}

TEST_CASE("a warm MaskBinner does not allocate") {
    const Scene scene(640, 360, 500), smaller(320, 200, 300);
    MaskBinner binner;
    const auto bin = [&](const Scene& of) {
        (void)*binner.bin(of.view, of.lights);
        (void)*binner.bin(of.view, world_space(of.lights, glm::mat4(1.0f)), of.slices);
    };
    CHECK(allocations_in([&] { bin(scene); }) > 0);
    CHECK(allocations_in([&] { bin(smaller); }) == 0);
    CHECK(allocations_in([&] { bin(scene); }) == 0);
}

TEST_CASE("making a view and reducing a depth buffer never allocate") {
    Scene scene(640, 360, 1);
    CHECK(allocations_in([&] { scene.view = test::view({500, 300}, 16); }) == 0);
    scene = Scene(640, 360, 1);
    CHECK(allocations_in([&] { scene.reduce(); }) == 0);
}
