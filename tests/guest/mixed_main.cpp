// Files that are compiled with and without optimisation, of which only the first have vector kernels, share a View and a
// Binner, and make the same lists, whichever copy of an inline function the linker keeps.
#include "mixed.hpp"

#include <cstdio>

int main() {
    const double perspective[] = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.002, -1, 0, 0, -0.2002, 0};
    const auto view = lightbin::View::from_projection(
        lightbin::matrix(perspective, lightbin::MatrixLayout::column_major), {1920, 1080});
    if (!view) return 1;
    lightbin::Binner<> binner, scalar(lightbin::Isa::scalar);
    for (const unsigned count : {1, 50, 3000, 40, 20000, 700}) {
        std::vector<lightbin::Sphere> lights;
        for (std::uint32_t i = 0, state = count; i < count; ++i) {
            const auto random = [&] { return static_cast<float>(state = state * 1664525 + 1013904223) / 4294967296.0f; };
            const float x = random(), y = random(), z = random(), radius = random();
            lights.push_back({100 * x - 50, 60 * y - 30, 5 - 90 * z, 3 * radius});
        }
        const Lists expected = optimised(scalar, *view, lights);
        if (expected.empty() || unoptimised(binner, *view, lights) != expected ||
            optimised(binner, *view, lights) != expected) {
            std::printf("the lists of %u lights differ\n", count);
            return 1;
        }
    }
}
