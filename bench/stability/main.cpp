// SPDX-License-Identifier: MIT
// stability [--quick | --tiny]: how far off, under stiff and extreme conditions, are the bounds of lights by our formulas and
// by the textbooks', and what do they miss? A table on the console, stability.csv, and stability.page for bench/page.sh. A
// tile or slice that the library misses is an error. --tiny is for a test: a few lights, and its times mean nothing.
#include "report.hpp"

#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace stability;

int main(int count, char** words) try {
    const std::string_view option = count > 1 ? words[1] : "";
    if (count > 2 || (count == 2 && option != "--quick" && option != "--tiny")) {
        std::fprintf(stderr, "stability takes nothing, --quick or --tiny, not '%s'\n", words[1]);
        return 2;
    }
    const Effort effort = option == "--tiny"    ? Effort{2, 20, 7, 16, 0}
                          : option == "--quick" ? Effort{32, 64, 16, 16384, 0.005}
                                                : Effort{256, 64, 16, 50000, 0.03};
    const std::vector<Family> families = all_families();
    std::vector<Measured> all;
    std::printf("%-32s%24s%37s%26s\n", "",
                "error in pixels (slices):", "missed: without, and with our margin:", "ns a light:");
    print_row("stiff or extreme: where float is worst", heads);
    std::uint64_t misses = 0, unlike = 0, denied = 0, checked = 0;
    for (const Family& family : families) {
        Measured measured{&family, {}};
        for (const Condition& condition : family.conditions) {
            measured.results.push_back(Measure(family, condition, effort).run());
            const Result& result = measured.results.back();
            misses += result.ours.missed_same, unlike += result.unlike;
            denied += result.denied, checked += result.checked;
            const auto complain = [&](std::uint64_t n, const char* what) {
                if (n > 0)
                    std::fprintf(stderr, "%s, %s: %llu %s\n", family.title.c_str(), condition.label.c_str(),
                                 static_cast<unsigned long long>(n), what);
            };
            complain(result.ours.missed_same, "tiles or slices missed by the library");
            complain(result.unlike, "rectangles that bench/stability/ours.hpp does not explain");
            complain(result.denied, "exact bounds that rational arithmetic denies");
        }
        all.push_back(std::move(measured));
        print_row(family.title, cells(all.back(), all.back().worst()));
    }
    std::printf("\n");
    for (const Measured& measured : all)
        std::printf("%s\n", sentence(measured).c_str());
    std::printf("\n");
    const std::vector<std::string> answer = verdict(all, misses);
    for (const std::string& line : answer)
        std::printf("%s\n", line.c_str());
    std::printf("%llu exact bounds were checked in rationals.\n", static_cast<unsigned long long>(checked));
    write_csv(all);
    write_page(all, answer);
    return misses + unlike + denied == 0 ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "stability: %s\n", error.what());
    return 1;
}
