// SPDX-License-Identifier: MIT
// No miss, and no excess beyond what rectangles, depths and boxes explain, on every camera kind.
#include "bounds.hpp"
#include "harness.hpp"

using namespace oracle;

namespace {

constexpr std::size_t lights_a_set = 950;

void examine_rectangles(const Camera& camera, Tally& tally, std::uint64_t& seed) {
    Examiner examiner(camera, tally);
    const lightbin::View view = view_of(camera);
    lightbin::Binner<> binner;
    lightbin::Binner<lightbin::Options{.ids = lightbin::IdWidth::u16}> small_binner;
    for (const SphereSet& set : sphere_sets()) {
        const std::vector<Light> lights = make(set, camera, lights_a_set, ++seed);
        const auto grid = binner.bin(view, lights);
        REQUIRE(grid.has_value());
        CHECK(grid->light_counts().rejected == rejected_of(lights));
        const auto small = small_binner.bin(view, lights);
        REQUIRE(small.has_value());
        CHECK(std::equal(grid->ids().begin(), grid->ids().end(), small->ids().begin(), small->ids().end()));
        const std::vector<Emitted> emitted = emitted_tiles(*grid, lights.size());
        for (std::size_t i = 0; i < lights.size(); ++i)
            examiner.examine_rectangle(lights[i], i, set.name, emitted[i]);
    }
}

/// Every pair that a Binner with the depth test lists or, of those that rectangles give, does not list.
void examine_depth_test(const Camera& camera, Tally& tally, std::uint64_t& seed) {
    Examiner examiner(camera, tally);
    const Oracle& oracle = examiner.oracle;
    const lightbin::View view = view_of(camera);
    const Aim aim(camera);
    lightbin::Binner<> rectangles;
    lightbin::Binner<lightbin::Options{.depth_test = true}> binner;
    lightbin::Binner<lightbin::Options{.ids = lightbin::IdWidth::u16, .depth_test = true}> small_binner;
    const std::size_t tiles = view.tile_count();

    for (const SphereSet& set : sphere_sets()) {
        const std::size_t count = std::clamp<std::size_t>(25000 / tiles, 8, 200);
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
            const auto grid = binner.bin(view, lights, {.bounds = given});
            REQUIRE(grid.has_value());
            emitted_tiles(*grid, lights.size());
            const auto in_list = membership(*grid, lights.size());
            for (std::size_t tile = 0; tile < tiles; ++tile) {
                const int x = static_cast<int>(tile) % oracle.tiles_x(),
                          y = static_cast<int>(tile) / oracle.tiles_x();
                std::optional<float> min, max;
                if (sides & 1) min = bounds.min[tile];
                if (sides & 2) max = bounds.max[tile];
                const Examiner::Cell cell(examiner, min.value_or(-INFINITY), max.value_or(INFINITY));
                const auto finite = [](std::optional<float> bound) {
                    return bound && std::isfinite(*bound) ? std::optional(exact(*bound)) : std::nullopt;
                };
                const std::optional<Rational> least = finite(min), most = finite(max);
                const FlatDepths flat = {least ? static_cast<double>(*min) : -infinite,
                                         most ? static_cast<double>(*max) : infinite};
                for (std::size_t i = 0; i < lights.size(); ++i) {
                    const auto at = [&] { return "tile " + std::to_string(x) + ", " + std::to_string(y); };
                    if (in_list[tile][i]) {
                        // Only lights of the rectangle, and of these only those whose depths meet the bounds
                        // and whose sphere the box.
                        ++tally.explained;
                        const bool empty = (min && max && *min > *max) ||
                                           (min && std::isinf(*min) && *min > 0) ||
                                           (max && std::isinf(*max) && *max < 0);
                        const bool fits = examiner.depths_within(subjects[i], flat, least, most) &&
                                          examiner.box_meets(subjects[i], x, y, cell);
                        // The depths of a light may reach FLT_MAX, where boxes end, and then meet a bound beyond.
                        const bool endless = std::abs(lights[i].z) + lights[i].w >= FLT_MAX;
                        if (!in_rectangle[tile][i] || !fits || (empty && !endless))
                            tally.report(tally.unexplained, "unexplained", camera, set.name, i, lights[i],
                                         at());
                    } else if (in_rectangle[tile][i]) {
                        ++tally.verdicts;
                        if (examiner.meets_tile(subjects[i], x, y, cell))
                            tally.report(tally.misses, "MISS", camera, set.name, i, lights[i], at());
                    }
                }
            }
            const auto small = small_binner.bin(view, lights, {.bounds = given});
            REQUIRE(small.has_value());
            CHECK(
                std::equal(grid->ids().begin(), grid->ids().end(), small->ids().begin(), small->ids().end()));
        }
    }
}

void prove(const std::string& kind, const std::vector<Camera>& cameras) {
    Tally rectangles, boxes;
    std::uint64_t seed = seed_of(kind);
    for (const Camera& camera : cameras) {
        examine_rectangles(camera, rectangles, seed);
        examine_depth_test(camera, boxes, seed);
    }
    for (const Tally* tally : {&rectangles, &boxes}) {
        MESSAGE(kind << (tally == &boxes ? ", boxes: " : ", rectangles: ") << tally->verdicts << " exact verdicts ("
                     << tally->twice << " of them by both deciders), " << tally->explained << " explained");
        CHECK(tally->misses == 0);
        CHECK(tally->below == 0);
        CHECK(tally->unexplained == 0);
        CHECK(tally->verdicts >= 30000);
        CHECK(tally->explained >= 10000);
    }
}

}  // namespace

#define PROVE(kind)                                                                                          \
    TEST_CASE("cells: " #kind) {                                                                             \
        prove(#kind, kinds::kind());                                                                         \
    }
ORACLE_CAMERA_KINDS(PROVE)
