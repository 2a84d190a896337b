// SPDX-License-Identifier: MIT
// stability [--quick | --tiny]: how far off, under stiff and extreme conditions, are the bounds of lights by our formulas and
// by the textbooks', and what do they miss? A table on the console, stability.csv, and stability.page for bench/page.sh. A
// tile or slice that the library misses is an error. --tiny is for a test: a few lights, and its times mean nothing.
#include "report.hpp"

#include <cstdint>
#include <cstdio>
#include <exception>
#include <string_view>
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
    std::uint64_t misses = 0, unlike = 0, denied = 0, checked = 0;
    {
        Progress progress;
        for (const Family& family : families) {
            all.push_back({&family, {}});
            for (const Condition& condition : family.conditions) {
                progress(family.title + ", " + condition.label);
                const Result result = Measure(family, condition, effort).run();
                misses += result.ours.missed_same, unlike += result.unlike;
                denied += result.denied, checked += result.checked;
                const auto complain = [&](std::uint64_t n, const char* what) {
                    if (n > 0)
                        std::fprintf(stderr, "%s, %s: %llu %s\n", family.title.c_str(),
                                     condition.label.c_str(), static_cast<unsigned long long>(n), what);
                };
                complain(result.ours.missed_same, "tiles or slices missed by the library");
                complain(result.unlike, "rectangles that bench/stability/ours.hpp does not explain");
                complain(result.denied, "exact bounds that rational arithmetic denies");
                all.back().results.push_back(result);
            }
        }
    }
    print_table(table(all));
    std::vector<std::string> answer = verdict(all, misses);
    write_csv(all);
    write_page(all, answer);
    answer.push_back(std::to_string(checked) + " exact bounds were checked in rationals.");
    conclude(answer, {"stability.csv"});
    return misses + unlike + denied == 0 ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "stability: %s\n", error.what());
    return 1;
}
