// SPDX-License-Identifier: MIT
// Spots: what each rung of the ladder lists of them beside the exact pairs, and what building them takes beside spheres
// that make as many entries. Writes spots_tightness.csv and spots_time.csv; exits with 1 where an exact pair is not listed.
#include "arguments.hpp"
#include "spots_tightness.hpp"
#include "spots_time.hpp"

#include <exception>
#include <string>

namespace {

/// Spots whose exact tiles are counted for the sets that are timed.
void print_tiles_a_spot(const char* set, float median_range, std::size_t count) {
    SpotDecider decider({}, 32);
    std::size_t in_view = 0, met = 0;
    for (const lightbin::Spot& spot : spot_field(count, median_range, 1)) {
        std::size_t tiles = 0;
        for (int y = 0; y < decider.tiles_y(); ++y)
            for (int x = 0; x < decider.tiles_x(); ++x)
                tiles += decider.meets(x, y, {}, spot) == true;
        in_view += tiles > 0;
        met += tiles;
    }
    std::printf("%s: %.2f tiles a spot that is in view, %zu of %zu\n", set, double(met) / double(in_view),
                in_view, count);
}

/// Of the cases whose names have all of the words.
void report_times(bool quick, const std::vector<std::string>& words) {
    std::printf("\n");
    print_tiles_a_spot("spots20", spots20_median, quick ? 300 : 2000);
    print_tiles_a_spot("spots4", spots4_median, quick ? 300 : 2000);
    print_spot_time_header();
    std::vector<SpotTime> times;
    for (const SpotTimeCase& which : spot_time_cases(quick)) {
        const auto is_in_name = [&](const std::string& word) {
            return which.name.find(word) != std::string::npos;
        };
        if (!std::ranges::all_of(words, is_in_name)) continue;
        times.push_back(which.time(quick ? 0.05 : 0.15));
        print_spot_time(times.back());
    }
    write_spot_times(times, "spots_time.csv");
    print_spot_time_goals(times);
}

}  // namespace

int main(int argc, char** argv) try {
    Arguments arguments(argc, argv);
    const bool quick = arguments.take("--quick"), tightness = arguments.take("--tightness"),
               time = arguments.take("--time");
    const std::uint64_t misses = time ? 0 : report_tightness(quick);
    if (!tightness) report_times(quick, arguments.scenes());
    return misses == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
} catch (const std::exception& problem) {
    std::fprintf(stderr, "spots: %s\n", problem.what());
    return EXIT_FAILURE;
}
