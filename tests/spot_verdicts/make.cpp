// SPDX-License-Identifier: MIT
// Writes the verdicts to standard output, in the format that README.md describes, and to standard error how it goes.
#include "../oracle/cameras.hpp"
#include "../oracle/spots.hpp"

#include "../../bench/exact/truth.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace oracle;

namespace {

struct Layer {
    float min, max;  ///< infinite: the near, the far plane
};

/// A camera, and the layers of depth that its cells are in: all of it, then one behind another.
struct Subject {
    Camera camera;
    std::vector<Layer> layers;
};

Subject subject(const std::string& name, const Lens& lens, const Screen& screen,
                const std::vector<float>& boundaries) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    Subject s = {camera_of(name, lens, screen), {{-inf, inf}}};
    float from = -inf;
    for (const float to : boundaries) {
        s.layers.push_back({from, to});
        from = to;
    }
    s.layers.push_back({from, inf});
    return s;
}

std::vector<Subject> subjects() {
    const auto aspect = [](const Screen& screen) { return aspect_of(screen); };
    const Screen wide = {960, 540, 60, false}, uneven = {1000, 700, 64, true}, hd = {1280, 720, 80, false},
                 square = {800, 800, 80, true}, box = {900, 600, 64, false}, small = {320, 180, 20, true};
    Lens off_centre = {-0.9 * aspect(uneven), 0.3 * aspect(uneven), -0.2, 0.7, 0.25, 500};
    off_centre.looks_up_z = off_centre.zero_to_one = true;
    Lens infinite_reversed = symmetric_lens(aspect(hd), 75);
    infinite_reversed.zero_to_one = infinite_reversed.reversed = true;
    infinite_reversed.far_plane = infinite;
    Lens flipped = symmetric_lens(aspect(square), 120);
    flipped.zero_to_one = flipped.flip_y = true;
    Lens orthographic = box_lens(aspect(box), 40);
    orthographic.left += 25, orthographic.right += 25;
    Lens orthographic_reversed = box_lens(aspect(small), 32);
    orthographic_reversed.reversed = orthographic_reversed.zero_to_one = true;
    return {subject("perspective", symmetric_lens(aspect(wide), 60), wide, {1, 4, 15, 50, 200}),
            subject("off_centre", off_centre, uneven, {1, 4, 15, 50, 200}),
            subject("infinite_reversed", infinite_reversed, hd, {1, 4, 15, 50, 200}),
            subject("wide_and_flipped", flipped, square, {1, 4, 15, 50, 200}),
            subject("orthographic", orthographic, box, {20, 60, 110, 170, 240}),
            subject("orthographic_reversed", orthographic_reversed, small, {20, 60, 110, 170, 240})};
}

/// How far a spot reaches in a direction of length 1.
double reach(const spots::Triple& axis, double cosine, double radius, const spots::Triple& direction) {
    const double along = spots::along(axis, direction), across = std::sqrt(std::max(0.0, 1 - along * along)),
                 side = cosine * along + std::sqrt(1 - cosine * cosine) * across;
    return along >= cosine ? radius : std::max(0.0, radius * side);
}

/// One of the field's, moved along the view until it touches a boundary of layers, but for rounding or a little more.
SpotLight touching_layer(const Subject& s, const Aim& aim, Random& random) {
    using namespace spots;
    const SpotLight any = least_field(aim, random);
    const Triple at = centre(aim, any.ball),
                 axis = unit(centre(aim, {any.axis_x, any.axis_y, any.axis_z, 0}));
    const double way = random.sign();
    const double depth = static_cast<double>(
        s.layers[static_cast<std::size_t>(random.integer(2, static_cast<int>(s.layers.size()) - 1))].min);
    const double end = way * reach(axis, std::max(0.0, static_cast<double>(any.cosine)),
                                   static_cast<double>(any.ball.w), {0, 0, way});
    const double off = random.sign() * static_cast<double>(any.ball.w) * random.power_of_two(-40, -4);
    const Light moved = aim.light(at[0], at[1], depth - end + off, static_cast<double>(any.ball.w));
    return {moved, any.axis_x, any.axis_y, any.axis_z, any.cosine};
}

SpotLight any_spot(const Subject& s, const Aim& aim, Random& random) {
    switch (random.integer(0, 10)) {
    case 0:
    case 1:
        return spots::field(aim, random);
    case 2:
        return spots::least_field(aim, random);
    case 3:
        return spots::in_any_ball(aim, random);
    case 4:
        return spots::at_eye(aim, random);
    case 5:
    case 6:
        return spots::touching(aim, random);
    case 7:
        return spots::along_edge(aim, random);
    case 8:
        return spots::eye_on_cone(aim, random);
    case 9:
        return touching_layer(s, aim, random);
    default:
        return random.chance(0.5) ? spots::huge(aim, random) : touching_layer(s, aim, random);
    }
}

/// What every engine takes: finite, a range, a half angle below 90 degrees.
bool is_usual(const SpotLight& s) {
    return !is_bad(s) && s.ball.w > 0 && std::isfinite(s.ball.w) && s.cosine > 0;
}

