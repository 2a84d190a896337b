// SPDX-License-Identifier: MIT
// Spots: no miss, on every camera kind, with every footprint and depth test, in view and world space. What is asked is the
// spot itself, not the sphere that it is binned as.
//
// Asked are cells whose tile is in the rectangle of the spot's whole ball and whose list lacks the spot: in all others the
// ball, which cells.cpp answers for, is not. Those beside a tile that has the spot come first.
//
// LIGHTBIN_SPOT_ROUNDS=N asks so many times as much, each time of other spots, and says how far it is: the campaign does.
#include "spots.hpp"
#include "bounds.hpp"
#include "harness.hpp"
#include "world.hpp"

#include <lightbin/spot.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

using namespace oracle;

namespace {

struct SpotTally {
    std::uint64_t verdicts = 0;      ///< "this spot does not meet this cell", each proven
    std::uint64_t certificates = 0;  ///< of these, not by its ball alone
    std::uint64_t open = 0, misses = 0;
    struct Set {
        std::uint64_t certificates = 0, open = 0;
    };
    std::map<std::string, Set> sets;
};

std::vector<lightbin::Spot> as_spots(const std::vector<SpotLight>& lights) {
    std::vector<lightbin::Spot> spots;
    for (const SpotLight& s : lights)
        spots.push_back({s.ball.x, s.ball.y, s.ball.z, s.ball.w, s.axis_x, s.axis_y, s.axis_z, s.cosine});
    return spots;
}

/// World-space spots that land, more or less, where a set wants them in view space.
std::vector<SpotLight> into_world(std::vector<SpotLight> lights, const ViewMatrix& view) {
    for (SpotLight& s : lights) {
        const float size = s.ball.w / std::hypot(s.axis_x, s.axis_y, s.axis_z);
        const Light tip = {s.ball.x + size * s.axis_x, s.ball.y + size * s.axis_y, s.ball.z + size * s.axis_z,
                           0};
        const std::vector<Light> both = into_world({s.ball, tip}, view);
        s = {both[0], both[1].x - both[0].x, both[1].y - both[0].y, both[1].z - both[0].z, s.cosine};
    }
    return lights;
}

/// A camera, and spots with the space that they are in.
class Subjects {
public:
    Subjects(Examiner& examiner, std::vector<SpotLight> given, const ViewMatrix* matrix)
        : lights(std::move(given)), examiner_(examiner) {
        std::optional<AroundImage> around;
        if (matrix) world_.emplace(matrix->m), around.emplace(examiner.oracle, matrix->m);
        for (const SpotLight& light : lights) {
            const bool bad = is_bad(light);
            exact_.push_back(exact_spot(bad ? SpotLight{{}, 0, 0, 1, 1} : light));
            balls_.push_back(bad      ? FlatBall{}
                             : around ? (*around)(light.ball)
                                      : examiner.subject(exact_.back().ball).flat);
        }
    }

    /// A list lacks a spot: it must not meet any of the cells of the tile.
    void ask(std::size_t i, int x, int y, const std::vector<Examiner::Cell>& cells, SpotTally& tally,
             const std::string& rung, const std::string& set) {
        const Oracle& oracle = examiner_.oracle;
        ++tally.verdicts;
        bool certificate = false, open = false;
        for (const Examiner::Cell& cell : cells) {
            if (cell.empty || examiner_.apart(x, x + 1, y, y + 1, cell, balls_[i]) ||
                cell.depths().contains_none())
                continue;
            certificate = true;
            auto planes = oracle.half_spaces(oracle.columns(x, x + 1), oracle.rows(y, y + 1), cell.depths());
            if (world_)
                for (HalfSpace& plane : planes)
                    plane = world_->preimage(plane);
            const auto verdict = meets(planes, exact_[i]);
            open |= !verdict;
            if (verdict == true && ++tally.misses <= 5)
                MESSAGE("MISS: " << oracle.camera().name << ", " << rung << ", " << set << " "
                                 << text(lights[i]) << " tile " << x << ", " << y);
        }
        tally.certificates += certificate, tally.open += open;
        tally.sets[set].certificates += certificate, tally.sets[set].open += open;
    }

