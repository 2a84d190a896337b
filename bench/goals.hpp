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
inline constexpr const char* goal_tiers[] = {"avx512", "avx2", "sse2", "scalar"};

/// What must be reached, and what is aimed at; 0 where there is no goal.
struct Target {
    double must = 0, aim = 0;
};

/// A goal for the worst of the rows whose "NAME to TO" the expression matches; for each text that its first brackets match,
/// a goal of its own. MANY stands for 1,000 to 99,999 lights. Where it is there, 200 to 899 lights have a goal as well, which
/// is 1.5 times as high.
struct Goal {
    const char* group;
    const char* what;
    const char* rows;
    Target targets[std::size(goal_tiers)];  ///< by tier
    bool more_is_better = false;
};

inline constexpr const char *to_flat = "builds to the flat loop", *of_scale = "scale",
                            *clusters_to_flat = "clusters to the flat loop",
                            *z_bins_to_none = "z-bins to none", *what_lights_are = "what the lights are",
                            *spots_to_spheres = "spots to spheres";

constexpr Goal goal(const char* group, const char* what, const char* rows, Target avx512, Target avx2,
                    Target sse2 = {}, Target scalar = {}) {
    return {group, what, rows, {avx512, avx2, sse2, scalar}};
}
constexpr Goal for_all(const char* group, const char* what, const char* rows, Target target,
                       bool more_is_better = false) {
    return {group, what, rows, {target, target, target, target}, more_is_better};
}

inline constexpr Goal goals[] = {
    goal(to_flat, "field20, 32 px", "field20/MANY/32px/rectangle/none to flat", {0.16, 0.09}, {},
         {0.48, 0.38}, {1.0, 0.6}),
    goal(to_flat, "field20, 4,096 and more", "field20/(?:4096|10000)/32px/rectangle/none to flat", {},
         {0.28, 0.18}),
    goal(to_flat, "field20, 1,000 lights", "field20/1000/32px/rectangle/none to flat", {}, {0.38, 0.25}),
    goal(to_flat, "field20, 256 lights", "field20/256/32px/rectangle/none to flat", {}, {0.51, 0.30}),
    goal(to_flat, "field20, 16 px", "field20/MANY/16px/rectangle/none to flat", {0.20, 0.11}, {0.33, 0.22},
         {0.55, 0.40}, {1.0, 0.7}),
    goal(to_flat, "field200", "field200/MANY/32px/rectangle/none to flat", {0.17, 0.10}, {0.36, 0.18},
         {0.50, 0.32}, {1.0, 0.7}),
    goal(to_flat, "real scenes", "(?!field|near)[^/]+/MANY/32px/rectangle/none to flat", {0.17, 0.10},
         {0.36, 0.18}, {0.50, 0.32}, {1.0, 0.7}),
    goal(to_flat, "field4", "field4/MANY/32px/rectangle/none to flat", {0.20, 0.11}, {0.42, 0.25},
         {0.50, 0.38}, {1.0, 0.6}),
    goal(to_flat, "box, field20, 32 px", "field20/MANY/32px/rectangle/box to flat", {0.50, 0.25},
         {0.60, 0.40}),
    goal(to_flat, "near", "near/MANY/32px/rectangle/none to flat", {0.25, 0.12}, {0.50, 0.25}),

    for_all(of_scale, "no light, to clearing the tile table", "field4/0/32px/rectangle/none to clearing",
            {2, 1.2}),
    for_all(of_scale, "one light (field20), to clearing the tile table",
            "field20/1/32px/rectangle/none to clearing", {2, 1.2}),
    for_all(of_scale, "4K, 16 px, 256 small lights (field4), to flat",
            "field4-4k/256/16px/rectangle/none to flat", {0.6, 0.35}),
    for_all(of_scale, "1,000,000 lights, 99 % out of view, to reading them",
            "away/1000000/32px/rectangle/none to reading", {1.5, 1.15}),
    for_all(of_scale, "field4, ns a light, 1,000,000 to 10,000",
            "field4/1000000/32px/rectangle/none to 10,000 lights", {1.5, 1.1}),
    for_all(of_scale, "2 threads, 10,000 of field200, times as fast",
            "field200/10000/32px/rectangle/none/2 threads to one", {1.5, 1.9}, true),
    // Sharing must never make a build slower; a twentieth is what the clock can tell.
    for_all(of_scale, "2 threads that slept, no slower:",
            "(field20/10000|field4/256)/32px/rectangle/none/2 threads to one from sleep", {0.95, 1}, true),

    goal(clusters_to_flat, "256 lights of field20:", "slices/field20/256/clusters/(none|box) to flat",
         {1.4, 0.8}, {2, 1}),
    goal(clusters_to_flat, "1,000 lights of field20:", "slices/field20/1000/clusters/(none|box) to flat",
         {0.8, 0.4}, {1.1, 0.6}),
    goal(clusters_to_flat, "4,096 and more of field20:",
         "slices/field20/(?:4096|10000)/clusters/(none|box) to flat", {0.5, 0.25}, {0.8, 0.45}),
    goal(z_bins_to_none, "10,000 lights of field20", "slices/field20/10000/z_bins/none to none", {1.5, 1.25},
         {1.3, 1.15}),

    for_all(what_lights_are, "10,000 world-space vec4s", "sources/field.*/world_vec4s to view_vec4s",
            {1.15, 1.05}),
    for_all(what_lights_are, "10,000 structs of 64 bytes, view space",
            "sources/field.*/view_structs to view_vec4s", {1.15, 1.05}),
    for_all(what_lights_are, "10,000 structs of 64 bytes, world space",
            "sources/field.*/world_structs to view_vec4s", {1.25, 1.1}),
    for_all(what_lights_are, "many_lights, world-space vec4s",
            "sources/many_lights/.*/world_vec4s to view_vec4s", {1.5, 1.2}),
    for_all(what_lights_are, "10,000 world-space vec4s, to a loop of one's own",
            "sources/field.*/world_vec4s to loop_vec4s", {1, 1}),
    for_all(what_lights_are, "10,000 structs, world space, to a loop of one's own",
            "sources/field.*/world_structs to loop_structs", {1, 1}),
    for_all(what_lights_are, "many_lights, world-space vec4s, to a loop",
            "sources/many_lights/.*/world_vec4s to loop_vec4s", {1, 1}),

    for_all(spots_to_spheres, "", "spots/[^/]+/[0-9]+/(.*) to spheres", {1.5, 1.2}),
};

