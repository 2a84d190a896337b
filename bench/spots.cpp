// SPDX-License-Identifier: MIT
// Spots: what each rung of the ladder lists of them beside the exact pairs, and what building them takes beside spheres
// that make as many entries. Writes spots_tightness.csv and spots_time.csv; exits with 1 where an exact pair is not listed.
#include "arguments.hpp"
#include "console.hpp"
#include "spots_tightness.hpp"
#include "spots_time.hpp"

#include <cmath>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

/// Exact tiles a spot that is in view, of a set that is timed.
double tiles_a_spot(float median_range, std::size_t count) {
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
    return double(met) / double(in_view);
}

/// A row a rung, a column a tier: the least and the greatest ratio.
void print_times(const std::vector<SpotTime>& times) {
    std::vector<TableRow> table = {{"spots to spheres"}};
    for (const char* const tier : goal_tiers)
        if (std::ranges::any_of(times, [&](const SpotTime& t) { return t.tier == tier; }))
            table[0].push_back(tier);
    for (const SpotTime& first : times) {
        const std::string name = first.rung();
        if (std::ranges::any_of(table, [&](const TableRow& row) { return row[0] == name; })) continue;
        TableRow row = {name};
        for (std::size_t i = 1; i < table[0].size(); ++i) {
            double least = HUGE_VAL, most = 0;
            for (const SpotTime& t : times)
                if (t.rung() == name && t.tier == table[0][i])
                    least = std::min(least, t.ratio), most = std::max(most, t.ratio);
            row.push_back(most > 0 ? text("%.2f to %.2f", least, most) : "");
        }
        table.push_back(row);
    }
    std::puts("");
    print_table(table);
}

/// Of the cases whose names have all of the words.
std::vector<SpotTime> report_times(bool quick, const std::vector<std::string>& words) {
    std::vector<SpotTime> times;
    Progress progress;
    for (const SpotTimeCase& which : spot_time_cases(quick)) {
        const auto is_in_name = [&](const std::string& word) {
            return which.name.find(word) != std::string::npos;
        };
        if (!std::ranges::all_of(words, is_in_name)) continue;
        progress(which.name);
        times.push_back(which.time(quick ? 0.05 : 0.15));
    }
    write_spot_times(times, "spots_time.csv");
    if (times.empty()) throw std::runtime_error("no case has all of these words in its name");
    return times;
}

}  // namespace

int main(int argc, char** argv) try {
    Arguments arguments(argc, argv);
    const bool quick = arguments.take("--quick"), tightness = arguments.take("--tightness"),
               time = arguments.take("--time");
    Goals goals;
    std::vector<std::string> verdict, files;
    std::uint64_t misses = 0;
    if (!time) {
        const TightnessReport report = report_tightness(quick, goals);
        misses = report.misses;
        verdict.push_back(text("%llu entries missed, %llu verdicts left open.",
                               static_cast<unsigned long long>(misses),
                               static_cast<unsigned long long>(report.open)));
        verdict.push_back(text(
            "Whole spheres are listed %.1f to %.0f times as often as the spots in them, in the median %.1f.",
            percentile(report.saved, 0), percentile(report.saved, 1), median(report.saved)));
        files.push_back("spots_tightness.csv");
    }
    if (!tightness) {
        const std::vector<SpotTime> times = report_times(quick, arguments.scenes());
        print_times(times);
        add_spot_time_goals(times, goals);
        std::vector<double> ratios;
        for (const SpotTime& t : times)
            ratios.push_back(t.ratio);
        verdict.push_back(
            text("Building them takes %.2f to %.2f times as long as as many spheres with as many entries, "
                 "in the median %.2f; spots20 has %.1f exact tiles a spot, spots4 %.1f.",
                 percentile(ratios, 0), percentile(ratios, 1), median(ratios),
                 tiles_a_spot(spots20_median, quick ? 300 : 2000),
                 tiles_a_spot(spots4_median, quick ? 300 : 2000)));
        files.push_back("spots_time.csv");
    }
    if (!goals.empty()) verdict.push_back(goals.sentence());
    conclude(verdict, files);
    return misses == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
} catch (const std::exception& problem) {
    std::fprintf(stderr, "spots: %s\n", problem.what());
    return EXIT_FAILURE;
}
