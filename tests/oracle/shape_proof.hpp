// SPDX-License-Identifier: MIT
// The proof that no list lacks a light that it should have. spheres.cpp, spots.cpp and boxes.cpp run it for their kind
// of light: on every camera kind, with and without depth test, in view and world space.
//
// A question is whether a light meets a cell whose list does not have it. Cells beside a tile that has the light have a
// number of questions of their own, as a wrong margin shows there first. Masks must have the lights of the lists.
//
// LIGHTBIN_CAMERAS names the kinds of camera to ask about, world_space among them; LIGHTBIN_ROUNDS=N asks N times as
// much, each time of other lights: the campaign does.
//
// A Kind has
//   Light              a light as the sets make it; is_bad(Light), is_off(Light), text(Light) and into_world(lights,
//                      matrix) are known
//   Tally              a ShapeTally and what the Shapes count
//   Shapes             constructed from an Examiner, lights, a const ViewMatrix* or nullptr, and a Tally&. Its
//                      meets(light, tiles, depths, planes) decides whether a light meets a block of tiles between two
//                      depths; planes() returns the half-spaces of that cell, in the lights' space. No value: the
//                      question stays open.
//   sets()             the sets of lights
//   ball(light)        the ball that the light is a part of
//   to_library(lights), least(light of the library's)
//   whole_rectangles   whether all tiles outside a light's plain rectangle are asked, in blocks. Otherwise single cells
//                      are, and of all lists only cells in the rectangle of the ball: spheres.cpp proves those outside
//   tight              whether all that the lists have must be explained by the method: by Shapes::as_seen(light). Of
//                      these, too, only cells in the rectangle are asked.
//   beside, others     how many cells beside a tile that has the light, and how many others, are asked at most:
//                      multiples of `most`
//   check(tally)       what else must hold at the end
//   lights             how many lights of a set are asked about whole rectangles
#pragma once

#include "bounds.hpp"
#include "harness.hpp"
#include "world.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

