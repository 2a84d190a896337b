// SPDX-License-Identifier: MIT
#include "report.hpp"

#include "cases.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace {

template <class Key> auto grouped(const std::vector<Row>& rows, Key key_of) {
    std::vector<std::pair<decltype(key_of(rows.front())), std::vector<Row>>> groups;
    for (const Row& row : rows) {
        const auto key = key_of(row);
        auto group = std::ranges::find(groups, key, [](const auto& g) { return g.first; });
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

class File {
public:
    explicit File(const std::string& path) : file_(std::fopen(path.c_str(), "w")) {
        if (!file_) throw std::runtime_error("cannot write '" + path + "'");
    }
    ~File() { std::fclose(file_); }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    operator std::FILE*() const { return file_; }

private:
    std::FILE* file_;
};

// As RFC 4180 has it.
std::string quoted(const std::string& text) {
    std::string made = "\"";
    for (const char c : text)
        made += c == '"' ? "\"\"" : std::string(1, c);
    return made + '"';
}

double millions(const Row& row) {
    return static_cast<double>(row.evaluations) * 1e-6;
}

}  // namespace

void print_techniques(const std::string& title, const std::vector<Row>& rows) {
    if (rows.empty()) return;
    std::printf("\n%s\n%-52s %26s %30s %8s %16s\n", title.c_str(), "", "ms", "million evaluations", "MB",
                "differs");
    for (const auto& [name, views] : grouped(rows, [](const Row& row) { return row.technique; })) {
        Spread ms = spread_of(views, [](const Row& row) { return row.frame.median; });
        if (views.size() == 1) ms = {ms.mean, views[0].frame.least, views[0].frame.most};
        const Spread evaluations = spread_of(views, millions);
        const Spread different = spread_of(views, [](const Row& row) {
            return 100.0 * static_cast<double>(row.different) / static_cast<double>(row.pixels);
        });
        const Spread difference =
            spread_of(views, [](const Row& row) { return static_cast<double>(row.difference); });
        const Spread bytes = spread_of(views, [](const Row& row) { return static_cast<double>(row.bytes); });
        std::printf("%-52s", name.c_str());
        if (ms.most > 0)
            std::printf(" %8.1f (%7.1f /%7.1f)", ms.mean, ms.least, ms.most);
        else
            std::printf(" %27s", "not timed");
        if (evaluations.most > 0)
            std::printf(" %9.3f (%8.3f /%8.3f)", evaluations.mean, evaluations.least, evaluations.most);
        else
            std::printf(" %30s", "not counted");
        std::printf(" %8.1f", bytes.most * 1e-6);
        if (different.most == 0)
            std::printf(" %16s\n", "nowhere");
        else
            std::printf(" %6.2f %% by %3.0f\n", different.most, difference.most);
    }
}

void print_samples(const std::string& title, std::vector<Row> rows) {
    if (rows.empty()) return;
    std::printf("\n%s\n%-14s", title.c_str(), "lights, MSAA");
    const auto columns = grouped(rows, [](const Row& row) { return row.technique; });
    for (const auto& [name, column] : columns)
        std::printf(" | %-34s", name.c_str());
    std::printf("\n%-14s", "");
    for (std::size_t i = 0; i < columns.size(); ++i)
        std::printf(" | %8s %8s %6s %9s", "ms", "million", "MB", "differs");
    std::printf("\n");
    std::ranges::sort(rows, {}, [](const Row& r) { return std::pair(r.lights, r.samples); });
    for (const auto& [key, line] :
         grouped(rows, [](const Row& r) { return std::pair(r.lights, r.samples); })) {
        std::printf("%8zu, %4d", key.first, key.second);
        for (const auto& [name, column] : columns) {
            const auto row = std::ranges::find(line, name, &Row::technique);
            if (row == line.end())
                std::printf(" | %34s", "left out");
            else if (row->computed)
                std::printf(" | %8s %8s %6.1f %9s", "", "", static_cast<double>(row->bytes) * 1e-6,
                            "computed");
            else
                std::printf(" | %8.1f %8.3f %6.1f %7.2f %%", row->frame.median, millions(*row),
                            static_cast<double>(row->bytes) * 1e-6,
                            100.0 * static_cast<double>(row->different) / static_cast<double>(row->pixels));
        }
        std::printf("\n");
    }
}

void write_csv(const std::string& name, const std::vector<Row>& rows) {
    const File file(name + ".csv");
    std::fprintf(file, "table,scene,view,lights,technique,samples,evaluations,ms,least_ms,most_ms,bytes,"
                       "bytes_are,pixels,different_pixels,largest_difference,passes\n");
    for (const Row& row : rows) {
        std::fprintf(file, "%s,%s,%s,%zu,%s,%d,%llu,%.3f,%.3f,%.3f,%zu,%s,%zu,%zu,%d,", row.table.c_str(),
                     quoted(row.scene).c_str(), quoted(row.view).c_str(), row.lights, row.technique.c_str(),
                     row.samples, static_cast<unsigned long long>(row.evaluations), row.frame.median,
                     row.frame.least, row.frame.most, row.bytes, row.computed ? "computed" : "measured",
                     row.pixels, row.different, row.difference);
        for (const auto& [pass, times] : row.passes)
            std::fprintf(file, "%s%s %.3f (%.3f to %.3f)", &pass == &row.passes.front().first ? "" : "; ",
                         pass.c_str(), times.median, times.least, times.most);
        std::fprintf(file, "\n");
    }
}

void write_paths(const std::string& name, const std::vector<Row>& rows) {
    const File file(name + ".csv");
    std::fprintf(file, "panel,frame,technique,million_evaluations,ms\n");
    std::string panel, first;
    int view = 0;
    for (const Row& row : rows) {
        if (!row.table.starts_with("path")) continue;
        std::string its = row.scene.substr(0, row.scene.rfind(".glb")) + ": " + counted(row.lights, "light");
        std::erase_if(its, [](char c) { return c == '"' || c == '\''; });  // which the plot cannot take
        if (its != std::exchange(panel, its)) {
            view = -1;
            first = row.technique;
        }
        if (row.technique == first) ++view;
        const int frame = frame_of(row.view);
        std::fprintf(file, "\"%s\",%d,%s,%.6f,%.3f\n", its.c_str(), frame < 0 ? view : frame,
                     row.technique.c_str(), millions(row), row.frame.median);
    }
}
