// SPDX-License-Identifier: MIT
// No miss, and no excess beyond what rectangles, depth intervals and boxes explain, on every camera kind.
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

template <class Id> bool same(const lightbin::LightGrid<Id>& a, const lightbin::LightGrid<Id>& b) {
    return std::equal(a.ids().begin(), a.ids().end(), b.ids().begin(), b.ids().end()) &&
           std::equal(a.ranges().begin(), a.ranges().end(), b.ranges().begin(), b.ranges().end(),
                      [](lightbin::ListRange s, lightbin::ListRange t) {
                          return s.offset == t.offset && s.count == t.count;
                      });
}

/// Without Z bounds, where silhouettes leave nothing but the exact set and its margin.
void examine_silhouettes(const Camera& camera, Tally& tally, std::uint64_t& seed) {
    Examiner examiner(camera, tally);
    const Oracle& oracle = examiner.oracle;
    const lightbin::View view = view_of(camera);
    lightbin::Binner<> rectangles;
    lightbin::Binner<lightbin::Options{.footprint = lightbin::Footprint::silhouette}> binner;
    const std::size_t tiles = view.tile_count();
    const Examiner::Cell range(examiner);
    for (const SphereSet& set : sphere_sets()) {
        const std::size_t count = std::clamp<std::size_t>(40000 / tiles, 8, 300);
        const std::vector<Light> lights = make(set, camera, count, ++seed);
        const auto rectangle_grid = rectangles.bin(view, lights);
        REQUIRE(rectangle_grid.has_value());
        const auto in_rectangle = membership(*rectangle_grid, lights.size());
        const auto grid = binner.bin(view, lights);
        REQUIRE(grid.has_value());
        CHECK(grid->light_counts().rejected == rectangle_grid->light_counts().rejected);
        emitted_tiles(*grid, lights.size());
        const auto in_list = membership(*grid, lights.size());
        const std::vector<Emitted> rectangle = emitted_tiles(*rectangle_grid, lights.size());
        for (std::size_t i = 0; i < lights.size(); ++i) {
            if (is_bad(lights[i])) continue;
            const auto subject = examiner.subject(lights[i]);
            // These keep their rectangle: spheres cut by the near plane or nearer than 2^-40, and those in one row
            // or column.
            const Emitted& r = rectangle[i];
            const bool whole = std::isinf(lights[i].w) || r.x0 == r.x1 || r.y0 == r.y1 ||
                               (!oracle.orthographic() && !(subject.flat.depth - subject.flat.radius >
                                                            std::max(range.flat.min, 0x1p-40)));
            for (std::size_t tile = 0; tile < tiles; ++tile) {
                if (!in_rectangle[tile][i] && !in_list[tile][i]) continue;
                const int x = static_cast<int>(tile) % oracle.tiles_x(),
                          y = static_cast<int>(tile) / oracle.tiles_x();
                const auto at = [&] { return "tile " + std::to_string(x) + ", " + std::to_string(y); };
                if (in_list[tile][i]) {
                    ++tally.explained;
                    // A row that the silhouette crosses beside the viewport has the tile next to it.
                    const bool at_side = (x == 0 && r.x1 > 0 && !in_list[tile + 1][i]) ||
                                         (x > 0 && x + 1 == oracle.tiles_x() && !in_list[tile - 1][i]);
                    if (!in_rectangle[tile][i] ||
                        (!whole && !at_side && !examiner.silhouette_meets(subject, x, y)))
                        tally.report(tally.unexplained, "unexplained", camera, set.name, i, lights[i], at());
                } else {
                    ++tally.verdicts;
                    if (examiner.meets_tile(subject, x, y, range))
                        tally.report(tally.misses, "MISS", camera, set.name, i, lights[i], at());
                }
            }
        }
    }
}