namespace oracle {

struct ShapeTally {
    std::uint64_t verdicts = 0;  ///< proofs that a light does not meet certain cells
    std::uint64_t by_shape = 0;  ///< of these, proofs that need the shape, not only its sphere
    std::uint64_t open = 0, misses = 0;
    std::uint64_t explained = 0;    ///< if Kind::tight: rectangles and listed pairs that were checked
    std::uint64_t unexplained = 0;  ///< of these, those that the library's method does not explain
    std::uint64_t below = 0;        ///< rectangles that lack tiles of the library's method
    struct Set {
        std::uint64_t by_shape = 0, open = 0;
    };
    std::map<std::string, Set> sets;
};

/// Lights of one kind in front of a camera, in view space or, with a view matrix, in world space.
template <class Kind> class Subjects {
public:
    using Lights = std::vector<typename Kind::Light>;

    Subjects(Examiner& examiner, Lights given, const ViewMatrix* matrix, typename Kind::Tally& tally)
        : lights(std::move(given)), shapes(examiner, lights, matrix, tally), examiner_(examiner),
          planes_(examiner.oracle, matrix), tally_(tally) {
        std::optional<AroundImage> around;
        if (matrix) around.emplace(examiner.oracle, *matrix);
        for (const auto& light : lights)
            balls_.push_back(is_bad(light) ? FlatBall{}
                             : around      ? (*around)(Kind::ball(light))
                                           : examiner.subject(exact_ball(Kind::ball(light))).flat);
    }

    /// The lists of these tiles lack a light: proves that the light does not meet their cell.
    void ask(std::size_t i, const Block& tiles, const Examiner::Cell& cell, const std::string& rung,
             const std::string& set) {
        if (tally_.misses > 20) return;  // rationals take long, and nothing is left to prove
        ++tally_.verdicts;
        ShapeTally::Set& of_set = tally_.sets[set];
        if (cell.empty || examiner_.apart(tiles, cell, balls_[i]) ||
            cell.depths().contains_none())
            return;
        ++tally_.by_shape, ++of_set.by_shape;
        const std::optional<bool> meets =
            shapes.meets(i, tiles, cell.flat, [&] { return planes_(tiles, cell.depths()); });
        if (!meets) ++tally_.open, ++of_set.open;
        if (meets == true) report(tally_.misses, "MISS", i, tiles, cell, rung, set);
    }

    void report(std::uint64_t& count, const char* what, std::size_t i, const Block& tiles, const Examiner::Cell& cell,
                const std::string& rung, const std::string& set) const {
        if (++count <= 5)
            MESSAGE(what << ": " << examiner_.oracle.camera().name << ", " << rung << ", " << set << " "
                         << text(lights[i]) << " tiles " << tiles.x0 << ".." << tiles.x1 << ", " << tiles.y0 << ".."
                         << tiles.y1 << ", depths " << cell.min << ".." << cell.max);
    }

    const Lights lights;
    typename Kind::Shapes shapes;

private:
    Examiner& examiner_;
    CellPlanes planes_;
    typename Kind::Tally& tally_;
    std::vector<FlatBall> balls_;
};

/// Calls bin() with lights in view space or, if a matrix is given, in world space.
template <class Any, class Bin> auto bin_in(const std::vector<Any>& lights, const ViewMatrix* matrix, Bin bin) {
    if (!matrix) return bin(lightbin::view_space(lights));
    if (!matrix->large) return bin(lightbin::world_space(lights, matrix->m));
    const auto [eye, origin] = *matrix->large;
    return bin(lightbin::world_space(lights, matrix->m, {eye.x, eye.y, eye.z}, [&](const Any& light) {
        const auto local = lightbin::detail::AsLight()(light);
        return lightbin::Placed<std::remove_const_t<decltype(local)>>{{origin.x, origin.y, origin.z}, local};
    }));
}

/// Returns in[cell][light], slice by slice. With z-bins it has the lights of a tile's list that are in the bin.
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

template <class Kind, lightbin::Options options>
void examine_shapes(const Camera& camera, Examiner& examiner, const lightbin::View& view, const ViewMatrix* matrix,
                    std::size_t most, typename Kind::Tally& tally, std::uint64_t& seed) {
    constexpr bool sliced = options.slicing != lightbin::Slicing::none, bounded = !sliced && options.depth_test,
                   whole_rectangles = Kind::whole_rectangles && !sliced && !bounded;
    const std::string rung = std::string(options.depth_test ? "depth test, " : "") + to_string(options.slicing);
    const Aim aim(camera);
    const std::size_t tiles = view.tile_count();
    const int nx = view.tiles_x(), ny = view.tiles_y();
    lightbin::Binner<> rectangles;
    lightbin::Binner<options> binner;
    lightbin::MaskBinner mask_binner;
    for (const auto& set : Kind::sets()) {
        Random random(++seed);
        const auto aimed =
            make(set, camera,
                 whole_rectangles || (bounded && matrix && Kind::tight)
                     ? Kind::lights
                     : std::clamp<std::size_t>(100000 / tiles, 12, 60),
                 ++seed);
        Subjects<Kind> subjects(examiner, matrix ? into_world(aimed, *matrix) : aimed, matrix, tally);
        const std::size_t count = aimed.size();
        std::vector<Light> least;  // the spheres that the lights are binned as, about
        for (const auto& light : Kind::to_library(aimed)) {
            const lightbin::Sphere s = Kind::least(light);
            least.push_back({s.x, s.y, s.z, s.radius});
        }
        const Bounds bounds = make_bounds(camera, aim, least, static_cast<BoundsShape>(seed / 2 % 3), random);
        lightbin::ZBounds given;
        const std::uint64_t sides = 1 + seed % 3;  // minimum, maximum, both
        if (sides & 1) given.min = bounds.min;
        if (sides & 2) given.max = bounds.max;
        const lightbin::Slices slices = slices_at_ends(aim, least, random);

        const auto grid = bin_in(Kind::to_library(subjects.lights), matrix, [&](const auto& lights) {
            return binner.bin(view, lights, lightbin::inputs_for<options>(given, slices));
        });
        REQUIRE(grid.has_value());
        CHECK(grid->light_counts().rejected == rejected_of(subjects.lights));
        if constexpr (!options.depth_test && options.slicing != lightbin::Slicing::clusters) {
            const auto masks = bin_in(Kind::to_library(subjects.lights), matrix, [&](const auto& lights) {
                return sliced ? mask_binner.bin(view, lights, slices) : mask_binner.bin(view, lights);
            });
            REQUIRE(masks.has_value());
            CHECK_MESSAGE(membership(*masks, count) == membership_of<options>(*grid, count), set.name);
        }
        if constexpr (whole_rectangles) {
            const Examiner::Cell cell(examiner);
            const std::vector<Emitted> emitted = emitted_tiles(*grid, count);
            for (std::size_t i = 0; i < count; ++i) {
                const Emitted& e = emitted[i];
                CHECK(e.rectangle());
                if (is_bad(subjects.lights[i])) {
                    CHECK(!e.any());
                    continue;
                }
                for (const Block& block : blocks_around(e, nx, ny))
                    subjects.ask(i, block, cell, rung, set.name);
                if constexpr (Kind::tight) {
                    const std::optional<Ball> seen = subjects.shapes.as_seen(i);
                    if (!seen) continue;
                    const Examiner::Subject subject = examiner.subject(*seen);
                    const Block block = {e.x0, e.x1 + 1, e.y0, e.y1 + 1};
                    if (!matrix && examiner.lacks_some(subject, e))
                        subjects.report(tally.below, "too small", i, block, cell, rung, set.name);
                    if (!e.any()) continue;
                    ++tally.explained;
                    if (!examiner.explained(subject, e))
                        subjects.report(tally.unexplained, "unexplained", i, block, cell, rung, set.name);
                }
            }
            continue;
        }
        const auto in_list = membership_of<options>(*grid, count);
        std::vector<std::vector<bool>> in_rectangle;
        if constexpr (!Kind::whole_rectangles || Kind::tight) {
            std::vector<Light> balls;
            for (const auto& light : subjects.lights)
                balls.push_back(Kind::ball(light));
            const auto of_balls =
                bin_in(balls, matrix, [&](const auto& lights) { return rectangles.bin(view, lights); });
            REQUIRE(of_balls.has_value());
            in_rectangle = membership(*of_balls, count);
        }

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
                if ((!Kind::whole_rectangles || Kind::tight) && !in_rectangle[cell % tiles][i]) continue;
                const bool near_one = has(-1, 0, i) || has(1, 0, i) || has(0, -1, i) || has(0, 1, i);
                (near_one ? beside : others).push_back({cell, i});
            }
        }
        const auto block_of = [&](std::size_t cell) {
            const int x = static_cast<int>(cell % tiles) % nx, y = static_cast<int>(cell % tiles) / nx;
            return Block{x, x + 1, y, y + 1};
        };
        const auto depths_of = [&](std::size_t cell) {
            const std::size_t tile = cell % tiles, slice = cell / tiles;
            const auto boundaries = slices.boundaries();
            float min = -INFINITY, max = INFINITY;
            if (bounded && sides & 1) min = bounds.min[tile];
            if (bounded && sides & 2) max = bounds.max[tile];
            if (sliced && slice > 0) min = boundaries[slice - 1];
            if (sliced && slice < boundaries.size()) max = boundaries[slice];
            return Examiner::Cell(examiner, min, max);
        };
        const auto judge = [&](const std::vector<Pair>& pairs, std::size_t at_most) {
            const std::size_t step = pairs.size() / at_most + 1;
            for (std::size_t p = pairs.empty() ? 0 : random.bits() % step; p < pairs.size(); p += step)
                subjects.ask(pairs[p].light, block_of(pairs[p].cell), depths_of(pairs[p].cell), rung, set.name);
        };
        judge(beside, Kind::beside * most);
        judge(others, Kind::others * most);

