// SPDX-License-Identifier: MIT
// Reports results: a table with a line for each family, stability.csv, and stability.page for bench/page.sh.
#pragma once

#include "measure.hpp"

#include "../console.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace stability {

struct Measured {
    const Family* family;
    std::vector<Result> results;  ///< one for each condition

    /// Returns the textbook formula in a precision that has the least, or the largest, error; null if none applies.
    const Tally* textbook(std::size_t condition, std::string_view precision, bool largest) const {
        const Tally* found = nullptr;
        for (const Tally& tally : results[condition].textbooks)
            if (tally.used() && tally.precision == precision &&
                (found == nullptr || (largest ? tally.error > found->error : tally.error < found->error)))
                found = &tally;
        return found;
    }
    /// Returns the condition under which the best textbook formula in float is farthest off or, if that is less than a
    /// pixel or slice, the worst formula. Among equals the mildest condition.
    std::size_t worst() const {
        std::size_t found = 0;
        double most = 0;
        for (const bool largest : {false, true}) {
            for (std::size_t i = 0; i < results.size(); ++i)
                if (const Tally* const tally = textbook(i, "float", largest); tally && tally->error > most)
                    found = i, most = tally->error;
            if (most >= 1) break;
        }
        return found;
    }
    /// Returns whether there is a condition under which even the best textbook formula is off by a pixel or a slice.
    bool breaks(std::string_view precision) const {
        for (std::size_t i = 0; i < results.size(); ++i)
            if (const Tally* const best = textbook(i, precision, false); best && best->error >= 1)
                return true;
        return false;
    }
    /// The most of a member of our tallies.
    template <class Member> double most(Member member) const {
        double found = 0;
        for (const Result& result : results)
            found = std::max(found, double(std::invoke(member, result.ours)));
        return found;
    }
};

/// A number in a few characters.
inline std::string number(double value) {
    if (value == 0) return "0";
    return text(value >= 99.5 ? "%.0f" : value >= 0.01 ? "%.2g" : value >= 1e-4 ? "%.1g" : "%.0e", value);
}

inline std::string percent(double share) {
    if (share == 0) return "0";
    if (share < 0.00001) return "<.001%";
    return text(share >= 0.995 ? "%.0f%%" : share < 0.0001 ? "%.3f%%" : "%.2g%%", 100 * share);
}
inline std::string percent(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? "-" : percent(double(part) / double(whole));
}

/// Returns a table row for each family, at the condition where the best formula in float errs most.
inline std::vector<TableRow> table(const std::vector<Measured>& all) {
    std::vector<TableRow> rows = {{"stiff or extreme", "at", "error: float", "double", "ours", "ours at most",
                                   "missed: float", "double", "ours", "excess at most", "ns: float", "double",
                                   "ours"}};
    const auto of = [](const Tally* tally, auto figure) { return tally ? figure(*tally) : std::string("-"); };
    const auto error = [](const Tally& t) { return number(t.error); };
    const auto missed = [](const Tally& t) { return percent(t.missed_same, t.exact); };
    const auto ns = [](const Tally& t) { return t.ns > 0 ? number(t.ns) : "-"; };
    for (const Measured& measured : all) {
        const std::size_t i = measured.worst();
        const Result& result = measured.results[i];
        const Tally *const best = measured.textbook(i, "float", false), *const in_double = measured.textbook(
                                                                            i, "double", true);
        rows.push_back({measured.family->title, measured.family->conditions[i].label, of(best, error),
                        of(in_double, error), error(result.ours), number(measured.most(&Tally::error)),
                        of(best, missed), of(in_double, missed), missed(result.ours),
                        percent(measured.most(&Tally::excess)), of(best, ns), of(in_double, ns),
                        ns(result.ours)});
    }
    return rows;
}

inline void write_csv(const std::vector<Measured>& all) {
    std::FILE* const file = open_report(
        "stability.csv",
        "family,condition,value,formula,precision,unit,lights,error,exact_tiles,missed_without_margin,"
        "missed_with_our_margin,listed_too_much,ns_a_light");
    const auto count = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    for (const Measured& measured : all)
        for (std::size_t i = 0; i < measured.results.size(); ++i)
            for (const Tally* const tally : measured.results[i].all()) {
                const Condition& condition = measured.family->conditions[i];
                std::fprintf(file, "%s,%s,%.9g,%s,%s,%s,%llu,", measured.family->name.c_str(),
                             condition.label.c_str(), condition.value, tally->formula.c_str(),
                             tally->precision.c_str(), measured.family->make_depths ? "slices" : "px",
                             count(tally->lights));
                if (tally->used())
                    std::fprintf(file, "%.4g,%llu,%llu,%llu,%llu,%.4g\n", tally->error, count(tally->exact),
                                 count(tally->missed_bare), count(tally->missed_same), count(tally->extra),
                                 tally->ns);
                else
                    std::fprintf(file, ",,,,,\n");
            }
    std::fclose(file);
}

/// The answer, a sentence a line.
inline std::vector<std::string> verdict(const std::vector<Measured>& all, std::uint64_t misses) {
    std::uint64_t lights = 0;
    double most_ns = 0;
    for (const Measured& measured : all) {
        for (const Result& result : measured.results)
            lights += result.ours.lights;
        if (!measured.family->make_depths) most_ns = std::max(most_ns, measured.most(&Tally::ns));
    }
    const auto titles = [&](auto wanted) {
        std::string list;
        for (const Measured& measured : all)
            if (wanted(measured)) list += (list.empty() ? "" : "; ") + measured.family->title;
        return list.empty() ? std::string("nowhere") : list;
    };
    const Measured& ordinary = all.front();
    return {std::to_string(lights) + " lights under " + std::to_string(all.size()) +
                " families of conditions: the library missed " +
                (misses == 0 ? "nothing." : std::to_string(misses) + " tiles."),
            "In float even the best textbook formula is off by a pixel or a slice or more: " +
                titles([](const Measured& m) { return m.breaks("float"); }) + ".",
            "In double: " + titles([](const Measured& m) { return m.breaks("double"); }) + "; that takes " +
                number(ordinary.textbook(0, "double", false)->ns) +
                " ns a sphere in an ordinary scene, in float " +
                number(ordinary.textbook(0, "float", false)->ns) + ", ours " +
                number(ordinary.results[0].ours.ns) + " there and up to " + number(most_ns) + " elsewhere.",
            "Ours lists more than a pixel or a slice too much, where formulas in double would not: " +
                titles([](const Measured& m) { return m.most(&Tally::error) > 1; }) + "."};
}

/// bench/stability.page goes below it.
inline void write_page(const std::vector<Measured>& all, const std::vector<std::string>& answer) {
    std::FILE* const file =
        open_report("stability.page", "# Stiff and extreme conditions: how far bounds of lights are off\n");
    for (const std::string& line : answer)
        std::fprintf(file, "> %s\n", line.c_str());
    std::fprintf(file, "\n## Each family at its worst\n");
    for (const TableRow& row : table(all)) {
        for (const std::string& cell : row)
            std::fprintf(file, "| %s ", cell.c_str());
        std::fprintf(file, "|\n");
    }
    std::fprintf(file, "\n## By decade\n");
    for (const Measured& measured : all) {
        const Family& family = *measured.family;
        if (family.conditions.size() > 1)
            std::fprintf(file, "![%s %s](stability.gp stability.csv %s \"%s\" \"%s\")\n", family.what.c_str(),
                         family.why.c_str(), family.name.c_str(), family.title.c_str(), family.axis.c_str());
    }
    std::fclose(file);
}

}  // namespace stability
