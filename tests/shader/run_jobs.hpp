// SPDX-License-Identifier: MIT
// Runs jobs on a device and compares results. A device has `std::vector<std::uint32_t> run(const Job&)`, which throws
// std::runtime_error if the text is refused.
#pragma once

#include "builders.hpp"
#include "readers.hpp"

#include <cstddef>
#include <cstdio>
#include <stdexcept>
#include <string>

struct Tally {
    int jobs = 0, refused = 0, wrong = 0;

    /// Counts a job; what(job) returns whether its result is right.
    template <class What> void count(const Job& job, const What& what) {
        ++jobs;
        std::string problem = "is wrong";
        try {
            if (what()) return;
            ++wrong;
        } catch (const std::runtime_error& error) {
            problem = std::string("is refused: ") + error.what();
            ++refused;
        }
        if (refused + wrong <= 3)
            std::printf("%s %s\n%s\n", job.name.c_str(), problem.c_str(), job.text.c_str());
    }
    template <class Device> void run(Device& device, const Job& job) {
        count(job, [&] { return job.accepts(device.run(job)); });
    }

    bool good() const { return jobs > 0 && refused == 0 && wrong == 0; }
    std::string text(const char* what = "runs") const {
        return std::to_string(jobs) + " " + what + ", " + std::to_string(refused) + " refused, " +
               std::to_string(wrong) + " wrong";
    }
};

template <class Device>
void run_readers(Device& device, const std::vector<ReaderRun>& runs, const Share& share, Tally& tally) {
    for (std::size_t i = share.first; i < runs.size(); i += share.count)
        tally.run(device, runs[i].job());
}

/// Runs the shaders that reduce depth buffers; multisample ones if the device supports them.
template <class Device>
void run_reductions(Device& device, lightbin::ShaderLanguage language, bool multisample, const Share& share,
                    Tally& tally) {
    const std::vector<Job> jobs = reduce_jobs(language, multisample);
    for (std::size_t i = share.first; i < jobs.size(); i += share.count)
        tally.run(device, jobs[i]);
}