        // Lists have only lights whose rectangle has the tile, whose depths meet the tile's bounds and, under a depth
        // test, whose sphere meets the box around the cell. If a light's depths reach FLT_MAX, where boxes end, it also
        // meets bounds beyond.
        if constexpr (Kind::tight && options.slicing != lightbin::Slicing::z_bins) {
            if (matrix) continue;
            std::vector<Examiner::Subject> balls;
            for (std::size_t i = 0; i < count; ++i)
                balls.push_back(examiner.subject(*subjects.shapes.as_seen(i)));
            for (std::size_t c = 0; c < in_list.size(); ++c) {
                const Examiner::Cell cell = depths_of(c);
                const auto finite = [](float bound) {
                    return std::isfinite(bound) ? std::optional(exact(static_cast<double>(bound))) : std::nullopt;
                };
                const std::optional<Rational> least_depth = finite(cell.min), most_depth = finite(cell.max);
                const Block block = block_of(c);
                for (std::size_t i = 0; i < count; ++i) {
                    if (!in_list[c][i]) continue;
                    ++tally.explained;
                    const bool endless = std::abs(least[i].z) + least[i].w >= FLT_MAX,
                               empty = cell.empty || cell.min > cell.max;
                    const bool in_box = !options.depth_test || (endless && (sliced || cell.min == INFINITY)) ||
                                        ((endless || !empty) && examiner.box_meets(balls[i], block.x0, block.y0, cell));
                    if (!in_rectangle[c % tiles][i] || !in_box ||
                        !examiner.depths_within(balls[i], least_depth, most_depth))
                        subjects.report(tally.unexplained, "unexplained", i, block, cell, rung, set.name);
                }
            }
        }
    }
}

