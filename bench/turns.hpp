// SPDX-License-Identifier: MIT
// Two ways to build, timed in turns.
#pragma once

#include "measure.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

/// Seconds of each turn.
struct Turns {
    std::vector<double> ours, theirs;
    std::size_t together;  ///< frames a turn

    /// Of the medians.
    double ratio() const { return median(ours) / median(theirs); }
    /// 10th to 90th percentile of the turns' own ratios.
    double spread() const {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < ours.size(); ++i)
            ratios.push_back(ours[i] / theirs[i]);
        return percentile(ratios, 0.9) - percentile(ratios, 0.1);
    }
};

/// Times two ways to build in turns, each turn on other frames, some together where one is too short for the clock. Which
/// comes first alternates, as the second finds the lights in the cache.
template <class AnyFrame, class Ours, class Theirs>
Turns take_turns(const std::vector<AnyFrame>& frames, double seconds_a_case, Ours ours, Theirs theirs) {
    Turns turns = {{}, {}, std::max<std::size_t>(1, 256 / frames[0].lights.size())};
    double spent = 0;
    for (std::size_t turn = 0; spent < seconds_a_case || turn < 5; ++turn) {
        const auto time = [&](std::vector<double>& times, auto& build) {
            times.push_back(seconds([&] {
                for (std::size_t i = 0; i < turns.together; ++i)
                    build(frames[(turn * turns.together + i) % frames.size()]);
            }));
            spent += times.back();
        };
        if (turn % 2 == 0) time(turns.ours, ours);
        time(turns.theirs, theirs);
        if (turn % 2 == 1) time(turns.ours, ours);
    }
    return turns;
}
