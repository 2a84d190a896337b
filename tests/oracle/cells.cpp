// SPDX-License-Identifier: MIT
// No miss, and no excess beyond what rectangles and depth intervals explain, on every camera kind.
#include "bounds.hpp"
#include "harness.hpp"

using namespace oracle;

namespace {

constexpr std::size_t lights_a_set = 950;

void examine_rectangles(const Camera& camera, Tally& tally, std::uint64_t& seed) {
    Examiner examiner(camera, tally);
    const lightbin::View view = view_of(camera);
    lightbin::Binner<> binner;
    lightbin::Binner<lightbin::Options{.index = lightbin::Index::u16}> small_binner;
    for (const SphereSet& set : sphere_sets()) {
        const std::vector<Light> lights = make(set, camera, lights_a_set, ++seed);
        const auto grid = binner.bin(view, lights);
        REQUIRE(grid.has_value());
        CHECK(grid->rejected() == std::count_if(lights.begin(), lights.end(), is_bad));
        const auto small = small_binner.bin(view, lights);
        REQUIRE(small.has_value());
        CHECK(std::equal(grid->indices().begin(), grid->indices().end(), small->indices().begin(),
                         small->indices().end()));
        const std::vector<Emitted> emitted = emitted_tiles(*grid, lights.size());
        for (std::size_t i = 0; i < lights.size(); ++i)
            examiner.examine_rectangle(lights[i], i, set.name, emitted[i]);
    }
}

template <class Id> bool same(const lightbin::LightGrid<Id>& a, const lightbin::LightGrid<Id>& b) {
    return std::equal(a.indices().begin(), a.indices().end(), b.indices().begin(), b.indices().end()) &&
           std::equal(
               a.tiles().begin(), a.tiles().end(), b.tiles().begin(), b.tiles().end(),
               [](lightbin::Tile s, lightbin::Tile t) { return s.offset == t.offset && s.count == t.count; });
}

void examine_intervals(const Camera& camera, Tally& tally, std::uint64_t& seed) {
    constexpr auto interval = lightbin::Options{.depth_test = lightbin::DepthTest::interval};
    Examiner examiner(camera, tally);
    const Oracle& oracle = examiner.oracle;
    const lightbin::View view = view_of(camera);
    const Aim aim(camera);
    lightbin::Binner<> rectangles;
    lightbin::Binner<interval> binner, other;
    lightbin::Binner<lightbin::Options{.index = lightbin::Index::u16,
                                       .depth_test = lightbin::DepthTest::interval}>
        small_binner;
    const std::size_t tiles = view.tile_count();

    for (const SphereSet& set : sphere_sets()) {
        const std::size_t count = std::clamp<std::size_t>(40000 / tiles, 8, 300);
        const std::vector<Light> lights = make(set, camera, count, ++seed);
        Random random(++seed);
        const Bounds bounds =
            make_bounds(camera, aim, lights, static_cast<BoundsShape>(seed / 2 % 3), random);
        const auto rectangle_grid = rectangles.bin(view, lights);
        REQUIRE(rectangle_grid.has_value());
        const auto in_rectangle = membership(*rectangle_grid, lights.size());
        std::vector<Examiner::Subject> subjects;
        for (const Light& light : lights)
            subjects.push_back(examiner.subject(is_bad(light) ? Light{} : light));

        for (const int sides : {1, 2, 3}) {  // minimum, maximum, both
            lightbin::ZBounds given;
            if (sides & 1) given.min = bounds.min;
            if (sides & 2) given.max = bounds.max;
            const auto grid = binner.bin(view, lights, given);
            REQUIRE(grid.has_value());
            emitted_tiles(*grid, lights.size());
            const auto in_list = membership(*grid, lights.size());
            for (std::size_t tile = 0; tile < tiles; ++tile) {
                const int x = static_cast<int>(tile) % oracle.tiles_x(),
                          y = static_cast<int>(tile) / oracle.tiles_x();
                std::optional<float> min, max;
                if (sides & 1) min = bounds.min[tile];
                if (sides & 2) max = bounds.max[tile];
                const Depths depths = oracle.depths(min, max);
                for (std::size_t i = 0; i < lights.size(); ++i) {
                    const auto at = [&] { return "tile " + std::to_string(x) + ", " + std::to_string(y); };
                    if (in_list[tile][i]) {
                        // Only lights of the rectangle, and of these only those whose depths meet the bounds.
                        ++tally.explained;
                        const auto finite = [](std::optional<float> bound) {
                            return bound && std::isfinite(*bound) ? std::optional(exact(*bound))
                                                                  : std::nullopt;
                        };
                        const bool empty = (min && max && *min > *max) ||
                                           (min && std::isinf(*min) && *min > 0) ||
                                           (max && std::isinf(*max) && *max < 0);
                        const bool fits = examiner.depths_within(subjects[i], finite(min), finite(max));
                        // In float the depth interval of a light may reach infinity, and then meets a bound
                        // that lies there.
                        const bool endless = std::isinf(std::abs(lights[i].z) + lights[i].w);
                        if (!in_rectangle[tile][i] || !fits || (empty && !endless))
                            tally.report(tally.unexplained, "unexplained", camera, set.name, i, lights[i],
                                         at());
                    } else if (in_rectangle[tile][i]) {
                        ++tally.verdicts;
                        if (examiner.meets_tile(subjects[i], x, y, depths))
                            tally.report(tally.misses, "MISS", camera, set.name, i, lights[i], at());
                    }
                }
            }
            const auto small = small_binner.bin(view, lights, given);
            REQUIRE(small.has_value());
            CHECK(std::equal(grid->indices().begin(), grid->indices().end(), small->indices().begin(),
                             small->indices().end()));

            if (sides != 1) {  // Listing 4.2: the transparent list is pruned by the maximum alone
                const auto both =
                    other.bin_transparency(view, lights, {.min = bounds.min, .max = bounds.max});
                REQUIRE(both.has_value());
                CHECK(same(sides == 2 ? both->transparent : both->opaque, *grid));
            }
        }
    }
}

void prove(const std::string& kind, const std::vector<Camera>& cameras) {
    Tally rectangles, intervals;
    std::uint64_t seed = seed_of(kind);
    for (const Camera& camera : cameras) {
        examine_rectangles(camera, rectangles, seed);
        examine_intervals(camera, intervals, seed);
    }
    MESSAGE(kind << ": " << rectangles.verdicts << " exact verdicts on lights outside their rectangles ("
                 << rectangles.twice << " of them by both deciders), " << intervals.verdicts
                 << " on pairs outside Z bounds; explained: " << rectangles.explained << " rectangles, "
                 << intervals.explained << " pairs");
    for (const Tally& tally : {rectangles, intervals}) {
        CHECK(tally.misses == 0);
        CHECK(tally.below == 0);
        CHECK(tally.unexplained == 0);
        CHECK(tally.verdicts >= 100000);
        CHECK(tally.explained >= 10000);
    }
}

}  // namespace

#define PROVE(kind)                                                                                          \
    TEST_CASE("cells: " #kind) {                                                                             \
        prove(#kind, kinds::kind());                                                                         \
    }
ORACLE_CAMERA_KINDS(PROVE)
