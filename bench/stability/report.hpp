// SPDX-License-Identifier: MIT
// What was measured in words: a line of a table and a sentence a family, stability.csv, and stability.page for bench/page.sh.
#pragma once

#include "measure.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stability {

struct Measured {
    const Family* family;
    std::vector<Result> results;  ///< a condition

    std::string unit() const { return family->make_depths ? "slices" : "px"; }

    /// Of the textbooks' formulas in a precision, the one with the least error, or the largest; null if none applies.
    const Tally* textbook(std::size_t condition, std::string_view precision, bool largest) const {
        const Tally* found = nullptr;
        for (const Tally& tally : results[condition].textbooks)
            if (tally.used() && tally.precision == precision &&
                (found == nullptr || (largest ? tally.error > found->error : tally.error < found->error)))
                found = &tally;
        return found;
    }
    /// The condition under which the best textbook in float is farthest off; if that is less than a pixel or a slice, the
    /// worst one. The mildest of several.
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
    /// The most of a member of our tallies.
    template <class Member> double most(Member member) const {
        double found = 0;
        for (const Result& result : results)
            found = std::max(found, double(std::invoke(member, result.ours)));
        return found;
    }
};

inline std::string number(double value, const char* none = "-") {
    char buffer[32];
    if (value <= 0) return value < 0 ? none : "0";
    std::snprintf(buffer, sizeof buffer,
                  value >= 99.5   ? "%.0f"
                  : value >= 0.01 ? "%.2g"
                  : value >= 1e-4 ? "%.1g"
                                  : "%.0e",
                  value);
    return buffer;
}

inline std::string percent(std::uint64_t part, std::uint64_t whole) {
    if (whole == 0) return "-";
    if (part == 0) return "0";
    char buffer[32];
    const double share = 100 * double(part) / double(whole);
    if (share < 0.001) return "<.001%";
    std::snprintf(buffer, sizeof buffer,
                  share >= 99.5  ? "%.0f%%"
                  : share < 0.01 ? "%.3f%%"
                                 : "%.2g%%",
                  share);
    return buffer;
}

inline std::string error(const Tally* tally) {
    return tally ? number(tally->error) : "-";
}
inline std::string missed(const Tally* tally) {
    return tally ? percent(tally->missed_same, tally->exact) : "-";
}

inline std::vector<std::string> cells(const Measured& of, std::size_t i) {
    const Result& result = of.results[i];
    const Tally* const best = of.textbook(i, "float", false);
    const Tally* const worst = of.textbook(i, "float", true);
    const Tally* const in_double = of.textbook(i, "double", true);
    return {of.family->conditions[i].label,
            error(best),
            error(worst),
            error(in_double),
            number(result.ours.error),
            best ? percent(best->missed_bare, best->exact) : "-",
            missed(best),
            missed(in_double),
            percent(result.ours.missed_same, std::max<std::uint64_t>(1, result.ours.exact)),
            percent(result.ours.extra, result.ours.exact),
            result.asked ? percent(result.careful, result.asked) : "-",
            best ? number(best->ns) : "-",
            in_double ? number(in_double->ns) : "-",
            number(result.ours.ns)};
}

inline const std::vector<std::string> heads = {"at",      "best", "worst",  "double", "ours",
                                               "bare",    "best", "double", "ours",   "excess",
                                               "careful", "best", "double", "ours"};