/// Every pair that a Binner of these options lists or, of those that rectangles give, does not list.
template <lightbin::DepthTest depth_test>
void examine_depth_test(const Camera& camera, Tally& tally, std::uint64_t& seed) {
    using lightbin::DepthTest;
    constexpr bool split = depth_test == DepthTest::split_box, boxes = split || depth_test == DepthTest::box;
    Examiner examiner(camera, tally);
    const Oracle& oracle = examiner.oracle;
    const lightbin::View view = view_of(camera);
    const Aim aim(camera);
    lightbin::Binner<> rectangles;
    lightbin::Binner<lightbin::Options{.depth_test = depth_test}> binner, other;
    lightbin::Binner<lightbin::Options{.ids = lightbin::IdWidth::u16, .depth_test = depth_test}> small_binner;
    const std::size_t tiles = view.tile_count();

    for (const SphereSet& set : sphere_sets()) {
        const std::size_t count =
            std::clamp<std::size_t>((boxes ? 25000 : 40000) / tiles, 8, boxes ? 200 : 300);
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

        for (const int sides : {1, 2, 3}) {                      // minimum, maximum, both
            if (split && sides != 3 && seed % 4 != 0) continue;  // for time
            lightbin::ZBounds given;
            if (sides & 1) given.min = bounds.min;
            if (sides & 2) given.max = bounds.max;
            if (split) given.gap_min = bounds.gap_min, given.gap_max = bounds.gap_max;
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
                const std::vector<Examiner::Cell> cells =
                    cells_of(examiner, min.value_or(-INFINITY), max.value_or(INFINITY), bounds.gap_min[tile],
                             bounds.gap_max[tile], split);
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
                        bool fits = examiner.depths_within(subjects[i], flat, least, most);
                        if (boxes && fits)
                            fits = examiner.box_meets(subjects[i], x, y, cells);
                        // In float the depth interval of a light may reach infinity, and then meets a bound
                        // that lies there; boxes end at FLT_MAX.
                        const float end = std::abs(lights[i].z) + lights[i].w;
                        const bool endless = boxes ? end >= FLT_MAX : std::isinf(end);
                        if (!in_rectangle[tile][i] || !fits || (empty && !endless))
                            tally.report(tally.unexplained, "unexplained", camera, set.name, i, lights[i],
                                         at());
                    } else if (in_rectangle[tile][i]) {
                        ++tally.verdicts;
                        for (const Examiner::Cell& cell : cells)
                            if (examiner.meets_tile(subjects[i], x, y, cell))
                                tally.report(tally.misses, "MISS", camera, set.name, i, lights[i], at());
                    }
                }
            }
            const auto small = small_binner.bin(view, lights, {.bounds = given});
            REQUIRE(small.has_value());
            CHECK(
                std::equal(grid->ids().begin(), grid->ids().end(), small->ids().begin(), small->ids().end()));

            if (sides != 1) {  // Listing 4.2: the transparent list is pruned by the maximum alone
                lightbin::ZBounds all = given;
                all.min = bounds.min;
                const auto both = other.bin_transparency(view, lights, {.bounds = all});
                REQUIRE(both.has_value());
                if (sides == 3)
                    CHECK(same(both->opaque, *grid));
                else if (!split)
                    CHECK(same(both->transparent, *grid));
            }
        }
    }
}

void prove(const std::string& kind, const std::vector<Camera>& cameras) {
    using lightbin::DepthTest;
    Tally rectangles, silhouettes, intervals, boxes, split_boxes;
    std::uint64_t seed = seed_of(kind);
    for (const Camera& camera : cameras) {
        examine_rectangles(camera, rectangles, seed);
        examine_silhouettes(camera, silhouettes, seed);
        examine_depth_test<DepthTest::interval>(camera, intervals, seed);
        examine_depth_test<DepthTest::box>(camera, boxes, seed);
        examine_depth_test<DepthTest::split_box>(camera, split_boxes, seed);
    }
    const struct {
        const char* name;
        const Tally& tally;
        std::uint64_t least;
    } methods[] = {{"rectangles", rectangles, 30000},
                   {"silhouettes", silhouettes, 3000},
                   {"intervals", intervals, 30000},
                   {"boxes", boxes, 30000},
                   {"split boxes", split_boxes, 30000}};
    for (const auto& [name, tally, least] : methods) {
        MESSAGE(kind << ", " << std::string(name) << ": " << tally.verdicts << " exact verdicts ("
                     << tally.twice << " of them by both deciders), " << tally.explained << " explained");
        CHECK(tally.misses == 0);
        CHECK(tally.below == 0);
        CHECK(tally.unexplained == 0);
        CHECK(tally.verdicts >= least);
        CHECK(tally.explained >= 10000);
    }
}

}  // namespace

#define PROVE(kind)                                                                                          \
    TEST_CASE("cells: " #kind) {                                                                             \
        prove(#kind, kinds::kind());                                                                         \
    }
ORACLE_CAMERA_KINDS(PROVE)
