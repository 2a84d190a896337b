// SPDX-License-Identifier: MIT
// Prints jobs as lines of JSON, with bytes in hexadecimal. Another process reads them and is the device.
#pragma once

#include "../job.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstdio>
#include <iostream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

template <class T> std::string hexadecimal(const std::vector<T>& values) {
    constexpr const char* digits = "0123456789abcdef";
    std::string text;
    for (const std::byte byte : std::as_bytes(std::span(values))) {
        text += digits[static_cast<unsigned>(byte) >> 4];
        text += digits[static_cast<unsigned>(byte) & 15];
    }
    return text;
}

/// What the other process does with a job: compiles its text; runs it and compares the result; or runs it and returns
/// the result.
enum class JobUse : std::uint8_t { compiles, runs, asks };

inline std::string json(const Job& job, JobUse use) {
    nlohmann::json inputs = nlohmann::json::array();
    for (const Input& input : job.inputs)
        inputs.push_back({{"name", input.binding.name},
                          {"resource", to_string(input.binding.resource)},
                          {"format", webgpu_format(input.binding.format)},
                          {"set", input.binding.slot.set},
                          {"binding", input.binding.slot.binding},
                          {"size", input.binding.bytes},
                          {"width", input.width},
                          {"height", input.height},
                          {"samples", input.samples},
                          {"bytes", hexadecimal(input.bytes)}});
    nlohmann::json object = {{"name", job.name},
                             {"text", job.text},
                             {"runs", use != JobUse::compiles},
                             {"asks", use == JobUse::asks},
                             {"stage", job.stage == Stage::compute ? "compute" : "fragment"},
                             {"result", job.result},
                             {"groups", job.groups},
                             {"width", job.width},
                             {"height", job.height},
                             {"x", job.corner[0]},
                             {"y", job.corner[1]},
                             {"views", job.views},
                             {"inputs", inputs}};
    if (job.within.empty())
        object["expected"] = hexadecimal(job.expected);
    else
        object["within"] = hexadecimal(job.within);
    return object.dump();
}

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
