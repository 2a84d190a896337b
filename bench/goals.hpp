// SPDX-License-Identifier: MIT
// What was measured, as a file and held against the project's goals.
#pragma once

#include "console.hpp"
#include "gains.hpp"
#include "measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
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

inline void write_csv(const std::vector<Result>& results, const char* path) {
    std::FILE* const csv = open_report(
        path,
        "set,n,tile_px,footprint,depth_test,tier,threads,ns_per_light,ns_per_entry,ratio_to_flat,spread,"
        "entries_per_light,ratio_to_storing,ratio_to_clearing,ratio_to_reading,gain_awake,gain_asleep,"
        "gain_storing,gain_arithmetic");
    for (const Result& r : results)
        std::fprintf(
            csv, "%s,%zu,%d,%s,%s,%s,%d,%.3f,%.4f,%.4f,%.4f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f\n",
            r.set.c_str(), r.lights, r.tile_size, r.footprint.c_str(), r.depth_test.c_str(), r.tier.c_str(),
            r.threads, r.ns_per_light, r.ns_per_entry, r.ratio, r.spread, r.entries_per_light, r.store_ratio,
            r.clear_ratio, r.read_ratio, r.gains.awake, r.gains.asleep, r.gains.stores, r.gains.sums);
    std::fclose(csv);
}

/// What must be reached, and what is aimed at.
struct Goal {
    double must, aim;
};

/// All goals of a run and what was measured. A miss is one in the figures as they are printed.
class Goals {
public:
    /// Nothing where nothing was measured.
    void add(const std::string& group, const std::string& what, const std::string& tier, Goal goal,
             double measured, bool more_is_better = false) {
        if (measured > 0 && !std::isinf(measured))
            rows_.push_back({group, what, tier, goal, measured, more_is_better});
    }

    /// How many of each group are met, and of each the three that are missed by most.
    void print() const {
        std::vector<TableRow> table = {{"goals of", "met", "as aimed at"}},
                              misses = {{"missed", "", "tier", "must", "aim", "measured"}};
        for (const Row& first : rows_) {
            if (std::ranges::any_of(table, [&](const TableRow& row) { return row[0] == first.group; }))
                continue;
            std::vector<Row> group = rows_;
            std::erase_if(group, [&](const Row& row) { return row.group != first.group; });
            const auto of_all = [&](bool (Row::*is)() const) {
                return text("%td of %zu", std::ranges::count_if(group, is), group.size());
            };
            table.push_back({first.group, of_all(&Row::met), of_all(&Row::as_aimed_at)});
            std::erase_if(group, &Row::met);
            std::ranges::sort(group, std::greater(), &Row::worse);
            for (std::size_t i = 0; i < group.size() && i < 3; ++i)
                misses.push_back({first.group, group[i].what, group[i].tier, text("%.2f", group[i].goal.must),
                                  text("%.2f", group[i].goal.aim), text("%.2f", group[i].measured)});
        }
        if (table.size() > 1) print_table(table);
        if (misses.size() == 1) return;
        std::puts("");
        print_table(misses);
    }

    std::string sentence() const {
        const auto met = std::ranges::count_if(rows_, &Row::met);
        const auto worst =
            std::ranges::max_element(rows_, {}, [](const Row& row) { return row.met() ? 0 : row.worse(); });
        std::string s = text("Goals met: %td of %zu", met, rows_.size());
        if (met < std::ssize(rows_))
            s += ", worst " + worst->group + ", " + worst->what + ", " + worst->tier +
                 text(": %.2f, where %.2f must be", worst->measured, worst->goal.must);
        return s + ".";
    }

    bool empty() const { return rows_.empty(); }

    void write_csv(const char* path) const {
        std::FILE* const csv = open_report(path, "group,what,tier,must,aim,measured,met");
        for (const Row& row : rows_)
            std::fprintf(csv, "%s,\"%s\",%s,%.3f,%.3f,%.4f,%d\n", row.group.c_str(), row.what.c_str(),
                         row.tier.c_str(), row.goal.must, row.goal.aim, row.measured, row.met());
        std::fclose(csv);
    }

private:
    struct Row {
        std::string group, what, tier;
        Goal goal;
        double measured;
        bool more_is_better;

        bool meets(double wanted) const {
            return (more_is_better ? wanted - measured : measured - wanted) < 0.005;
        }
        bool met() const { return meets(goal.must); }
        bool as_aimed_at() const { return meets(goal.aim); }
        double worse() const { return more_is_better ? goal.must / measured : measured / goal.must; }
    };