/// Under which conditions a formula is off by a pixel or a slice, or more, in words.
inline std::string where_broken(const Measured& of, std::size_t formula) {
    std::vector<std::size_t> at;
    std::size_t asked = 0, last_asked = 0;
    for (std::size_t i = 0; i < of.results.size(); ++i) {
        const Tally& tally = of.results[i].textbooks[formula];
        if (!tally.used()) continue;
        ++asked, last_asked = i;
        if (tally.error >= 1) at.push_back(i);
    }
    const auto label = [&](std::size_t i) { return of.family->conditions[i].label; };
    if (at.empty()) return "nowhere";
    if (at.size() == asked) return "everywhere";
    if (at.size() == 1) return "at " + label(at[0]);
    if (at.back() - at.front() + 1 == at.size())
        return "from " + label(at[0]) + (at.back() == last_asked ? " on" : " to " + label(at.back()));
    // At both ends, and between them not?
    const auto gap =
        std::adjacent_find(at.begin(), at.end(), [](std::size_t i, std::size_t j) { return j > i + 1; });
    if (at.front() == 0 && at.back() == last_asked && gap[1] - gap[0] + at.size() == asked + 1)
        return "outside of " + label(gap[0] + 1) + " to " + label(gap[1] - 1);
    std::string list = "at";
    for (const std::size_t i : at)
        list += (i == at.front() ? " " : i == at.back() ? " and " : ", ") + label(i);
    return list;
}

/// The same of all formulas in a precision: those alike together.
inline std::string where_broken(const Measured& of, std::string_view precision) {
    std::vector<std::pair<std::string, std::string>> groups;  // where, which
    const std::vector<Tally>& formulas = of.results.front().textbooks;
    for (std::size_t i = 0; i < formulas.size(); ++i) {
        // Not of a formula that is for few of these lights.
        const auto used = std::count_if(of.results.begin(), of.results.end(),
                                        [&](const Result& result) { return result.textbooks[i].used(); });
        if (2 * static_cast<std::size_t>(used) < of.results.size() || formulas[i].precision != precision)
            continue;
        const std::string where = where_broken(of, i);
        const auto same =
            std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == where; });
        if (same == groups.end())
            groups.emplace_back(where, formulas[i].formula);
        else
            same->second += " and " + formulas[i].formula;
    }
    if (groups.size() == 1) return groups[0].first;
    std::string list;
    for (const auto& [where, which] : groups)
        list += (list.empty() ? "" : ", ") + which + " " + where;
    return list;
}

/// Where the textbooks break and what ours does.
inline std::string sentence(const Measured& of) {
    const bool slices = of.family->make_depths != nullptr;
    const double ours = of.most(&Tally::error), inward = of.most(&Tally::inward),
                 excess = 100 * of.most(&Tally::excess);
    std::string text = of.family->title + (of.family->axis.empty() ? "" : ", by " + of.family->axis) + ": ";
    if (of.family->spots)
        text += "what textbooks put around spots is up to " + error(of.textbook(of.worst(), "float", false)) +
                " px too wide by the better of two shapes, in either precision";
    else
        text += std::string("textbooks off by a ") + (slices ? "slice" : "pixel") +
                " or more, in float: " + where_broken(of, "float") +
                "; in double: " + where_broken(of, "double");
    text += ". Ours: by " + number(ours) + (slices ? " slice" : " px") + (slices && ours != 1 ? "s" : "") +
            " at most";
    if (!slices && inward < ours / 2)
        text += ", outward (inward by " + number(inward) + ", which the margin covers)";
    std::uint64_t misses = 0;
    for (const Result& result : of.results)
        misses += result.ours.missed_same;
    return text + (misses == 0 ? ", no miss, " : ", " + std::to_string(misses) + " MISSED, ") +
           (excess == 0 ? "nothing" : number(excess) + " %") + " listed too much.";
}

inline void print_row(const std::string& title, const std::vector<std::string>& row) {
    static constexpr int widths[] = {9, 7, 7, 7, 7, 7, 7, 7, 5, 7, 8, 5, 7, 5};
    std::printf("%-32s", title.c_str());
    for (std::size_t i = 0; i < row.size(); ++i)
        std::printf("%*s", widths[i], row[i].c_str());
    std::printf("\n");
    std::fflush(stdout);
}

