// SPDX-License-Identifier: MIT
// A device in another process, that which reads what this one prints.
#pragma once

#include "../job_json.hpp"

#include <cstdint>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

/// Runs a job by printing it as a line of JSON and reading its result as a line of hexadecimal.
class PipedDevice {
public:
    std::vector<std::uint32_t> run(const Job& job) {
        std::printf("%s\n", json(job, JobUse::asks).c_str());
        std::fflush(stdout);
        std::string line;
        if (!std::getline(std::cin, line) || line.empty()) throw std::runtime_error(job.name + " is refused");
        std::vector<std::uint32_t> words;
        for (std::size_t at = 0; at + 8 <= line.size(); at += 8) {
            // The bytes are in the order of memory.
            const auto bytes = static_cast<std::uint32_t>(std::stoul(line.substr(at, 8), nullptr, 16));
            words.push_back(bytes >> 24 | (bytes >> 8 & 0xff00) | (bytes & 0xff00) << 8 | bytes << 24);
        }
        return words;
    }
};
