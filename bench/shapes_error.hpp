// SPDX-License-Identifier: MIT
// What each method lists of one spot or one box, beside the cells that it meets: as the shape that it is, and as a
// sphere around it.
#pragma once

#include "boxes_sets.hpp"
#include "console.hpp"
#include "dice.hpp"
#include "exact/box.hpp"
#include "exact_pairs.hpp"
#include "measure.hpp"
#include "spots_sets.hpp"

#include <lightbin/binner.hpp>
#include <lightbin/box.hpp>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

/// The camera of the made sets, its projection in floats, as the exact decider has it.
inline ExactDecider made_decider(int tile_size) {
    return {glm::mat4(Lens().projection()), Lens().screen, tile_size};
}
inline lightbin::View made_view(int tile_size) {
    return *lightbin::View::from_projection(glm::mat4(Lens().projection()), Lens().screen, {.tile_size = tile_size});
}

/// Depths of each tile, drawn among those that a sphere around a light can meet: 6 % deep.
struct DrawnBounds {
    std::vector<float> min, max;

    DrawnBounds(std::size_t count, const lightbin::Sphere& around, Dice& dice) {
        const float first = (-around.z - around.radius) / 1.06f, last = -around.z + around.radius;
        for (std::size_t tile = 0; tile < count; ++tile) {
            const float from = dice.between(first, last);
            min.push_back(from), max.push_back(from * 1.06f);
        }
    }
    lightbin::ZBounds bounds() const { return {min, max}; }
};

using AnyLight = std::variant<lightbin::Sphere, lightbin::Spot, lightbin::Box>;

/// A method of listing lights.
struct ShapeMethod {
    const char* name;
    Fact exact;  ///< what is true of the cells that the light meets
    bool clusters;
    /// The lists of one light alone, valid until the next call.
    std::function<std::span<const lightbin::ListRange>(const AnyLight&, const lightbin::ZBounds&)> lists;
    /// Of all lights of a family: entries by the form that a light is binned in, and cells that the lights meet.
    std::array<std::uint64_t, 3> entries = {};
    std::uint64_t met = 0;

    double ratio(std::size_t form) const { return double(entries[form]) / double(met); }
};

template <lightbin::Options options> ShapeMethod shape_method(const char* name, Fact exact) {
    constexpr bool clusters = options.slicing == lightbin::Slicing::clusters;
    const auto binner = std::make_shared<lightbin::Binner<options>>();
    const lightbin::View view = made_view(clusters ? 64 : 32);
    const lightbin::Slices slices = cluster_slices();
    return {name, exact, clusters, [=](const AnyLight& any, const lightbin::ZBounds& bounds) {
                return std::visit(
                    [&](const auto& light) {
                        const std::array lights = {light};
                        return binner
                            ->bin(view, lightbin::view_space(lights), lightbin::inputs_for<options>(bounds, slices))
                            ->ranges();
                    },
                    any);
            }};
}

inline std::vector<ShapeMethod> shape_methods() {
    using lightbin::Options, lightbin::Slicing;
    constexpr Options box = {.depth_test = true}, slabs = {.slicing = Slicing::clusters},
                      boxes = {.depth_test = true, .slicing = Slicing::clusters};
    return {
        shape_method<Options{}>("rectangle", in_pyramid),
        shape_method<box>("box", in_cell),
        shape_method<slabs>("clusters", in_cell),
        shape_method<boxes>("clusters box", in_cell),
    };
}

/// What is true of the cells that a light may meet, in the order of a grid's ranges.
struct ShapeFacts {
    std::vector<std::uint32_t> of_tiles, of_clusters;
};

/// Lights of one shape and size.
struct ShapeFamily {
    std::string name;
    /// Of each light, the forms that it is binned in: first a sphere around it, last the light itself.
    std::vector<std::vector<AnyLight>> lights;
};

/// What the families and methods gave in all.
struct ShapeErrors {
    std::vector<TableRow> table;
    std::uint64_t misses = 0, open = 0;
    std::vector<double> saved;  ///< of each family and method: the entries of spheres over those of the lights
};

