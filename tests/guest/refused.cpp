// Mistakes that must not compile, a number each. The comment behind a case is what the compiler must say.
#include <lightbin/lightbin.hpp>

#include <string>
#include <vector>

void mistake() {
    [[maybe_unused]] lightbin::Binner<> binner;
#if MISTAKE == 1  // a Parallel refers to `run`, and this one is gone after the expression
    [[maybe_unused]] const lightbin::Parallel parallel(8, [](std::size_t n, const auto& body) {
        for (std::size_t i = 0; i < n; ++i)
            body(i);
    });
#elif MISTAKE == 2  // this light is no Sphere or Spot and has no float or double x, y, z and w .*: pass view_space
    struct Lamp {
        std::string name;
        float position[3], range;
    };
    const double projection[4][4] = {};
    (void)binner.bin(*lightbin::View::from_projection(projection, {64, 64}), std::vector<Lamp>());
#elif MISTAKE == 3  // View.*private|private.*View
    [[maybe_unused]] lightbin::View view;
#elif MISTAKE >= 4
    const double projection[4][4] = {};
    const auto view = lightbin::View::from_projection(projection, {64, 64});
    const std::vector<lightbin::Sphere> lights;
    [[maybe_unused]] lightbin::Binner<lightbin::Options{.depth_test = lightbin::DepthTest::box}> tested;
#if MISTAKE == 4    // this Binner's depth test needs Z bounds: bin.view, lights, ..bounds =
    (void)tested.bin(*view, lights);
#elif MISTAKE == 5  // this Binner's depth test needs Z bounds
    (void)tested.bin(*view, lights, {}, lightbin::Serial());
#elif MISTAKE == 6  // this Binner's depth test needs Z bounds
    (void)tested.bin_transparency(*view, lights, {});
#elif MISTAKE == 7  // no matching (member )?function for call to .*bin
    (void)binner.bin(*view, lights, {.bounds = {}});
#elif MISTAKE == 8  // a Binner's ids have 16 or 32 bits
    [[maybe_unused]] lightbin::Binner<lightbin::Options{.ids = lightbin::IdWidth::u8}> narrow;
#endif
#endif
}
