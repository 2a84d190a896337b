// SPDX-License-Identifier: MIT
// What each way to bin lists too much for spots, and what it would list of the spheres around them: each pair of a cell
// and a spot, decided exactly.
#pragma once

#include "built.hpp"
#include "cluster_error.hpp"
#include "exact_pairs.hpp"
#include "ladder.hpp"
#include "lit.hpp"

#include <lightbin/lightbin.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

/// Writes spot_error.csv and prints its rows, one a scene, tile size, way and form of the lights:
///
///   as        spots; the least spheres around them; their whole spheres
///   exact     pairs whose spot meets the cell that the way knows of: the whole tile, the tile between its Z bounds, with
///             split_box without the gap, or a cluster
///   excess    entries / exact - 1
///   evals     light evaluations a drawn pixel; exact_evals: by lists of the exact set; `needed`: of spots that reach its
///             point
///   open      questions that no certificate was found for
class SpotErrors {
public:
    explicit SpotErrors(bool quick)
        : quick_(quick),
          csv_(open_report("spot_error.csv", "scene,lights,tile_px,slicing,footprint,depth_test,as,misses,"
                                             "open,entries,exact,excess,evals,exact_evals,needed,us")) {}
    ~SpotErrors() { std::fclose(csv_); }
    SpotErrors(const SpotErrors&) = delete;
    SpotErrors& operator=(const SpotErrors&) = delete;

    /// Returns the number of misses.
    std::uint64_t report(const SeenScene& seen) {
        scene_ = &seen;
        sets_.clear();
        for (std::uint32_t seed = 0; seed < (quick_ ? 12 : 48); ++seed) {
            const Spots spots = seen.scene.spots(seed);
            sets_.push_back({spots, least_spheres(spots), whole_spheres(spots)});
        }
        misses_ = 0;
        for (const int tile_size : {16, 32})
            if (!quick_ || tile_size == 32) report_ladder(tile_size);
        report_clusters();
        return misses_;
    }

private:
    struct Forms {
        Spots spots;
        Lights least, whole;
    };
    /// Where a way bins.
    struct Way {
        int tile_size;
        const char *slicing, *footprint, *depth_test;
        double needed;  ///< evaluations of all drawn pixels
    };
    /// One form of the lights, binned.
    struct Row {
        std::uint64_t entries = 0, exact = 0, misses = 0, open = 0;
        std::vector<lightbin::ListRange> exact_lists = {};  ///< their lengths
        double evaluations = 0, exact_evaluations = 0;
        std::vector<double> times = {};
    };
    using Lists = std::span<const lightbin::ListRange>;
    static constexpr const char* form_names[] = {"spots", "least", "whole"};

    template <class Visit> static void with_form(const Forms& forms, std::size_t form, Visit visit) {
        if (form == 0)
            visit(forms.spots);
        else
            visit(form == 1 ? forms.least : forms.whole);
    }

    void report_ladder(int tile_size) {
        const TiledView view(scene_->scene, scene_->picture, tile_size);
        const ExactPairs truth =
            ExactDecider(scene_->scene.projection, screen, tile_size).pairs(sets_[0].spots, view.bounds());
        double needed = 0;
        for (int y = 0, tile = 0; y < view.view.tiles_y(); ++y)
            for (int x = 0; x < view.view.tiles_x(); ++x, ++tile) {
                const Points points(*scene_, view.view, x, y);
                for (const Pair& pair : truth.tiles[std::size_t(tile)])
                    if (pair.facts & in_split) needed += points.inside(sets_[0].spots[pair.id]);
            }
        Ladder().for_each([&](std::size_t rung, auto& bin) {
            const Method& method = ladder[rung];
            const auto build = [&](const auto& lights) { return bin(view, lights); };
            const auto evaluations = [&](Lists lists) { return view.all_evaluations(lists); };
            const auto count = [&](const auto& grid, Row& row) {
                count_slice(truth, grid, 0, must_be_met(method.depth_test), row);
            };
            report_way({tile_size, "none", to_string(method.footprint), to_string(method.depth_test), needed},
                       view, build, count, evaluations);
        });
        needed_ = needed;
    }

