// Mistakes that must not compile, a number each. The comment behind a case is what the compiler must say, in one error.
#include <lightbin/budget.hpp>
#include <lightbin/lightbin.hpp>
#include <lightbin/spot.hpp>

#include <array>
#include <list>
#include <string>
#include <vector>

namespace {

struct Lamp {
    std::string name;
    float position[3], range;
};

/// As Eigen's and OpenSceneGraph's are.
struct Vec4 {
    float numbers[4];
    float x() const { return numbers[0]; }
    float y() const { return numbers[1]; }
    float z() const { return numbers[2]; }
    float w() const { return numbers[3]; }
};

/// As Irrlicht's, Qt's and others are: nobody knows whether its vectors are rows or columns.
struct CalledMatrix {
    float operator()(int row, int column) const { return row == column ? 1.0f : 0.0f; }
};

}  // namespace

void mistake() {
    [[maybe_unused]] lightbin::Binner<> binner;
    [[maybe_unused]] lightbin::Binner<lightbin::Options{.depth_test = true}> tested;
    const double projection[4][4] = {};
    const auto view = lightbin::View::from_projection(projection, {64, 64});
    [[maybe_unused]] const std::vector<lightbin::Sphere> lights;
    [[maybe_unused]] const std::vector<Lamp> lamps;
#if MISTAKE == 1  // a Parallel refers to `run`, and this one is gone after the expression
    [[maybe_unused]] const lightbin::Parallel parallel(8, [](std::size_t n, const auto& body) {
        for (std::size_t i = 0; i < n; ++i)
            body(i);
    });
#elif MISTAKE == 2  // this light is no Sphere, Spot or Box and has no float x, y, z and w .*: pass view_space
    (void)binner.bin(*view, lamps);
#elif MISTAKE == 3  // View.*private|private.*View
    [[maybe_unused]] lightbin::View none;
#elif MISTAKE == 4  // this Binner's depth test needs Z bounds: bin.view, lights, ..bounds =
    (void)tested.bin(*view, lights);
#elif MISTAKE == 5  // this Binner's depth test needs Z bounds
    (void)tested.bin(*view, lights, {});
#elif MISTAKE == 6  // this Binner does not read this input: bounds want an Options::depth_test
    (void)binner.bin(*view, lights, {.bounds = lightbin::ZBounds()});
#elif MISTAKE == 7  // a Binner's ids have 16 or 32 bits
    [[maybe_unused]] lightbin::Binner<lightbin::Options{.ids = lightbin::IdWidth::u8}> narrow;
#elif MISTAKE == 8  // this light is no Sphere, Spot or Box
    (void)binner.bin(*view, std::vector<Vec4>());
#elif MISTAKE == 9  // this light is no Sphere, Spot or Box
    (void)binner.bin(*view, lightbin::world_space(lamps, projection));
#elif MISTAKE == 10  // to_light is called, as const, with a const reference to one of the lights
    (void)binner.bin(*view, lightbin::view_space(lamps, [](Lamp&) { return lightbin::Sphere(); }));
#elif MISTAKE == 11  // to_light must return a lightbin::Sphere, a lightbin::Spot or a lightbin::Box
    (void)binner.bin(*view, lightbin::view_space(lamps, [](const Lamp& lamp) { return lamp.range; }));
#elif MISTAKE == 12  // lights are an array, a std::vector, a std::span or another range
    (void)binner.bin(*view, std::list<lightbin::Sphere>());
#elif MISTAKE == 13  // this is still a Result: .*pass \*result
    (void)binner.bin(view, lights);
#elif MISTAKE == 14  // sixteen numbers do not say which matrix they are: pass lightbin::matrix
    const float numbers[16] = {};
    (void)lightbin::View::from_projection(numbers, {64, 64});
#elif MISTAKE == 15  // sixteen numbers do not say which matrix they are
    (void)binner.bin(*view, lightbin::world_space(lights, std::array<float, 16>()));
#elif MISTAKE == 16  // sixteen numbers do not say which matrix they are
    const double* const pointer = projection[0];
    (void)lightbin::View::from_projection(pointer, {64, 64});
#elif MISTAKE == 17  // this is no matrix.column..row. and none of Eigen's
    (void)lightbin::View::from_projection(CalledMatrix(), {64, 64});
#elif MISTAKE == 18  // this matrix is not 4x4
    const float affine[3][4] = {};
    (void)binner.bin(*view, lightbin::world_space(lights, affine));
#elif MISTAKE == 19  // a matrix has sixteen numbers, this array has not
    const float numbers[12] = {};
    (void)lightbin::matrix(numbers, lightbin::MatrixLayout::row_major);
#elif MISTAKE == 20  // matrix.. takes sixteen numbers, one after another
    (void)lightbin::matrix(CalledMatrix(), lightbin::MatrixLayout::row_major);
#elif MISTAKE == 21  // this is still a Result
    [[maybe_unused]] const lightbin::View copied = view;
#elif MISTAKE == 22  // this Binner slices depth
    lightbin::Binner<lightbin::Options{.slicing = lightbin::Slicing::clusters}> sliced;
    (void)sliced.bin(*view, lights);
#elif MISTAKE == 23  // this is still a Result
    lightbin::Binner<lightbin::Options{.slicing = lightbin::Slicing::z_bins}> sliced;
    (void)sliced.bin(*view, lights, {.slices = lightbin::Slices::linear(8, 0, 1)});
#elif MISTAKE == 24  // this Binner slices depth
    lightbin::Binner<lightbin::Options{.slicing = lightbin::Slicing::z_bins}> sliced;
    (void)sliced.bin(*view, lights);
#elif MISTAKE == 25  // this Binner does not read this input
    (void)tested.bin(*view, lights, {.slices = *lightbin::Slices::linear(8, 0, 1), .bounds = {}});
#elif MISTAKE == 26  // lights are an array, a std::vector, a std::span or another range
    const auto to_sphere = [](const Lamp& lamp) { return lightbin::Sphere{0, 0, 0, lamp.range}; };
    const std::list<Lamp> list;
    (void)binner.bin(*view, lightbin::view_space(list, to_sphere));
#elif MISTAKE == 27  // this light is no Sphere, Spot or Box
    (void)binner.bin(*view, std::vector<Lamp*>());
#elif MISTAKE == 28  // these lights are gone after the expression: give the array a name
    [[maybe_unused]] const auto gone = lightbin::view_space(std::vector<lightbin::Sphere>());
#elif MISTAKE == 29  // this is still a Result
    constexpr lightbin::Options clusters = {.slicing = lightbin::Slicing::clusters};
    [[maybe_unused]] const auto inputs = lightbin::inputs_for<clusters>({}, lightbin::Slices::linear(8, 0, 1));
#elif MISTAKE == 30  // cannot bind|lvalue reference
    [[maybe_unused]] lightbin::Slices& gone = *lightbin::Slices::linear(8, 0, 1);
#elif MISTAKE == 31  // this is still a Result
    lightbin::Budget<> budget;
    (void)budget.limit(binner.bin(*view, lights), {}, {.per_cell = 8});
#elif MISTAKE == 32  // lights\(\) takes Spheres, Spots and Boxes in this order
    const std::vector<lightbin::Spot> spots;
    (void)binner.bin(*view, lightbin::lights(spots, lights));
#elif MISTAKE == 33  // these lights are gone after the expression
    const std::vector<lightbin::Spot> spots;
    (void)binner.bin(*view, lightbin::lights(std::vector<lightbin::Sphere>(), spots));
#elif MISTAKE == 34  // to bin Spots include <lightbin/spot.hpp>, and to bin Boxes <lightbin/box.hpp>
    const std::vector<lightbin::Box> boxes;
    (void)tested.bin(*view, boxes, {.bounds = {}});
#elif MISTAKE == 35  // to bin Spots include <lightbin/spot.hpp>, and to bin Boxes <lightbin/box.hpp>
    const auto to_box = [](const Lamp&) { return lightbin::Box(); };
    (void)binner.bin(*view, lightbin::world_space(lamps, projection, to_box));
#elif MISTAKE == 36  // conver(t|sion).*Spot.*Sphere
    [[maybe_unused]] const lightbin::Sphere sphere = lightbin::Spot();
#elif MISTAKE == 37  // conver(t|sion).*Box.*Sphere
    [[maybe_unused]] const lightbin::Sphere sphere = lightbin::Box();
#elif MISTAKE == 38  // with an eye, it must return a Placed light
    const auto to_sphere = [](const Lamp&) { return lightbin::Sphere(); };
    (void)binner.bin(*view, lightbin::world_space(lamps, projection, {0, 0, 0}, to_sphere));
#endif
}

#if !MISTAKE
/// No mistake: mixed lights of the kinds whose headers are included link, without the other kind's.
int main() {
    const std::vector<lightbin::Sphere> spheres;
    const std::vector<lightbin::Spot> spots;
    const double projection[4][4] = {};
    const auto view = lightbin::View::from_projection(projection, {64, 64});
    lightbin::Binner<> binner;
    return view && binner.bin(*view, lightbin::lights(spheres, spots)) ? 1 : 0;
}
#endif
