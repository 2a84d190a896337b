// SPDX-License-Identifier: MIT
// Console output of the programs: progress on stderr, then a table, a conclusion, and the names of the files written.
#pragma once

#include "measure.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

template <class... Values> std::string text(const char* format, Values... values) {
    char buffer[400];
    std::snprintf(buffer, sizeof buffer, format, values...);
    return buffer;
}

/// A progress line that the next one replaces, gone at the end; where stderr is no terminal, one in ten seconds.
class Progress {
public:
    ~Progress() {
        if (terminal_) std::fprintf(stderr, "\r\033[K");
    }
    void operator()(const std::string& what) {
        if (!terminal_ && time_now() < next_) return;
        std::fprintf(stderr, terminal_ ? "\r\033[K%.100s" : "%s\n", what.c_str());
        next_ = time_now() + 10;
    }

private:
    bool terminal_ = isatty(STDERR_FILENO) != 0;
    double next_ = 0;
};

using TableRow = std::vector<std::string>;

/// Prints a table in which each column is as wide as its widest text.
inline void print_table(const std::vector<TableRow>& rows) {
    std::vector<std::size_t> widths(rows[0].size());
    for (const TableRow& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());
    for (const TableRow& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i)
            line += row[i] + std::string(widths[i] + 2 - row[i].size(), ' ');
        std::puts(line.substr(0, line.find_last_not_of(' ') + 1).c_str());
    }
}

/// Prints the conclusion at a program's end. `files` are the files that it wrote to the current folder.
inline void conclude(const std::vector<std::string>& verdict, const std::vector<std::string>& files) {
    std::puts("");
    for (const std::string& line : verdict)
        std::puts(line.c_str());
    std::string names;
    for (const std::string& file : files)
        names += (names.empty() ? "" : ", ") + file;
    std::printf("All rows: %s in %s\n", names.c_str(), std::filesystem::current_path().c_str());
}
