// SPDX-License-Identifier: MIT
// Writes a page that runs the jobs of GLSL ES 3.00: every text to compile, and those of the small screens to
// run. Bytes are written in hexadecimal.  write_jobs [FIRST COUNT]: takes a share of them.
#include "../run_jobs.hpp"

#include <cstdio>
#include <span>
#include <string>

namespace {

std::string hex(std::span<const std::byte> bytes) {
    std::string text;
    for (const std::byte byte : bytes) {
        constexpr const char* digits = "0123456789abcdef";
        text += digits[static_cast<unsigned>(byte) >> 4];
        text += digits[static_cast<unsigned>(byte) & 15];
    }
    return text;
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text)
        result += c == '\n' ? "\\n" : c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return result + "\"";
}

void write(const Job& job) {
    constexpr const char* resources[] = {"vector", "block", "push", "storage", "bytes", "texels", "texture"};
    constexpr const char* formats[] = {"", "R8UI", "R16UI", "R32UI", "RG32UI"};
    std::string line = "{\"name\": " + quoted(job.name) + ", \"text\": " + quoted(job.text);
    const auto number = [&](const char* key, std::uint32_t value) {
        line += std::string(", \"") + key + "\": " + std::to_string(value);
    };
    number("width", job.width);
    number("height", job.height);
    number("x", job.corner[0]);
    number("y", job.corner[1]);
    line += ", \"inputs\": [";
    for (const Input& input : job.inputs) {
        line += (&input == &job.inputs.front() ? "{\"name\": " : ", {\"name\": ") +
                quoted(input.binding.name) +
                ", \"resource\": " + quoted(resources[static_cast<int>(input.binding.resource)]) +
                ", \"format\": " + quoted(formats[static_cast<int>(input.binding.format)]);
        number("width", input.width);
        number("height", input.height);
        line += ", \"bytes\": \"" + hex(input.bytes) + "\"}";
    }
    std::printf("%s], \"expected\": \"%s\"},\n", line.c_str(),
                hex(std::as_bytes(std::span(job.expected))).c_str());
}

}  // namespace

int main(int count, char** arguments) {
    constexpr auto language = lightbin::ShaderLanguage::essl_300;
    const Share share = share_of(count, arguments);
    std::printf("<!DOCTYPE html><body><script src=\"run_jobs.js\"></script>\n<script>runAll([\n");
    const auto readers = every_reader(language);
    for (std::size_t i = share.first; i < readers.size(); i += share.count) {
        const auto snippet = lightbin::shader_snippet(readers[i]);
        Job job;
        job.name = name_of(readers[i]);
        if (snippet) job.text = reader_text(readers[i], *snippet, Stage::fragment, 100, 100);
        write(job);
    }
    const auto runs = reader_runs(language);
    for (std::size_t i = share.first; i < runs.size(); i += share.count)
        if (runs[i].screen.width < 100) write(runs[i].job());
    std::printf("]);</script>\n");
}