    const std::vector<SpotLight> lights;

private:
    Examiner& examiner_;
    std::vector<ExactSpot> exact_;
    std::vector<FlatBall> balls_;
    std::optional<ExactView> world_;
};

/// Calls bin() with lights, as they are or in world space.
template <class Any, class Bin>
auto bin_in(const std::vector<Any>& lights, const ViewMatrix* matrix, Bin bin) {
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
             std::size_t most, SpotTally& tally, std::uint64_t& seed) {
    using lightbin::DepthTest;
    constexpr bool sliced = options.slicing != lightbin::Slicing::none,
                   bounded = !sliced && options.depth_test != DepthTest::none,
                   split = options.depth_test == DepthTest::split_box;
    const std::string rung = std::string(to_string(options.footprint)) + ", " +
                             to_string(options.depth_test) + ", " + to_string(options.slicing);
    const Oracle& oracle = examiner.oracle;
    const Aim aim(camera);
    const std::size_t tiles = view.tile_count();
    lightbin::Binner<> rectangles;
    lightbin::Binner<options> binner;
    for (const SpotSet& set : spot_sets()) {
        Random random(++seed);
        std::vector<SpotLight> aimed =
            make(set, camera, std::clamp<std::size_t>(100000 / tiles, 12, 60), ++seed);
        std::vector<Light> least, balls;
        for (const lightbin::Spot& spot : as_spots(aimed)) {
            const lightbin::Sphere s = spot;
            least.push_back({s.x, s.y, s.z, s.radius});
        }
        Subjects subjects(examiner, matrix ? into_world(aimed, *matrix) : aimed, matrix);
        const std::size_t count = aimed.size();
        for (const SpotLight& light : subjects.lights)
            balls.push_back(light.ball);

        const Bounds bounds = make_bounds(camera, aim, least, static_cast<BoundsShape>(seed / 2 % 3), random);
        lightbin::ZBounds given = {.min = bounds.min, .max = bounds.max};
        if (split) given.gap_min = bounds.gap_min, given.gap_max = bounds.gap_max;
        std::vector<float> boundaries;
        for (std::size_t i = 0; i < 3; ++i)
            boundaries.push_back(aim.depth_of(least[i]) + (random.chance(0.5) ? 1.0f : -1.0f) * least[i].w);
        std::erase_if(boundaries, [](float b) { return !std::isfinite(b); });
        std::sort(boundaries.begin(), boundaries.end());
        boundaries.erase(std::unique(boundaries.begin(), boundaries.end()), boundaries.end());
        const auto slices = lightbin::Slices::from_boundaries(boundaries);
        REQUIRE(slices.has_value());

        const auto whole =
            bin_in(balls, matrix, [&](const auto& lights) { return rectangles.bin(view, lights); });
        REQUIRE(whole.has_value());
        const auto in_rectangle = membership(*whole, count);
        const auto grid = bin_in(as_spots(subjects.lights), matrix, [&](const auto& lights) {
            if constexpr (sliced)
                return binner.bin(view, lights, {.slices = *slices});
            else
                return binner.bin(view, lights, lightbin::inputs_for<options>(given));
        });
        REQUIRE(grid.has_value());
        CHECK(grid->light_counts().rejected == std::count_if(subjects.lights.begin(), subjects.lights.end(),
                                                             [](const SpotLight& s) { return is_bad(s); }));
        const auto in_list = membership_of<options>(*grid, count);

        struct Pair {
            std::size_t cell, light;
        };
        std::vector<Pair> beside, others;
        const int nx = oracle.tiles_x(), ny = oracle.tiles_y();
        for (std::size_t cell = 0; cell < in_list.size(); ++cell) {
            const int x = static_cast<int>(cell % tiles) % nx, y = static_cast<int>(cell % tiles) / nx;
            const auto has = [&](int dx, int dy, std::size_t i) {
                return x + dx >= 0 && x + dx < nx && y + dy >= 0 && y + dy < ny &&
                       in_list[cell + static_cast<std::size_t>(dy * nx + dx)][i];
            };
            for (std::size_t i = 0; i < count; ++i) {
                if (in_list[cell][i] || !in_rectangle[cell % tiles][i] || is_bad(subjects.lights[i]))
                    continue;
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
                subjects.ask(pairs[p].light, static_cast<int>(tile) % nx, static_cast<int>(tile) / nx, cells,
                             tally, rung, set.name);
            }
        };
        judge(beside, most);
        judge(others, 2 * most);
    }
}

void examine_all(const Camera& camera, const ViewMatrix* matrix, std::size_t most, SpotTally& tally,
                 std::uint64_t& seed) {
    using namespace lightbin;
    oracle::Tally unused;
    Examiner examiner(camera, unused);
    const View view = view_of(camera);
    const auto with = [&]<Options options>() {
        examine<options>(camera, examiner, view, matrix, most, tally, seed);
    };
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

void check(const std::string& name, const SpotTally& tally) {
    MESSAGE(name << ": " << tally.verdicts << " verdicts, " << tally.certificates << " by certificates, "
                 << tally.open << " left open, " << tally.misses << " missed");
    CHECK(tally.misses == 0);
    for (const auto& set : tally.sets)
        CHECK_MESSAGE(set.second.open * 1000 <= set.second.certificates, set.first);
    CHECK(tally.verdicts >= 100000);
    CHECK(tally.certificates >= 20000);
}

int rounds() {
    const char* const asked = std::getenv("LIGHTBIN_SPOT_ROUNDS");
    return asked != nullptr ? std::max(std::atoi(asked), 1) : 1;
}

/// Calls round(seed) as often as is asked for.
template <class Round>
void repeat(const std::string& name, const SpotTally& tally, std::uint64_t seed, Round round) {
    for (int done = 0; done < rounds(); ++done) {
        round(seed + static_cast<std::uint64_t>(done) * 1000003);
        if (rounds() > 1)
            std::fprintf(stderr, "%s: %d of %d rounds, %llu verdicts, %llu missed\n", name.c_str(), done + 1,
                         rounds(), static_cast<unsigned long long>(tally.verdicts),
                         static_cast<unsigned long long>(tally.misses));
    }
}

void prove(const std::string& kind, const std::vector<Camera>& cameras) {
    SpotTally tally;
    repeat(kind, tally, seed_of(kind), [&](std::uint64_t seed) {
        for (const Camera& camera : cameras)
            examine_all(camera, nullptr, 84, tally, seed);
    });
    check(kind, tally);
}

}  // namespace

#define PROVE(kind)                                                                                          \
    TEST_CASE("spots: " #kind) {                                                                             \
        prove(#kind, kinds::kind());                                                                         \
    }
ORACLE_CAMERA_KINDS(PROVE)

TEST_CASE("spots: world space") {
    SpotTally tally;
    repeat("world space", tally, 7, [&](std::uint64_t seed) {
        Random random(seed);
        const std::vector<ViewMatrix> matrices = view_matrices(random);
        for (const auto& cameras : {kinds::symmetric(), kinds::orthographic_off_centre()})
            for (const ViewMatrix& matrix : matrices)
                examine_all(cameras.front(), &matrix, 24, tally, seed);
    });
    check("world space", tally);
}

// By the campaign, which asks for more than a test has time for.
TEST_CASE("spots: missed once") {
    struct Missed {
        std::vector<Camera> cameras;
        std::string camera;
        SpotLight spot;
        int x, y;
    };
    // Half angles of 89.8 degrees: the sine and the length of the axis as floats tilted the wedge too far.
    const Missed all[] = {{kinds::wide_fov(),
                           "wide fov 3841x2161/57 upper left",
                           {{-0x1.b6e13ap+11f, -0x1.7d055cp+8f, -0x1.2ead24p+9f, 0x1.f35bbp+8f},
                            0x1.dfd71ap-10f,
                            -0x1.b07292p-1f,
                            0x1.121a44p-1f,
                            0x1.de77bep-9f},
                           15,
                           19},
                          {kinds::right_handed_zero_to_one(),
                           "right-handed [0,1] 3841x2161/57 upper left",
                           {{0x1.1888e4p-19f, 0x1.c98bb4p-18f, -0x1.778138p-16f, 0x1.b9d34cp-21f},
                            0x1.5000dcp+10f,
                            0x1.d43846p+1f,
                            0x1.f54df4p+6f,
                            0x1.63a5aep-9f},
                           35,
                           10}};
    for (const Missed& m : all)
        for (const Camera& camera : m.cameras) {
            if (camera.name != m.camera) continue;
            const Oracle oracle(camera);
            CHECK(meets(oracle.half_spaces(oracle.columns(m.x, m.x + 1), oracle.rows(m.y, m.y + 1),
                                           oracle.depths()),
                        exact_spot(m.spot)) == true);
            lightbin::Binner<lightbin::Options{.footprint = lightbin::Footprint::silhouette}> binner;
            const auto grid = *binner.bin(view_of(camera), as_spots({m.spot}));
            CHECK_MESSAGE(grid.lights_in(m.x, m.y).size() == 1, m.camera);
        }
}
