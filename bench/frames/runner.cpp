// SPDX-License-Identifier: MIT
#include "runner.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>

namespace {

Times times_of(std::vector<double> milliseconds) {
    std::ranges::sort(milliseconds);
    return {milliseconds[milliseconds.size() / 2], milliseconds.front(), milliseconds.back()};
}

std::string full_name(const Technique& technique) {
    if (technique.g_buffer_bits == 0) return technique.name;
    return technique.name + " " + std::to_string(technique.g_buffer_bits) + " bit";
}

}  // namespace

void LeftOut::say(const std::string& who, const std::string& why) {
    const std::string line = who + " is left out: " + why;
    if (std::ranges::find(lines_, line) != lines_.end()) return;
    lines_.push_back(line);
    std::fprintf(stderr, "\r%s\n", line.c_str());
}

Runner::Runner(const Scene& scene, const RunSettings& settings, int glsl, LeftOut& left_out)
    : scene_(scene), run_(settings), stage_(scene, glsl), meter_(scene, glsl), left_out_(left_out),
      every_light_(forward_every_light()) {}

std::vector<Row> Runner::run(const std::string& table, const Camera& camera,
                             const std::vector<Technique>& techniques, Settings wanted) {
    wanted.width = run_.width;
    wanted.height = run_.height;
    wanted.tile_size = run_.tile_size;
    std::vector<Row> rows;
    const auto add_row = [&](const Technique& technique, int timed_frames) {
        try {
            Row row = draw(technique, camera, wanted, timed_frames);
            if (rows.empty()) reference_ = picture_;
            compare(row);
            row.as_stated = row.difference <= technique.tolerance;
            row.table = table;
            rows.push_back(row);
        } catch (const std::exception& problem) {
            left_out_.say(rows.empty() ? "every technique" : full_name(technique), problem.what());
        }
    };
    try {
        Stage::reset_state();
        wanted.exposure = meter_.meter(camera, {});
    } catch (const std::exception& problem) {
        left_out_.say(scene_.name + ", " + camera.name, problem.what());
        return {};
    }
    // Lighting every fragment by every light takes long, so one frame is drawn; on a software renderer it is not timed.
    add_row(every_light_, is_software_renderer() ? 0 : 1);
    if (rows.empty()) return {};
    for (const Technique& technique : techniques)
        add_row(technique, run_.timed_frames);
    return rows;
}

Row Runner::draw(const Technique& technique, const Camera& camera, Settings wanted, int timed_frames) {
    stage_.memory.clear();
    wanted.wide = technique.g_buffer_bits == 32;
    Row row;
    row.scene = scene_.name;
    row.view = camera.name;
    row.technique = full_name(technique);
    row.lights = scene_.lights.size();
    const auto draw_once = [&](bool count) {
        wanted.count = count;
        stage_.begin(camera, wanted);
        technique.draw(stage_);
        return stage_.end();
    };
    // The first frame of each technique also compiles its programs and makes its textures, so it is not timed.
    const bool can_count = stage_.glsl() >= 430;
    draw_once(can_count);
    if (can_count) row.evaluations = stage_.evaluations(), row.words = stage_.words();
    const bool is_first = has_programs_.insert(row.technique).second;
    if (can_count && timed_frames > 0 && is_first) draw_once(false);
    std::vector<std::vector<Pass>> frames;
    for (int i = 0; i < timed_frames; ++i)
        frames.push_back(draw_once(false));
    picture_ = stage_.read_picture();
    row.pixels = picture_.size() / 4;
    row.bytes = stage_.memory.bytes();
    if (frames.empty()) return row;

    std::vector<double> sums(frames.size());
    for (std::size_t i = 0; i < frames.front().size(); ++i) {
        std::vector<double> pass;
        for (std::size_t k = 0; k < frames.size(); ++k) {
            pass.push_back(frames[k][i].milliseconds);
            sums[k] += pass.back();
        }
        row.passes.emplace_back(frames.front()[i].name, times_of(pass));
    }
    row.frame = times_of(sums);
    return row;
}

void Runner::compare(Row& row) const {
    for (std::size_t i = 0; i < picture_.size(); i += 4) {
        int largest = 0;
        for (std::size_t k = i; k < i + 3; ++k)
            largest = std::max(largest, std::abs(picture_[k] - reference_[k]));
        row.different += largest > 0;
        row.difference = std::max(row.difference, largest);
    }
}
