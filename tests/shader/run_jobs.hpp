// SPDX-License-Identifier: MIT
// Runs jobs on a device and compares. A device has `std::vector<std::uint32_t> run(const Job&)`, which throws
// std::runtime_error where the text is refused.
#pragma once

#include "builders.hpp"
#include "readers.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

/// Which share of the work: every count-th job from `first` on. On the command line: its two numbers.
struct Share {
    std::size_t first = 0, count = 1;
};

inline Share share_of(int count, char** arguments) {
    return count < 3 ? Share{} : Share{std::stoul(arguments[count - 2]), std::stoul(arguments[count - 1])};
}

struct Tally {
    int runs = 0, refused = 0, wrong = 0;

    template <class Device> void run(Device& device, const Job& job) {
        ++runs;
        try {
            if (job.accepts(device.run(job))) return;
            std::printf("%s is wrong\n", job.name.c_str());
            ++wrong;
        } catch (const std::runtime_error& error) {
            if (++refused <= 3)
                std::printf("%s is refused: %s\n%s\n", job.name.c_str(), error.what(), job.text.c_str());
        }
    }

    bool good() const { return runs > 0 && refused == 0 && wrong == 0; }
    std::string text() const {
        return std::to_string(runs) + " runs, " + std::to_string(refused) + " refused, " +
               std::to_string(wrong) + " wrong";
    }
};

template <class Device>
void run_readers(Device& device, lightbin::ShaderLanguage language, const Share& share, Tally& tally,
                 bool each_flip = true, bool waves = false) {
    const std::vector<ReaderRun> runs = reader_runs(language, each_flip, waves);
    for (std::size_t i = share.first; i < runs.size(); i += share.count)
        tally.run(device, runs[i].job());
}

/// Two views drawn at once, if the device has multiview.
template <class Device>
void run_multiview(Device& device, lightbin::ShaderLanguage language, const Share& share, Tally& tally) {
    const std::vector<ReaderRun> runs = multiview_runs(language);
    for (std::size_t i = share.first; i < runs.size(); i += share.count)
        tally.run(device, runs[i].job());
}

/// The reduction of depth buffers; of multisample ones if the device has them.
template <class Device>
void run_reductions(Device& device, lightbin::ShaderLanguage language, bool multisample, const Share& share,
                    Tally& tally) {
    std::size_t turn = 0;
    for (const Job& job : reduce_jobs(language, multisample))
        if (turn++ % share.count == share.first) tally.run(device, job);
}
