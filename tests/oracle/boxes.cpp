// SPDX-License-Identifier: MIT
// Boxes, and balls cut by boxes: no miss, on every camera kind, with every footprint and depth test, in view and
// world space.
//
// Of rectangles all tiles are asked: the blocks of tiles left and right of a light's rectangle, below and above it,
// and for a light without one the whole image. Of the other lists single cells are asked that do not have the light,
// those beside a tile that has it first.
//
// LIGHTBIN_BOX_ROUNDS=N asks so many times as much, each time of other boxes, and says how far it is: the campaign
// does.
#include "boxes.hpp"
#include "bounds.hpp"
#include "harness.hpp"
#include "world.hpp"

#include <lightbin/box.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

using namespace oracle;

namespace {

struct BoxTally {
    std::uint64_t verdicts = 0;  ///< "this light does not meet these cells", each proven
    std::uint64_t by_box = 0;    ///< of these, not by the ball alone
    std::uint64_t settled = 0;   ///< of these, in double precision
    std::uint64_t exact = 0;     ///< of these, in rationals: those that are not settled, and some that are
    std::uint64_t twice = 0;     ///< of these, by both deciders
    std::uint64_t misses = 0;
    std::map<std::string, std::uint64_t> sets;  ///< by_box
};

std::vector<lightbin::Box> as_boxes(const std::vector<BoxLight>& lights) {
    std::vector<lightbin::Box> boxes;
    for (const BoxLight& b : lights) {
        lightbin::Box box = {b.x, b.y, b.z, b.radius, b.centre[0], b.centre[1], b.centre[2], {}, b.taper};
        std::copy(&b.half_axes[0][0], &b.half_axes[0][0] + 9, &box.half_axes[0][0]);
        boxes.push_back(box);
    }
    return boxes;
}

/// World-space boxes that land, more or less, where a set wants them in view space.
std::vector<BoxLight> into_world(std::vector<BoxLight> lights, const ViewMatrix& view) {
    for (BoxLight& b : lights) {
        std::vector<Light> points = {{b.x, b.y, b.z, b.radius}, {b.centre[0], b.centre[1], b.centre[2], 0}};
        for (const float(&h)[3] : b.half_axes)
            points.push_back({b.centre[0] + h[0], b.centre[1] + h[1], b.centre[2] + h[2], 0});
        points = into_world(points, view);
        const Light &ball = points[0], &c = points[1];
        b.x = ball.x, b.y = ball.y, b.z = ball.z, b.radius = ball.w;
        b.centre[0] = c.x, b.centre[1] = c.y, b.centre[2] = c.z;
        for (std::size_t i = 0; i < 3; ++i) {
            const bool none = b.half_axes[i][0] == 0 && b.half_axes[i][1] == 0 && b.half_axes[i][2] == 0;
            if (none) continue;
            const Light& end = points[2 + i];
            b.half_axes[i][0] = end.x - c.x, b.half_axes[i][1] = end.y - c.y, b.half_axes[i][2] = end.z - c.z;
        }
    }
    return lights;
}

/// A camera, and boxes with the space that they are in.
class Subjects {
public:
    Subjects(Examiner& examiner, std::vector<BoxLight> given, const ViewMatrix* matrix)
        : lights(std::move(given)), examiner_(examiner) {
        std::optional<AroundImage> around;
        if (matrix) world_.emplace(matrix->m), around.emplace(examiner.oracle, matrix->m);
        const CameraBall signs = examiner.oracle.in_camera({{1, 1, 1}, 0});
        const double sign[] = {nearly(signs.x), nearly(signs.y), nearly(signs.depth)};
        double m[4][3] = {};  // to the camera's axes
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 4; ++c)
                m[c][r] = sign[r] * (matrix ? static_cast<double>(matrix->m[static_cast<int>(c)][static_cast<int>(r)])
                                     : c == r ? 1.0
                                              : 0.0);
        for (const BoxLight& light : lights) {
            const BoxLight fine =
                is_bad(light) ? BoxLight{0, 0, 0, 1, {}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1} : light;
            const Light ball = {fine.x, fine.y, fine.z, fine.radius};
            exact_.emplace_back();
            fine_.push_back(fine);
            balls_.push_back(around ? (*around)(ball) : examiner.subject(ball).flat);
            boxes_.push_back(flat(fine, m));
        }
    }