/// Lists each light alone by each method, in each form, and writes a CSV file. decide(light, bounds) returns
/// ShapeFacts. The bounds of a family are drawn from a seed that counts up from `seed`.
template <class Decide>
ShapeErrors measure_shapes(const char* path, const char* header, const char* head, const std::vector<ShapeMethod>& all,
                           const std::vector<ShapeFamily>& families, std::uint32_t seed, Decide decide) {
    std::FILE* const csv = open_report(path, header);
    ShapeErrors errors;
    errors.table = {{head}};
    for (const ShapeMethod& method : all)
        errors.table.push_back({method.name});
    for (const ShapeFamily& family : families) {
        std::vector<ShapeMethod> methods = all;
        Dice dice(seed++);
        for (const std::vector<AnyLight>& forms : family.lights) {
            const DrawnBounds bounds(Lens().view(32).tile_count(), std::get<lightbin::Sphere>(forms.front()), dice);
            const ShapeFacts facts = decide(forms.back(), bounds.bounds());
            for (ShapeMethod& method : methods) {
                const std::vector<std::uint32_t>& cells = method.clusters ? facts.of_clusters : facts.of_tiles;
                method.met += static_cast<std::uint64_t>(
                    std::ranges::count_if(cells, [&](std::uint32_t fact) { return (fact & method.exact) != 0; }));
                for (std::size_t form = 0; form < forms.size(); ++form) {
                    const auto lists = method.lists(forms[form], bounds.bounds());
                    for (std::size_t cell = 0; cell < lists.size(); ++cell) {
                        method.entries[form] += lists[cell].count;
                        errors.misses += (cells[cell] & method.exact) != 0 && lists[cell].count == 0;
                    }
                }
            }
        }
        errors.table[0].push_back(family.name);
        const std::size_t forms = family.lights[0].size();
        for (std::size_t i = 0; i < methods.size(); ++i) {
            std::fprintf(csv, "%s,%s,%zu,%llu", methods[i].name, family.name.c_str(), family.lights.size(),
                         static_cast<unsigned long long>(methods[i].met));
            for (std::size_t form = 0; form < forms; ++form)
                std::fprintf(csv, ",%.4f", methods[i].ratio(form));
            std::fputc('\n', csv);
            const double as_sphere = methods[i].ratio(0), own = methods[i].ratio(forms - 1);
            errors.table[i + 1].push_back(text("%.2f (%.1f)", own, as_sphere));
            errors.saved.push_back(as_sphere / own);
        }
    }
    std::fclose(csv);
    return errors;
}

/// Spots by half angle, in spots_error.csv: as the sphere of their range, as their least sphere and as themselves.
inline ShapeErrors measure_spots(std::size_t spots) {
    const lightbin::View view = made_view(64);
    const lightbin::Slices slices = cluster_slices();
    ExactDecider of_tiles = made_decider(32), of_clusters = made_decider(64);
    std::vector<ShapeFamily> families;
    std::uint32_t seed = 0;
    for (const float angle : {10.0f, 20.0f, 30.0f, 45.0f, 60.0f, 80.0f, 90.0f, 110.0f}) {
        ShapeFamily& family = families.emplace_back(ShapeFamily{text("%g", double(angle)), {}});
        for (const lightbin::Spot& spot : spots_of_angle(spots, angle, ++seed))
            family.lights.push_back({lightbin::Sphere{spot.x, spot.y, spot.z, spot.radius}, least_sphere(spot), spot});
    }
    std::uint64_t open = 0;
    const auto add = [&](const ExactPairs& pairs, std::vector<std::uint32_t>& facts) {
        for (const std::vector<Pair>& its : pairs.tiles)
            facts.push_back(its.empty() ? 0 : its[0].facts);
        open += pairs.open;
    };
    ShapeErrors errors =
        measure_shapes("spots_error.csv", "method,half_angle,spots,exact,whole_sphere,least_sphere,spot", "half angle",
                       shape_methods(), families, 100, [&](const AnyLight& light, const lightbin::ZBounds& bounds) {
                           const Spots spot = {std::get<lightbin::Spot>(light)};
                           ShapeFacts facts;
                           add(of_tiles.pairs(spot, bounds), facts.of_tiles);
                           for (int slice = 0; slice < slices.count(); ++slice)
                               add(pairs_in(of_clusters, view, slices, slice, spot), facts.of_clusters);
                           return facts;
                       });
    errors.open = open;
    return errors;
}

/// Boxes of one family, of half lengths or radii .05 to .25 of their depth, with their middles in view.
inline Boxes boxes_of(const BoxFamily& family, std::size_t count, std::uint32_t seed) {
    Dice dice(seed);
    Boxes boxes;
    while (boxes.size() < count) {
        const float depth = 5 * std::pow(30.0f, dice.between(0, 1)), x = dice.between(-1, 1) * tan_half_fov * aspect,
                    y = dice.between(-1, 1) * tan_half_fov;
        const float size = dice.between(0.05f, 0.25f) * depth;
        boxes.push_back(box_in({x * depth, y * depth, -depth, size}, family, dice));
    }
    return boxes;
}

/// Whether boxes meet cells of a symmetric perspective camera that looks down -z.
class BoxDecider {
public:
    explicit BoxDecider(int tile_size)
        : truth_(camera_with(glm::mat4(Lens().projection()), Lens().screen, tile_size)) {}

