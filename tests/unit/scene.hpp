// What the unit tests share: views, random lights, and grids in a form that is easy to compare.
#pragma once

#include <lightbin/box.hpp>
#include <lightbin/lightbin.hpp>
#include <lightbin/spot.hpp>

#include <doctest/doctest.h>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace test {

/// The instruction sets that this machine runs, the scalar kernels first and the widest last. A function of the library
/// that takes an Isa and does not ask the machine is to be given one of these, never compiled_isa.
inline const std::vector<lightbin::Isa>& machine_tiers() {
    using lightbin::Isa;
    static const std::vector<Isa> tiers = [] {
        std::vector<Isa> found = {Isa::scalar};
        for (const Isa isa : {Isa::simd128, Isa::avx2, Isa::avx512})
            if (lightbin::machine_isa(isa) == isa) found.push_back(isa);
        return found;
    }();
    return tiers;
}
/// Returns a view 60 degrees high, near 0.1, far 1000, by OpenGL's conventions.
inline lightbin::View view(lightbin::ImageSize viewport, int tile_size) {
    const float aspect =
        viewport.height > 0 ? static_cast<float>(viewport.width) / static_cast<float>(viewport.height) : 1.0f;
    const glm::mat4 projection = glm::perspectiveRH_NO(1.0471976f, aspect > 0 ? aspect : 1.0f, 0.1f, 1000.0f);
    return *lightbin::View::from_projection(projection, viewport, {.tile_size = tile_size});
}

/// Cameras that look down -z and +z, off-centre, with pixels that are not square, and without perspective.
inline std::vector<lightbin::View> cameras(int tile_size) {
    std::vector<lightbin::View> all;
    for (const glm::mat4& projection :
         {glm::perspectiveRH_NO(1.0f, 1.5f, 0.1f, 1000.0f), glm::frustumRH_NO(-0.2f, 0.05f, -0.1f, 0.3f, 0.25f, 500.0f),
          glm::perspectiveLH_NO(1.0f, 1.5f, 2.0f, 60.0f), glm::orthoRH_NO(-30.0f, 50.0f, -20.0f, 25.0f, 1.0f, 80.0f)})
        all.push_back(*lightbin::View::from_projection(projection, {500, 330}, {.tile_size = tile_size}));
    return all;
}

/// Returns lights around and in front of the eye, which looks down -z; some are behind it.
inline std::vector<glm::vec4> random_lights(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> depth(-10.0f, 100.0f), side(-1.0f, 1.0f);
    std::lognormal_distribution<float> radius(1.0f, 0.7f);
    std::vector<glm::vec4> lights;
    for (std::size_t i = 0; i < count; ++i) {
        const float z = depth(random);
        lights.emplace_back(side(random) * (std::fabs(z) + 2), side(random) * (std::fabs(z) + 2), -z,
                            radius(random));
    }
    return lights;
}

/// Lights of each kind around and in front of the eye: spheres, spots of half angles up to 172 degrees (every third a
/// whole sphere), and spheres cut by boxes with half axes at any angles.
struct Kinds {
    std::vector<lightbin::Sphere> spheres;
    std::vector<lightbin::Spot> spots;
    std::vector<lightbin::Box> boxes;
};

inline Kinds random_kinds(std::size_t spheres, std::size_t spots, std::size_t boxes, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1), angle(0, 3);
    Kinds kinds;
    for (const glm::vec4& s : random_lights(spheres, seed))
        kinds.spheres.push_back({s.x, s.y, s.z, s.w});
    for (const glm::vec4& s : random_lights(spots, seed + 1)) {
        const lightbin::Sphere ball = {s.x, s.y, s.z, s.w};
        const lightbin::Spot spot = {
            s.x, s.y, s.z, s.w, unit(random), unit(random), unit(random), std::cos(angle(random))};
        kinds.spots.push_back(kinds.spots.size() % 3 == 0 ? lightbin::Spot::whole(ball) : spot);
    }
    for (const glm::vec4& s : random_lights(boxes, seed + 2)) {
        lightbin::Box box = {s.x, s.y, s.z, s.w, s.x + unit(random), s.y, s.z, {}};
        for (float(&axis)[3] : box.half_axes)
            for (float& coordinate : axis)
                coordinate = s.w * unit(random);
        kinds.boxes.push_back(box);
    }
    return kinds;
}

/// One list of ids a tile.
using Lists = std::vector<std::vector<std::uint32_t>>;

template <class Id> Lists to_lists(const lightbin::LightGrid<Id>& grid) {
    Lists lists;
    for (int slice = 0; slice < grid.slices(); ++slice)
        for (int y = 0; y < grid.tiles_y(); ++y)
            for (int x = 0; x < grid.tiles_x(); ++x) {
                const auto ids = grid.lights_in(x, y, slice);
                lists.emplace_back(ids.begin(), ids.end());
            }
    return lists;
}

