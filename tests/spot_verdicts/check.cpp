// SPDX-License-Identifier: MIT
// The files of verdicts on spots and on boxes, read as an engine's tests would read them: each file is whole, and every
// verdict is proven again. That lightbin misses no spot and no box is proven in tests/oracle, of other ones.
#include "../../bench/exact/box.hpp"
#include "../../bench/exact/spot.hpp"
#include "../../bench/exact/truth.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

struct Layer {
    float min, max;
};

struct Spot {
    static constexpr const char *title = "lightbin_spot_verdicts", *plural = "spots", *singular = "spot";
    float x, y, z, radius, axis_x, axis_y, axis_z, cos_half_angle;

    static Spot read(auto number) {
        Spot s;
        for (float* v : {&s.x, &s.y, &s.z, &s.radius, &s.axis_x, &s.axis_y, &s.axis_z, &s.cos_half_angle})
            *v = number();
        return s;
    }
};

struct Box : oracle::BoxLight {
    static constexpr const char *title = "lightbin_box_verdicts", *plural = "boxes", *singular = "box";

    static Box read(auto number) {
        Box b;
        for (float* v : {&b.x, &b.y, &b.z, &b.radius, &b.centre[0], &b.centre[1], &b.centre[2]})
            *v = number();
        for (float(&axis)[3] : b.half_axes)
            for (float& v : axis)
                v = number();
        b.taper = number();
        return b;
    }
};

/// The cells of one camera, and the lights, spots or boxes, that were held against them.
template <class Light> struct Part {
    std::string name;
    float matrix[4][4];  ///< [column][row]
    int width, height, tile_size;
    bool upper_left;
    int clip_depth, forward, tiles_x, tiles_y;
    std::vector<Layer> layers;
    std::vector<Light> lights;
    std::vector<std::vector<bool>> met;  ///< of each light, layer by layer, row by row

    std::size_t tiles() const { return static_cast<std::size_t>(tiles_x * tiles_y); }
    bool meets(std::size_t light, std::size_t layer, std::size_t tile) const {
        return met[light][layer * tiles() + tile];
    }
};

template <class Light> class Reader {
public:
    explicit Reader(const char* path) : file_(path) {
        if (!file_) throw std::runtime_error(std::string("cannot read ") + path);
    }

    std::vector<Part<Light>> parts() {
        expect(Light::title);
        if (integer() != 1) throw std::runtime_error("another version of the format");
        std::vector<Part<Light>> parts;
        std::string word = next();
        for (; word == "camera"; word = next())
            parts.push_back(part());
        if (word != "end") throw std::runtime_error("neither camera nor end: " + word);
        std::size_t lights = 0, verdicts = 0, met = 0;
        for (const Part<Light>& part : parts)
            for (const std::vector<bool>& cells : part.met) {
                ++lights, verdicts += cells.size();
                met += static_cast<std::size_t>(std::count(cells.begin(), cells.end(), true));
            }
        for (const std::size_t expected : {lights, verdicts, met})
            if (static_cast<std::size_t>(integer()) != expected)
                throw std::runtime_error("the file is not whole");
        return parts;
    }

private:
    std::string next() {
        std::string word;
        if (!(file_ >> word)) throw std::runtime_error("the file ends early");
        return word;
    }
    void expect(const char* keyword) {
        if (const std::string word = next(); word != keyword)
            throw std::runtime_error(word + " where " + keyword + " should be");
    }
    int integer() { return std::stoi(next()); }
    int integer(const char* keyword) {
        expect(keyword);
        return integer();
    }
    float number() {
        return std::bit_cast<float>(static_cast<std::uint32_t>(std::stoul(next(), nullptr, 16)));
    }

    Part<Light> part() {
        Part<Light> p;
        p.name = next();
        expect("matrix");
        for (auto& column : p.matrix)
            for (float& entry : column)
                entry = number();
        p.width = integer("viewport"), p.height = integer();
        p.tile_size = integer("tile");
        expect("origin");
        p.upper_left = next() == "upper_left";
        p.clip_depth = integer("clip_depth");
        p.forward = integer("forward");
        p.tiles_x = integer("grid"), p.tiles_y = integer();
        p.layers.resize(static_cast<std::size_t>(integer("layers")));
        for (Layer& layer : p.layers) {
            expect("layer");
            layer.min = number(), layer.max = number();
        }
        const int lights = integer(Light::plural);
        for (int i = 0; i < lights; ++i) {
            expect(Light::singular);
            p.lights.push_back(Light::read([this] { return number(); }));
            p.met.push_back(bits(next(), p.layers.size() * p.tiles()));
        }
        return p;
    }

    static std::vector<bool> bits(const std::string& digits, std::size_t count) {
        if (digits.size() != (count + 3) / 4) throw std::runtime_error("verdicts of another number of cells");
        std::vector<bool> bits;
        for (const char digit : digits)
            for (const int value = std::stoi(std::string(1, digit), nullptr, 16);
                 const int bit : {8, 4, 2, 1})
                bits.push_back((value & bit) != 0);
        bits.resize(count);
        return bits;
    }

    std::ifstream file_;
};

/// The declaration that an orthographic matrix needs: its depth grows the other way.
template <class Light> bool reversed(const Part<Light>& p) {
    return p.matrix[2][3] == 0 && (p.matrix[2][2] > 0) != (p.forward > 0);
}