    struct Subject {
        explicit Subject(const oracle::BoxLight& light) : exact(light) {
            const std::vector<oracle::Vector> corners = oracle::exact_corners(light);
            for (std::size_t i = 0; i < corners.size(); ++i) {
                double(&corner)[3] = flat.corners[i];
                corner[0] = oracle::nearly(corners[i].x);
                corner[1] = oracle::nearly(corners[i].y);
                corner[2] = -oracle::nearly(corners[i].z);
                for (const double coordinate : corner)
                    flat.error = std::max(flat.error, std::abs(coordinate) * 0x1p-52);
            }
            ball = {static_cast<double>(light.x), static_cast<double>(light.y), -static_cast<double>(light.z),
                    static_cast<double>(light.radius)};
        }
        oracle::ExactBox exact;
        oracle::FlatBox flat = {};
        oracle::FlatBall ball = {};
    };

    bool meets(int x, int y, float min, float max, const Subject& box) {
        const oracle::FlatDepths depths(std::max(static_cast<double>(min), truth_.range.min),
                                        std::min(static_cast<double>(max), truth_.range.max));
        if (!(depths.min <= depths.max)) return false;
        if (truth_.filter.apart(x, x + 1, y, y + 1, depths, box.ball) ||
            oracle::apart(truth_.filter, x, x + 1, y, y + 1, depths, box.flat))
            return false;
        const oracle::Oracle& oracle = truth_.oracle;
        return oracle::meets(
            oracle.half_spaces(oracle.columns(x, x + 1), oracle.rows(y, y + 1), oracle.depths(min, max)), box.exact);
    }
    int tiles_x() const { return truth_.oracle.tiles_x(); }

private:
    oracle::Truth truth_;
};

/// Boxes by family, in boxes_error.csv: as the sphere around them and as themselves.
inline ShapeErrors measure_boxes(std::size_t boxes) {
    const lightbin::Slices slices = cluster_slices();
    BoxDecider of_tiles(32), of_clusters(64);
    // Only tiles in the rectangle of the sphere around a box are asked.
    const ShapeMethod tiles_of = shape_method<lightbin::Options{}>("", in_pyramid),
                      clusters_of =
                          shape_method<lightbin::Options{.slicing = lightbin::Slicing::clusters}>("", in_cell);
    std::vector<ShapeFamily> families;
    std::uint32_t seed = 0;
    for (const BoxFamily& family : box_families()) {
        families.push_back({family.name, {}});
        for (const lightbin::Box& box : boxes_of(family, boxes, ++seed))
            families.back().lights.push_back({bounding_sphere(box), box});
    }
    return measure_shapes(
        "boxes_error.csv", "method,family,boxes,exact,sphere,box", "family", shape_methods(), families, 300,
        [&](const AnyLight& any, const lightbin::ZBounds& bounds) {
            const lightbin::Box& box = std::get<lightbin::Box>(any);
            oracle::BoxLight light = {box.x, box.y,    box.z, box.radius, {box.box_x, box.box_y, box.box_z},
                                      {},    box.taper};
            std::copy(&box.half_axes[0][0], &box.half_axes[0][0] + 9, &light.half_axes[0][0]);
            const BoxDecider::Subject subject(light);
            ShapeFacts facts;
            for (const lightbin::ListRange& list : tiles_of.lists(bounding_sphere(box), bounds)) {
                const std::size_t tile = facts.of_tiles.size();
                const int x = static_cast<int>(tile) % of_tiles.tiles_x(),
                          y = static_cast<int>(tile) / of_tiles.tiles_x();
                const bool meets = list.count > 0 && of_tiles.meets(x, y, -INFINITY, INFINITY, subject),
                           meets_cell = meets && of_tiles.meets(x, y, bounds.min[tile], bounds.max[tile], subject);
                facts.of_tiles.push_back((meets ? +in_pyramid : 0u) | (meets_cell ? +in_cell : 0u));
            }
            const auto lists = clusters_of.lists(bounding_sphere(box), bounds);
            const std::size_t tiles = lists.size() / static_cast<std::size_t>(slices.count());
            for (std::size_t cell = 0; cell < lists.size(); ++cell) {
                const std::size_t tile = cell % tiles, slice = cell / tiles;
                const auto ends = slices.boundaries();
                const float min = slice == 0 ? -INFINITY : ends[slice - 1],
                            max = slice < ends.size() ? ends[slice] : INFINITY;
                const int x = static_cast<int>(tile) % of_clusters.tiles_x(),
                          y = static_cast<int>(tile) / of_clusters.tiles_x();
                facts.of_clusters.push_back(
                    lists[cell].count > 0 && of_clusters.meets(x, y, min, max, subject) ? +in_cell : 0u);
            }
            return facts;
        });
}