/// All goals of a run and what was measured. A miss is one in the figures as they are printed.
class Verdicts {
public:
    explicit Verdicts(const std::vector<Timed>& rows) {
        for (const Goal& goal : goals) {
            const std::string rows_of = goal.rows;
            const std::size_t many = rows_of.find("MANY");
            if (many == std::string::npos) {
                add(goal, "", rows_of, 1, rows);
                continue;
            }
            add(goal, "", std::string(rows_of).replace(many, 4, "[0-9]{4,5}"), 1, rows);
            add(goal, ", few lights", std::string(rows_of).replace(many, 4, "[2-8][0-9]{2}"), 1.5, rows);
        }
    }

    bool empty() const { return all_.empty(); }

    /// How many of each group are met, and of each the three that are missed by most.
    void print() const {
        std::vector<TableRow> table = {{"goals of", "met", "as aimed at"}},
                              misses = {{"missed", "", "tier", "must", "aim", "measured"}};
        for (const Verdict& first : all_) {
            if (std::ranges::any_of(table, [&](const TableRow& row) { return row[0] == first.goal->group; }))
                continue;
            std::vector<Verdict> group = all_;
            std::erase_if(group, [&](const Verdict& v) { return v.goal->group != first.goal->group; });
            const auto of_all = [&](bool (Verdict::*is)() const) {
                return text("%td of %zu", std::ranges::count_if(group, is), group.size());
            };
            table.push_back({first.goal->group, of_all(&Verdict::met), of_all(&Verdict::as_aimed_at)});
            std::erase_if(group, &Verdict::met);
            std::ranges::sort(group, std::greater(), &Verdict::worse);
            for (std::size_t i = 0; i < group.size() && i < 3; ++i)
                misses.push_back({first.goal->group, group[i].what, group[i].tier,
                                  text("%.2f", group[i].target.must), text("%.2f", group[i].target.aim),
                                  text("%.2f", group[i].measured)});
        }
        if (table.size() > 1) print_table(table);
        if (misses.size() == 1) return;
        std::puts("");
        print_table(misses);
    }