template <class Kind>
void examine_all(const Camera& camera, const ViewMatrix* matrix, std::size_t most, typename Kind::Tally& tally,
                 std::uint64_t& seed) {
    using namespace lightbin;
    Examiner examiner(camera);
    const View view = view_of(camera);
    const auto with = [&]<Options options>() {
        examine_shapes<Kind, options>(camera, examiner, view, matrix, most, tally, seed);
    };
    with.template operator()<Options{}>();
    with.template operator()<Options{.depth_test = true}>();
    with.template operator()<Options{.slicing = Slicing::clusters}>();
    with.template operator()<Options{.depth_test = true, .slicing = Slicing::clusters}>();
    with.template operator()<Options{.slicing = Slicing::z_bins}>();
}

/// Tests one kind of camera, or world space with every kind of view matrix, once or as often as LIGHTBIN_ROUNDS says,
/// and checks what holds for all kinds of light.
template <class Kind> void prove(const std::string& name, const std::vector<Camera>& cameras) {
    const bool in_world = cameras.empty();
    const char* const asked = std::getenv("LIGHTBIN_ROUNDS");
    typename Kind::Tally tally;
    for (int round = 0; round == 0 || (asked != nullptr && round < std::atoi(asked)); ++round) {
        std::uint64_t seed = seed_of(name) + static_cast<std::uint64_t>(round) * 1000003;
        for (const Camera& camera : cameras)
            examine_all<Kind>(camera, nullptr, 200, tally, seed);
        if (!in_world) continue;
        Random random(seed);
        const std::vector<ViewMatrix> matrices = view_matrices(random);
        for (const char* const kind : {"symmetric", "reversed_infinite", "orthographic_off_centre"})
            for (const ViewMatrix& matrix : matrices)
                examine_all<Kind>(camera_of_kind(kind), &matrix, 24, tally, seed);
    }
    MESSAGE(name << ": " << tally.verdicts << " verdicts, " << tally.by_shape << " not by balls alone, " << tally.open
                 << " left open, " << tally.misses << " missed, " << tally.explained << " explained");
    CHECK(tally.misses == 0);
    CHECK(tally.unexplained == 0);
    CHECK(tally.below == 0);
    CHECK(tally.verdicts >= 30000);
    CHECK((Kind::tight ? tally.explained : tally.by_shape) >= 10000);
    for (const auto& set : tally.sets)
        CHECK_MESSAGE(set.second.open * 1000 <= set.second.by_shape, set.first);
    Kind::check(tally);
}

/// Tests all kinds of camera and world space, or those named by LIGHTBIN_CAMERAS.
template <class Kind> void prove_all() {
    const char* const only = std::getenv("LIGHTBIN_CAMERAS");
    bool found = false;
    const auto run = [&](const std::string& name, const std::vector<Camera>& cameras) {
        if (only != nullptr && (" " + std::string(only) + " ").find(" " + name + " ") == std::string::npos) return;
        prove<Kind>(name, cameras);
        found = true;
    };
    for (const CameraKind& kind : camera_kinds())
        run(kind.name, kind.cameras());
    run("world_space", {});
    CHECK(found);
}

}  // namespace oracle
