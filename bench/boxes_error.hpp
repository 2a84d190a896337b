// SPDX-License-Identifier: MIT
// What each method lists of a box, or of a ball cut by one, beside the cells that it meets: as the sphere around it,
// and as the box that it is.
#pragma once

#include "dice.hpp"
#include "exact/box.hpp"
#include "spots_error.hpp"

#include <lightbin/box.hpp>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

using Boxes = std::vector<lightbin::Box>;

/// Shapes of one family, of half lengths or radii .05 to .25 of their depth, with their middles in view.
struct BoxFamily {
    const char* name;
    lightbin::Box (*one)(const glm::vec3& middle, float size, const glm::mat3& frame, Dice& dice);
};

inline lightbin::Box whole_box_of(const glm::vec3& middle, const glm::mat3& frame, float x, float y, float z) {
    return lightbin::whole_box(middle, frame[0] * x, frame[1] * y, frame[2] * z);
}

inline const std::vector<BoxFamily>& box_families() {
    using glm::mat3, glm::vec3, lightbin::Box, lightbin::Sphere;
    static const std::vector<BoxFamily> families = {
        {"decal 4:4:1", [](const vec3& c, float s, const mat3& f, Dice&) { return whole_box_of(c, f, s, s, s / 4); }},
        {"card 32:32:1",
         [](const vec3& c, float s, const mat3& f, Dice&) { return whole_box_of(c, f, s, s, s / 32); }},
        {"card 1:1:0", [](const vec3& c, float s, const mat3& f, Dice&) { return whole_box_of(c, f, s, s, 0); }},
        {"cube", [](const vec3& c, float s, const mat3& f, Dice&) { return whole_box_of(c, f, s, s, s); }},
        {"rod 8:1:1",
         [](const vec3& c, float s, const mat3& f, Dice&) { return whole_box_of(c, f, s, s / 8, s / 8); }},
        {"room",
         [](const vec3& c, float s, const mat3&, Dice& dice) {
             const float turn = dice.between(0, 6.2831853f), x = std::cos(turn), z = std::sin(turn);
             return whole_box_of(c, {{x, 0, z}, {0, 1, 0}, {-z, 0, x}}, 4 * s, 1.6f * s, 3 * s);
         }},
        {"half ball",
         [](const vec3& c, float s, const mat3& f, Dice&) {
             return half_sphere(Sphere{c.x, c.y, c.z, s}, f[0]);
         }},
        {"ball in a room",
         [](const vec3& c, float s, const mat3& f, Dice& dice) {
             const vec3 half = s * vec3(dice.between(0.3f, 1.2f), dice.between(0.2f, 0.6f), dice.between(0.3f, 1.2f));
             const vec3 off = half * dice.between(vec3(-0.9f), vec3(0.9f));
             return clipped_sphere(Sphere{c.x, c.y, c.z, s}, whole_box_of(c + f * off, f, half.x, half.y, half.z));
         }},
        {"projector",
         [](const vec3& c, float s, const mat3& f, Dice&) {
             return lightbin::projector_box(c, f[2] * (2 * s), f[0] * (0.72794f * s), f[1] * (0.42511f * s), 0.05);
         }},
        {"tube 4:1", [](const vec3& c, float s, const mat3& f, Dice&) {
             return lightbin::tube_box(c - f[0] * (2 * s / 3), c + f[0] * (2 * s / 3), s / 3);
         }}};
    return families;
}

