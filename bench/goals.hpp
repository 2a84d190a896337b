// SPDX-License-Identifier: MIT
// What was measured, as a file and held against the project's goals.
#pragma once

#include "measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

struct Result {
    std::string set;
    std::size_t lights;
    int tile_size;
    std::string footprint, depth_test, tier;
    int threads;
    double ns_per_light, ns_per_entry;
    double ratio;   ///< of the medians, to the flat baseline
    double spread;  ///< 10th to 90th percentile of the turns' own ratios
    double entries_per_light;
    double store_ratio;  ///< to storing the light index list once
    double clear_ratio;  ///< to clearing the tile table
};

inline void write_csv(const std::vector<Result>& results, const char* path) {
    std::FILE* const csv = open_report(
        path,
        "set,n,tile_px,footprint,depth_test,tier,threads,ns_per_light,ns_per_entry,ratio_to_flat,spread");
    for (const Result& r : results)
        std::fprintf(csv, "%s,%zu,%d,%s,%s,%s,%d,%.3f,%.4f,%.4f,%.4f\n", r.set.c_str(), r.lights, r.tile_size,
                     r.footprint.c_str(), r.depth_test.c_str(), r.tier.c_str(), r.threads, r.ns_per_light,
                     r.ns_per_entry, r.ratio, r.spread);
    std::fclose(csv);
}

/// Ratio to the flat baseline that must be reached at 1,000 to 10,000 lights, and the one aimed at; at fewer
/// lights one and a half times these.
struct Goal {
    double must, aim;
};

struct GoalRow {
    const char* name;
    std::function<bool(const Result&)> covers;
    std::vector<std::pair<const char*, Goal>> tiers;
};

inline std::vector<GoalRow> goal_rows() {
    const auto plain = [](const Result& r) {
        return r.depth_test == "none" && r.footprint == "rectangle" && r.threads == 1;
    };
    const auto is_made = [](const Result& r) {
        return r.set.starts_with("field") || r.set.starts_with("near");
    };
    return {
        {"field20, 32 px",
         [=](const Result& r) { return plain(r) && r.set == "field20" && r.tile_size == 32; },
         {{"avx512", {0.16, 0.09}}, {"avx2", {0.34, 0.20}}, {"sse2", {0.48, 0.35}}, {"scalar", {1.0, 0.6}}}},
        {"field20, 16 px",
         [=](const Result& r) { return plain(r) && r.set == "field20" && r.tile_size == 16; },
         {{"avx512", {0.20, 0.11}}, {"avx2", {0.42, 0.22}}, {"sse2", {0.55, 0.40}}, {"scalar", {1.0, 0.7}}}},
        {"field200",
         [=](const Result& r) { return plain(r) && r.set == "field200" && r.tile_size == 32; },
         {{"avx512", {0.17, 0.10}}, {"avx2", {0.36, 0.18}}, {"sse2", {0.50, 0.32}}, {"scalar", {1.0, 0.7}}}},
        {"real scenes",
         [=](const Result& r) { return plain(r) && !is_made(r) && r.tile_size == 32; },
         {{"avx512", {0.17, 0.10}}, {"avx2", {0.36, 0.18}}, {"sse2", {0.50, 0.32}}, {"scalar", {1.0, 0.7}}}},
        {"field4",
         [=](const Result& r) { return plain(r) && r.set == "field4" && r.tile_size == 32; },
         {{"avx512", {0.20, 0.11}}, {"avx2", {0.42, 0.25}}, {"sse2", {0.50, 0.38}}, {"scalar", {1.0, 0.6}}}},
        {"box, field20, 32 px",
         [](const Result& r) {
             return r.depth_test == "box" && r.footprint == "rectangle" && r.threads == 1 &&
                    r.set == "field20" && r.tile_size == 32;
         },
         {{"avx512", {0.50, 0.25}}, {"avx2", {1.0, 0.5}}}},
        {"near",
         [=](const Result& r) { return plain(r) && r.set == "near" && r.tile_size == 32; },
         {{"avx512", {0.25, 0.12}}, {"avx2", {0.50, 0.25}}}},
    };
}

