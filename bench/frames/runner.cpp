// SPDX-License-Identifier: MIT
#include "runner.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>

namespace {

double median(std::vector<double> numbers) {
    const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
    std::ranges::nth_element(numbers, middle);
    return *middle;
}

}  // namespace

std::string LeftOut::key(const Technique& technique, int samples) {
    return technique.name + (technique.g_buffer_bits ? ", " + std::to_string(technique.g_buffer_bits) + " bit" : "") +
           (samples > 1 ? ", MSAA " + std::to_string(samples) : "");
}

void LeftOut::say(const Technique& technique, int samples, const std::string& why) {
    if (!names_.insert(key(technique, samples)).second) return;
    lines_.push_back(key(technique, samples) + " is left out: " + why);
    std::fprintf(stderr, "\r%s\n", lines_.back().c_str());
}

Runner::Runner(const Scene& scene, const RunSettings& settings, int glsl, LeftOut& left_out)
    : scene_(scene), run_(settings), stage_(scene, glsl), meter_(scene, glsl), left_out_(left_out),
      every_light_(forward_every_light()) {}

std::vector<Row> Runner::run(const std::string& table, const Camera& camera, std::vector<Technique> techniques,
                             Settings wanted) {
    wanted.width = run_.width;
    wanted.height = run_.height;
    wanted.tile_size = run_.tile_size;
    wanted.exposure = meter_.meter(camera, {});
    std::vector<Row> rows;
    reference_.clear();
    techniques.insert(techniques.begin(), every_light_);
    for (const Technique& technique : techniques) {
        const bool is_reference = reference_.empty();
        if (left_out_.has(technique, wanted.samples)) continue;
        try {
            if (technique.glsl > stage_.glsl()) throw std::runtime_error("it needs OpenGL 4.3");
            // The reference takes long. One frame will do.
            Row row = draw(technique, camera, wanted, is_reference ? 0 : run_.timed_frames);
            if (is_reference) reference_ = picture_;
            compare(row);
            row.table = table;
            rows.push_back(row);
        } catch (const std::exception& problem) {
            left_out_.say(technique, wanted.samples, problem.what());
            if (is_reference) return {};
        }
    }
    return rows;
}

Row Runner::draw(const Technique& technique, const Camera& camera, Settings wanted, int timed_frames) {
    stage_.memory.clear();
    wanted.wide = technique.g_buffer_bits == 32;
    Row row{.scene = scene_.name,
            .view = camera.name,
            .technique = technique.name,
            .g_buffer_bits = technique.g_buffer_bits,
            .samples = wanted.samples,
            .lights = scene_.lights.size()};
    const auto draw_once = [&](bool count) {
        wanted.count = count;
        stage_.begin(camera, wanted);
        technique.draw(stage_);
        return stage_.end();
    };
    const bool counts = stage_.glsl() >= 430;
    std::vector<std::vector<Pass>> frames;
    if (counts) {  // and what is made once is made
        frames.push_back(draw_once(true));
        row.evaluations = stage_.evaluations();
    }
    if (!counts || timed_frames > 0) frames.clear();
    for (int i = 0; i < std::max(timed_frames, counts ? 0 : 1); ++i)
        frames.push_back(draw_once(false));
    picture_ = stage_.read_picture();
    row.pixels = picture_.size() / 4;
    row.bytes = stage_.memory.bytes();

    std::vector<double> sums;
    for (const std::vector<Pass>& passes : frames) {
        double sum = 0;
        for (const Pass& pass : passes)
            sum += pass.milliseconds;
        sums.push_back(sum);
    }
    row.milliseconds = median(sums);
    row.least = std::ranges::min(sums);
    row.most = std::ranges::max(sums);
    for (std::size_t i = 0; i < frames.front().size(); ++i) {
        std::vector<double> times;
        for (const std::vector<Pass>& passes : frames)
            times.push_back(passes[i].milliseconds);
        row.passes.push_back({frames.front()[i].name, median(times)});
    }
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
