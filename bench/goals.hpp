// SPDX-License-Identifier: MIT
// What was measured, as a file and held against the project's goals.
#pragma once

#include "measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <iterator>
#include <string>
#include <tuple>
#include <vector>

/// How many times as fast threads are as one alone.
struct Gains {
    double awake, asleep;  ///< at a build, coming from other work or from sleep
    double stores;         ///< at storing its light index list
    double sums;           ///< at arithmetic in registers that takes one thread as long
};

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
    double store_ratio;  ///< to storing the light index list once, by as many threads
    double clear_ratio;  ///< to clearing the tile table
    Gains gains;         ///< with threads
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

inline constexpr const char* goal_tiers[] = {"avx512", "avx2", "sse2", "scalar"};

struct GoalRow {
    const char* name;
    const char* set;  ///< null: any real scene
    int tile_size;
    const char* depth_test;
    Goal goals[std::size(goal_tiers)];  ///< by tier; all 0 where there is none

    bool covers(const Result& r) const {
        const bool made = r.set.starts_with("field") || r.set.starts_with("near");
        return (set == nullptr ? !made : r.set == set) && r.tile_size == tile_size &&
               r.depth_test == depth_test && r.footprint == "rectangle" && r.threads == 1;
    }
};

inline constexpr GoalRow goal_rows[] = {
    {"field20, 32 px", "field20", 32, "none", {{0.16, 0.09}, {0.34, 0.20}, {0.48, 0.35}, {1.0, 0.6}}},
    {"field20, 16 px", "field20", 16, "none", {{0.20, 0.11}, {0.42, 0.22}, {0.55, 0.40}, {1.0, 0.7}}},
    {"field200", "field200", 32, "none", {{0.17, 0.10}, {0.36, 0.18}, {0.50, 0.32}, {1.0, 0.7}}},
    {"real scenes", nullptr, 32, "none", {{0.17, 0.10}, {0.36, 0.18}, {0.50, 0.32}, {1.0, 0.7}}},
    {"field4", "field4", 32, "none", {{0.20, 0.11}, {0.42, 0.25}, {0.50, 0.38}, {1.0, 0.6}}},
    {"box, field20, 32 px", "field20", 32, "box", {{0.50, 0.25}, {1.0, 0.5}}},
    {"near", "near", 32, "none", {{0.25, 0.12}, {0.50, 0.25}}},
};

/// The worst ratio of each row and tier, beside what it must be and what is aimed at.
inline void print_goals(const std::vector<Result>& results) {
    std::printf("\nworst ratio to the flat baseline, one thread       1,000 to 10,000 lights          fewer\n"
                "%-24s %-8s %24s %24s\n",
                "case", "tier", "must   aim  measured", "must   aim  measured");
    for (const GoalRow& row : goal_rows)
        for (std::size_t tier = 0; tier < std::size(goal_tiers); ++tier) {
            const Goal& goal = row.goals[tier];
            double worst[2] = {0, 0};
            for (const Result& r : results)
                if (row.covers(r) && r.tier == goal_tiers[tier] && r.lights >= 200 && r.lights <= 10000) {
                    double& of_size = worst[r.lights < 900 ? 1 : 0];
                    of_size = std::max(of_size, r.ratio);
                }
            if (goal.must == 0 || (worst[0] == 0 && worst[1] == 0)) continue;
            std::printf("%-24s %-8s", row.name, goal_tiers[tier]);
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

/// The goals that are not a ratio to the baseline at equal work, tier by tier.
inline void print_scale_goals(const std::vector<Result>& results) {
    std::printf("\n%-56s %-8s %6s %6s %9s\n", "scale", "tier", "must", "aim", "measured");
    for (const char* const tier : goal_tiers) {
        const auto pick = [&](const char* set, std::size_t n, int threads, auto figure) {
            double worst = 0;  // where there is none
            for (const Result& r : results)
                if (r.set == set && r.lights == n && r.threads == threads && r.tier == tier &&
                    r.tile_size == (r.set.ends_with("4k") ? 16 : 32) && r.depth_test == "none" &&
                    r.footprint == "rectangle")
                    worst = std::max(worst, figure(r));
            return worst;
        };
        const auto print = [&](const char* what, double must, double aim, double measured,
                               bool more_is_better) {
            if (!(measured > 0) || std::isinf(measured)) return;
            std::printf("%-56s %-8s %6.2f %6.2f %9.2f %s\n", what, tier, must, aim, measured,
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
        print("2 threads, 10,000 of field200, times as fast", 1.5, 1.9,
              pick("field200", 10000, 2, [](const Result& r) { return r.gains.awake; }), true);
        // Sharing must never make a build slower; a twentieth is what the clock can tell.
        for (const auto& [what, set, n] :
             {std::tuple("2 threads that slept, 10,000 of field20, no slower", "field20", 10000),
              std::tuple("2 threads that slept, 256 of field4, no slower", "field4", 256)})
            print(what, 0.95, 1, pick(set, std::size_t(n), 2, [](const Result& r) { return r.gains.asleep; }),
                  true);
    }
}

inline void print_threads(const std::vector<Result>& results) {
    std::printf(
        "\ntimes as fast as one thread, in turns with it: a build by threads that come from other work, or "
        "that slept;\nstoring its list; arithmetic as long as the build\n"
        "%-16s%8s  %-8s%8s%8s%8s%8s%12s\n",
        "set", "n", "tier", "threads", "build", "slept", "store", "arithmetic");
    for (const Result& r : results)
        if (r.threads > 1)
            std::printf("%-16s%8zu  %-8s%8d%8.2f%8.2f%8.2f%12.2f\n", r.set.c_str(), r.lights, r.tier.c_str(),
                        r.threads, r.gains.awake, r.gains.asleep, r.gains.stores, r.gains.sums);
}