    void report_clusters() {
        constexpr int tile_size = 64;
        const TiledView view(scene_->scene, scene_->picture, tile_size);
        ExactDecider decider(scene_->scene.projection, screen, tile_size);
        std::vector<ExactPairs> slices;
        for (int slice = 0; slice < view.clusters.count(); ++slice)
            slices.push_back(pairs_in(decider, view.view, view.clusters, slice, sets_[0].spots));
        const auto count = [&](const auto& grid, Row& row) {
            for (int slice = 0; slice < view.clusters.count(); ++slice)
                count_slice(slices[std::size_t(slice)], grid, slice, in_cell, row);
        };
        const auto report = [&]<DepthTest test>() {
            lightbin::Binner<lightbin::Options{.depth_test = test, .slicing = lightbin::Slicing::clusters}>
                binner;
            const auto build = [&](const auto& lights) {
                return *binner.bin(view.view, lights, {.slices = view.clusters});
            };
            const auto evaluations = [&](Lists lists) {
                return all_evaluations(view, scene_->picture, {lists, 0, &view.clusters});
            };
            report_way({tile_size, "clusters", "rectangle", to_string(test), needed_}, view, build, count,
                       evaluations);
        };
        report.template operator()<DepthTest::none>();
        report.template operator()<DepthTest::box>();
    }

    template <class Grid>
    static void count_slice(const ExactPairs& truth, const Grid& grid, int slice, Fact must, Row& row) {
        row.open += truth.open;
        for (std::size_t tile = 0; tile < truth.tiles.size(); ++tile) {
            const int x = int(tile) % grid.tiles_x(), y = int(tile) / grid.tiles_x();
            const auto list = grid.lights_in(x, y, slice);
            row.entries += list.size();
            std::uint32_t exact = 0;
            for_each_listed(truth.tiles[tile], list, [&](const Pair& pair, bool listed) {
                const bool met = (pair.facts & must) != 0;
                exact += met;
                row.misses += met && !listed;
            });
            row.exact += exact;
            row.exact_lists.push_back({0, exact});
        }
    }

    template <class Build, class Count, class Evaluations>
    void report_way(const Way& way, const TiledView& view, Build build, Count count,
                    Evaluations evaluations) {
        Row rows[std::size(form_names)];
        for (std::size_t form = 0; form < std::size(rows); ++form)
            with_form(sets_[0], form, [&](const auto& lights) {
                const auto grid = build(lights);
                rows[form].evaluations = evaluations(grid.ranges());
                count(grid, rows[form]);
                rows[form].exact_evaluations = evaluations(rows[form].exact_lists);
            });
        for (std::size_t turn = 0; turn < sets_.size(); ++turn)
            for (std::size_t i = 0; i < std::size(rows); ++i) {
                const std::size_t form = (turn + i) % std::size(rows);  // each one comes first in turn
                with_form(sets_[turn], form, [&](const auto& lights) {
                    rows[form].times.push_back(seconds([&] { build(lights); }));
                });
            }
        write(way, static_cast<double>(view.all_drawn), rows);
    }

    void write(const Way& way, double drawn, std::span<const Row> rows) {
        const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
        const std::string& name = scene_->scene.name;
        std::printf("%-10s %2d px %-8s %-10s %-9s needed %5.2f, exact lists %5.2f", name.c_str(),
                    way.tile_size, way.slicing == std::string("none") ? "" : way.slicing, way.footprint,
                    way.depth_test, way.needed / drawn, rows[0].exact_evaluations / drawn);
        for (std::size_t form = 0; form < rows.size(); ++form) {
            const Row& row = rows[form];
            const double excess = double(row.entries) / double(row.exact) - 1, us = 1e6 * median(row.times);
            std::fprintf(csv_, "%s,%zu,%d,%s,%s,%s,%s,%llu,%llu,%llu,%llu,%.5f,%.3f,%.3f,%.3f,%.1f\n",
                         name.c_str(), sets_[0].spots.size(), way.tile_size, way.slicing, way.footprint,
                         way.depth_test, form_names[form], number(row.misses), number(row.open),
                         number(row.entries), number(row.exact), excess, row.evaluations / drawn,
                         row.exact_evaluations / drawn, way.needed / drawn, us);
            std::printf(" | %s: %.0f %%, %.2f, %.0f us", form_names[form], 100 * excess,
                        row.evaluations / drawn, us);
            misses_ += row.misses;
        }
        std::printf(" | %llu open\n", number(rows[0].open));
        std::fflush(stdout);
        std::fflush(csv_);
    }

    const bool quick_;
    std::FILE* const csv_;
    const SeenScene* scene_ = nullptr;
    std::vector<Forms> sets_;
    double needed_ = 0;
    std::uint64_t misses_ = 0;
};

/// Returns the number of misses.
inline std::uint64_t report_spot_errors(std::span<const SeenScene> scenes, bool quick) {
    std::puts("\nspots: what is listed beyond the exact set, evaluations a pixel and the time of a build; "
              "the same of the "
              "least and\nwhole spheres around them");
    SpotErrors errors(quick);
    std::uint64_t misses = 0;
    for (const SeenScene& scene : scenes)
        misses += errors.report(scene);
    return misses;
}