template <lightbin::Options options = lightbin::Options{}, class Lights, class Threads = lightbin::detail::Serial>
Lists lists(const lightbin::View& view, const Lights& lights, const lightbin::ZBounds& bounds = {},
            const Threads& threads = {}) {
    lightbin::Binner<options> binner;
    const auto grid = binner.bin(view, lights, lightbin::inputs_for<options>(bounds), threads);
    REQUIRE(grid);
    return to_lists(*grid);
}

inline std::size_t entries(const Lists& lists) {
    std::size_t sum = 0;
    for (const auto& list : lists)
        sum += list.size();
    return sum;
}

/// Returns whether every list of `outer` has all ids of the same tile's list of `inner`.
inline bool is_superset(const Lists& outer, const Lists& inner) {
    if (outer.size() != inner.size()) return false;
    for (std::size_t tile = 0; tile < outer.size(); ++tile)
        if (!std::includes(outer[tile].begin(), outer[tile].end(), inner[tile].begin(), inner[tile].end()))
            return false;
    return true;
}

/// A loop for lightbin::Parallel in the worst order: one thread does everything, from the end.
inline constexpr auto backwards = [](std::size_t n, const auto& body) {
    while (n > 0)
        body(--n);
};

/// Z bounds of a few units of depth that differ from tile to tile. They refer to `min` and `max`, which must be empty.
inline lightbin::ZBounds some_bounds(const lightbin::View& view, std::vector<float>& min, std::vector<float>& max) {
    for (std::size_t tile = 0; tile < view.tile_count(); ++tile) {
        min.push_back(static_cast<float>(tile % 97));
        max.push_back(min.back() + static_cast<float>(tile % 5));
    }
    return {.min = min, .max = max};
}

/// Bins lights with some_bounds() and returns the list of ids of each tile. With z-bins the ranks in the lists are
/// turned into ids, and these are sorted.
template <lightbin::Options options, class LightRange>
Lists id_lists(const lightbin::View& view, const LightRange& lights, const lightbin::Parallel& threads = {},
               lightbin::LightCounts* counts = nullptr, lightbin::Isa isa = lightbin::compiled_isa) {
    std::vector<float> min, max;
    const lightbin::Slices slices = *lightbin::Slices::exponential(7, 3, 90);
    lightbin::Binner<options> binner(isa);
    const auto inputs = lightbin::inputs_for<options>(some_bounds(view, min, max), slices);
    const auto grid = binner.bin(view, lights, inputs, threads);
    REQUIRE(grid);
    if (counts != nullptr) *counts = grid->light_counts();
    Lists lists = to_lists(*grid);
    if (options.slicing == lightbin::Slicing::z_bins)
        for (auto& list : lists) {
            for (auto& id : list)
                id = grid->ranks().order[id];
            std::sort(list.begin(), list.end());
        }
    return lists;
}

/// Calls visit with every instruction set for which spots and boxes have kernels of their own.
template <class Visit> void on_rungs(Visit visit) {
    using namespace lightbin;
    visit.template operator()<Options{}>();
    visit.template operator()<Options{.depth_test = true}>();
    visit.template operator()<Options{.depth_test = true, .slicing = Slicing::clusters}>();
    visit.template operator()<Options{.depth_test = true, .slicing = Slicing::z_bins}>();
}

/// Checks that on each such instruction set spots or boxes have less than three quarters of the entries of their
/// spheres, no light outside of its rectangle, and each light where it is listed alone.
template <class Light>
void check_rungs(const std::vector<Light>& lights, const std::vector<lightbin::Sphere>& spheres) {
    const lightbin::View view = test::view({1283, 721}, 16);
    const auto in_rectangles = id_lists<lightbin::Options{}>(view, lights);
    on_rungs([&]<lightbin::Options options> {
        const auto here = id_lists<options>(view, lights), of_spheres = id_lists<options>(view, spheres);
        if constexpr (options.slicing != lightbin::Slicing::clusters) CHECK(is_superset(in_rectangles, here));
        CHECK(4 * entries(here) < 3 * entries(of_spheres));
        CHECK(entries(here) > 0);
        const auto alone = id_lists<options>(view, std::vector<Light>{lights[1]});
        for (std::size_t cell = 0; cell < here.size(); ++cell)
            REQUIRE(alone[cell].size() ==
                    static_cast<std::size_t>(std::count(here[cell].begin(), here[cell].end(), 1u)));
    });
}

}  // namespace test