inline void write_csv(const std::vector<Measured>& all) {
    std::FILE* const file = open_report(
        "stability.csv",
        "family,condition,value,formula,precision,unit,lights,error,error_inward,exact_tiles,missed_without_"
        "margin,missed_with_our_margin,listed_too_much,ns_a_light,our_margin,share_on_careful_path");
    for (const Measured& measured : all)
        for (std::size_t i = 0; i < measured.results.size(); ++i)
            for (const Tally* const tally : measured.results[i].all()) {
                const Condition& condition = measured.family->conditions[i];
                std::fprintf(file, "%s,%s,%.9g,%s,%s,%s,%llu,", measured.family->name.c_str(),
                             condition.label.c_str(), condition.value, tally->formula.c_str(),
                             tally->precision.c_str(), measured.unit().c_str(),
                             static_cast<unsigned long long>(tally->lights));
                const auto count = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
                if (tally->used())
                    std::fprintf(file, "%.4g,%.4g,%llu,%llu,%llu,%llu,%.4g", tally->error, tally->inward,
                                 count(tally->exact), count(tally->missed_bare), count(tally->missed_same),
                                 count(tally->extra), tally->ns);
                else
                    std::fprintf(file, ",,,,,,");
                const Result& result = measured.results[i];
                if (tally == &result.ours && result.asked > 0)
                    std::fprintf(file, ",%.4g,%.4g\n", result.margin,
                                 double(result.careful) / double(result.asked));
                else
                    std::fprintf(file, ",,\n");
            }
    std::fclose(file);
}

/// The answer, a sentence a line.
inline std::vector<std::string> verdict(const std::vector<Measured>& all, std::uint64_t misses) {
    std::uint64_t lights = 0;
    std::string in_float, in_double, loose;
    double float_ns = 0, double_ns = 0, plain_ns = 0, most_ns = 0;
    const auto add = [](std::string& list, const Measured& measured) {
        list += (list.empty() ? "" : "; ") + measured.family->title;
    };
    for (const Measured& measured : all) {
        const auto breaks = [&](std::string_view precision) {
            for (std::size_t i = 0; i < measured.results.size(); ++i)
                if (const Tally* const best = measured.textbook(i, precision, false);
                    best && best->error >= 1)
                    return true;
            return false;
        };
        if (!measured.family->spots && breaks("float")) add(in_float, measured);
        if (!measured.family->spots && breaks("double")) add(in_double, measured);
        if (measured.most(&Tally::error) > 1) add(loose, measured);
        for (const Result& result : measured.results)
            lights += result.ours.lights;
        if (measured.family->make_depths || measured.family->spots) continue;
        most_ns = std::max(most_ns, measured.most(&Tally::ns));
        if (measured.family->name == "ordinary") {
            float_ns = measured.textbook(0, "float", false)->ns, plain_ns = measured.results[0].ours.ns;
            double_ns = measured.textbook(0, "double", false)->ns;
        }
    }
    const auto count = [](std::uint64_t n) { return std::to_string(n); };
    return {count(lights) + " lights under " + count(all.size()) +
                " families of conditions: the library missed " +
                (misses == 0 ? "nothing." : count(misses) + " tiles."),
            "In float even the best textbook formula is off by a pixel or a slice or more: " +
                (in_float.empty() ? "nowhere" : in_float) + ".",
            "In double: " + (in_double.empty() ? "nowhere" : in_double) + "; that takes " +
                number(double_ns) + " ns a sphere in an ordinary scene, in float " + number(float_ns) +
                ", ours " + number(plain_ns) + " there and up to " + number(most_ns) +
                " elsewhere. (Slices are timed up to their lists.)",
            "Ours lists more than a pixel or a slice too much, where formulas in double would not: " +
                (loose.empty() ? "nowhere" : loose) + "."};
}