template <class Light> oracle::Camera camera_of(const Part<Light>& p) {
    oracle::Camera camera;
    camera.name = p.name;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            camera.m[column][row] = static_cast<double>(p.matrix[column][row]);
    camera.width = p.width, camera.height = p.height, camera.tile = p.tile_size;
    camera.zero_to_one = p.clip_depth == 0, camera.upper_left = p.upper_left;
    camera.reversed = reversed(p);
    return camera;
}

oracle::FlatBall flat(const oracle::CameraBall& ball) {
    return {oracle::nearly(ball.x), oracle::nearly(ball.y), oracle::nearly(ball.depth),
            ball.all ? HUGE_VAL : oracle::nearly(ball.radius)};
}

auto cell_of(const oracle::Oracle& exact, int x, int y, const oracle::Depths& depths) {
    return exact.half_spaces(exact.columns(x, x + 1), exact.rows(y, y + 1), depths);
}

/// A spot in the exact arithmetic's forms.
struct ExactSpot {
    oracle::ExactSpot spot;
    oracle::FlatBall ball;

    ExactSpot(const oracle::Oracle& exact, const Spot& s)
        : spot(oracle::exact_spot(s.x, s.y, s.z, s.radius, s.axis_x, s.axis_y, s.axis_z, s.cos_half_angle)),
          ball(flat(exact.in_camera(spot.ball))) {}

    std::optional<bool> meets(oracle::Truth& truth, int x, int y, const oracle::Depths& depths,
                              const oracle::FlatDepths& flat_depths) const {
        // Double precision says so of the ball of most.
        if (truth.filter.apart(x, x + 1, y, y + 1, flat_depths, ball)) return false;
        return oracle::meets(cell_of(truth.oracle, x, y, depths), spot);
    }
};

/// A box in the exact arithmetic's forms.
struct ExactBox {
    oracle::ExactBox box;
    oracle::FlatBall ball;
    oracle::FlatBox corners = {};

    ExactBox(const oracle::Oracle& exact, const Box& b) : box(b), ball(flat(exact.in_camera(box.ball))) {
        const std::vector<oracle::Vector> given = oracle::exact_corners(b);
        for (std::size_t i = 0; i < given.size(); ++i) {
            const oracle::FlatBall corner = flat(exact.in_camera({given[i], 0}));
            const double seen[] = {corner.x, corner.y, corner.depth};
            for (std::size_t k = 0; k < 3; ++k) {
                corners.corners[i][k] = seen[k];
                corners.error = std::max(corners.error,
                                         std::abs(seen[k]) * 0x1p-52);  // the digits that nearly() cuts off
            }
        }
    }

    std::optional<bool> meets(oracle::Truth& truth, int x, int y, const oracle::Depths& depths,
                              const oracle::FlatDepths& flat_depths) const {
        // Double precision says so of most, by the ball or by the box.
        if (truth.filter.apart(x, x + 1, y, y + 1, flat_depths, ball) ||
            oracle::apart(truth.filter, x, x + 1, y, y + 1, flat_depths, corners))
            return false;
        return oracle::meets(cell_of(truth.oracle, x, y, depths), box);
    }
};

struct Proof {
    std::size_t verdicts = 0, met = 0, wrong = 0;
};

template <class Exact, class Light> void prove(const Part<Light>& p, Proof& proof) {
    oracle::Truth truth(camera_of(p));
    const oracle::Oracle& exact = truth.oracle;
    REQUIRE(exact.tiles_x() == p.tiles_x);
    REQUIRE(exact.tiles_y() == p.tiles_y);
    REQUIRE(exact.depth_sign() == p.forward);
    std::vector<Exact> subjects;
    for (const Light& light : p.lights)
        subjects.emplace_back(exact, light);
    for (std::size_t layer = 0; layer < p.layers.size(); ++layer) {
        const oracle::Depths depths = exact.depths(p.layers[layer].min, p.layers[layer].max);
        const oracle::FlatDepths flat_depths(depths);
        for (std::size_t tile = 0; tile < p.tiles(); ++tile) {
            const int x = static_cast<int>(tile) % p.tiles_x, y = static_cast<int>(tile) / p.tiles_x;
            for (std::size_t i = 0; i < subjects.size(); ++i) {
                const auto verdict = subjects[i].meets(truth, x, y, depths, flat_depths);
                const bool expected = p.meets(i, layer, tile);
                ++proof.verdicts, proof.met += expected, proof.wrong += verdict != expected;
            }
        }
    }
}

/// Proves every verdict of a file.
template <class Exact, class Light> Proof proof_of(const std::vector<Part<Light>>& parts) {
    Proof proof;
    for (const Part<Light>& p : parts)
        prove<Exact>(p, proof);
    MESSAGE(proof.verdicts << " verdicts, " << proof.met << " of them that they meet");
    return proof;
}

}  // namespace

TEST_CASE("spot verdicts: proven again") {
    const Proof proof = proof_of<ExactSpot>(Reader<Spot>(VERDICTS "/verdicts.txt").parts());
    CHECK(proof.wrong == 0);
    CHECK(proof.verdicts > 300000);
    CHECK(proof.met > 10000);
}

TEST_CASE("box verdicts: proven again") {
    const Proof proof = proof_of<ExactBox>(Reader<Box>(VERDICTS "/boxes.txt").parts());
    CHECK(proof.wrong == 0);
    CHECK(proof.verdicts > 200000);
    CHECK(proof.met > 5000);
}
