// SPDX-License-Identifier: MIT
// What was measured, as a file and held against the project's goals.
#pragma once

#include "gains.hpp"
#include "measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <iterator>
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
    double store_ratio;  ///< to storing the light index list once, by as many threads
    double clear_ratio;  ///< to clearing the tile table
    double read_ratio;   ///< to reading the lights once; 0 where that was not timed
    Gains gains;         ///< with threads
};

inline void print_header() {
    std::printf(
        "ratio: of the medians, to the flat baseline (interval: to its interval twin); spread: 10th to 90th\n"
        "percentile of the turns' ratios; entries: a light; x store: to writing the index list once, with "
        "as\n"
        "many threads\n\n"
        "%-16s%8s%4s %-11s%-10s%-7s%2s%10s%10s%8s%8s%9s%9s\n",
        "set", "n", "px", "footprint", "depth", "tier", "th", "ns/light", "ns/entry", "ratio", "spread",
        "entries", "x store");
}

inline void print_row(const Result& r) {
    std::printf("%-16s%8zu%4d %-11s%-10s%-7s%2d%10.2f%10.3f%8.3f%8.3f%9.2f%9.1f\n", r.set.c_str(), r.lights,
                r.tile_size, r.footprint.c_str(), r.depth_test.c_str(), r.tier.c_str(), r.threads,
                r.ns_per_light, r.ns_per_entry, r.ratio, r.spread, r.entries_per_light, r.store_ratio);
    std::fflush(stdout);
}

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

/// What must be reached, and what is aimed at.
struct Goal {
    double must, aim;
};

/// The widest first.
inline constexpr const char* goal_tiers[] = {"avx512", "avx2", "sse2", "scalar"};

/// Ratios to the flat baseline at some numbers of lights.
struct GoalRow {
    const char* name;
    const char* set;  ///< null: any real scene
    int tile_size;
    const char* depth_test;
    Goal goals[std::size(goal_tiers)];       ///< by tier; all 0 where there is none
    std::size_t least = 1000, most = 10000;  ///< lights

    bool covers(const Result& r) const {
        const bool made = r.set.starts_with("field") || r.set.starts_with("near");
        return (set == nullptr ? !made : r.set == set) && r.tile_size == tile_size &&
               r.depth_test == depth_test && r.footprint == "rectangle" && r.threads == 1;
    }
    /// Fewer lights than 1,000 have one and a half times the goals, where the row's are not of some numbers only.
    bool has_fewer() const { return least == 1000 && most == 10000; }
};

inline constexpr GoalRow goal_rows[] = {
    {"field20, 32 px", "field20", 32, "none", {{0.16, 0.09}, {}, {0.48, 0.38}, {1.0, 0.6}}},
    {"field20, 4,096 and more", "field20", 32, "none", {{}, {0.28, 0.18}}, 4096},
    {"field20, 1,000 lights", "field20", 32, "none", {{}, {0.38, 0.25}}, 1000, 1000},
    {"field20, 256 lights", "field20", 32, "none", {{}, {0.51, 0.30}}, 256, 256},
    {"field20, 16 px", "field20", 16, "none", {{0.20, 0.11}, {0.33, 0.22}, {0.55, 0.40}, {1.0, 0.7}}},
    {"field200", "field200", 32, "none", {{0.17, 0.10}, {0.36, 0.18}, {0.50, 0.32}, {1.0, 0.7}}},
    {"real scenes", nullptr, 32, "none", {{0.17, 0.10}, {0.36, 0.18}, {0.50, 0.32}, {1.0, 0.7}}},
    {"field4", "field4", 32, "none", {{0.20, 0.11}, {0.42, 0.25}, {0.50, 0.38}, {1.0, 0.6}}},
    {"box, field20, 32 px", "field20", 32, "box", {{0.50, 0.25}, {0.60, 0.40}}},
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
            double worst = 0, worst_of_fewer = 0;
            for (const Result& r : results) {
                if (!row.covers(r) || r.tier != goal_tiers[tier]) continue;
                if (r.lights >= row.least && r.lights <= row.most) worst = std::max(worst, r.ratio);
                if (r.lights >= 200 && r.lights < 900 && row.has_fewer())
                    worst_of_fewer = std::max(worst_of_fewer, r.ratio);
            }
            if (goal.must == 0 || (worst == 0 && worst_of_fewer == 0)) continue;
            std::printf("%-24s %-8s", row.name, goal_tiers[tier]);
            for (const auto& [measured, scale] : {std::pair(worst, 1.0), std::pair(worst_of_fewer, 1.5)})
                if (measured == 0)
                    std::printf("%25s", "");
                else
                    std::printf(" %8.2f %5.2f %5.2f %-4s", scale * goal.must, scale * goal.aim, measured,
                                measured > scale * goal.must ? "MISS" : "");
            std::printf("\n");
        }
}

