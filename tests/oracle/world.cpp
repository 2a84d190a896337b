// SPDX-License-Identifier: MIT
// World-space input: no miss for the exact image of the ball under the view matrix.
#include "bounds.hpp"
#include "harness.hpp"
#include "world.hpp"

using namespace oracle;

namespace {

void examine_rectangles(const Camera& camera, Tally& tally, std::uint64_t& seed) {
    Examiner examiner(camera, tally);
    const Oracle& oracle = examiner.oracle;
    const lightbin::View view = view_of(camera);
    const int nx = oracle.tiles_x(), ny = oracle.tiles_y();
    lightbin::Binner<> binner;
    Random random(++seed);
    const Examiner::Cell range(examiner);
    for (const ViewMatrix& matrix : view_matrices(random)) {
        const ExactView exact_view(matrix.m);
        const AroundImage around_image(oracle, matrix.m);
        for (const SphereSet& set : sphere_sets()) {
            const std::vector<Light> lights = into_world(make(set, camera, 110, ++seed), matrix);
            const auto grid = binner.bin(view, lightbin::world_space(lights, matrix.m));
            REQUIRE(grid.has_value());
            CHECK(grid->light_counts().rejected == rejected_of(lights));
            const std::vector<Emitted> emitted = emitted_tiles(*grid, lights.size());
            for (std::size_t i = 0; i < lights.size(); ++i) {
                const Emitted& e = emitted[i];
                CHECK(e.rectangle());
                if (is_bad(lights[i])) {
                    CHECK(!e.any());
                    continue;
                }
                const Ball ball = exact_ball(lights[i].x, lights[i].y, lights[i].z, lights[i].w);
                const FlatBall around = around_image(lights[i]);
                for (const Block& block : blocks_around(e, nx, ny)) {
                    const auto [x0, x1, y0, y1] = block;
                    if (++tally.verdicts % 97 != 0 && examiner.apart(x0, x1, y0, y1, range, around)) continue;
                    if (image_meets(exact_view, oracle.half_spaces(oracle.columns(x0, x1), oracle.rows(y0, y1), {}),
                                    ball))
                        tally.report(tally.misses, "MISS", camera, matrix.name + ", " + set.name, i, lights[i], "");
                }
                if (!e.any()) continue;

                // A rotation and scale gives the ball back, but for the rounding of its matrix and of the
                // moved centre. A centre that leaves the range of float is taken to be everywhere.
                if (matrix.stretch == 0 || ball.all) continue;
                Ball image{exact_view(ball.centre), ball.radius * exact(matrix.stretch)};
                const Vector& c = image.centre;
                if (abs(c.x) + abs(c.y) + abs(c.z) + image.radius > exact(FLT_MAX)) continue;
                const Vector &p = ball.centre, &t = exact_view.column[3];
                const Rational terms =
                    exact(matrix.stretch) * (abs(p.x) + abs(p.y) + abs(p.z)) + abs(t.x) + abs(t.y) + abs(t.z);
                image.radius += (image.radius + abs(c.x) + abs(c.y) + abs(c.z)) / (1 << 20) +
                                terms / (std::int64_t{1} << 44) + exact(0x1p-125);
                ++tally.explained;
                if (!examiner.explained(examiner.subject(image), e))
                    tally.report(tally.unexplained, "unexplained", camera, matrix.name + ", " + set.name, i,
                                 lights[i], "");
            }
        }
    }
}

/// Every pair that rectangles give and a Binner with the depth test does not. With Z bounds there is no margin in
/// pixels to hide behind: what counts is where the image ends.
void examine_pairs(const Camera& camera, Tally& tally, std::uint64_t& seed) {
    Examiner examiner(camera, tally);
    const Oracle& oracle = examiner.oracle;
    const lightbin::View view = view_of(camera);
    const Aim aim(camera);
    const std::size_t tiles = view.tile_count();
    lightbin::Binner<> rectangles;
    lightbin::Binner<lightbin::Options{.depth_test = true}> binner;
    Random random(++seed);
    for (const ViewMatrix& matrix : view_matrices(random)) {
        const ExactView exact_view(matrix.m);
        const AroundImage around_image(oracle, matrix.m);
        for (const SphereSet& set : sphere_sets()) {
            if (set.name != "field" && set.name != "near eye" && set.name != "tiny and far") continue;
            const std::vector<Light> aimed = make(set, camera, 1000, ++seed),
                                     lights = into_world(aimed, matrix);
            const Bounds bounds = make_bounds(camera, aim, aimed, BoundsShape::tips, random);
            const auto world = lightbin::world_space(lights, matrix.m);
            const auto rectangle_grid = rectangles.bin(view, world);
            REQUIRE(rectangle_grid.has_value());
            const auto in_rectangle = membership(*rectangle_grid, lights.size());
            for (const int sides : {1, 2, 3}) {  // minimum, maximum, both
                lightbin::ZBounds given;
                if (sides & 1) given.min = bounds.min;
                if (sides & 2) given.max = bounds.max;
                const auto grid = binner.bin(view, world, {.bounds = given});
                REQUIRE(grid.has_value());
                const auto in_list = membership(*grid, lights.size());
                bool added = false;  // a pair that is not in the rectangles
                for (std::size_t tile = 0; tile < tiles; ++tile) {
                    const int x = static_cast<int>(tile) % oracle.tiles_x(),
                              y = static_cast<int>(tile) / oracle.tiles_x();
                    const Examiner::Cell cell(examiner, (sides & 1) ? bounds.min[tile] : -INFINITY,
                                              (sides & 2) ? bounds.max[tile] : INFINITY);
                    for (std::size_t i = 0; i < lights.size(); ++i) {
                        if (i % 16 != 0 && bounds.owner[tile] != i) continue;  // for time
                        added |= in_list[tile][i] && !in_rectangle[tile][i];
                        if (!in_rectangle[tile][i] || in_list[tile][i]) continue;
                        const bool exactly = ++tally.verdicts % 97 == 0;
                        const FlatBall around = around_image(lights[i]);
                        if (cell.empty || (!exactly && examiner.apart(x, x + 1, y, y + 1, cell, around)))
                            continue;
                        const Ball ball = exact_ball(lights[i].x, lights[i].y, lights[i].z, lights[i].w);
                        const auto planes = oracle.half_spaces(oracle.columns(x, x + 1), oracle.rows(y, y + 1),
                                                               cell.depths());
                        if (image_meets(exact_view, planes, ball))
                            tally.report(tally.misses, "MISS", camera, matrix.name + ", " + set.name, i,
                                         lights[i], "tile " + std::to_string(x) + ", " + std::to_string(y));
                    }
                }
                CHECK(!added);
            }
        }
    }
}

}  // namespace

TEST_CASE("world space: depth test") {
    Tally tally;
    std::uint64_t seed = 6;
    for (const auto& cameras : {kinds::symmetric(), kinds::orthographic_off_centre()})
        examine_pairs(cameras.front(), tally, seed);
    MESSAGE(tally.verdicts << " exact verdicts");
    CHECK(tally.misses == 0);
    CHECK(tally.verdicts >= 100000);
}

TEST_CASE("world space") {
    Tally tally;
    std::uint64_t seed = 5;
    for (const auto& cameras :
         {kinds::symmetric(), kinds::reversed_infinite(), kinds::orthographic_off_centre()})
        for (const std::size_t screen : {std::size_t{0}, std::size_t{1}})
            examine_rectangles(cameras[screen], tally, seed);
    MESSAGE(tally.verdicts << " exact verdicts, " << tally.explained << " rectangles explained");
    CHECK(tally.misses == 0);
    CHECK(tally.unexplained == 0);
    CHECK(tally.verdicts >= 100000);
    CHECK(tally.explained >= 20000);
}
