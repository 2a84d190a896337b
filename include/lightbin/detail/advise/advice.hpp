// SPDX-License-Identifier: MIT
// How Advice orders plans, judges their parts, and prints them.
#pragma once

#include <lightbin/advise.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

inline std::string to_string(const Plan& plan) {
    if (!plan.tiled) return "every light in every pixel";
    std::string words = std::to_string(plan.tile_size) + " px, " + to_string(plan.footprint);
    if (plan.depth_test != DepthTest::none) words += std::string(", ") + to_string(plan.depth_test);
    if (plan.slicing != Slicing::none) words += std::string(", ") + to_string(plan.slicing);
    return words;
}

inline std::string to_string(const Verdict& verdict) {
    const bool weighed = !verdict.instead.empty(), gains = verdict.saved_ns >= 0;
    const char* said = verdict.keep ? "keep: no other was weighed" : "leave out: was not weighed";
    if (weighed && verdict.keep) said = gains ? "keep: saves" : "keep: costs only";
    if (weighed && !verdict.keep) said = gains ? "leave out: would cost" : "leave out: would save only";
    char line[100];
    std::snprintf(line, sizeof line, "%-12s %s", verdict.part.c_str(), said);
    std::string words = line;
    if (!weighed) return words + "\n";
    std::snprintf(line, sizeof line, " %.3f ms", std::fabs(verdict.saved_ns) * 1e-6);
    words += line;
    words.resize((std::max)(words.size() + 1, std::size_t{50}), ' ');
    return words + "instead: " + verdict.instead + "\n";
}

/// Sorts the plans by insertion: those of equal time keep their order. (std::stable_sort warns with some compilers.)
inline Advice::Advice(std::vector<Plan> plans) : plans_(std::move(plans)) {
    const auto is_cheaper = [](const Plan& a, const Plan& b) { return a.total_ns < b.total_ns; };
    for (auto plan = plans_.begin(); plan != plans_.end(); ++plan)
        std::rotate(std::upper_bound(plans_.begin(), plan, *plan, is_cheaper), plan, plan + 1);
}

inline std::string Advice::text() const {
    std::string lines = "   cost  tile  footprint   depth test  slicing      entries   build us  "
                        "M evaluations   total us\n";
    for (const Plan& plan : plans()) {
        char tile[16] = "-", line[160];
        if (plan.tiled) std::snprintf(tile, sizeof tile, "%d", plan.tile_size);
        std::snprintf(line, sizeof line, "%7.2f  %4s  %-10s  %-10s  %-8s  %10llu  %9.1f  %13.3f  %9.1f\n",
                      plan.total_ns / (std::max)(best().total_ns, 1.0), tile,
                      plan.tiled ? to_string(plan.footprint) : "no tiling",
                      plan.tiled ? to_string(plan.depth_test) : "-",
                      plan.tiled ? to_string(plan.slicing) : "-",
                      static_cast<unsigned long long>(plan.entries), plan.build_ns * 1e-3,
                      plan.evaluations * 1e-6, plan.total_ns * 1e-3);
        lines += line;
    }
    return lines;
}

inline std::vector<Verdict> Advice::verdicts(const Plan& plan) const {
    constexpr std::pair<const char*, bool (*)(const Plan&)> parts[] = {
        {"tiles", [](const Plan& p) { return p.tiled; }},
        {"pre-pass", [](const Plan& p) { return p.has_z_bounds(); }},
        {"box", [](const Plan& p) { return p.tiled && p.depth_test >= DepthTest::box; }},
        {"split boxes", [](const Plan& p) { return p.tiled && p.depth_test == DepthTest::split_box; }},
        {"clusters", [](const Plan& p) { return p.tiled && p.slicing == Slicing::clusters; }},
        {"z-bins", [](const Plan& p) { return p.tiled && p.slicing == Slicing::z_bins; }},
        {"silhouettes", [](const Plan& p) { return p.tiled && p.footprint == Footprint::silhouette; }}};
    std::vector<Verdict> all;
    for (const auto& [part, has] : parts) {
        Verdict verdict = {.part = part, .keep = has(plan), .instead = {}};
        for (const Plan& other : plans()) {
            if (has(other) == verdict.keep) continue;
            verdict.other = other;
            verdict.instead = to_string(other);
            verdict.saved_ns = other.total_ns - plan.total_ns;
            break;
        }
        all.push_back(std::move(verdict));
    }
    return all;
}

inline std::string to_string(const Advice& advice) {
    char line[160];
    std::snprintf(line, sizeof line, "%.3f ms a frame: %s; the cheapest of %zu plans\n",
                  advice.best().total_ns * 1e-6, to_string(advice.best()).c_str(), advice.plans().size());
    std::string lines = line;
    for (const Verdict& verdict : advice.verdicts(advice.best()))
        lines += to_string(verdict);
    return lines;
}

}}  // namespace lightbin
