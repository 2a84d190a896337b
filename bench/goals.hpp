// SPDX-License-Identifier: MIT
// What was timed, as a file and held against the project's goals.
#pragma once

#include "console.hpp"
#include "measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <iterator>
#include <regex>
#include <string>
#include <utility>
#include <vector>

/// What one case takes on one instruction set, as a ratio to something that was timed in turns with it.
struct Timed {
    std::string name, tier;
    std::string to;  ///< what the ratio is to
    double ratio;    ///< of the medians; where it is to one thread, how many times as fast several are
    double spread;   ///< from the 10th to the 90th percentile of the turns' own ratios
    double ns_per_light = 0, entries_per_light = 0;
};

inline void write_timed(const std::vector<Timed>& rows, const char* path) {
    std::FILE* const csv = open_report(path, "case,tier,to,ratio,spread,ns_per_light,entries_per_light");
    for (const Timed& t : rows)
        std::fprintf(csv, "%s,%s,%s,%.4f,%.4f,%.4f,%.3f\n", t.name.c_str(), t.tier.c_str(), t.to.c_str(),
                     t.ratio, t.spread, t.ns_per_light, t.entries_per_light);
    std::fclose(csv);
}

/// The widest first.
inline constexpr const char* goal_tiers[] = {"avx512", "avx2", "simd128", "scalar"};

/// A goal for the worst of the rows whose "NAME to TO" the expression matches; for each text that its first brackets
/// match, a goal of its own. MANY stands for 1,000 to 99,999 lights. Where it is there, 200 to 899 lights have a goal
/// as well, which is 1.5 times as high.
struct Goal {
    const char *group, *rows;
    double must[std::size(goal_tiers)];  ///< by tier; 0 where there is no goal
    bool more_is_better = false;
};

inline constexpr const char *to_flat = "builds to the flat loop", *of_scale = "scale",
                            *clusters_to_flat = "clusters to the flat loop",
                            *z_bins_to_none = "z-bins to none", *what_lights_are = "what the lights are",
                            *spots_to_spheres = "spots to spheres",
                            *boxes_to_both = "boxes to spheres and spots";

constexpr Goal goal(const char* group, const char* rows, double avx512, double avx2, double simd128 = 0,
                    double scalar = 0) {
    return {group, rows, {avx512, avx2, simd128, scalar}};
}
constexpr Goal for_all(const char* group, const char* rows, double must, bool more_is_better = false) {
    return {group, rows, {must, must, must, must}, more_is_better};
}

inline constexpr Goal goals[] = {
    goal(to_flat, "field20/MANY/32px/none to flat", 0.16, 0, 0.48, 1.0),
    goal(to_flat, "field20/(?:4096|10000)/32px/none to flat", 0, 0.28),
    goal(to_flat, "field20/1000/32px/none to flat", 0, 0.38),
    goal(to_flat, "field20/256/32px/none to flat", 0, 0.51),
    goal(to_flat, "field20/MANY/16px/none to flat", 0.20, 0.33, 0.55, 1.0),
    goal(to_flat, "field200/MANY/32px/none to flat", 0.17, 0.36, 0.50, 1.0),
    goal(to_flat, "(?!field|near)[^/]+/MANY/32px/none to flat", 0.17, 0.36, 0.50, 1.0),
    goal(to_flat, "field4/MANY/32px/none to flat", 0.20, 0.42, 0.50, 1.0),
    goal(to_flat, "field20/MANY/32px/box to flat", 0.50, 0.60),
    goal(to_flat, "near/MANY/32px/none to flat", 0.25, 0.50),

    for_all(of_scale, "field4/0/32px/none to clearing", 2),
    for_all(of_scale, "field20/1/32px/none to clearing", 2),
    for_all(of_scale, "field4-4k/256/16px/none to flat", 0.6),
    for_all(of_scale, "away/1000000/32px/none to reading", 1.5),
    for_all(of_scale, "field4/1000000/32px/none to 10,000 lights", 1.5),
    for_all(of_scale, "field20/100000/none/none/4 threads to one", 1.5, true),

    goal(clusters_to_flat, "slices/field20/256/clusters/(none|box) to flat", 1.4, 2),
    goal(clusters_to_flat, "slices/field20/1000/clusters/(none|box) to flat", 0.8, 1.1),
    goal(clusters_to_flat, "slices/field20/(?:4096|10000)/clusters/(none|box) to flat", 0.5, 0.8),
    goal(z_bins_to_none, "slices/field20/10000/z_bins/none to none", 1.5, 1.3),

    for_all(what_lights_are, "sources/field.*/world_vec4s to view_vec4s", 1.15),
    for_all(what_lights_are, "sources/field.*/view_structs to view_vec4s", 1.15),
    for_all(what_lights_are, "sources/field.*/world_structs to view_vec4s", 1.25),
    for_all(what_lights_are, "sources/many_lights/world_vec4s to view_vec4s", 1.5),
    for_all(what_lights_are, "sources/field.*/world_vec4s to loop_vec4s", 1),
    for_all(what_lights_are, "sources/many_lights/world_vec4s to loop_vec4s", 1),

    for_all(spots_to_spheres, "spots/[^/]+/[0-9]+/(.*) to spheres", 1.5),

    for_all(boxes_to_both, "boxes/(.*)/[0-9]+/none/none to spheres", 1.5),
    for_all(boxes_to_both, "boxes/boxes20/[0-9]+/box/none to spots", 1.2),
    for_all(boxes_to_both, "boxes/clipped20/[0-9]+/box/none to spots", 1.7),
};

