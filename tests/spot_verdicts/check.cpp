// SPDX-License-Identifier: MIT
// The file of verdicts, read as another engine's tests would read it: it is whole, every verdict is proven again, and no
// rung of the library misses a pair that meets.
#include "../../bench/exact/spot.hpp"
#include "../../bench/exact/truth.hpp"

#include <lightbin/binner.hpp>
#include <lightbin/spot.hpp>

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

struct Part {
    std::string name;
    float matrix[4][4];  ///< [column][row]
    int width, height, tile_size;
    bool upper_left;
    int clip_depth, forward, tiles_x, tiles_y;
    std::vector<Layer> layers;
    std::vector<lightbin::Spot> spots;
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
            lightbin::Spot s;
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

const std::vector<Part>& all_parts() {
    static const std::vector<Part> parts = Reader(SPOT_VERDICTS).parts();
    return parts;
}

/// The declaration that an orthographic matrix needs: its depth grows the other way.
bool reversed(const Part& p) {
    return p.matrix[2][3] == 0 && (p.matrix[2][2] > 0) != (p.forward > 0);
}

lightbin::View view_of(const Part& p) {
    const auto view = lightbin::View::from_projection(
        p.matrix, {p.width, p.height},
        {.tile_size = p.tile_size,
         .clip_depth =
             p.clip_depth == 0 ? lightbin::ClipDepth::zero_to_one : lightbin::ClipDepth::minus_one_to_one,
         .origin = p.upper_left ? lightbin::WindowOrigin::upper_left : lightbin::WindowOrigin::lower_left,
         .reversed_z = reversed(p)});
    REQUIRE(view.has_value());
    REQUIRE(view->tiles_x() == p.tiles_x);
    REQUIRE(view->tiles_y() == p.tiles_y);
    return *view;
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

/// Pairs that meet, and how many of them were not listed.
struct Count {
    std::size_t met = 0, missed = 0;

    /// Holds lists(tile), ids that ascend, against the layers of which a list must have the spots.
    template <class Lists>
    void add(const Part& p, const std::vector<std::size_t>& layers, const char* rung, Lists lists) {
        for (std::size_t tile = 0; tile < p.tiles(); ++tile) {
            const auto list = lists(tile);
            for (std::size_t spot = 0; spot < p.spots.size(); ++spot) {
                if (std::ranges::none_of(layers,
                                         [&](std::size_t layer) { return p.meets(spot, layer, tile); }))
                    continue;
                ++met;
                if (std::ranges::find(list, spot) == list.end() && ++missed <= 5)
                    MESSAGE("MISS: " << rung << ", " << p.name << ", spot " << spot << ", tile " << tile);
            }
        }
    }
};

/// A tile's list of a grid.
template <class Grid> auto list_of(const Grid& grid, std::size_t cell) {
    return grid.ids().subspan(grid.ranges()[cell].offset, grid.ranges()[cell].count);
}

template <lightbin::Options options> void count_plain(const Part& p, Count& count) {
    lightbin::Binner<options> binner;
    const auto grid = *binner.bin(view_of(p), lightbin::view_space(p.spots));
    count.add(p, {0}, to_string(options.footprint), [&](std::size_t tile) { return list_of(grid, tile); });
}

/// Every layer as the Z bounds of all tiles; of split_box, two with the one between them left out.
template <lightbin::Options options> void count_bounded(const Part& p, Count& count) {
    constexpr bool split = options.depth_test == lightbin::DepthTest::split_box;
    lightbin::Binner<options> binner;
    const lightbin::View view = view_of(p);
    const auto all_tiles = [&](float depth) { return std::vector<float>(p.tiles(), depth); };
    for (std::size_t first = 1; first + (split ? 2 : 0) < p.layers.size(); ++first) {
        const std::size_t last = first + (split ? 2 : 0);
        const std::vector<float> min = all_tiles(p.layers[first].min), max = all_tiles(p.layers[last].max),
                                 gap_min = all_tiles(p.layers[first].max),
                                 gap_max = all_tiles(p.layers[last].min);
        lightbin::ZBounds bounds = {.min = min, .max = max};
        if (split) bounds.gap_min = gap_min, bounds.gap_max = gap_max;
        const auto grid = *binner.bin(view, lightbin::view_space(p.spots), {.bounds = bounds});
        count.add(p, {first, last}, to_string(options.depth_test),
                  [&](std::size_t tile) { return list_of(grid, tile); });
    }
}

template <lightbin::Options options> void count_sliced(const Part& p, Count& count) {
    std::vector<float> boundaries;
    for (std::size_t layer = 2; layer < p.layers.size(); ++layer)
        boundaries.push_back(p.layers[layer].min);
    const auto slices = *lightbin::Slices::from_boundaries(boundaries);
    lightbin::Binner<options> binner;
    const auto grid = *binner.bin(view_of(p), lightbin::view_space(p.spots), {.slices = slices});
    for (std::size_t layer = 1; layer < p.layers.size(); ++layer)
        count.add(p, {layer}, to_string(options.slicing), [&](std::size_t tile) {
            if constexpr (options.slicing == lightbin::Slicing::clusters) {
                return list_of(grid, (layer - 1) * p.tiles() + tile);
            } else {
                std::vector<std::size_t> ids;
                for (const std::uint32_t rank :
                     lightbin::lights_of_bin(list_of(grid, tile), grid.ranks().bins[layer - 1]))
                    ids.push_back(grid.ranks().order[rank]);
                return ids;
            }
        });
}

}  // namespace

TEST_CASE("spot verdicts: no rung misses a pair that meets") {
    using lightbin::DepthTest, lightbin::Footprint, lightbin::Options, lightbin::Slicing;
    Count count;
    for (const Part& p : all_parts()) {
        count_plain<Options{}>(p, count);
        count_plain<Options{.footprint = Footprint::silhouette}>(p, count);
        count_bounded<Options{.depth_test = DepthTest::interval}>(p, count);
        count_bounded<Options{.depth_test = DepthTest::box}>(p, count);
        count_bounded<Options{.depth_test = DepthTest::split_box}>(p, count);
        count_bounded<Options{.footprint = Footprint::silhouette, .depth_test = DepthTest::box}>(p, count);
        count_sliced<Options{.slicing = Slicing::clusters}>(p, count);
        count_sliced<Options{.depth_test = DepthTest::box, .slicing = Slicing::clusters}>(p, count);
        count_sliced<Options{
            .footprint = Footprint::silhouette, .depth_test = DepthTest::box, .slicing = Slicing::clusters}>(
            p, count);
        count_sliced<Options{.slicing = Slicing::z_bins}>(p, count);
        count_sliced<Options{.footprint = Footprint::silhouette, .slicing = Slicing::z_bins}>(p, count);
    }
    MESSAGE(count.met << " pairs that meet, in all rungs");
    CHECK(count.missed == 0);
    CHECK(count.met > 100000);
}

namespace {

/// A spot in the exact arithmetic's forms.
struct Subject {
    oracle::ExactSpot spot;
    oracle::FlatBall ball;

    Subject(const oracle::Oracle& exact, const lightbin::Spot& s)
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
    for (const lightbin::Spot& spot : p.spots)
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
    for (const Part& p : all_parts())
        prove(p, proof);
    MESSAGE(proof.verdicts << " verdicts, " << proof.met << " of them that they meet");
    CHECK(proof.wrong == 0);
    CHECK(proof.verdicts > 300000);
    CHECK(proof.met > 10000);
}