    std::string sentence() const {
        const auto met = std::ranges::count_if(all_, &Verdict::met);
        const Verdict& worst =
            *std::ranges::max_element(all_, {}, [](const Verdict& v) { return v.met() ? 0 : v.worse(); });
        std::string s = text("Goals met: %td of %zu", met, all_.size());
        if (met < std::ssize(all_))
            s += std::string(", worst ") + worst.goal->group + ", " + worst.what + ", " + worst.tier +
                 text(": %.2f, where %.2f must be", worst.measured, worst.target.must);
        return s + ".";
    }

    void write_csv(const char* path) const {
        std::FILE* const csv = open_report(path, "group,what,tier,must,aim,measured,met");
        for (const Verdict& v : all_)
            std::fprintf(csv, "%s,\"%s\",%s,%.3f,%.3f,%.4f,%d\n", v.goal->group, v.what.c_str(),
                         v.tier.c_str(), v.target.must, v.target.aim, v.measured, v.met());
        std::fclose(csv);
    }

private:
    struct Verdict {
        const Goal* goal;
        std::string what, tier;
        Target target;
        double measured;

        bool meets(double wanted) const {
            return (goal->more_is_better ? wanted - measured : measured - wanted) < 0.005;
        }
        bool met() const { return meets(target.must); }
        bool as_aimed_at() const { return meets(target.aim); }
        double worse() const {
            return goal->more_is_better ? target.must / measured : measured / target.must;
        }
    };

    void add(const Goal& goal, const char* whose, const std::string& expression, double times,
             const std::vector<Timed>& rows) {
        const std::regex wanted(expression);
        for (const Timed& row : rows) {
            const auto tier = std::ranges::find(goal_tiers, row.tier) - std::begin(goal_tiers);
            const std::string name = row.name + " to " + row.to;
            std::smatch found;
            if (tier == std::ssize(goal_tiers) || goal.targets[tier].must == 0 ||
                !std::regex_match(name, found, wanted))
                continue;
            std::string what = std::string(goal.what) + whose;
            if (found.size() > 1) what += (what.empty() ? "" : " ") + found[1].str();
            const Target target = {times * goal.targets[tier].must, times * goal.targets[tier].aim};
            const Verdict verdict = {&goal, what, row.tier, target, row.ratio};
            const auto same = std::ranges::find_if(all_, [&](const Verdict& v) {
                return v.goal == &goal && v.what == what && v.tier == row.tier;
            });
            if (same == all_.end())
                all_.push_back(verdict);
            else if (verdict.worse() > same->worse())
                *same = verdict;
        }
    }

    std::vector<Verdict> all_;
};

/// The cases in which a wider tier is more than 5 % slower than a narrower one, to the baseline of its own minute, and by more
/// than half of both spreads.
inline std::string slower_tiers(const std::vector<Timed>& rows) {
    const auto rank = [](const Timed& row) { return std::ranges::find(goal_tiers, row.tier); };
    std::size_t slower = 0;
    double most = 0;
    std::string worst;
    for (const Timed& wide : rows)
        for (const Timed& narrow : rows) {
            const double times = wide.ratio / narrow.ratio;
            if (wide.to != "flat" || narrow.to != "flat" || wide.name != narrow.name ||
                rank(wide) >= rank(narrow) || times <= 1.05 ||
                wide.ratio - narrow.ratio <= (wide.spread + narrow.spread) / 2)
                continue;
            ++slower;
            if (times <= most) continue;
            most = times;
            worst = wide.name + ", " + wide.tier + text(" %.2f times as long as ", times) + narrow.tier;
        }
    if (slower == 0) return "No wider instruction set is slower than a narrower one beyond their spreads.";
    return text("A wider instruction set is slower than a narrower one in %zu pairs, most in ", slower) +
           worst + ".";
}

/// What threads gain, from the least to the most of all cases; empty where no case has several.
inline std::string gains_of_threads(const std::vector<Timed>& rows) {
    const auto range = [&](const char* to) {
        std::vector<double> gains;
        for (const Timed& row : rows)
            if (row.to == to) gains.push_back(row.ratio);
        if (gains.empty()) return std::string();
        return text("%.2f to %.2f", percentile(gains, 0), percentile(gains, 1));
    };
    if (range("one").empty()) return "";
    return "Several threads are " + range("one") + " times as fast as one from sleep " +
           range("one from sleep") + ", at mere arithmetic " + range("one at arithmetic") + ".";
}
