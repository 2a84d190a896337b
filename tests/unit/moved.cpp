// Compiled with optimisation, because only then do compilers fuse products and sums.
#include "scene.hpp"

using namespace lightbin;

// If a compiler fuses products and sums of one instruction set, it differs by one rounding, which few numbers show.
TEST_CASE("lights that are moved in doubles are the same on every tier where their radius is about to step") {
    const View view = *View::from_projection(glm::ortho(-1.0f, 1.0f, -1.0f, 1.0f, 0.0f, 10.0f), {64, 64});
    std::mt19937 random(1);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int tries = 0; tries < 200; ++tries) {
        const double offset = between(-1e4, 1e4), first = between(0.5, 2);
        const Sphere light = {static_cast<float>(-offset / first), 0, -2, static_cast<float>(between(1, 2))};
        const auto matrix = [&](double scale) {  // flat, for floats
            return glm::dmat4(scale, 0, 0, 0, 0, scale / 40, 0, 0, 0, 0, scale, 0, offset, 0, 0, 1);
        };
        const auto radius = [&](double scale) {
            return detail::WorldToView(detail::to_matrix(matrix(scale)))(light).radius;
        };
        double low = first, high = first * (1 + 0x1p-20);
        if (radius(low) == radius(high)) continue;
        while (std::nextafter(low, 4.0) < high) {
            const double middle = low + (high - low) / 2;
            (radius(middle) == radius(first) ? low : high) = middle;
        }
        const std::vector<Sphere> lights(16, light);
        for (int step = -3; step <= 3; ++step) {
            const auto world = world_space(lights, matrix(low * (1 + step * 0x1p-52)));
            std::vector<float> radii;
            for (const Isa isa : test::machine_tiers()) {
                detail::Footprints footprints;
                footprints.project(isa, view, world, {}, detail::Kept::lights);
                radii.push_back(footprints.arrays().view_lights.spheres[0].radius);
            }
            CHECK(std::count(radii.begin(), radii.end(), radii[0]) == std::ssize(radii));
        }
    }
}
