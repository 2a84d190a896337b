// SPDX-License-Identifier: MIT
// Writes boxes.txt, in the format that README.md describes, to standard output:
//
//     g++ -std=c++20 -O2 tests/spot_verdicts/make_boxes.cpp -lgmp -o make_boxes && ./make_boxes > boxes.txt
//
// The same compiler and C library give the same bytes.
#include "../oracle/boxes.hpp"
#include "../oracle/cameras.hpp"

#include "../../bench/exact/truth.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using namespace oracle;

namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

/// A camera, and the depths at which the layers of its cells meet.
struct Subject {
    Camera camera;
    std::vector<float> boundaries;
};

/// The cameras of the file of spots, with tiles that are larger.
std::vector<Subject> subjects() {
    const Screen wide = {960, 540, 80, false}, uneven = {1000, 700, 96, true}, hd = {1280, 720, 128, false},
                 square = {800, 800, 100, true}, across = {900, 600, 96, false}, small = {320, 180, 30, true};
    const double uneven_aspect = aspect_of(uneven);
    Lens off_centre = {-0.9 * uneven_aspect, 0.3 * uneven_aspect, -0.2, 0.7, 0.25, 500};
    off_centre.looks_up_z = off_centre.zero_to_one = true;
    Lens infinite_reversed = symmetric_lens(aspect_of(hd), 75);
    infinite_reversed.zero_to_one = infinite_reversed.reversed = true;
    infinite_reversed.far_plane = infinite;
    Lens flipped = symmetric_lens(aspect_of(square), 120);
    flipped.zero_to_one = flipped.flip_y = true;
    Lens orthographic = box_lens(aspect_of(across), 40);
    orthographic.left += 25, orthographic.right += 25;
    Lens orthographic_reversed = box_lens(aspect_of(small), 32);
    orthographic_reversed.reversed = orthographic_reversed.zero_to_one = true;
    const std::vector<float> perspective_layers = {1, 4, 15, 50, 200},
                             parallel_layers = {20, 60, 110, 170, 240};
    return {{camera_of("perspective", symmetric_lens(aspect_of(wide), 60), wide), perspective_layers},
            {camera_of("off_centre", off_centre, uneven), perspective_layers},
            {camera_of("infinite_reversed", infinite_reversed, hd), perspective_layers},
            {camera_of("wide_and_flipped", flipped, square), perspective_layers},
            {camera_of("orthographic", orthographic, across), parallel_layers},
            {camera_of("orthographic_reversed", orthographic_reversed, small), parallel_layers}};
}

//------------------------------------------------------------------------------------------------------------
// Boxes as renderers have them: decals, cards, sticks, cubes and projectors, and balls that rooms and half-spaces cut.

/// A ball in and around the view whose size is a fair part of the view's at its depth.
Light middle_sized(const Aim& aim, Random& random) {
    const double depth = aim.depth(random),
                 radius = aim.half_height(std::max(depth, aim.unit)) * random.power_of_two(-4, 0);
    return aim.light(aim.at(0, aim.pixel(0, random), depth), aim.at(1, aim.pixel(1, random), depth), depth,
                     radius);
}

/// A whole box with half axes of these parts of a size, at right angles.
BoxLight of_shape(const Aim& aim, Random& random, double a, double b, double c) {
    const Light ball = middle_sized(aim, random);
    const boxes::Triple at = spots::centre(aim, ball);
    const double size = static_cast<double>(ball.w);
    return boxes::whole(aim, random, at, boxes::sized(boxes::frame(at, random), a * size, b * size, c * size),
                        1);
}
BoxLight decal(const Aim& aim, Random& random) {
    return of_shape(aim, random, 1, 1, 0.25);
}
BoxLight card(const Aim& aim, Random& random) {
    return of_shape(aim, random, 1, random.uniform(0.2, 1), 0);
}
BoxLight stick(const Aim& aim, Random& random) {
    return of_shape(aim, random, 0.25, 0.25, 2);
}
BoxLight cube(const Aim& aim, Random& random) {
    return of_shape(aim, random, 0.6, 0.6, 0.6);
}