/// The verdicts of one camera's cells.
class Judge {
public:
    explicit Judge(const Subject& s) : truth_(s.camera) {
        for (const Layer& layer : s.layers) {
            depths_.push_back(truth_.oracle.depths(layer.min, layer.max));
            flat_.emplace_back(depths_.back());
        }
    }

    /// In the file's order; nothing: one is open.
    std::optional<std::vector<bool>> verdicts(const SpotLight& light) {
        const Oracle& oracle = truth_.oracle;
        const ExactSpot spot = exact_spot(light);
        const CameraBall seen = oracle.in_camera(spot.ball);
        const FlatBall ball = {nearly(seen.x), nearly(seen.y), nearly(seen.depth), nearly(seen.radius)};
        std::vector<bool> met;
        for (std::size_t layer = 0; layer < depths_.size(); ++layer)
            for (int y = 0; y < oracle.tiles_y(); ++y)
                for (int x = 0; x < oracle.tiles_x(); ++x) {
                    met.push_back(false);
                    if (truth_.filter.apart(x, x + 1, y, y + 1, flat_[layer], ball)) continue;
                    const auto verdict = oracle::meets(
                        oracle.half_spaces(oracle.columns(x, x + 1), oracle.rows(y, y + 1), depths_[layer]),
                        spot);
                    ++certificates;
                    if (!verdict) {
                        ++open;
                        return std::nullopt;
                    }
                    met.back() = *verdict;
                }
        return met;
    }

    int tiles_x() const { return truth_.oracle.tiles_x(); }
    int tiles_y() const { return truth_.oracle.tiles_y(); }
    int depth_sign() const { return truth_.oracle.depth_sign(); }

    std::uint64_t certificates = 0, open = 0;

private:
    Truth truth_;
    std::vector<Depths> depths_;
    std::vector<FlatDepths> flat_;
};

void print_float(float value) {
    std::printf(" %08x", std::bit_cast<std::uint32_t>(value));
}

void print_camera(const Subject& s, const Judge& judge, int spots) {
    const Camera& camera = s.camera;
    std::printf("camera %s\nmatrix", camera.name.c_str());
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            print_float(static_cast<float>(camera.m[column][row]));
    std::printf("\nviewport %d %d\ntile %d\norigin %s\nclip_depth %d\nforward %d\ngrid %d %d\nlayers %zu\n",
                camera.width, camera.height, camera.tile, camera.upper_left ? "upper_left" : "lower_left",
                camera.zero_to_one ? 0 : -1, judge.depth_sign(), judge.tiles_x(), judge.tiles_y(),
                s.layers.size());
    for (const Layer& layer : s.layers) {
        std::printf("layer");
        print_float(layer.min), print_float(layer.max);
        std::printf("\n");
    }
    std::printf("spots %d\n", spots);
}

void print_spot(const SpotLight& s, const std::vector<bool>& met) {
    std::printf("spot");
    for (const float v : {s.ball.x, s.ball.y, s.ball.z, s.ball.w, s.axis_x, s.axis_y, s.axis_z, s.cosine})
        print_float(v);
    std::printf(" ");
    for (std::size_t i = 0; i < met.size(); i += 4) {
        unsigned digit = 0;
        for (std::size_t k = i; k < i + 4; ++k)
            digit = 2 * digit + (k < met.size() && met[k]);
        std::printf("%x", digit);
    }
    std::printf("\n");
}

}  // namespace

int main() {
    constexpr int spots_a_camera = 110, unmet_at_most = 20;
    std::size_t spots = 0, verdicts = 0, met_cells = 0;
    std::uint64_t certificates = 0, open = 0;
    std::printf("lightbin_spot_verdicts 1\n");
    for (const Subject& s : subjects()) {
        Judge judge(s);
        print_camera(s, judge, spots_a_camera);
        const Aim aim(s.camera);
        Random random(seed_of(s.camera.name));
        for (int made = 0, unmet = 0; made < spots_a_camera;) {
            const SpotLight light = any_spot(s, aim, random);
            if (!is_usual(light)) continue;
            const auto met = judge.verdicts(light);
            if (!met) continue;
            const auto count = std::count(met->begin(), met->end(), true);
            if (count == 0 && ++unmet > unmet_at_most) continue;
            print_spot(light, *met);
            ++made, ++spots;
            verdicts += met->size();
            met_cells += static_cast<std::size_t>(count);
            if (made % 10 == 0)
                std::fprintf(stderr, "%s: %d of %d spots\n", s.camera.name.c_str(), made, spots_a_camera);
        }
        certificates += judge.certificates, open += judge.open;
    }
    std::printf("end %zu %zu %zu\n", spots, verdicts, met_cells);
    std::fprintf(
        stderr,
        "%zu spots, %zu verdicts, %zu of them that they meet; %llu certificates were sought, for %llu of "
        "which there was none: those spots are left out\n",
        spots, verdicts, met_cells, static_cast<unsigned long long>(certificates),
        static_cast<unsigned long long>(open));
}