    std::vector<Row> rows_;
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

/// The worst ratio of each row and tier.
inline void add_goals(const std::vector<Result>& results, Goals& goals) {
    for (const GoalRow& row : goal_rows)
        for (std::size_t tier = 0; tier < std::size(goal_tiers); ++tier) {
            const Goal& goal = row.goals[tier];
            if (goal.must == 0) continue;
            double worst = 0, worst_of_fewer = 0;
            for (const Result& r : results) {
                if (!row.covers(r) || r.tier != goal_tiers[tier]) continue;
                if (r.lights >= row.least && r.lights <= row.most) worst = std::max(worst, r.ratio);
                if (r.lights >= 200 && r.lights < 900 && row.has_fewer())
                    worst_of_fewer = std::max(worst_of_fewer, r.ratio);
            }
            goals.add("builds to the flat loop", row.name, goal_tiers[tier], goal, worst);
            goals.add("builds to the flat loop", std::string(row.name) + ", few lights", goal_tiers[tier],
                      {1.5 * goal.must, 1.5 * goal.aim}, worst_of_fewer);
        }
}

/// The goals that are not a ratio to the baseline at equal work, tier by tier.
inline void add_scale_goals(const std::vector<Result>& results, Goals& goals) {
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
        const auto add = [&](const char* what, double must, double aim, double measured,
                             bool more_is_better = false) {
            goals.add("scale", what, tier, {must, aim}, measured, more_is_better);
        };
        const auto clears = [](const Result& r) { return r.clear_ratio; };
        const auto ratio = [](const Result& r) { return r.ratio; };
        const auto reads = [](const Result& r) { return r.read_ratio; };
        const auto ns = [](const Result& r) { return r.ns_per_light; };
        add("no light, to clearing the tile table", 2, 1.2, pick("field4", 0, 1, clears));
        add("one light (field20), to clearing the tile table", 2, 1.2, pick("field20", 1, 1, clears));
        add("4K, 16 px, 256 small lights (field4), to flat", 0.6, 0.35, pick("field4-4k", 256, 1, ratio));
        add("1,000,000 lights, 99 % out of view, to reading them", 1.5, 1.15,
            pick("away", 1000000, 1, reads));
        add("field4, ns a light, 1,000,000 to 10,000", 1.5, 1.1,
            pick("field4", 1000000, 1, ns) / pick("field4", 10000, 1, ns));
        add("2 threads, 10,000 of field200, times as fast", 1.5, 1.9,
            pick("field200", 10000, 2, [](const Result& r) { return r.gains.awake; }), true);
        // Sharing must never make a build slower; a twentieth is what the clock can tell.
        for (const auto& [what, set, n] :
             {std::tuple("2 threads that slept, 10,000 of field20, no slower", "field20", 10000),
              std::tuple("2 threads that slept, 256 of field4, no slower", "field4", 256)})
            add(what, 0.95, 1, pick(set, std::size_t(n), 2, [](const Result& r) { return r.gains.asleep; }),
                true);
    }
}

/// The cases in which a wider tier is more than 5 % slower than a narrower one, to the baseline of its own minute, and by more
/// than half of both spreads.
inline std::string slower_tiers(const std::vector<Result>& results) {
    const auto rank = [](const Result& r) {
        return std::find(std::begin(goal_tiers), std::end(goal_tiers), r.tier) - std::begin(goal_tiers);
    };
    std::size_t slower = 0;
    double most = 0;
    std::string worst;
    for (const Result& wide : results)
        for (const Result& narrow : results) {
            const auto same = [&](auto member) { return wide.*member == narrow.*member; };
            const double times = wide.ratio / narrow.ratio;
            if (rank(wide) >= rank(narrow) || times <= 1.05 || !same(&Result::set) ||
                !same(&Result::lights) || !same(&Result::tile_size) || !same(&Result::footprint) ||
                !same(&Result::depth_test) || !same(&Result::threads) ||
                wide.ratio - narrow.ratio <= (wide.spread + narrow.spread) / 2)
                continue;
            ++slower;
            if (times <= most) continue;
            most = times;
            worst = text("%s/%zu/%dpx/%s/%s, %s %.2f times as long as %s", wide.set.c_str(), wide.lights,
                         wide.tile_size, wide.footprint.c_str(), wide.depth_test.c_str(), wide.tier.c_str(),
                         times, narrow.tier.c_str());
        }
    if (slower == 0) return "No wider instruction set is slower than a narrower one beyond their spreads.";
    return text("A wider instruction set is slower than a narrower one in %zu pairs, most in ", slower) +
           worst + ".";
}

/// What the most threads gain, over all cases that have them.
inline std::string gains_of_threads(const std::vector<Result>& results) {
    int threads = 1;
    for (const Result& r : results)
        threads = std::max(threads, r.threads);
    std::vector<double> awake, asleep, sums;
    for (const Result& r : results)
        if (r.threads == threads && threads > 1) {
            awake.push_back(r.gains.awake);
            asleep.push_back(r.gains.asleep);
            sums.push_back(r.gains.sums);
        }
    if (awake.empty()) return "";
    return text(
        "%d threads: %.2f to %.2f times as fast as one, from sleep %.2f to %.2f (mere arithmetic: %.2f).",
        threads, *std::ranges::min_element(awake), *std::ranges::max_element(awake),
        *std::ranges::min_element(asleep), *std::ranges::max_element(asleep), median(sums));
}