    /// A list lacks a light: it must not meet any of the cells of the tiles.
    void ask(std::size_t i, const Block& tiles, const std::vector<Examiner::Cell>& cells, BoxTally& tally,
             const std::string& rung, const std::string& set) {
        const Oracle& oracle = examiner_.oracle;
        ++tally.verdicts;
        bool by_box = false;
        for (const Examiner::Cell& cell : cells) {
            if (cell.empty || examiner_.apart(tiles.x0, tiles.x1, tiles.y0, tiles.y1, cell, balls_[i]) ||
                cell.depths().contains_none())
                continue;
            by_box = true;
            const bool settled =
                apart(examiner_.truth.filter, tiles.x0, tiles.x1, tiles.y0, tiles.y1, cell.flat, boxes_[i]);
            if (settled && ++tally.settled % 97 != 0) continue;
            auto planes = oracle.half_spaces(oracle.columns(tiles.x0, tiles.x1), oracle.rows(tiles.y0, tiles.y1),
                                             cell.depths());
            if (world_)
                for (HalfSpace& plane : planes)
                    plane = world_->preimage(plane);
            if (!exact_[i]) exact_[i].emplace(fine_[i]);
            const ExactBox& box = *exact_[i];
            const bool meet = meets(planes, box);
            ++tally.exact;
            if (tally.exact % 97 == 0) {
                ++tally.twice;
                auto all = planes;
                all.insert(all.end(), box.faces.begin(), box.faces.end());
                REQUIRE(meet == oracle::meets(all, box.ball));
            }
            REQUIRE(!(settled && meet));
            if (meet && ++tally.misses <= 5)
                MESSAGE("MISS: " << oracle.camera().name << ", " << rung << ", " << set << " " << text(lights[i])
                                 << " tiles " << tiles.x0 << ".." << tiles.x1 << ", " << tiles.y0 << ".."
                                 << tiles.y1);
        }
        tally.by_box += by_box;
        tally.sets[set] += by_box;
    }

    const std::vector<BoxLight> lights;

private:
    /// Each term of a corner goes through fewer than 16 roundings of 2^-53: 2^-47 of the terms is taken.
    static FlatBox flat(const BoxLight& light, const double (&m)[4][3]) {
        FlatBox box = {};
        double terms = 0;
        for (std::size_t r = 0; r < 3; ++r) {
            double at[4] = {m[3][r], 0, 0, 0};
            terms += std::abs(at[0]);
            for (std::size_t c = 0; c < 3; ++c) {
                at[0] += m[c][r] * static_cast<double>(light.centre[c]);
                terms += std::abs(m[c][r] * static_cast<double>(light.centre[c]));
                for (std::size_t k = 0; k < 3; ++k) {
                    at[k + 1] += m[c][r] * static_cast<double>(light.half_axes[k][c]);
                    terms += std::abs(m[c][r] * static_cast<double>(light.half_axes[k][c]));
                }
            }
            for (std::size_t i = 0; i < 8; ++i) {
                const double across = ((i & 1) != 0 ? at[1] : -at[1]) + ((i & 2) != 0 ? at[2] : -at[2]);
                box.corners[i][r] =
                    at[0] + ((i & 4) != 0 ? at[3] + across : static_cast<double>(light.taper) * across - at[3]);
            }
        }
        box.error = 0x1p-47 * terms;
        return box;
    }

    Examiner& examiner_;
    std::vector<BoxLight> fine_;  ///< the lights, with others in place of bad ones
    std::vector<std::optional<ExactBox>> exact_;
    std::vector<FlatBall> balls_;
    std::vector<FlatBox> boxes_;
    std::optional<ExactView> world_;
};

/// Calls bin() with lights, as they are or in world space.
template <class Any, class Bin> auto bin_in(const std::vector<Any>& lights, const ViewMatrix* matrix, Bin bin) {
    return matrix ? bin(lightbin::world_space(lights, matrix->m)) : bin(lightbin::view_space(lights));
}

/// in[cell][light], cells in the order of slices: of z-bins those lights of the tile's list that are in the bin.
template <lightbin::Options options, class Grid>
std::vector<std::vector<bool>> membership_of(const Grid& grid, std::size_t lights) {
    if constexpr (options.slicing != lightbin::Slicing::z_bins) {
        return membership(grid, lights);
    } else {
        std::vector<std::vector<bool>> in;
        for (const lightbin::BinRange& bin : grid.ranks().bins)
            for (const lightbin::ListRange& tile : grid.ranges()) {
                in.emplace_back(lights);
                for (const std::uint32_t rank :
                     lightbin::lights_of_bin(grid.ids().subspan(tile.offset, tile.count), bin))
                    in.back()[grid.ranks().order[rank]] = true;
            }
        return in;
    }
}