/// The worst ratio of each row and tier, beside what it must be and what is aimed at.
inline void print_goals(const std::vector<Result>& results) {
    std::printf("\nworst ratio to the flat baseline, one thread       1,000 to 10,000 lights          fewer\n"
                "%-24s %-8s %24s %24s\n",
                "case", "tier", "must   aim  measured", "must   aim  measured");
    for (const GoalRow& row : goal_rows())
        for (const auto& [tier, goal] : row.tiers) {
            double worst[2] = {0, 0};
            for (const Result& r : results)
                if (row.covers(r) && r.tier == tier && r.lights >= 200 && r.lights <= 10000) {
                    double& of_size = worst[r.lights < 900 ? 1 : 0];
                    of_size = std::max(of_size, r.ratio);
                }
            if (worst[0] == 0 && worst[1] == 0) continue;
            std::printf("%-24s %-8s", row.name, tier);
            for (const int few : {0, 1}) {
                const double scale = few != 0 ? 1.5 : 1.0;
                if (worst[few] == 0)
                    std::printf("%25s", "");
                else
                    std::printf(" %8.2f %5.2f %5.2f %-4s", scale * goal.must, scale * goal.aim, worst[few],
                                worst[few] > scale * goal.must ? "MISS" : "");
            }
            std::printf("\n");
        }
}

/// Worst over the results that `covers` picks; 0 where there is none.
inline double worst(const std::vector<Result>& results, const std::function<bool(const Result&)>& covers,
                    const std::function<double(const Result&)>& figure) {
    double most = 0;
    for (const Result& r : results)
        if (covers(r)) most = std::max(most, figure(r));
    return most;
}

/// The goals that are not a ratio to the baseline at equal work, tier by tier.
inline void print_scale_goals(const std::vector<Result>& results) {
    std::printf("\n%-56s %-8s %6s %6s %9s\n", "scale", "tier", "must", "aim", "measured");
    for (const std::string tier : {"avx512", "avx2", "sse2", "scalar"}) {
        const auto pick = [&](const char* set, std::size_t n, int threads, auto figure) {
            return worst(
                results,
                [&](const Result& r) {
                    return r.set == set && r.lights == n && r.threads == threads && r.tier == tier &&
                           r.tile_size == (r.set.ends_with("4k") ? 16 : 32) && r.depth_test == "none" &&
                           r.footprint == "rectangle";
                },
                figure);
        };
        const auto print = [&](const char* what, double must, double aim, double measured,
                               bool more_is_better) {
            if (!(measured > 0) || std::isinf(measured)) return;
            std::printf("%-56s %-8s %6.2f %6.2f %9.2f %s\n", what, tier.c_str(), must, aim, measured,
                        (more_is_better ? measured < must : measured > must) ? "MISS" : "");
        };
        const auto clears = [](const Result& r) { return r.clear_ratio; };
        const auto ratio = [](const Result& r) { return r.ratio; };
        const auto ns = [](const Result& r) { return r.ns_per_light; };
        print("no light, to clearing the tile table", 2, 1.2, pick("field4", 0, 1, clears), false);
        print("one light (field20), to clearing the tile table", 2, 1.2, pick("field20", 1, 1, clears),
              false);
        print("4K, 16 px, 256 small lights (field4), to flat", 0.6, 0.35, pick("field4-4k", 256, 1, ratio),
              false);
        print("1,000,000 lights, 99 % out of view, ns a light", 1.5, 0.6, pick("away", 1000000, 1, ns),
              false);
        print("field4, ns a light, 1,000,000 to 10,000", 1.5, 1.1,
              pick("field4", 1000000, 1, ns) / pick("field4", 10000, 1, ns), false);
        // Sharing must never make a build slower; a twentieth is what the clock can tell.
        for (const auto& [what, set, n, must, aim] :
             {std::tuple("2 threads, 10,000 of field200, times as fast", "field200", 10000, 1.5, 1.9),
              std::tuple("2 threads, 10,000 of field20, no slower", "field20", 10000, 0.95, 1.0),
              std::tuple("2 threads, 256 of field4, no slower", "field4", 256, 0.95, 1.0)})
            print(what, must, aim, pick(set, std::size_t(n), 1, ratio) / pick(set, std::size_t(n), 2, ratio),
                  true);
    }
}