/// Half axes at any angles; every other of them is left-handed, as a mirrored transform makes it.
BoxLight sheared(const Aim& aim, Random& random) {
    const Light ball = middle_sized(aim, random);
    const boxes::Triple at = spots::centre(aim, ball);
    const double size = static_cast<double>(ball.w);
    const boxes::Frame f = {boxes::plus({}, spots::any_direction(random), size),
                            boxes::plus({}, spots::any_direction(random), size * random.uniform(0.2, 1)),
                            boxes::plus({}, spots::any_direction(random), size * random.uniform(0.2, 1))};
    return boxes::whole(aim, random, at, f, random.chance(0.5) ? 1 : random.uniform());
}

/// A light in a room: its centre is in the room, and the room's walls cut its ball.
BoxLight room(const Aim& aim, Random& random) {
    const Light ball = middle_sized(aim, random);
    boxes::Triple at = spots::centre(aim, ball);
    const double size = static_cast<double>(ball.w);
    const boxes::Frame f = boxes::sized(boxes::frame(at, random), size * random.uniform(0.3, 1.2),
                                        size * random.uniform(0.2, 0.6), size * random.uniform(0.3, 1.2));
    for (const boxes::Triple& axis : f)
        at = boxes::plus(at, axis, random.uniform(-0.9, 0.9));
    return boxes::box(aim, ball, at, f, 1);
}

/// The half of a ball on one side of its centre.
BoxLight half_ball(const Aim& aim, Random& random) {
    const Light ball = middle_sized(aim, random);
    const boxes::Triple at = spots::centre(aim, ball);
    const double size = static_cast<double>(ball.w);
    const boxes::Frame f = boxes::sized(boxes::frame(at, random), size / 2, size * 1.0625, size * 1.0625);
    return boxes::box(aim, ball, boxes::plus(at, f[0], 1), f, 1);
}

/// A box whose corner touches a boundary of layers or misses it by 2^-4 to 2^-40 of its size.
BoxLight touching_layer(const Subject& s, const Aim& aim, Random& random) {
    const Light ball = middle_sized(aim, random);
    boxes::Triple at = spots::centre(aim, ball);
    const double size = static_cast<double>(ball.w), way = random.sign();
    const boxes::Frame f = boxes::half_axes(at, size, random);
    at[2] = static_cast<double>(
        s.boundaries[static_cast<std::size_t>(random.integer(0, static_cast<int>(s.boundaries.size()) - 1))]);
    at[2] += random.sign() * size * random.power_of_two(-40, -4);
    for (const boxes::Triple& axis : f)
        at[2] -= way * std::abs(axis[2]);
    return boxes::whole(aim, random, at, f, 1);
}

BoxLight any_box(const Subject& s, const Aim& aim, Random& random) {
    using Maker = BoxLight (*)(const Aim&, Random&);
    static constexpr Maker makers[] = {decal,
                                       card,
                                       stick,
                                       cube,
                                       sheared,
                                       room,
                                       room,
                                       half_ball,
                                       half_ball,
                                       boxes::projector,
                                       boxes::field,
                                       boxes::in_any_ball,
                                       boxes::around_eye,
                                       boxes::around_eye,
                                       boxes::around_eye,
                                       boxes::at_near,
                                       boxes::touching,
                                       boxes::touching,
                                       boxes::touching,
                                       boxes::along_edge,
                                       boxes::along_edge,
                                       boxes::huge};
    const int which = random.integer(0, static_cast<int>(std::size(makers)));
    return which < static_cast<int>(std::size(makers)) ? makers[which](aim, random)
                                                       : touching_layer(s, aim, random);
}

/// A box whose ball contains all corners is whole: it gets a ball without end at its own centre.
BoxLight plainly_whole(BoxLight b) {
    const ExactBox box(b);
    bool whole = true;
    if (!box.ball.all)
        for (const Vector& corner : exact_corners(b)) {
            const Vector away = corner - box.ball.centre;
            whole = whole && dot(away, away) <= square(box.ball.radius);
        }
    if (whole) b.x = b.centre[0], b.y = b.centre[1], b.z = b.centre[2], b.radius = inf;
    return b;
}

//------------------------------------------------------------------------------------------------------------