template <lightbin::Options options>
void examine(const Camera& camera, Examiner& examiner, const lightbin::View& view, const ViewMatrix* matrix,
             std::size_t most, BoxTally& tally, std::uint64_t& seed) {
    using lightbin::DepthTest;
    constexpr bool sliced = options.slicing != lightbin::Slicing::none,
                   bounded = !sliced && options.depth_test != DepthTest::none,
                   split = options.depth_test == DepthTest::split_box,
                   rectangles = !sliced && !bounded && options.footprint == lightbin::Footprint::rectangle;
    const std::string rung = std::string(to_string(options.footprint)) + ", " + to_string(options.depth_test) + ", " +
                             to_string(options.slicing);
    const Oracle& oracle = examiner.oracle;
    const Aim aim(camera);
    const std::size_t tiles = view.tile_count();
    lightbin::Binner<options> binner;
    for (const BoxSet& set : box_sets()) {
        Random random(++seed);
        std::vector<BoxLight> aimed =
            make(set, camera, std::clamp<std::size_t>(100000 / tiles, 12, rectangles ? 400 : 60), ++seed);
        Subjects subjects(examiner, matrix ? into_world(aimed, *matrix) : aimed, matrix);
        const std::size_t count = aimed.size();
        std::vector<Light> balls;  // about where the lights are
        for (const lightbin::Box& box : as_boxes(aimed)) {
            const lightbin::Sphere s = box;
            balls.push_back({s.x, s.y, s.z, s.radius});
        }
        const Bounds bounds = make_bounds(camera, aim, balls, static_cast<BoundsShape>(seed / 2 % 3), random);
        lightbin::ZBounds given = {.min = bounds.min, .max = bounds.max};
        if (split) given.gap_min = bounds.gap_min, given.gap_max = bounds.gap_max;
        std::vector<float> boundaries;
        for (std::size_t i = 0; i < 3; ++i)
            boundaries.push_back(aim.depth_of(balls[i]) + (random.chance(0.5) ? 1.0f : -1.0f) * balls[i].w);
        std::erase_if(boundaries, [](float b) { return !std::isfinite(b); });
        std::sort(boundaries.begin(), boundaries.end());
        boundaries.erase(std::unique(boundaries.begin(), boundaries.end()), boundaries.end());
        const auto slices = lightbin::Slices::from_boundaries(boundaries);
        REQUIRE(slices.has_value());

        const auto grid = bin_in(as_boxes(subjects.lights), matrix, [&](const auto& lights) {
            if constexpr (sliced)
                return binner.bin(view, lights, {.slices = *slices});
            else
                return binner.bin(view, lights, lightbin::inputs_for<options>(given));
        });
        REQUIRE(grid.has_value());
        CHECK(grid->light_counts().rejected == std::count_if(subjects.lights.begin(), subjects.lights.end(),
                                                             [](const BoxLight& b) { return is_bad(b); }));
        const int nx = oracle.tiles_x(), ny = oracle.tiles_y();
        if constexpr (rectangles) {
            const std::vector<Emitted> emitted = emitted_tiles(*grid, count);
            const std::vector<Examiner::Cell> all = {{examiner}};
            for (std::size_t i = 0; i < count; ++i) {
                const Emitted& e = emitted[i];
                CHECK(e.rectangle());
                if (is_bad(subjects.lights[i])) {
                    CHECK(!e.any());
                    continue;
                }
                const auto block = [&](int x0, int x1, int y0, int y1) {
                    if (x0 < x1 && y0 < y1) subjects.ask(i, {x0, x1, y0, y1}, all, tally, rung, set.name);
                };
                if (!e.any()) {
                    block(0, nx, 0, ny);
                    continue;
                }
                block(0, e.x0, 0, ny);
                block(e.x1 + 1, nx, 0, ny);
                block(e.x0, e.x1 + 1, 0, e.y0);
                block(e.x0, e.x1 + 1, e.y1 + 1, ny);
            }
            continue;
        }
        const auto in_list = membership_of<options>(*grid, count);
        struct Pair {
            std::size_t cell, light;
        };
        std::vector<Pair> beside, others;
        for (std::size_t cell = 0; cell < in_list.size(); ++cell) {
            const int x = static_cast<int>(cell % tiles) % nx, y = static_cast<int>(cell % tiles) / nx;
            const auto has = [&](int dx, int dy, std::size_t i) {
                return x + dx >= 0 && x + dx < nx && y + dy >= 0 && y + dy < ny &&
                       in_list[cell + static_cast<std::size_t>(dy * nx + dx)][i];
            };
            for (std::size_t i = 0; i < count; ++i) {
                if (in_list[cell][i] || is_bad(subjects.lights[i])) continue;
                const bool near_one = has(-1, 0, i) || has(1, 0, i) || has(0, -1, i) || has(0, 1, i);
                (near_one ? beside : others).push_back({cell, i});
            }
        }
        const auto judge = [&](const std::vector<Pair>& pairs, std::size_t at_most) {
            const std::size_t step = pairs.size() / at_most + 1;
            for (std::size_t p = pairs.empty() ? 0 : random.bits() % step; p < pairs.size(); p += step) {
                const std::size_t tile = pairs[p].cell % tiles, slice = pairs[p].cell / tiles;
                float min = -INFINITY, max = INFINITY;
                if (bounded) min = bounds.min[tile], max = bounds.max[tile];
                if (sliced && slice > 0) min = boundaries[slice - 1];
                if (sliced && slice < boundaries.size()) max = boundaries[slice];
                const float from = bounds.gap_min[tile], to = bounds.gap_max[tile];
                std::vector<Examiner::Cell> cells = {{examiner, min, max}};
                if (split && from < to && min <= max)
                    cells = {{examiner, min, std::min(from, max)}, {examiner, std::max(to, min), max}};
                const int x = static_cast<int>(tile) % nx, y = static_cast<int>(tile) / nx;
                subjects.ask(pairs[p].light, {x, x + 1, y, y + 1}, cells, tally, rung, set.name);
            }
        };
        judge(beside, 2 * most);
        judge(others, most);
    }
}

