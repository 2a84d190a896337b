// SPDX-License-Identifier: MIT
// A job as a line of JSON, for the runners in JavaScript. Bytes are written in hexadecimal.
#pragma once

#include "job.hpp"

#include <lightbin/shader_text.hpp>

#include <nlohmann/json.hpp>

#include <span>
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

/// What a runner does with a job: it compiles the text, also runs it and compares what it wrote, or runs it and hands back
/// what it wrote.
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
