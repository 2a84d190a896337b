// SPDX-License-Identifier: MIT
// The file of verdicts, read as an engine's tests would read it: it is whole, and every verdict is proven again. That
// lightbin misses no pair that meets is proven in tests/oracle/spots.cpp, of other spots in each run.
#include "../../bench/exact/spot.hpp"
#include "../../bench/exact/truth.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
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
    float x, y, z, radius, axis_x, axis_y, axis_z, cos_half_angle;
};

struct Part {
    std::string name;
    float matrix[4][4];  ///< [column][row]
    int width, height, tile_size;
    bool upper_left;
    int clip_depth, forward, tiles_x, tiles_y;
    std::vector<Layer> layers;
    std::vector<Spot> spots;
    std::vector<std::vector<bool>> met;  ///< of each spot, layer by layer, row by row

    std::size_t tiles() const { return static_cast<std::size_t>(tiles_x * tiles_y); }
    bool meets(std::size_t spot, std::size_t layer, std::size_t tile) const {
        return met[spot][layer * tiles() + tile];
    }
};

class Reader {
public:
    explicit Reader(const char* path) : file_(path) {
        if (!file_) throw std::runtime_error(std::string("cannot read ") + path);
    }

    std::vector<Part> parts() {
        expect("lightbin_spot_verdicts");
        if (integer() != 1) throw std::runtime_error("another version of the format");
        std::vector<Part> parts;
        std::string word = next();
        for (; word == "camera"; word = next())
            parts.push_back(part());
        if (word != "end") throw std::runtime_error("neither camera nor end: " + word);
        std::size_t spots = 0, verdicts = 0, met = 0;
        for (const Part& part : parts)
            for (const std::vector<bool>& cells : part.met) {
                ++spots, verdicts += cells.size();
                met += static_cast<std::size_t>(std::count(cells.begin(), cells.end(), true));
            }
        for (const std::size_t expected : {spots, verdicts, met})
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

    Part part() {
        Part p;
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
        const int spots = integer("spots");
        for (int i = 0; i < spots; ++i) {
            expect("spot");
            Spot s;
            for (float* v : {&s.x, &s.y, &s.z, &s.radius, &s.axis_x, &s.axis_y, &s.axis_z, &s.cos_half_angle})
                *v = number();
            p.spots.push_back(s);
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
bool reversed(const Part& p) {
    return p.matrix[2][3] == 0 && (p.matrix[2][2] > 0) != (p.forward > 0);
}

oracle::Camera camera_of(const Part& p) {
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

/// A spot in the exact arithmetic's forms.
struct Subject {
    oracle::ExactSpot spot;
    oracle::FlatBall ball;

    Subject(const oracle::Oracle& exact, const Spot& s)
        : spot(oracle::exact_spot(s.x, s.y, s.z, s.radius, s.axis_x, s.axis_y, s.axis_z, s.cos_half_angle)) {
        const oracle::CameraBall seen = exact.in_camera(spot.ball);
        ball = {oracle::nearly(seen.x), oracle::nearly(seen.y), oracle::nearly(seen.depth),
                oracle::nearly(seen.radius)};
    }
};

struct Proof {
    std::size_t verdicts = 0, met = 0, wrong = 0;
};

void prove(const Part& p, Proof& proof) {
    oracle::Truth truth(camera_of(p));
    const oracle::Oracle& exact = truth.oracle;
    REQUIRE(exact.tiles_x() == p.tiles_x);
    REQUIRE(exact.tiles_y() == p.tiles_y);
    REQUIRE(exact.depth_sign() == p.forward);
    std::vector<Subject> subjects;
    for (const Spot& spot : p.spots)
        subjects.emplace_back(exact, spot);
    for (std::size_t layer = 0; layer < p.layers.size(); ++layer) {
        const oracle::Depths depths = exact.depths(p.layers[layer].min, p.layers[layer].max);
        const oracle::FlatDepths flat(depths);
        for (std::size_t tile = 0; tile < p.tiles(); ++tile) {
            const int x = static_cast<int>(tile) % p.tiles_x, y = static_cast<int>(tile) / p.tiles_x;
            const auto cell = exact.half_spaces(exact.columns(x, x + 1), exact.rows(y, y + 1), depths);
            for (std::size_t i = 0; i < subjects.size(); ++i) {
                // Double precision says so of the ball of most.
                const bool apart = truth.filter.apart(x, x + 1, y, y + 1, flat, subjects[i].ball);
                const auto verdict = apart ? std::optional(false) : oracle::meets(cell, subjects[i].spot);
                const bool expected = p.meets(i, layer, tile);
                ++proof.verdicts, proof.met += expected, proof.wrong += verdict != expected;
            }
        }
    }
}

}  // namespace

TEST_CASE("spot verdicts: proven again") {
    Proof proof;
    for (const Part& p : Reader(SPOT_VERDICTS).parts())
        prove(p, proof);
    MESSAGE(proof.verdicts << " verdicts, " << proof.met << " of them that they meet");
    CHECK(proof.wrong == 0);
    CHECK(proof.verdicts > 300000);
    CHECK(proof.met > 10000);
}