void examine_all(const Camera& camera, const ViewMatrix* matrix, std::size_t most, BoxTally& tally,
                 std::uint64_t& seed) {
    using namespace lightbin;
    oracle::Tally unused;
    Examiner examiner(camera, unused);
    const View view = view_of(camera);
    const auto with = [&]<Options options>() { examine<options>(camera, examiner, view, matrix, most, tally, seed); };
    with.operator()<Options{}>();
    with.operator()<Options{.footprint = Footprint::silhouette}>();
    with.operator()<Options{.depth_test = DepthTest::interval}>();
    with.operator()<Options{.depth_test = DepthTest::box}>();
    with.operator()<Options{.footprint = Footprint::silhouette, .depth_test = DepthTest::split_box}>();
    with.operator()<Options{.slicing = Slicing::clusters}>();
    with.operator()<Options{.depth_test = DepthTest::box, .slicing = Slicing::clusters}>();
    with.operator()<Options{
        .footprint = Footprint::silhouette, .depth_test = DepthTest::box, .slicing = Slicing::clusters}>();
    with.operator()<Options{.slicing = Slicing::z_bins}>();
    with.operator()<Options{.footprint = Footprint::silhouette, .slicing = Slicing::z_bins}>();
}

void check(const std::string& name, const BoxTally& tally) {
    MESSAGE(name << ": " << tally.verdicts << " verdicts, " << tally.by_box << " not by balls alone, " << tally.exact
                 << " in rationals (" << tally.twice << " of them by both deciders), " << tally.misses << " missed");
    CHECK(tally.misses == 0);
    CHECK(tally.verdicts >= 100000);
    CHECK(tally.by_box >= 20000);
    for (const auto& set : tally.sets)
        CHECK_MESSAGE(set.second >= 100, set.first);
}

int rounds() {
    const char* const asked = std::getenv("LIGHTBIN_BOX_ROUNDS");
    return asked != nullptr ? std::max(std::atoi(asked), 1) : 1;
}

/// Calls round(seed) as often as is asked for.
template <class Round> void repeat(const std::string& name, const BoxTally& tally, std::uint64_t seed, Round round) {
    for (int done = 0; done < rounds(); ++done) {
        round(seed + static_cast<std::uint64_t>(done) * 1000003);
        if (rounds() > 1)
            std::fprintf(stderr, "%s: %d of %d rounds, %llu verdicts, %llu missed\n", name.c_str(), done + 1,
                         rounds(), static_cast<unsigned long long>(tally.verdicts),
                         static_cast<unsigned long long>(tally.misses));
    }
}

void prove(const std::string& kind, const std::vector<Camera>& cameras) {
    BoxTally tally;
    repeat(kind, tally, seed_of(kind), [&](std::uint64_t seed) {
        for (const Camera& camera : cameras)
            examine_all(camera, nullptr, 100, tally, seed);
    });
    check(kind, tally);
}

}  // namespace

#define PROVE(kind)                                                                                                  \
    TEST_CASE("boxes: " #kind) {                                                                                     \
        prove(#kind, kinds::kind());                                                                                 \
    }
ORACLE_CAMERA_KINDS(PROVE)

TEST_CASE("boxes: world space") {
    BoxTally tally;
    repeat("world space", tally, 7, [&](std::uint64_t seed) {
        Random random(seed);
        const std::vector<ViewMatrix> matrices = view_matrices(random);
        for (const auto& cameras : {kinds::symmetric(), kinds::orthographic_off_centre()})
            for (const ViewMatrix& matrix : matrices)
                examine_all(cameras.front(), &matrix, 24, tally, seed);
    });
    check("world space", tally);
}