void print_float(float value) {
    std::printf(" %08x", static_cast<unsigned>(std::bit_cast<std::uint32_t>(value)));
}

/// Of one camera, all boxes of which a cell is met, and some of which none is.
class Writer {
public:
    explicit Writer(const Subject& s) : subject_(s), truth_(s.camera) {
        float from = -inf;
        layers_.emplace_back(-inf, inf);
        for (const float to : s.boundaries)
            layers_.emplace_back(std::exchange(from, to), to);
        layers_.emplace_back(from, inf);
    }

    void write(int count, int unmet_at_most) {
        print_camera(count);
        const Aim aim(subject_.camera);
        Random random(seed_of(subject_.camera.name));
        for (int made = 0, unmet = 0; made < count;) {
            const BoxLight light = any_box(subject_, aim, random);
            if (is_bad(light)) continue;
            const BoxLight box = plainly_whole(light);
            const std::vector<bool> met = verdicts(box);
            const auto cells = static_cast<std::size_t>(std::count(met.begin(), met.end(), true));
            if (cells == 0 && ++unmet > unmet_at_most) continue;
            print_box(box, met);
            ++made, all_verdicts += met.size(), all_met += cells;
        }
        std::fprintf(stderr, "%s\n", subject_.camera.name.c_str());
    }

    std::size_t all_verdicts = 0, all_met = 0;

private:
    std::vector<bool> verdicts(const BoxLight& light) const {
        const Oracle& oracle = truth_.oracle;
        const ExactBox box(light);
        std::vector<bool> met;
        for (const auto& [min, max] : layers_) {
            const Depths depths = oracle.depths(min, max);
            for (int y = 0; y < oracle.tiles_y(); ++y)
                for (int x = 0; x < oracle.tiles_x(); ++x)
                    met.push_back(meets(
                        oracle.half_spaces(oracle.columns(x, x + 1), oracle.rows(y, y + 1), depths), box));
        }
        return met;
    }

    void print_camera(int count) const {
        const Camera& camera = subject_.camera;
        std::printf("camera %s\nmatrix", camera.name.c_str());
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                print_float(static_cast<float>(camera.m[column][row]));
        std::printf(
            "\nviewport %d %d\ntile %d\norigin %s\nclip_depth %d\nforward %d\ngrid %d %d\nlayers %zu\n",
            camera.width, camera.height, camera.tile, camera.upper_left ? "upper_left" : "lower_left",
            camera.zero_to_one ? 0 : -1, truth_.oracle.depth_sign(), truth_.oracle.tiles_x(),
            truth_.oracle.tiles_y(), layers_.size());
        for (const auto& [min, max] : layers_) {
            std::printf("layer");
            print_float(min), print_float(max);
            std::printf("\n");
        }
        std::printf("boxes %d\n", count);
    }

    static void print_box(const BoxLight& b, const std::vector<bool>& met) {
        std::printf("box");
        for (const float v : {b.x, b.y, b.z, b.radius, b.centre[0], b.centre[1], b.centre[2]})
            print_float(v);
        for (const float(&axis)[3] : b.half_axes)
            for (const float v : axis)
                print_float(v);
        print_float(b.taper);
        std::printf(" ");
        for (std::size_t i = 0; i < met.size(); i += 4) {
            unsigned digit = 0;
            for (std::size_t k = i; k < i + 4; ++k)
                digit = 2 * digit + (k < met.size() && met[k]);
            std::printf("%x", digit);
        }
        std::printf("\n");
    }

    const Subject& subject_;
    Truth truth_;
    std::vector<std::pair<float, float>> layers_;
};

}  // namespace

int main() {
    constexpr int boxes_a_camera = 100, unmet_at_most = 15;
    std::size_t boxes = 0, verdicts = 0, met = 0;
    std::printf("lightbin_box_verdicts 1\n");
    for (const Subject& s : subjects()) {
        Writer writer(s);
        writer.write(boxes_a_camera, unmet_at_most);
        boxes += boxes_a_camera, verdicts += writer.all_verdicts, met += writer.all_met;
    }
    std::printf("end %zu %zu %zu\n", boxes, verdicts, met);
}
