// SPDX-License-Identifier: MIT
// Clusters: no miss over tiles and slices, and no excess beyond what rectangles, depths and boxes explain, on every
// camera kind. That a tile is in the rectangle, or out of it, is proven in cells.cpp.
#include "harness.hpp"

using namespace oracle;

namespace {

/// Boundaries of which every second one is where a light begins or ends, as floats have it, or a hair beside; the others
/// anywhere.
std::vector<float> make_boundaries(const lightbin::View& view, const std::vector<Light>& lights,
                                   Random& random) {
    std::vector<float> boundaries;
    const float sign = view.view_point({0, 0, 1}).z < 0 ? -1.0f : 1.0f;
    for (int i = 0; i < 7; ++i) {
        const Light& light =
            lights[static_cast<std::size_t>(random.integer(0, static_cast<int>(lights.size()) - 1))];
        float end = sign * light.z + (random.chance(0.5) ? light.w : -light.w);
        if (random.chance(0.3)) end = std::nextafter(end, random.chance(0.5) ? 1e38f : -1e38f);
        if (i % 2 == 1) end = static_cast<float>(random.sign() * random.power_of_two(-12, 12));
        if (std::isfinite(end)) boundaries.push_back(end);
    }
    std::sort(boundaries.begin(), boundaries.end());
    boundaries.erase(std::unique(boundaries.begin(), boundaries.end()), boundaries.end());
    return boundaries;
}

template <bool depth_test>
void examine_clusters(const Camera& camera, Tally& tally, std::uint64_t& seed) {
    Examiner examiner(camera, tally);
    const Oracle& oracle = examiner.oracle;
    const lightbin::View view = view_of(camera);
    lightbin::Binner<> rectangles;
    lightbin::Binner<lightbin::Options{.depth_test = depth_test, .slicing = lightbin::Slicing::clusters}> binner;
    const std::size_t tiles = view.tile_count();
    for (const SphereSet& set : sphere_sets()) {
        const std::vector<Light> lights =
            make(set, camera, std::clamp<std::size_t>(800 / tiles, 2, 8), ++seed);
        Random random(++seed);
        const std::vector<float> boundaries = make_boundaries(view, lights, random);
        const auto rectangle_grid = rectangles.bin(view, lights);
        REQUIRE(rectangle_grid.has_value());
        const auto in_rectangle = membership(*rectangle_grid, lights.size());
        const auto grid =
            binner.bin(view, lights, {.slices = *lightbin::Slices::from_boundaries(boundaries)});
        REQUIRE(grid.has_value());
        const auto in_list = membership(*grid, lights.size());
        REQUIRE(in_list.size() == tiles * (boundaries.size() + 1));
        for (std::size_t i = 0; i < lights.size(); ++i) {
            if (is_bad(lights[i])) continue;
            const Examiner::Subject subject = examiner.subject(lights[i]);
            for (std::size_t slice = 0; slice <= boundaries.size(); ++slice) {
                const float min = slice == 0 ? -INFINITY : boundaries[slice - 1],
                            max = slice == boundaries.size() ? INFINITY : boundaries[slice];
                const Examiner::Cell cell(examiner, min, max);
                const auto bound = [](float depth) {
                    return std::isfinite(depth) ? std::optional(exact(static_cast<double>(depth)))
                                                : std::nullopt;
                };
                const std::optional<Rational> least = bound(min), most = bound(max);
                const bool in_depth = examiner.depths_within(
                    subject, {static_cast<double>(min), static_cast<double>(max)}, least, most);
                for (std::size_t tile = 0; tile < tiles; ++tile) {
                    const int x = static_cast<int>(tile) % oracle.tiles_x(),
                              y = static_cast<int>(tile) / oracle.tiles_x();
                    const auto at = [&] {
                        return "tile " + std::to_string(x) + ", " + std::to_string(y) + ", depths " +
                               std::to_string(min) + " to " + std::to_string(max);
                    };
                    if (in_list[slice * tiles + tile][i]) {
                        ++tally.explained;
                        const float end = std::abs(lights[i].z) + lights[i].w;
                        const bool fits = in_depth && (!depth_test || end >= FLT_MAX ||
                                                       examiner.box_meets(subject, x, y, cell));
                        if (!in_rectangle[tile][i] || !fits)
                            tally.report(tally.unexplained, "unexplained", camera, set.name, i, lights[i],
                                         at());
                    } else if (in_rectangle[tile][i]) {
                        ++tally.verdicts;
                        if (examiner.meets_tile(subject, x, y, cell))
                            tally.report(tally.misses, "MISS", camera, set.name, i, lights[i], at());
                    }
                }
            }
        }
    }
}

void prove(const std::string& kind, const std::vector<Camera>& cameras) {
    Tally slabs, boxes;
    std::uint64_t seed = seed_of(kind);
    for (const Camera& camera : cameras) {
        examine_clusters<false>(camera, slabs, seed);
        examine_clusters<true>(camera, boxes, seed);
    }
    for (const Tally* tally : {&slabs, &boxes}) {
        MESSAGE(kind << (tally == &slabs ? ", slices: " : ", slices, boxes: ") << tally->verdicts
                     << " exact verdicts, " << tally->explained << " explained");
        CHECK(tally->misses == 0);
        CHECK(tally->unexplained == 0);
        CHECK(tally->verdicts >= 30000);
        CHECK(tally->explained >= 10000);
    }
}

}  // namespace

#define PROVE(kind)                                                                                          \
    TEST_CASE("clusters: " #kind) {                                                                          \
        prove(#kind, kinds::kind());                                                                         \
    }
ORACLE_CAMERA_KINDS(PROVE)
