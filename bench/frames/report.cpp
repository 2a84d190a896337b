// SPDX-License-Identifier: MIT
#include "report.hpp"

#include "plan.hpp"

#include "../console.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <utility>

namespace {

template <class Key> auto grouped(const std::vector<Row>& rows, Key key_of) {
    using Group = std::pair<std::decay_t<std::invoke_result_t<Key, const Row&>>, std::vector<Row>>;
    std::vector<Group> groups;
    for (const Row& row : rows) {
        const auto key = std::invoke(key_of, row);
        auto group = std::ranges::find(groups, key, &Group::first);
        if (group == groups.end()) group = groups.insert(groups.end(), {key, {}});
        group->second.push_back(row);
    }
    return groups;
}

struct Spread {
    double mean = 0, least = 0, most = 0;
};
template <class Value> Spread spread_of(const std::vector<Row>& rows, Value value) {
    Spread spread{0, value(rows.front()), value(rows.front())};
    for (const Row& row : rows) {
        spread.mean += value(row) / static_cast<double>(rows.size());
        spread.least = std::min(spread.least, value(row));
        spread.most = std::max(spread.most, value(row));
    }
    return spread;
}

double milliseconds(const Row& row) {
    return row.frame.median;
}
double millions(const Row& row) {
    return static_cast<double>(row.evaluations) * 1e-6;
}
double megabytes(const Row& row) {
    return static_cast<double>(row.bytes) * 1e-6;
}
double million_words(const Row& row) {
    return static_cast<double>(row.words) * 1e-6;
}
double words_a_pixel(const Row& row) {
    return static_cast<double>(row.words) / static_cast<double>(row.pixels);
}
double percent_different(const Row& row) {
    return 100.0 * static_cast<double>(row.different) / static_cast<double>(row.pixels);
}

/// Returns the least milliseconds of the pass that draws and lights surfaces; 0 if their depth was drawn before.
double shading(const Row& row) {
    if (row.passes.empty() || row.passes.front().first != "bin") return 0;
    return row.passes.back().second.least;
}
double sum(const std::vector<Row>& rows, double (*value)(const Row&)) {
    double all = 0;
    for (const Row& row : rows)
        all += value(row);
    return all;
}

/// Returns a table row for each technique: means, and in brackets least and greatest, over views or a view's frames.
std::vector<TableRow> by_technique(const std::vector<Row>& rows) {
    std::vector<TableRow> table = {{"", "ms", "million evaluations", "MB", "differs", "shading", "words"}};
    double of_lists = 0;
    for (const auto& [name, views] : grouped(rows, &Row::technique)) {
        const double its = sum(views, shading);
        if (name == "TiledForward") of_lists = its;
        Spread ms = spread_of(views, milliseconds);
        if (views.size() == 1) ms = {ms.mean, views[0].frame.least, views[0].frame.most};
        const Spread evaluations = spread_of(views, millions),
                     different = spread_of(views, percent_different);
        const double by = spread_of(views, [](const Row& row) { return 1.0 * row.difference; }).most;
        table.push_back(
            {name, ms.most > 0 ? text("%8.1f (%7.1f /%7.1f)", ms.mean, ms.least, ms.most) : "not timed",
             evaluations.most > 0
                 ? text("%9.3f (%8.3f /%8.3f)", evaluations.mean, evaluations.least, evaluations.most)
                 : "not counted",
             text("%8.1f", spread_of(views, megabytes).most),
             different.most > 0 ? text("%6.2f %% by %.0f", different.most, by) : "nowhere",
             its > 0 && of_lists > 0 ? text("%5.2f", its / of_lists) : "",
             views[0].words > 0 ? text("%6.2f", sum(views, words_a_pixel) / static_cast<double>(views.size()))
                                : ""});
    }
    return table;
}

// As RFC 4180 has it.
std::string quoted(const std::string& text) {
    std::string made = "\"";
    for (const char c : text)
        made += c == '"' ? "\"\"" : std::string(1, c);
    return made + '"';
}

}  // namespace

void print_rows(const std::vector<Row>& rows) {
    for (const auto& [key, its] :
         grouped(rows, [](const Row& row) { return std::pair(row.scene, row.table); })) {
        std::printf("\n%s: %s\n", key.first.c_str(), key.second.c_str());
        print_table(by_technique(its));
    }
    std::printf("\nshading: the time in which surfaces are drawn and lit, over TiledForward's. words: of "
                "masks, for a "
                "pixel.\n");
}

void print_price_of_words(const std::vector<Row>& all) {
    const auto of = [&](const char* technique) {
        std::vector<Row> rows;
        for (const Row& row : all)
            if (row.table == lists_and_masks && row.technique == technique) rows.push_back(row);
        return rows;
    };
    // Views with fewer lights draw the same fragments, so the difference in time is that of the light evaluations.
    const std::vector<Row> lists = of("TiledForward");
    double time = 0, evaluations = 0;
    for (const auto& [view, by_lights] : grouped(lists, &Row::view)) {
        time += shading(by_lights.back()) - shading(by_lights.front());
        evaluations += millions(by_lights.back()) - millions(by_lights.front());
    }
    if (!(time > 0 && evaluations > 0)) return;
    const double evaluation = time / evaluations;
    const auto price = [&](const std::vector<Row>& of_lists, const std::vector<Row>& of_masks) {
        return ((sum(of_masks, shading) - sum(of_lists, shading)) / evaluation -
                (sum(of_masks, millions) - sum(of_lists, millions))) /
               sum(of_masks, million_words);
    };
    std::printf("A word of masks takes as long as %.2f light evaluations, with z-bins as %.2f.\n",
                price(lists, of("MaskedForward")), price(of("ZBinnedForward"), of("MaskedForward z-bins")));
}

void write_csv(const std::vector<Row>& rows) {
    std::FILE* const file =
        open_report("frames.csv", "table,scene,view,lights,technique,evaluations,ms,least_ms,most_ms,"
                                  "bytes,pixels,different_pixels,largest_difference,words,passes");
    for (const Row& row : rows) {
        std::fprintf(file, "%s,%s,%s,%zu,%s,%llu,%.3f,%.3f,%.3f,%zu,%zu,%zu,%d,%llu,", row.table.c_str(),
                     quoted(row.scene).c_str(), quoted(row.view).c_str(), row.lights, row.technique.c_str(),
                     static_cast<unsigned long long>(row.evaluations), row.frame.median, row.frame.least,
                     row.frame.most, row.bytes, row.pixels, row.different, row.difference,
                     static_cast<unsigned long long>(row.words));
        for (const auto& [pass, times] : row.passes)
            std::fprintf(file, "%s%s %.3f (%.3f to %.3f)", &pass == &row.passes.front().first ? "" : "; ",
                         pass.c_str(), times.median, times.least, times.most);
        std::fprintf(file, "\n");
    }
    std::fclose(file);
}
