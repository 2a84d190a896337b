// SPDX-License-Identifier: MIT
// A job as a line of JSON, for the runners in JavaScript. Bytes are written in hexadecimal.
#pragma once

#include "job.hpp"

#include <lightbin/shader_text.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// An object of JSON, made member by member.
class JsonObject {
public:
    JsonObject& text(const char* key, const std::string& value) {
        begin(key) += '"';
        for (const char c : value)
            line_ += c == '\n' ? "\\n" : c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
        line_ += '"';
        return *this;
    }

    template <class T> JsonObject& bytes(const char* key, const std::vector<T>& values) {
        constexpr const char* digits = "0123456789abcdef";
        begin(key) += '"';
        for (const std::byte byte : std::as_bytes(std::span(values))) {
            line_ += digits[static_cast<unsigned>(byte) >> 4];
            line_ += digits[static_cast<unsigned>(byte) & 15];
        }
        line_ += '"';
        return *this;
    }

    JsonObject& raw(const char* key, const std::string& value) {
        begin(key) += value;
        return *this;
    }

    JsonObject& number(const char* key, std::size_t value) { return raw(key, std::to_string(value)); }

    std::string line() const { return line_ + "}"; }

private:
    std::string& begin(const char* key) {
        line_ += std::string(line_.empty() ? "{\"" : ", \"") + key + "\": ";
        return line_;
    }

    std::string line_;
};

inline std::string json(const Input& input) {
    const lightbin::ShaderBinding& binding = input.binding;
    return JsonObject()
        .text("name", binding.name)
        .text("resource", to_string(binding.resource))
        .text("format", webgpu_format(binding.format))
        .number("set", static_cast<std::size_t>(binding.slot.set))
        .number("binding", static_cast<std::size_t>(binding.slot.binding))
        .number("size", binding.bytes)
        .number("width", input.width)
        .number("height", input.height)
        .number("samples", input.samples)
        .bytes("bytes", input.bytes)
        .line();
}

/// What a runner does with a job: it compiles the text, also runs it and compares what it wrote, or runs it and hands back
/// what it wrote.
enum class JobUse : std::uint8_t { compiles, runs, asks };

inline std::string json(const Job& job, JobUse use) {
    std::string inputs;
    for (const Input& input : job.inputs)
        inputs += (inputs.empty() ? "[" : ", ") + json(input);
    JsonObject object;
    object.text("name", job.name)
        .text("text", job.text)
        .raw("runs", use == JobUse::compiles ? "false" : "true")
        .raw("asks", use == JobUse::asks ? "true" : "false")
        .text("stage", job.stage == Stage::compute ? "compute" : "fragment")
        .number("result", job.result)
        .raw("groups", "[" + std::to_string(job.groups[0]) + ", " + std::to_string(job.groups[1]) + "]")
        .number("width", job.width)
        .number("height", job.height)
        .number("x", job.corner[0])
        .number("y", job.corner[1])
        .number("views", job.views)
        .raw("inputs", inputs.empty() ? "[]" : inputs + "]");
    if (job.within.empty())
        object.bytes("expected", job.expected);
    else
        object.bytes("within", job.within);
    return object.line();
}
