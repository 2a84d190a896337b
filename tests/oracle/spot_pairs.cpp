// SPDX-License-Identifier: MIT
// What the bench holds lists of spots against: every pair of a tile and a spot, asked one by one without short cuts.
#include "../../bench/exact_pairs.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace {

constexpr lightbin::Extent small = {640, 360};
constexpr int tile_size = 64;

/// Z bounds of tiles, as of pixels that lie anywhere: some of one depth, some empty.
struct Bounds {
    std::vector<float> min, max;

    Bounds(std::size_t tiles, Dice& dice) {
        for (std::size_t i = 0; i < tiles; ++i) {
            const float from = dice.between(1, 40), deep = i % 3 == 0 ? 0 : dice.between(0, 30),
                        to = from + deep;
            min.push_back(i % 11 == 0 ? 2 * to : from);
            max.push_back(to);
        }
    }
    lightbin::ZBounds given() const { return {min, max}; }
};

/// One tile and one spot, by nothing but certificates.
class OneByOne {
public:
    explicit OneByOne(const glm::mat4& projection) : oracle(camera_with(projection, small, tile_size)) {}

    std::uint32_t facts(const lightbin::Spot& spot, int x, int y, const Bounds& bounds) {
        const auto tile = static_cast<std::size_t>(y * oracle.tiles_x() + x);
        if (!meets(spot, x, y, {}, {})) return 0;
        return meets(spot, x, y, bounds.min[tile], bounds.max[tile]) ? in_pyramid | in_cell : in_pyramid;
    }

    oracle::Oracle oracle;
    int open = 0;

private:
    bool meets(const lightbin::Spot& s, int x, int y, std::optional<float> min, std::optional<float> max) {
        const auto spot =
            oracle::exact_spot(s.x, s.y, s.z, s.radius, s.axis_x, s.axis_y, s.axis_z, s.cos_half_angle);
        const auto verdict = oracle::meets(
            oracle.half_spaces(oracle.columns(x, x + 1), oracle.rows(y, y + 1), oracle.depths(min, max)),
            spot);
        open += !verdict;
        return verdict.value_or(false);
    }
};

void check(BenchScene scene, std::size_t every) {
    CAPTURE(scene.name);
    Spots all = scene.spots(1), some;
    for (std::size_t i = 0; i < all.size(); i += every)
        some.push_back(all[i]);
    some.push_back(lightbin::Spot::whole({0, 0, -9, 3}));

    OneByOne truth(scene.projection);
    Dice dice(9);
    const int nx = truth.oracle.tiles_x(), ny = truth.oracle.tiles_y();
    const Bounds bounds(static_cast<std::size_t>(nx * ny), dice);
    const ExactPairs pairs = ExactDecider(scene.projection, small, tile_size).pairs(some, bounds.given());
    int met = 0, met_cell = 0, wrong = 0;
    for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x)
            for (std::uint32_t id = 0; id < some.size(); ++id) {
                std::uint32_t given = 0;
                for (const Pair& pair : pairs.tiles[static_cast<std::size_t>(y * nx + x)])
                    if (pair.id == id) given = pair.facts & (in_pyramid | in_cell);
                const int open = truth.open;
                const std::uint32_t facts = truth.facts(some[id], x, y, bounds);
                if (truth.open > open) continue;  // no certificate, no answer
                wrong += facts != given;
                met += (facts & in_pyramid) != 0;
                met_cell += (facts & in_cell) != 0;
            }
    CHECK(wrong == 0);
    CHECK(truth.open * 3 < met_cell);
    CHECK(pairs.open <= static_cast<unsigned>(truth.open));
    CHECK(met > 100);
    CHECK(met_cell > 20);
}

}  // namespace

TEST_CASE("the bench's exact pairs of tiles and spots are those that certificates prove") {
    for (BenchScene& scene : spot_scenes())
        check(std::move(scene), 3);
}