/// The worst row of a goal on one instruction set. A miss is one in the figures as they are printed.
struct Verdict {
    const Goal* goal;
    std::string which, worst, tier;  ///< of the goals of an expression; the worst row
    double must, measured;

    bool met() const { return (goal->more_is_better ? must - measured : measured - must) < 0.005; }
    double worse() const { return goal->more_is_better ? must / measured : measured / must; }
};

inline void add_verdicts(const Goal& goal, const std::string& expression, double times,
                         const std::vector<Timed>& rows, std::vector<Verdict>& all) {
    const std::regex wanted(expression);
    for (const Timed& row : rows) {
        const auto tier = std::ranges::find(goal_tiers, row.tier) - std::begin(goal_tiers);
        const std::string name = row.name + " to " + row.to;
        std::smatch found;
        if (tier == std::ssize(goal_tiers) || goal.must[tier] == 0 || !std::regex_match(name, found, wanted))
            continue;
        const Verdict verdict = {&goal,
                                 expression + (found.size() > 1 ? found[1].str() : ""),
                                 name,
                                 row.tier,
                                 times * goal.must[tier],
                                 row.ratio};
        const auto same = std::ranges::find_if(
            all, [&](const Verdict& v) { return v.which == verdict.which && v.tier == row.tier; });
        if (same == all.end())
            all.push_back(verdict);
        else if (verdict.worse() > same->worse())
            *same = verdict;
    }
}

inline std::vector<Verdict> verdicts(const std::vector<Timed>& rows) {
    std::vector<Verdict> all;
    for (const Goal& goal : goals) {
        const std::string rows_of = goal.rows;
        const std::size_t many = rows_of.find("MANY");
        if (many == std::string::npos) {
            add_verdicts(goal, rows_of, 1, rows, all);
            continue;
        }
        add_verdicts(goal, std::string(rows_of).replace(many, 4, "[0-9]{4,5}"), 1, rows, all);
        add_verdicts(goal, std::string(rows_of).replace(many, 4, "[2-8][0-9]{2}"), 1.5, rows, all);
    }
    return all;
}

inline void write_verdicts(const std::vector<Verdict>& all, const char* path) {
    std::FILE* const csv = open_report(path, "group,worst,tier,must,measured,met");
    for (const Verdict& v : all)
        std::fprintf(csv, "%s,\"%s\",%s,%.3f,%.4f,%d\n", v.goal->group, v.worst.c_str(), v.tier.c_str(),
                     v.must, v.measured, v.met());
    std::fclose(csv);
}

/// The goals that are missed, those first that are missed by most.
inline std::vector<TableRow> misses(std::vector<Verdict> all) {
    std::erase_if(all, &Verdict::met);
    std::ranges::sort(all, std::greater(), &Verdict::worse);
    std::vector<TableRow> table = {{"missed", "worst case", "tier", "must", "measured"}};
    for (const Verdict& v : all)
        table.push_back({v.goal->group, v.worst, v.tier, text("%.2f", v.must), text("%.2f", v.measured)});
    return table;
}
