// SPDX-License-Identifier: MIT
// What each rung of the ladder lists of a spot, beside the cells that it meets, as the sphere of its range, as its least
// sphere and as the spot that it is.
#pragma once

#include "console.hpp"
#include "goals.hpp"
#include "measure.hpp"
#include "slicing.hpp"
#include "spots_exact.hpp"
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

inline constexpr std::array<float, 6> half_angles = {10, 20, 30, 45, 60, 80};

/// The cells that are asked about.
enum Question { tiles, cells, split_cells, clusters };

/// What a spot is binned as.
enum Form { whole_sphere, least_sphere_of_it, spot_itself };

/// Depths of each tile, drawn among those that the sphere of a spot's range can meet: 6 % deep, the middle third a gap.
struct DrawnBounds {
    std::vector<float> min, max, gap_min, gap_max;

    DrawnBounds(std::size_t count, const lightbin::Spot& spot, Dice& dice) {
        const float first = (-spot.z - spot.radius) / 1.06f, last = -spot.z + spot.radius;
        for (std::size_t tile = 0; tile < count; ++tile) {
            const float from = dice.between(first, last);
            min.push_back(from), gap_min.push_back(from * 1.02f);
            gap_max.push_back(from * 1.04f), max.push_back(from * 1.06f);
        }
    }
    lightbin::ZBounds bounds() const { return {min, max, gap_min, gap_max}; }
};

struct Rung {
    const char* name;
    Question question;
    std::array<double, 6> must;  ///< by half angle; 0 where there is no goal
    double aim;
    /// The lists of one spot alone, valid until the next call.
    std::function<std::span<const lightbin::ListRange>(const lightbin::Spot&, Form, const lightbin::ZBounds&)>
        lists;
};

inline constexpr int tile_size_of(Question question) {
    return question == clusters ? 64 : 32;
}

template <lightbin::Options options>
Rung rung(const char* name, Question question, const std::array<double, 6>& must, double aim) {
    const auto binner = std::make_shared<lightbin::Binner<options>>();
    const lightbin::View view = Lens().view(tile_size_of(question));
    const lightbin::Slices slices = cluster_slices();
    return {name, question, must, aim,
            [=](const lightbin::Spot& spot, Form form, const lightbin::ZBounds& bounds) {
                const auto bin = [&](const auto& light) {
                    return binner
                        ->bin(view, lightbin::view_space(std::array{light}),
                              lightbin::inputs_for<options>(bounds, slices))
                        ->ranges();
                };
                if (form == spot_itself) return bin(spot);
                if (form == least_sphere_of_it) return bin(least_sphere(spot));
                return bin(lightbin::Sphere{spot.x, spot.y, spot.z, spot.radius});
            }};
}

inline std::vector<Rung> spot_rungs() {
    using lightbin::DepthTest, lightbin::Footprint, lightbin::Options, lightbin::Slicing;
    constexpr Options silhouette = {.footprint = Footprint::silhouette},
                      interval = {.depth_test = DepthTest::interval}, box = {.depth_test = DepthTest::box},
                      split_box = {.depth_test = DepthTest::split_box},
                      both = {.footprint = Footprint::silhouette, .depth_test = DepthTest::box},
                      slabs = {.slicing = Slicing::clusters},
                      boxes = {.depth_test = DepthTest::box, .slicing = Slicing::clusters};
    constexpr std::array<double, 6> none = {};
    return {
        rung<Options{}>("rectangle", tiles, {3.6, 2.4, 1.9, 1.75, 1.65, 1.7}, 1.7),
        rung<silhouette>("silhouette", tiles, {1.3, 1.3, 1.2, 1.15, 1.15, 1.25}, 1.1),
        rung<interval>("interval", cells, none, 0),
        rung<box>("box", cells, {1.5, 1.4, 1.35, 1.3, 1.25, 1.25}, 1.15),
        rung<both>("silhouette box", cells, none, 0),
        rung<split_box>("split_box", split_cells, none, 0),
        rung<slabs>("clusters", clusters, none, 0),
        rung<boxes>("clusters box", clusters, none, 0),
    };
}

/// The cells that a spot meets: in the order of a grid's ranges.
struct Met {
    std::vector<bool> cells;
    std::uint64_t count = 0, open = 0;
};

/// Answers of both tile sizes.
class SpotQuestions {
public:
    Met ask(Question question, const lightbin::Spot& spot, const DrawnBounds& bounds) {
        SpotDecider& decider = question == clusters ? of_clusters_ : of_tiles_;
        const int slices = question == clusters ? slices_.count() : 1;
        Met met;
        for (int slice = 0; slice < slices; ++slice)
            for (int y = 0, tile = 0; y < decider.tiles_y(); ++y)
                for (int x = 0; x < decider.tiles_x(); ++x, ++tile) {
                    const auto verdict =
                        any(decider, x, y, spot, parts(question, bounds, std::size_t(tile), slice));
                    met.cells.push_back(verdict == true);
                    met.count += verdict == true;
                    met.open += !verdict;
                }
        return met;
    }

private:
    /// The depths of a cell, two where it has a gap.
    std::vector<DepthRange> parts(Question question, const DrawnBounds& bounds, std::size_t tile,
                                  int slice) const {
        if (question == tiles) return {{}};
        if (question == cells) return {{bounds.min[tile], bounds.max[tile]}};
        if (question == split_cells)
            return {{bounds.min[tile], bounds.gap_min[tile]}, {bounds.gap_max[tile], bounds.max[tile]}};
        DepthRange range;
        if (slice > 0) range.min = slices_.boundaries()[std::size_t(slice - 1)];
        if (slice + 1 < slices_.count()) range.max = slices_.boundaries()[std::size_t(slice)];
        return {range};
    }

