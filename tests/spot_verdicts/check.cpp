// SPDX-License-Identifier: MIT
// Reads the files of answers whether spots and boxes meet cells as another engine's tests would: each file is complete,
// and every answer is proven again. That lightbin misses no light is tested in tests/oracle.
#include "../../bench/exact/box.hpp"
#include "../../bench/exact/oracle.hpp"
#include "../../bench/exact/spot.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Proof {
    std::size_t lights = 0, verdicts = 0, met = 0, wrong = 0;
};

/// Returns a light for the exact arithmetic from the numbers in a line.
oracle::ExactSpot spot(const std::vector<float>& v) {
    return oracle::exact_spot(v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]);
}
oracle::ExactBox box(const std::vector<float>& v) {
    return oracle::ExactBox({v[0], v[1], v[2], v[3], {v[4], v[5], v[6]},
                             {{v[7], v[8], v[9]}, {v[10], v[11], v[12]}, {v[13], v[14], v[15]}}, v[16]});
}

/// Proves every verdict of a file.
template <class Read> Proof proof_of(const std::string& path, const std::string& word_for_light, const Read& read) {
    Proof proof;
    oracle::Camera camera;
    std::unique_ptr<oracle::Oracle> grid;
    int forward = 0, tiles_x = 0, tiles_y = 0;
    std::vector<oracle::Depths> layers;

    std::ifstream file(path);
    std::string line, key, word;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        words >> key;
        const auto number = [&] {
            words >> word;
            return std::bit_cast<float>(static_cast<std::uint32_t>(std::stoul(word, nullptr, 16)));
        };
        if (key == "camera") {
            camera = {}, layers = {};
        } else if (key == "matrix") {
            for (int i = 0; i < 16; ++i)
                camera.m[i / 4][i % 4] = static_cast<double>(number());
        } else if (key == "viewport") {
            words >> camera.width >> camera.height;
        } else if (key == "tile") {
            words >> camera.tile;
        } else if (key == "origin") {
            words >> word;
            camera.upper_left = word == "upper_left";
        } else if (key == "clip_depth") {
            words >> word;
            camera.zero_to_one = word == "0";
        } else if (key == "forward") {
            words >> forward;
            // An orthographic matrix needs the setting "reversed" if its depth grows the other way.
            camera.reversed = camera.m[2][3] == 0 && (camera.m[2][2] > 0) != (forward > 0);
            grid = std::make_unique<oracle::Oracle>(camera);
        } else if (key == "grid") {
            words >> tiles_x >> tiles_y;
            REQUIRE(grid->tiles_x() == tiles_x);
            REQUIRE(grid->tiles_y() == tiles_y);
            REQUIRE(grid->depth_sign() == forward);
        } else if (key == "layer") {
            const float min = number(), max = number();
            layers.push_back(grid->depths(min, max));
        } else if (key == word_for_light) {
            std::vector<float> numbers;
            for (auto n = std::count(line.begin(), line.end(), ' '); n > 1; --n)
                numbers.push_back(number());
            words >> word;  // the verdicts, four cells a digit
            const auto light = read(numbers);
            const std::size_t tiles = static_cast<std::size_t>(tiles_x * tiles_y), cells = layers.size() * tiles;
            REQUIRE(word.size() == (cells + 3) / 4);
            for (std::size_t cell = 0; cell < cells; ++cell) {
                const int digit = std::stoi(word.substr(cell / 4, 1), nullptr, 16);
                const bool expected = (digit >> (3 - cell % 4) & 1) != 0;
                const oracle::Depths& depths = layers[cell / tiles];
                const int x = static_cast<int>(cell % tiles) % tiles_x, y = static_cast<int>(cell % tiles) / tiles_x;
                const std::optional<bool> verdict = oracle::meets(
                    grid->half_spaces(grid->columns(x, x + 1), grid->rows(y, y + 1), depths), light);
                ++proof.verdicts, proof.met += expected, proof.wrong += verdict != expected;
            }
            ++proof.lights;
        } else if (key == "end") {  // the file is whole
            std::size_t lights = 0, verdicts = 0, met = 0;
            words >> lights >> verdicts >> met;
            CHECK(proof.lights == lights);
            CHECK(proof.verdicts == verdicts);
            CHECK(proof.met == met);
        }
    }
    REQUIRE(key == "end");
    return proof;
}

}  // namespace

TEST_CASE("spot verdicts: proven again") {
    CHECK(proof_of(VERDICTS "/verdicts.txt", "spot", spot).wrong == 0);
}

TEST_CASE("box verdicts: proven again") {
    CHECK(proof_of(VERDICTS "/boxes.txt", "box", box).wrong == 0);
}
