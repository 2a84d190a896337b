// SPDX-License-Identifier: MIT
// The proof that no list lacks a light that it should have, for lights whose shape is a part of a ball. spots.cpp and
// boxes.cpp run it for their kind of light: on every camera kind, with and without depth test, in view and world
// space.
//
// A question is whether a light meets a cell whose list does not have it. Cells beside a tile that has the light have a
// number of questions of their own, as a wrong margin shows there first.
//
// LIGHTBIN_ROUNDS=N asks N times as much, each time of other lights, and says how far it is: the campaign does.
//
// A Kind has
//   Light              a light as the sets make it; is_bad(Light), is_off(Light) and text(Light) are known
//   Tally              a ShapeTally and what the Shapes count
//   Shapes             constructed from an Examiner, lights, a const ViewMatrix* or nullptr, and a Tally&. Its
//                      meets(light, tiles, depths, planes) decides whether a light meets a block of tiles between two
//                      depths; planes() returns the half-spaces of that cell, in the lights' space. No value: the
//                      question stays open.
//   sets()             the sets of lights
//   ball(light)        the ball that the light is a part of
//   into_world(lights, matrix), to_library(lights)
//   whole_rectangles   whether all tiles outside a light's plain rectangle are asked, in blocks. Otherwise single cells
//                      are, and of all lists only cells in the rectangle of the ball: cells.cpp proves those outside.
//   beside, others     how many cells beside a tile that has the light, and how many others, are asked at most:
//                      multiples of `most`
#pragma once

#include "bounds.hpp"
#include "harness.hpp"
#include "world.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