    static std::optional<bool> any(SpotDecider& decider, int x, int y, const lightbin::Spot& spot,
                                   const std::vector<DepthRange>& parts) {
        bool open = false;
        for (const DepthRange& part : parts) {
            const auto verdict = decider.meets(x, y, part, spot);
            if (verdict == true) return true;
            open |= !verdict;
        }
        return open ? std::nullopt : std::optional(false);
    }

    lightbin::Slices slices_ = cluster_slices();
    SpotDecider of_tiles_{{}, tile_size_of(tiles)}, of_clusters_{{}, tile_size_of(clusters)};
};

/// Entries of each form and what they should be, of one rung and half angle.
struct Tightness {
    std::uint64_t entries[3] = {}, exact = 0, open = 0, misses = 0;
    double ratio(Form form) const { return double(entries[form]) / double(exact); }
};

inline void count(const Rung& rung, const lightbin::Spot& spot, const DrawnBounds& bounds, const Met& met,
                  Tightness& sum) {
    sum.exact += met.count;
    sum.open += met.open;
    for (const Form form : {whole_sphere, least_sphere_of_it, spot_itself}) {
        const auto lists = rung.lists(spot, form, bounds.bounds());
        for (std::size_t cell = 0; cell < lists.size(); ++cell) {
            sum.entries[form] += lists[cell].count;
            sum.misses += met.cells[cell] && lists[cell].count == 0;
        }
    }
}

inline void write_tightness(std::FILE* csv, const Rung& rung, std::size_t angle, std::size_t spots,
                            const Tightness& t) {
    const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    std::fprintf(csv, "%s,%g,%zu,%llu,%llu,%llu,%.4f,%.4f,%.4f,%g,%g\n", rung.name,
                 double(half_angles[angle]), spots, number(t.exact), number(t.open), number(t.misses),
                 t.ratio(whole_sphere), t.ratio(least_sphere_of_it), t.ratio(spot_itself), rung.must[angle],
                 rung.aim);
}

/// What the half angles and rungs gave in all.
struct TightnessReport {
    std::uint64_t misses = 0, open = 0;
    std::vector<double> saved;  ///< of each, the entries of whole spheres over the spots'
};

/// Writes spots_tightness.csv and prints a line a rung.
inline TightnessReport report_tightness(bool quick, Goals& goals) {
    std::FILE* const csv =
        open_report("spots_tightness.csv",
                    "rung,half_angle,spots,exact,open,misses,whole_sphere,least_sphere,spot,must,aim");
    const std::size_t count_of_spots = quick ? 100 : 1000;
    std::vector<Rung> rungs = spot_rungs();
    std::vector<TableRow> table = {{"half angle"}};
    for (const Rung& rung : rungs)
        table.push_back({rung.name});
    SpotQuestions questions;
    TightnessReport report;
    Progress progress;
    for (std::size_t angle = 0; angle < half_angles.size(); ++angle) {
        progress(text("half angle %g", double(half_angles[angle])));
        table[0].push_back(text("%g", double(half_angles[angle])));
        std::vector<Tightness> sums(rungs.size());
        Dice dice(std::uint32_t(angle) + 100);
        for (const lightbin::Spot& spot :
             spots_of_angle(count_of_spots, half_angles[angle], std::uint32_t(angle) + 1)) {
            const DrawnBounds bounds(Lens().view(32).tile_count(), spot, dice);
            Met met[4];
            for (const Question question : {tiles, cells, split_cells, clusters})
                met[question] = questions.ask(question, spot, bounds);
            for (std::size_t i = 0; i < rungs.size(); ++i)
                count(rungs[i], spot, bounds, met[rungs[i].question], sums[i]);
        }
        for (std::size_t i = 0; i < rungs.size(); ++i) {
            const double whole = sums[i].ratio(whole_sphere), own = sums[i].ratio(spot_itself);
            write_tightness(csv, rungs[i], angle, count_of_spots, sums[i]);
            table[i + 1].push_back(text("%.2f (%.1f)", own, whole));
            report.misses += sums[i].misses, report.open += sums[i].open;
            report.saved.push_back(whole / own);
            if (rungs[i].must[angle] > 0)
                goals.add("entries of spots",
                          rungs[i].name + text(", %g degrees", double(half_angles[angle])), "all",
                          {rungs[i].must[angle], rungs[i].aim}, own);
        }
    }
    std::fclose(csv);
    std::printf(
        "Entries of %zu spots over exact pairs of a cell and a spot; in brackets those of whole spheres\n",
        count_of_spots);
    print_table(table);
    return report;
}
