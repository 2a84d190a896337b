// SPDX-License-Identifier: MIT
// Compares the cells in which methods list a single spot or box with the cells that it truly meets: the light as it is,
// and as a sphere around it.
#pragma once

#include "boxes_sets.hpp"
#include "console.hpp"
#include "exact_pairs.hpp"
#include "measure.hpp"
#include "spots_sets.hpp"

#include <dice.hpp>

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

/// Returns the exact arithmetic for the camera of bench/sets.hpp.
inline ExactDecider made_decider(int tile_size) {
    return {glm::mat4(Lens().projection()), Lens().screen, tile_size};
}
inline lightbin::View made_view(int tile_size) {
    return *lightbin::View::from_projection(glm::mat4(Lens().projection()), Lens().screen, {.tile_size = tile_size});
}

/// Random depth intervals of tiles, near enough for a sphere around a light to meet; 6 % of the depth deep.
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
    Fact exact;  ///< fact about the cells that the light truly meets
    bool clusters;
    /// Returns the lists of one light alone, valid until the next call.
    std::function<std::span<const lightbin::ListRange>(const AnyLight&, const lightbin::ZBounds&)> lists;
    /// Entries of all lights of a family, by the form in which a light is binned; and cells that the lights truly meet.
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

/// Lights of one shape and size.
struct ShapeFamily {
    std::string name;
    /// For each light the forms in which it is binned, from a sphere around it to the light itself.
    std::vector<std::vector<AnyLight>> lights;
};

/// Results of all families of lights and all methods.
struct ShapeErrors {
    std::vector<TableRow> table;
    std::uint64_t misses = 0, open = 0;
    std::vector<double> saved;  ///< entries of spheres over those of the lights, for each family and method
};

/// Lists each light alone by each method in each form, and writes a CSV file. The random depths of tiles have the seeds
/// `seed`, `seed` + 1 and so on, one for each family.
inline ShapeErrors measure_shapes(const char* path, const char* header, const char* head,
                                  const std::vector<ShapeFamily>& families, std::uint32_t seed) {
    const lightbin::View view = made_view(64);
    const lightbin::Slices slices = cluster_slices();
    const std::vector<ShapeMethod> all = shape_methods();
    ExactDecider of_tiles = made_decider(32), of_clusters = made_decider(64);
    std::FILE* const csv = open_report(path, header);
    ShapeErrors errors;
    errors.table = {{head}};
    for (const ShapeMethod& method : all)
        errors.table.push_back({method.name});
    // Facts about each cell, in the order of a grid's ranges.
    using Facts = std::vector<std::uint32_t>;
    const auto add = [&](const ExactPairs& pairs, Facts& facts) {
        for (const std::vector<Pair>& its : pairs.tiles)
            facts.push_back(its.empty() ? 0 : its[0].facts);
        errors.open += pairs.open;
    };
    for (const ShapeFamily& family : families) {
        std::vector<ShapeMethod> methods = all;
        Dice dice(seed++);
        for (const std::vector<AnyLight>& forms : family.lights) {
            const DrawnBounds bounds(Lens().view(32).tile_count(), std::get<lightbin::Sphere>(forms.front()), dice);
            Facts tiles, clusters;
            std::visit(
                [&](const auto& light) {
                    const std::vector alone = {light};
                    add(of_tiles.pairs(alone, bounds.bounds()), tiles);
                    for (int slice = 0; slice < slices.count(); ++slice)
                        add(pairs_in(of_clusters, view, slices, slice, alone), clusters);
                },
                forms.back());
            for (ShapeMethod& method : methods) {
                const Facts& cells = method.clusters ? clusters : tiles;
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

/// Measures spots by half angle, as their range's sphere, their least sphere and spots; writes spots_error.csv.
inline ShapeErrors measure_spots(std::size_t spots) {
    std::vector<ShapeFamily> families;
    std::uint32_t seed = 0;
    for (const float angle : {10.0f, 20.0f, 30.0f, 45.0f, 60.0f, 80.0f, 90.0f, 110.0f}) {
        ShapeFamily& family = families.emplace_back(ShapeFamily{text("%g", double(angle)), {}});
        for (const lightbin::Spot& spot : spots_of_angle(spots, angle, ++seed))
            family.lights.push_back({lightbin::Sphere{spot.x, spot.y, spot.z, spot.radius}, bounding_sphere(spot), spot});
    }
    return measure_shapes("spots_error.csv", "method,half_angle,spots,exact,whole_sphere,bounding_sphere,spot",
                          "half angle", families, 100);
}

/// Returns boxes of one shape with half lengths or radii of 0.05 to 0.25 of their depth, and their centres in view.
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

/// Measures boxes by shape, as spheres around them and as boxes; writes boxes_error.csv.
inline ShapeErrors measure_boxes(std::size_t boxes) {
    std::vector<ShapeFamily> families;
    std::uint32_t seed = 0;
    for (const BoxFamily& family : box_families()) {
        families.push_back({family.name, {}});
        for (const lightbin::Box& box : boxes_of(family, boxes, ++seed))
            families.back().lights.push_back({bounding_sphere(box), box});
    }
    return measure_shapes("boxes_error.csv", "method,family,boxes,exact,sphere,box", "family", families, 300);
}
