// SPDX-License-Identifier: MIT
// What threads gain.
#pragma once

#include "measure.hpp"
#include "memory.hpp"

#include <lightbin/parallel.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

/// How many times as fast threads are as one alone.
struct Gains {
    double awake, asleep;  ///< at a build, coming from other work or from sleep
    double sums;           ///< at arithmetic in registers that takes one thread as long
};

inline constexpr std::size_t steps_a_ms = 400000;  // of churn, about

/// Arithmetic in registers, for the given number of steps.
inline void churn(std::size_t steps) {
    std::uint32_t sums[32] = {};
    for (std::size_t i = 0; i < steps; ++i)
        for (std::uint32_t& sum : sums)
            sum += (sum << 1) + 1;
    keep(sums);
}

/// In turns, the same by one thread alone and by all. `bin(threads, turn)` builds.
template <class Bin> Gains measure_gains(const lightbin::Parallel& parallel, double seconds_a_case, Bin bin) {
    double alone = 0;
    const auto gain = [&](bool asleep, auto work) {
        std::vector<double> times[2];
        const double end = time_now() + seconds_a_case / 2;
        for (std::size_t turn = 0; time_now() < end || times[1].size() < 5; ++turn) {
            // A few turns each: 14 in all, which do not divide the 48 frames.
            const bool sharing = turn / 7 % 2 == 1;
            const lightbin::Parallel threads = sharing ? parallel : lightbin::Parallel();
            // Threads come from other work, as in a frame they would, or they have slept.
            if (asleep)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            else
                threads.run(threads.workers(), [](std::size_t) { churn(steps_a_ms); });
            times[sharing].push_back(seconds([&] { work(threads, turn); }));
        }
        alone = median(times[0]);
        return alone / median(times[1]);
    };
    Gains gains = {.awake = gain(false, bin), .asleep = gain(true, bin), .sums = 0};
    const double steps = alone / seconds([] { churn(steps_a_ms); }) * steps_a_ms;
    gains.sums = gain(false, [&](const lightbin::Parallel& threads, std::size_t) {
        const std::size_t share = std::size_t(steps) / threads.workers();
        threads.run(threads.workers(), [&](std::size_t) { churn(share); });
    });
    return gains;
}
