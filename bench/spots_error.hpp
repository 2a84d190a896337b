// SPDX-License-Identifier: MIT
// What each method lists of a spot, beside the cells that it meets, as the sphere of its range, as its least sphere and as
// the spot that it is.
#pragma once

#include "console.hpp"
#include "exact_pairs.hpp"
#include "measure.hpp"
#include "spots_sets.hpp"

#include <lightbin/binner.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// The camera of the made sets, its projection in floats, as the exact decider has it.
inline ExactDecider made_decider(int tile_size) {
    return {glm::mat4(Lens().projection()), Lens().screen, tile_size};
}
inline lightbin::View made_view(int tile_size) {
    return *lightbin::View::from_projection(glm::mat4(Lens().projection()), Lens().screen,
                                            {.tile_size = tile_size});
}

/// Depths of each tile, drawn among those that a sphere around a light can meet: 6 % deep, the middle third a gap.
struct DrawnBounds {
    std::vector<float> min, max, gap_min, gap_max;

    DrawnBounds(std::size_t count, const lightbin::Sphere& around, Dice& dice) {
        const float first = (-around.z - around.radius) / 1.06f, last = -around.z + around.radius;
        for (std::size_t tile = 0; tile < count; ++tile) {
            const float from = dice.between(first, last);
            min.push_back(from), gap_min.push_back(from * 1.02f);
            gap_max.push_back(from * 1.04f), max.push_back(from * 1.06f);
        }
    }
    lightbin::ZBounds bounds() const { return {min, max, gap_min, gap_max}; }
};

/// What a spot is binned as.
enum class BinnedAs { whole_sphere, least_sphere, spot };

/// A method of listing spots.
struct SpotMethod {
    const char* name;
    Fact exact;  ///< what is true of the cells that the spot meets
    bool clusters;
    /// The lists of one spot alone, valid until the next call.
    std::function<std::span<const lightbin::ListRange>(const lightbin::Spot&, BinnedAs,
                                                       const lightbin::ZBounds&)>
        lists;
    /// Over all spots of one half angle.
    std::uint64_t entries[3] = {}, met = 0;

    double ratio(BinnedAs form) const { return double(entries[static_cast<int>(form)]) / double(met); }
};

template <lightbin::Options options> SpotMethod spot_method(const char* name, Fact exact) {
    constexpr bool clusters = options.slicing == lightbin::Slicing::clusters;
    const auto binner = std::make_shared<lightbin::Binner<options>>();
    const lightbin::View view = made_view(clusters ? 64 : 32);
    const lightbin::Slices slices = cluster_slices();
    return {name, exact, clusters,
            [=](const lightbin::Spot& spot, BinnedAs form, const lightbin::ZBounds& bounds) {
                const auto bin = [&](const auto& light) {
                    return binner
                        ->bin(view, lightbin::view_space(std::array{light}),
                              lightbin::inputs_for<options>(bounds, slices))
                        ->ranges();
                };
                if (form == BinnedAs::spot) return bin(spot);
                if (form == BinnedAs::least_sphere) return bin(least_sphere(spot));
                return bin(lightbin::Sphere{spot.x, spot.y, spot.z, spot.radius});
            }};
}

inline std::vector<SpotMethod> spot_methods() {
    using lightbin::DepthTest, lightbin::Footprint, lightbin::Options, lightbin::Slicing;
    constexpr Options silhouette = {.footprint = Footprint::silhouette},
                      interval = {.depth_test = DepthTest::interval}, box = {.depth_test = DepthTest::box},
                      split_box = {.depth_test = DepthTest::split_box},
                      both = {.footprint = Footprint::silhouette, .depth_test = DepthTest::box},
                      slabs = {.slicing = Slicing::clusters},
                      boxes = {.depth_test = DepthTest::box, .slicing = Slicing::clusters};
    return {
        spot_method<Options{}>("rectangle", in_pyramid), spot_method<silhouette>("silhouette", in_pyramid),
        spot_method<interval>("interval", in_cell),      spot_method<box>("box", in_cell),
        spot_method<both>("silhouette box", in_cell),    spot_method<split_box>("split_box", in_split),
        spot_method<slabs>("clusters", in_cell),         spot_method<boxes>("clusters box", in_cell),
    };
}