inline void print_goal_header(const char* what) {
    std::printf("\n%-56s %-8s %6s %6s %9s\n", what, "tier", "must", "aim", "measured");
}

/// Nothing where nothing was measured. A miss is one in the figures as they are printed.
inline void print_goal(const char* what, const char* tier, Goal goal, double measured,
                       bool more_is_better = false) {
    if (!(measured > 0) || std::isinf(measured)) return;
    const double beyond = more_is_better ? goal.must - measured : measured - goal.must;
    std::printf("%-56s %-8s %6.2f %6.2f %9.2f %s\n", what, tier, goal.must, goal.aim, measured,
                beyond >= 0.005 ? "MISS" : "");
}

/// The goals that are not a ratio to the baseline at equal work, tier by tier.
inline void print_scale_goals(const std::vector<Result>& results) {
    print_goal_header("scale");
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
                               bool more_is_better = false) {
            print_goal(what, tier, {must, aim}, measured, more_is_better);
        };
        const auto clears = [](const Result& r) { return r.clear_ratio; };
        const auto ratio = [](const Result& r) { return r.ratio; };
        const auto reads = [](const Result& r) { return r.read_ratio; };
        const auto ns = [](const Result& r) { return r.ns_per_light; };
        print("no light, to clearing the tile table", 2, 1.2, pick("field4", 0, 1, clears));
        print("one light (field20), to clearing the tile table", 2, 1.2, pick("field20", 1, 1, clears));
        print("4K, 16 px, 256 small lights (field4), to flat", 0.6, 0.35, pick("field4-4k", 256, 1, ratio));
        print("1,000,000 lights, 99 % out of view, to reading them", 1.5, 1.15,
              pick("away", 1000000, 1, reads));
        print("field4, ns a light, 1,000,000 to 10,000", 1.5, 1.1,
              pick("field4", 1000000, 1, ns) / pick("field4", 10000, 1, ns));
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

/// The cases in which a wider tier is more than 5 % slower than a narrower one, to the baseline of its own minute.
inline void print_slower_tiers(const std::vector<Result>& results) {
    const auto rank = [](const Result& r) {
        return std::find(std::begin(goal_tiers), std::end(goal_tiers), r.tier) - std::begin(goal_tiers);
    };
    std::printf(
        "\na wider tier more than 5 %% slower than a narrower one, by more than half of both spreads:\n");
    std::size_t slower = 0, within = 0;
    for (const Result& wide : results)
        for (const Result& narrow : results) {
            const auto same = [&](auto member) { return wide.*member == narrow.*member; };
            if (rank(wide) >= rank(narrow) || wide.ratio <= 1.05 * narrow.ratio || !same(&Result::set) ||
                !same(&Result::lights) || !same(&Result::tile_size) || !same(&Result::footprint) ||
                !same(&Result::depth_test) || !same(&Result::threads))
                continue;
            if (wide.ratio - narrow.ratio <= (wide.spread + narrow.spread) / 2) {
                ++within;
                continue;
            }
            ++slower;
            std::printf("  %-16s%8zu%4d %-11s%-10s%2d  %s to %s: %.2f\n", wide.set.c_str(), wide.lights,
                        wide.tile_size, wide.footprint.c_str(), wide.depth_test.c_str(), wide.threads,
                        wide.tier.c_str(), narrow.tier.c_str(), wide.ratio / narrow.ratio);
        }
    std::printf("  %s; %zu more within their spreads\n", slower == 0 ? "none" : "no other", within);
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