inline Boxes boxes_of(const BoxFamily& family, std::size_t count, std::uint32_t seed) {
    Dice dice(seed);
    Boxes boxes;
    while (boxes.size() < count) {
        const float depth = 5 * std::pow(30.0f, dice.between(0, 1)), x = dice.between(-1, 1) * tan_half_fov * aspect,
                    y = dice.between(-1, 1) * tan_half_fov;
        const float size = dice.between(0.05f, 0.25f) * depth;
        const glm::vec3 first = any_direction(dice), second = glm::normalize(glm::cross(first, any_direction(dice)));
        boxes.push_back(
            family.one({x * depth, y * depth, -depth}, size, {first, second, glm::cross(first, second)}, dice));
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

/// A method of listing boxes.
struct BoxMethod {
    const char* name;
    Fact exact;  ///< what is true of the cells that the box meets
    bool clusters;
    /// The lists of one box alone, or of the sphere around it, valid until the next call.
    std::function<std::span<const lightbin::ListRange>(const lightbin::Box&, bool as_sphere,
                                                       const lightbin::ZBounds&)>
        lists;
    std::uint64_t entries[2] = {}, met = 0;  ///< over all boxes of a family; entries as boxes and as spheres

    double ratio(bool as_sphere) const { return double(entries[as_sphere]) / double(met); }
};

template <lightbin::Options options> BoxMethod box_method(const char* name, Fact exact) {
    constexpr bool clusters = options.slicing == lightbin::Slicing::clusters;
    const auto binner = std::make_shared<lightbin::Binner<options>>();
    const lightbin::View view = made_view(clusters ? 64 : 32);
    const lightbin::Slices slices = cluster_slices();
    return {name, exact, clusters, [=](const lightbin::Box& box, bool as_sphere, const lightbin::ZBounds& bounds) {
                const auto bin = [&](const auto& light) {
                    return binner
                        ->bin(view, lightbin::view_space(std::array{light}),
                              lightbin::inputs_for<options>(bounds, slices))
                        ->ranges();
                };
                return as_sphere ? bin(bounding_sphere(box)) : bin(box);
            }};
}

inline std::vector<BoxMethod> box_methods() {
    using lightbin::DepthTest, lightbin::Footprint, lightbin::Options, lightbin::Slicing;
    constexpr Options silhouette = {.footprint = Footprint::silhouette},
                      interval = {.depth_test = DepthTest::interval}, box = {.depth_test = DepthTest::box},
                      both = {.footprint = Footprint::silhouette, .depth_test = DepthTest::box},
                      slabs = {.slicing = Slicing::clusters},
                      boxes = {.depth_test = DepthTest::box, .slicing = Slicing::clusters};
    return {box_method<Options{}>("rectangle", in_pyramid), box_method<silhouette>("silhouette", in_pyramid),
            box_method<interval>("interval", in_cell),      box_method<box>("box", in_cell),
            box_method<both>("silhouette box", in_cell),    box_method<slabs>("clusters", in_cell),
            box_method<boxes>("clusters box", in_cell)};
}

/// What the families and methods gave in all.
struct BoxErrors {
    std::vector<TableRow> table;
    std::uint64_t misses = 0;
};

/// Writes boxes_error.csv.
inline BoxErrors measure_boxes(std::size_t boxes) {
    std::FILE* const csv = open_report("boxes_error.csv", "method,family,boxes,exact,sphere,box");
    const lightbin::Slices slices = cluster_slices();
    BoxDecider of_tiles(32), of_clusters(64);
    // Which tiles are asked: those in the rectangle of the sphere around the box.
    BoxMethod tiles_of_sphere = box_method<lightbin::Options{}>("", in_pyramid),
              clusters_of_sphere = box_method<lightbin::Options{.slicing = lightbin::Slicing::clusters}>("", in_cell);
    BoxErrors errors;
    errors.table = {{"family"}};
    for (const BoxMethod& method : box_methods())
        errors.table.push_back({method.name});
    std::uint32_t seed = 0;
    for (const BoxFamily& family : box_families()) {
        std::vector<BoxMethod> methods = box_methods();
        Dice dice(seed + 300);
        for (const lightbin::Box& box : boxes_of(family, boxes, ++seed)) {
            oracle::BoxLight light = {box.x, box.y,    box.z, box.radius, {box.box_x, box.box_y, box.box_z},
                                      {},    box.taper};
            std::copy(&box.half_axes[0][0], &box.half_axes[0][0] + 9, &light.half_axes[0][0]);
            const BoxDecider::Subject subject(light);
            const DrawnBounds bounds(Lens().view(32).tile_count(), bounding_sphere(box), dice);
            std::vector<std::uint32_t> facts[2];
            for (const bool clusters : {false, true}) {
                BoxDecider& decider = clusters ? of_clusters : of_tiles;
                const auto lists =
                    (clusters ? clusters_of_sphere : tiles_of_sphere).lists(box, true, bounds.bounds());
                const std::size_t tiles =
                    clusters ? lists.size() / static_cast<std::size_t>(slices.count()) : lists.size();
                facts[clusters].resize(lists.size());
                for (std::size_t cell = 0; cell < lists.size(); ++cell) {
                    if (lists[cell].count == 0) continue;
                    const std::size_t tile = cell % tiles, slice = cell / tiles;
                    const int x = static_cast<int>(tile) % decider.tiles_x(),
                              y = static_cast<int>(tile) / decider.tiles_x();
                    std::uint32_t& its = facts[clusters][cell];
                    if (clusters) {
                        const float min = slice == 0 ? -INFINITY : slices.boundaries()[slice - 1],
                                    max = slice < slices.boundaries().size() ? slices.boundaries()[slice] : INFINITY;
                        its = decider.meets(x, y, min, max, subject) ? +in_cell : 0;
                    } else if (decider.meets(x, y, -INFINITY, INFINITY, subject)) {
                        its = in_pyramid;
                        if (decider.meets(x, y, bounds.min[tile], bounds.max[tile], subject)) its |= in_cell;
                    }
                }
            }
            for (BoxMethod& method : methods) {
                const std::vector<std::uint32_t>& cells = facts[method.clusters];
                method.met += static_cast<std::uint64_t>(
                    std::ranges::count_if(cells, [&](std::uint32_t fact) { return (fact & method.exact) != 0; }));
                for (const bool as_sphere : {false, true}) {
                    const auto lists = method.lists(box, as_sphere, bounds.bounds());
                    for (std::size_t cell = 0; cell < lists.size(); ++cell) {
                        method.entries[as_sphere] += lists[cell].count;
                        errors.misses += (cells[cell] & method.exact) != 0 && lists[cell].count == 0;
                    }
                }
            }
        }
        errors.table[0].push_back(family.name);
        for (std::size_t i = 0; i < methods.size(); ++i) {
            std::fprintf(csv, "%s,%s,%zu,%llu,%.4f,%.4f\n", methods[i].name, family.name, boxes,
                         static_cast<unsigned long long>(methods[i].met), methods[i].ratio(true),
                         methods[i].ratio(false));
            errors.table[i + 1].push_back(text("%.2f (%.1f)", methods[i].ratio(false), methods[i].ratio(true)));
        }
    }
    std::fclose(csv);
    return errors;
}
