// SPDX-License-Identifier: MIT
// Hunts for a light that the library misses, as somebody would who does not believe it: with the public headers
// alone, points inside spheres, the caller's own matrices in long double and the caller's own pixels.
//
//     hunt [--rounds N | --seconds N] [--seed N | --seed random] [--first ROUND] [--large]
//
// A fault is printed with its seed and round: `hunt --seed S --first R --rounds 1` goes there again.
#include "round.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <random>
#include <string_view>

int main(int count, char** words) {
    std::uint64_t rounds = 0, seed = 1, first = 0;
    double seconds = 0;
    bool large = false;
    for (int i = 1; i < count; ++i) {
        const std::string_view word = words[i];
        const char* const next = i + 1 < count ? words[i + 1] : nullptr;
        if (word == "--large")
            large = true;
        else if (word == "--rounds" && next != nullptr)
            rounds = std::strtoull(next, nullptr, 10), ++i;
        else if (word == "--seconds" && next != nullptr)
            seconds = std::strtod(next, nullptr), ++i;
        else if (word == "--first" && next != nullptr)
            first = std::strtoull(next, nullptr, 10), ++i;
        else if (word == "--seed" && next != nullptr)
            seed = std::string_view(next) == "random" ? std::random_device{}()
                                                      : std::strtoull(next, nullptr, 10),
            ++i;
        else
            return std::fprintf(stderr, "hunt [--rounds N | --seconds N] [--seed N | --seed random] [--first "
                                        "ROUND] [--large]\n"),
                   2;
    }
    if (rounds == 0 && seconds == 0) rounds = 200;
    std::setvbuf(stdout, nullptr, _IOLBF, 1 << 12);
    std::printf("hunt: seed %llu\n", static_cast<unsigned long long>(seed));

    hunt::Report report;
    const auto start = std::chrono::steady_clock::now();
    const auto elapsed = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const auto progress = [&](std::uint64_t done) {
        std::printf(
            "hunt: %.0f s, %llu rounds, %llu grids, %.4g entries, %.4g points looked for, %zu faults\n",
            elapsed(), static_cast<unsigned long long>(done), static_cast<unsigned long long>(report.grids),
            static_cast<double>(report.entries), static_cast<double>(report.points), report.faults.size());
    };
    std::size_t printed = 0;
    const auto print_faults = [&] {
        for (; printed < report.faults.size(); ++printed)
            std::printf("FAULT after %.1f s: %s\n", elapsed(), report.faults[printed].c_str());
    };
    hunt_limits(report, large);
    print_faults();
    double next_line = 10;
    std::uint64_t round = first;
    for (; (rounds == 0 || round - first < rounds) && (seconds == 0 || elapsed() < seconds); ++round) {
        try {
            hunt::hunt_round(seed, round, report);
        } catch (const std::bad_alloc&) {
            report.faults.push_back("out of memory in round " + std::to_string(round));
        }
        print_faults();
        if (report.faults.size() >= 10) break;
        if (elapsed() < next_line) continue;
        progress(round - first + 1);
        next_line = elapsed() * 1.2 + 5;
    }
    progress(round - first);

    // A few rounds can't have had everything: 200 must.
    const bool complete = round - first >= 200;
    hunt::Tally tally = report.tally;
    hunt::expect_all(tally);
    std::size_t left_out = 0;
    for (const auto& [name, times] : tally) {
        std::printf("  %10llu  %s\n", static_cast<unsigned long long>(times), name.c_str());
        left_out += times == 0;
    }
    if (left_out > 0) std::printf("hunt: %zu kinds had no turn\n", left_out);
    if (!report.faults.empty()) return 1;
    return complete && left_out > 0 ? 1 : 0;
}
