// SPDX-License-Identifier: MIT
// Times, and where they are written.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

/// In seconds, from some point on.
inline double time_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Work> double seconds(Work work) {
    const double start = time_now();
    work();
    return time_now() - start;
}

inline double percentile(std::vector<double> values, double share) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * double(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

inline double median(std::vector<double> values) {
    return percentile(std::move(values), 0.5);
}

/// A file to write a table to, with its first line.
inline std::FILE* open_report(const char* path, const char* header) {
    std::FILE* file = std::fopen(path, "w");
    if (file == nullptr) {
        std::perror(path);
        std::exit(EXIT_FAILURE);
    }
    std::fprintf(file, "%s\n", header);
    return file;
}