inline void write_page(const std::vector<Measured>& all, const std::vector<std::string>& answer) {
    std::FILE* const file =
        open_report("stability.page", "# Stiff and extreme conditions: how far bounds of lights are off\n");
    const auto row = [&](const std::vector<std::string>& words) {
        for (const std::string& word : words)
            std::fprintf(file, "| %s ", word.c_str());
        std::fprintf(file, "|\n");
    };
    for (const std::string& line : answer)
        std::fprintf(file, "> %s\n", line.c_str());
    std::fprintf(
        file,
        "\n"
        "## Each family at its worst\n"
        "A row a family, at the condition where the best formula in float errs most; the sentences below "
        "give the worst over all conditions. Errors are the largest of any light's screen bounds, in "
        "pixels, or of its slices, in slices: of the best formula in float, of the worst one in double, "
        "and ours before the margin. Missed is the share of the exact rectangles' tiles that is left "
        "out: bare is the best formula in float without a margin, the others have the library's.\n\n");
    const auto table = [&](const std::vector<std::string>& head, const std::vector<std::size_t>& columns) {
        row(head);
        for (const Measured& measured : all) {
            const std::vector<std::string> words = cells(measured, measured.worst());
            std::vector<std::string> part = {measured.family->title};
            for (const std::size_t column : columns)
                part.push_back(words[column]);
            part.push_back(measured.family->axis);
            row(part);
        }
    };
    table(
        {"family", "at", "error: best", "double", "ours", "missed: bare", "best", "double", "ours", "at is"},
        {0, 1, 3, 4, 5, 6, 7, 8});
    std::fprintf(file,
                 "\n"
                 "What ours costs. Excess is what it lists beside the exact set, by its margin and "
                 "by rounding outward: half of these lights end at tile edges, up to rounding, where "
                 "that costs most. Careful is the share of its lights in view that it takes by way of "
                 "doubles. ns are of a light, both axes, the textbooks' in a plain loop; of slices, from "
                 "its depth to its slices, ours to the finished lists; these may have one slice more at "
                 "either end, where that is sooner known.\n\n");
    table({"family", "at", "excess", "careful", "ns: best in float", "worst in double", "ours", "at is"},
          {0, 9, 10, 11, 12, 13});
    std::fprintf(file, "\n## In a sentence\n");
    for (const Measured& measured : all)
        std::fprintf(file, "- %s\n", sentence(measured).c_str());
    std::fprintf(
        file, "\n"
              "## By decade\n"
              "A curve is a formula's largest error: whole lines in float, dotted ones of the same "
              "colour in double, red the library. The line across is one pixel or slice. Errors below 1e-7 "
              "are drawn as that.\n\n");
    for (const Measured& measured : all) {
        const Family& family = *measured.family;
        if (family.conditions.size() > 1)
            std::fprintf(file, "![%s %s](stability.gp stability.csv %s \"%s\" \"%s\")\n", family.what.c_str(),
                         family.why.c_str(), family.name.c_str(), family.title.c_str(), family.axis.c_str());
    }
    std::fprintf(
        file,
        "\n"
        "## The formulas\n"
        "- Mara-McGuire: the centre turned by the tangent's angle, the only one that knows the near "
        "plane. \"2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D Sphere\", JCGT 2(2), "
        "2013.\n"
        "- quadratic: the two roots that the tangents' slopes are. Not for spheres that the near plane "
        "cuts.\n"
        "- Lengyel-Lauritzen: the tangent planes' normals; not for those, either. \"Mathematics for 3D "
        "Game Programming\", 2002; \"Deferred Rendering for Current and Future Rendering Pipelines\", "
        "SIGGRAPH 2010.\n"
        "- least sphere, of a spot: Wronski, \"Cull that cone!\", 2017. cone box: Quilez, \"Disk "
        "bounding box\".\n"
        "- `log z * a + b`: Sousa and Geffroy, \"The devil is in the details: idTech 666\", SIGGRAPH "
        "2016. `log(z / near)`, by that of far: Olsson, Billeter and Assarsson, \"Clustered Deferred and "
        "Forward Shading\", HPG 2012.\n"
        "- lightbin: the library's own, that detail/project.inl describes.\n\n"
        "Exact bounds are computed with 1,100 bits, which hold every sum of the inputs' products without "
        "rounding; one light in sixteen is also held against rational arithmetic, spots against "
        "certificates. An error is counted within the picture: a bound beyond its edge is at the edge, "
        "and one that is NaN is off by the whole picture.\n");
    std::fclose(file);
}

}  // namespace stability