/// Adds a spot's facts, by cell in the order of a grid's ranges. Returns the verdicts that were left open.
inline std::uint64_t add_facts(const ExactPairs& pairs, std::vector<std::uint32_t>& facts) {
    for (const std::vector<Pair>& its : pairs.tiles)
        facts.push_back(its.empty() ? 0 : its[0].facts);
    return pairs.open;
}

/// What the half angles and methods gave in all.
struct SpotErrors {
    std::vector<TableRow> table;
    std::uint64_t misses = 0, open = 0;
    std::vector<double> saved;  ///< of each, the entries of whole spheres over the spots'
};

/// Writes spots_error.csv.
inline SpotErrors measure_spots(std::size_t spots) {
    std::FILE* const csv =
        open_report("spots_error.csv", "method,half_angle,spots,exact,whole_sphere,least_sphere,spot");
    const lightbin::View view = made_view(64);
    const lightbin::Slices slices = cluster_slices();
    ExactDecider of_tiles = made_decider(32), of_clusters = made_decider(64);
    SpotErrors errors;
    errors.table = {{"half angle"}};
    for (const SpotMethod& method : spot_methods())
        errors.table.push_back({method.name});
    std::uint32_t seed = 0;
    for (const float angle : {10.0f, 20.0f, 30.0f, 45.0f, 60.0f, 80.0f, 90.0f, 110.0f}) {
        std::vector<SpotMethod> methods = spot_methods();
        Dice dice(seed + 100);
        for (const lightbin::Spot& spot : spots_of_angle(spots, angle, ++seed)) {
            const DrawnBounds bounds(Lens().view(32).tile_count(),
                                     lightbin::Sphere{spot.x, spot.y, spot.z, spot.radius}, dice);
            std::vector<std::uint32_t> facts[2];
            errors.open += add_facts(of_tiles.pairs(Spots{spot}, bounds.bounds()), facts[0]);
            for (int slice = 0; slice < slices.count(); ++slice)
                errors.open += add_facts(pairs_in(of_clusters, view, slices, slice, Spots{spot}), facts[1]);
            for (SpotMethod& method : methods) {
                const std::vector<std::uint32_t>& cells = facts[method.clusters];
                method.met += static_cast<std::uint64_t>(std::ranges::count_if(
                    cells, [&](std::uint32_t fact) { return (fact & method.exact) != 0; }));
                for (const BinnedAs form : {BinnedAs::whole_sphere, BinnedAs::least_sphere, BinnedAs::spot}) {
                    const auto lists = method.lists(spot, form, bounds.bounds());
                    for (std::size_t cell = 0; cell < lists.size(); ++cell) {
                        method.entries[static_cast<int>(form)] += lists[cell].count;
                        errors.misses += (cells[cell] & method.exact) != 0 && lists[cell].count == 0;
                    }
                }
            }
        }
        errors.table[0].push_back(text("%g", double(angle)));
        for (std::size_t i = 0; i < methods.size(); ++i) {
            const double whole = methods[i].ratio(BinnedAs::whole_sphere),
                         own = methods[i].ratio(BinnedAs::spot);
            std::fprintf(csv, "%s,%g,%zu,%llu,%.4f,%.4f,%.4f\n", methods[i].name, double(angle), spots,
                         static_cast<unsigned long long>(methods[i].met), whole,
                         methods[i].ratio(BinnedAs::least_sphere), own);
            errors.table[i + 1].push_back(text("%.2f (%.1f)", own, whole));
            errors.saved.push_back(whole / own);
        }
    }
    std::fclose(csv);
    return errors;
}
