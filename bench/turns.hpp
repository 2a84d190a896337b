// SPDX-License-Identifier: MIT
// Several pieces of work, timed in turns.
#pragma once

#include "measure.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

/// The seconds that each piece of work took in each turn, and what the pieces returned.
struct Turns {
    std::vector<std::vector<double>> seconds;  ///< by work, then by turn
    std::vector<std::size_t> made;             ///< for each work the sum of what it returned
    std::size_t together = 1;                  ///< frames that are timed together in a turn

    /// Returns the median time of one work over the median time of another.
    double ratio(std::size_t of, std::size_t to) const { return median(seconds[of]) / median(seconds[to]); }
    /// The distance from the 10th to the 90th percentile of the ratios of single turns.
    double spread(std::size_t of, std::size_t to) const {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < seconds[of].size(); ++i)
            ratios.push_back(seconds[of][i] / seconds[to][i]);
        return percentile(ratios, 0.9) - percentile(ratios, 0.1);
    }
    /// Returns, for one frame, the median time of a work and the mean of what it returned.
    double seconds_a_frame(std::size_t of) const { return median(seconds[of]) / double(together); }
    double made_a_frame(std::size_t of) const {
        return double(made[of]) / double(seconds[of].size() * together);
    }
};

template <class AnyFrame> using Work = std::function<std::size_t(const AnyFrame&)>;

/// Times all works in an even number of turns, each turn on other frames, some together where one is too short for the
/// clock. The order is turned round after each turn, because a work finds the lights in the cache where another has just
/// read them; with `apart`, each work of a turn has a frame of its own instead.
template <class AnyFrame>
Turns take_turns(const std::vector<AnyFrame>& frames, double seconds_in_all,
                 const std::vector<Work<AnyFrame>>& works, bool apart = false) {
    const std::size_t count = works.size(), lights = std::max<std::size_t>(frames[0].lights.size(), 1);
    Turns turns = {std::vector<std::vector<double>>(count), std::vector<std::size_t>(count),
                   std::max<std::size_t>(1, 256 / lights)};
    double spent = 0;
    for (std::size_t turn = 0; spent < seconds_in_all || turn < 6 || turn % 2 != 0; ++turn)
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t work = turn % 2 == 0 ? i : count - 1 - i,
                              first = turn * turns.together + (apart ? work : 0);
            turns.seconds[work].push_back(seconds([&] {
                for (std::size_t k = 0; k < turns.together; ++k)
                    turns.made[work] += works[work](frames[(first + k) % frames.size()]);
            }));
            spent += turns.seconds[work].back();
        }
    return turns;
}