namespace oracle {

struct ShapeTally {
    std::uint64_t verdicts = 0;  ///< "this light does not meet these cells", each proven
    std::uint64_t by_shape = 0;  ///< of these, not by the ball alone
    std::uint64_t open = 0, misses = 0;
    struct Set {
        std::uint64_t by_shape = 0, open = 0;
    };
    std::map<std::string, Set> sets;
};

/// The half-spaces of a cell in the space of the lights: world space if a matrix is given.
class CellPlanes {
public:
    CellPlanes(const Oracle& oracle, const ViewMatrix* matrix) : oracle_(oracle) {
        if (matrix) world_.emplace(matrix->m);
    }
    std::vector<HalfSpace> operator()(const Block& tiles, const Depths& depths) const {
        std::vector<HalfSpace> planes =
            oracle_.half_spaces(oracle_.columns(tiles.x0, tiles.x1), oracle_.rows(tiles.y0, tiles.y1), depths);
        if (world_)
            for (HalfSpace& plane : planes)
                plane = world_->preimage(plane);
        return planes;
    }

private:
    const Oracle& oracle_;
    std::optional<ExactView> world_;
};

/// Lights of a kind before a camera, in view space or, with a matrix, in world space.
template <class Kind> class Subjects {
public:
    using Lights = std::vector<typename Kind::Light>;

    Subjects(Examiner& examiner, Lights given, const ViewMatrix* matrix, typename Kind::Tally& tally)
        : lights(std::move(given)), examiner_(examiner), planes_(examiner.oracle, matrix), tally_(tally),
          shapes_(examiner, lights, matrix, tally) {
        std::optional<AroundImage> around;
        if (matrix) around.emplace(examiner.oracle, matrix->m);
        for (const auto& light : lights)
            balls_.push_back(is_bad(light) ? FlatBall{}
                             : around      ? (*around)(Kind::ball(light))
                                           : examiner.subject(Kind::ball(light)).flat);
    }

    /// Lists of these tiles lack a light: it must not meet their cell.
    void ask(std::size_t i, const Block& tiles, const Examiner::Cell& cell, const std::string& rung,
             const std::string& set) {
        ++tally_.verdicts;
        ShapeTally::Set& of_set = tally_.sets[set];
        if (cell.empty || examiner_.apart(tiles.x0, tiles.x1, tiles.y0, tiles.y1, cell, balls_[i]) ||
            cell.depths().contains_none())
            return;
        ++tally_.by_shape, ++of_set.by_shape;
        const std::optional<bool> meets =
            shapes_.meets(i, tiles, cell.flat, [&] { return planes_(tiles, cell.depths()); });
        if (!meets) ++tally_.open, ++of_set.open;
        if (meets == true && ++tally_.misses <= 5)
            MESSAGE("MISS: " << examiner_.oracle.camera().name << ", " << rung << ", " << set << " "
                             << text(lights[i]) << " tiles " << tiles.x0 << ".." << tiles.x1 << ", " << tiles.y0
                             << ".." << tiles.y1);
    }

    const Lights lights;

private:
    Examiner& examiner_;
    CellPlanes planes_;
    typename Kind::Tally& tally_;
    std::vector<FlatBall> balls_;
    typename Kind::Shapes shapes_;
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

/// Slices that begin or end where some of the lights do.
inline lightbin::Slices slices_at_ends(const Aim& aim, const std::vector<Light>& lights, Random& random) {
    std::vector<float> boundaries;
    for (std::size_t i = 0; i < 3; ++i)
        boundaries.push_back(aim.depth_of(lights[i]) + (random.chance(0.5) ? 1.0f : -1.0f) * lights[i].w);
    std::erase_if(boundaries, [](float b) { return !std::isfinite(b); });
    std::sort(boundaries.begin(), boundaries.end());
    boundaries.erase(std::unique(boundaries.begin(), boundaries.end()), boundaries.end());
    const auto slices = lightbin::Slices::from_boundaries(boundaries);
    REQUIRE(slices.has_value());
    return *slices;
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
    for (const auto& set : Kind::sets()) {
        Random random(++seed);
        const auto aimed =
            make(set, camera, std::clamp<std::size_t>(100000 / tiles, 12, whole_rectangles ? 400 : 60), ++seed);
        Subjects<Kind> subjects(examiner, matrix ? Kind::into_world(aimed, *matrix) : aimed, matrix, tally);
        const std::size_t count = aimed.size();
        std::vector<Light> least;  // the spheres that the lights are binned as, about
        for (const auto& light : Kind::to_library(aimed)) {
            const lightbin::Sphere s = Kind::least(light);
            least.push_back({s.x, s.y, s.z, s.radius});
        }
        const Bounds bounds = make_bounds(camera, aim, least, static_cast<BoundsShape>(seed / 2 % 3), random);
        const lightbin::ZBounds given = {.min = bounds.min, .max = bounds.max};
        const lightbin::Slices slices = slices_at_ends(aim, least, random);

        const auto grid = bin_in(Kind::to_library(subjects.lights), matrix, [&](const auto& lights) {
            return binner.bin(view, lights, lightbin::inputs_for<options>(given, slices));
        });
        REQUIRE(grid.has_value());
        CHECK(grid->light_counts().rejected == rejected_of(subjects.lights));
        if constexpr (whole_rectangles) {
            const std::vector<Emitted> emitted = emitted_tiles(*grid, count);
            for (std::size_t i = 0; i < count; ++i) {
                CHECK(emitted[i].rectangle());
                if (is_bad(subjects.lights[i]))
                    CHECK(!emitted[i].any());
                else
                    for (const Block& block : blocks_around(emitted[i], nx, ny))
                        subjects.ask(i, block, Examiner::Cell(examiner), rung, set.name);
            }
            continue;
        }
        const auto in_list = membership_of<options>(*grid, count);
        std::vector<std::vector<bool>> in_rectangle;
        if constexpr (!Kind::whole_rectangles) {
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
                if (!Kind::whole_rectangles && !in_rectangle[cell % tiles][i]) continue;
                const bool near_one = has(-1, 0, i) || has(1, 0, i) || has(0, -1, i) || has(0, 1, i);
                (near_one ? beside : others).push_back({cell, i});
            }
        }
        const auto judge = [&](const std::vector<Pair>& pairs, std::size_t at_most) {
            const std::size_t step = pairs.size() / at_most + 1;
            for (std::size_t p = pairs.empty() ? 0 : random.bits() % step; p < pairs.size(); p += step) {
                const std::size_t tile = pairs[p].cell % tiles, slice = pairs[p].cell / tiles;
                const auto boundaries = slices.boundaries();
                float min = -INFINITY, max = INFINITY;
                if (bounded) min = bounds.min[tile], max = bounds.max[tile];
                if (sliced && slice > 0) min = boundaries[slice - 1];
                if (sliced && slice < boundaries.size()) max = boundaries[slice];
                const int x = static_cast<int>(tile) % nx, y = static_cast<int>(tile) / nx;
                subjects.ask(pairs[p].light, {x, x + 1, y, y + 1}, {examiner, min, max}, rung, set.name);
            }
        };
        judge(beside, Kind::beside * most);
        judge(others, Kind::others * most);
    }
}

template <class Kind>
void examine_all(const Camera& camera, const ViewMatrix* matrix, std::size_t most, typename Kind::Tally& tally,
                 std::uint64_t& seed) {
    using namespace lightbin;
    oracle::Tally unused;
    Examiner examiner(camera, unused);
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

/// Calls round(seed, tally) once, or as often as LIGHTBIN_ROUNDS says, and checks what all kinds of light must pass.
template <class Kind, class Round>
typename Kind::Tally examine_rounds(const std::string& name, std::uint64_t seed, Round round) {
    const char* const asked = std::getenv("LIGHTBIN_ROUNDS");
    const int rounds = asked != nullptr ? std::max(std::atoi(asked), 1) : 1;
    typename Kind::Tally tally;
    for (int done = 0; done < rounds; ++done) {
        round(seed + static_cast<std::uint64_t>(done) * 1000003, tally);
        if (rounds > 1)
            std::fprintf(stderr, "%s: %d of %d rounds, %llu verdicts, %llu missed\n", name.c_str(), done + 1, rounds,
                         static_cast<unsigned long long>(tally.verdicts),
                         static_cast<unsigned long long>(tally.misses));
    }
    MESSAGE(name << ": " << tally.verdicts << " verdicts, " << tally.by_shape << " not by balls alone, " << tally.open
                 << " left open, " << tally.misses << " missed");
    CHECK(tally.misses == 0);
    CHECK(tally.verdicts >= 30000);
    CHECK(tally.by_shape >= 10000);
    for (const auto& set : tally.sets)
        CHECK_MESSAGE(set.second.open * 1000 <= set.second.by_shape, set.first);
    return tally;
}

/// In view space, with all cameras of a kind.
template <class Kind>
typename Kind::Tally prove_in_view_space(const std::string& name, const std::vector<Camera>& cameras,
                                         std::size_t most) {
    return examine_rounds<Kind>(name, seed_of(name), [&](std::uint64_t seed, auto& tally) {
        for (const Camera& camera : cameras)
            examine_all<Kind>(camera, nullptr, most, tally, seed);
    });
}

/// In world space, with every kind of view matrix.
template <class Kind> typename Kind::Tally prove_in_world_space() {
    return examine_rounds<Kind>("world space", 7, [](std::uint64_t seed, auto& tally) {
        Random random(seed);
        const std::vector<ViewMatrix> matrices = view_matrices(random);
        for (const auto& cameras : {kinds::symmetric(), kinds::orthographic_off_centre()})
            for (const ViewMatrix& matrix : matrices)
                examine_all<Kind>(cameras.front(), &matrix, 24, tally, seed);
    });
}

}  // namespace oracle
