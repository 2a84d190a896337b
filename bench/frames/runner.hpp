// SPDX-License-Identifier: MIT
// Draws the frames of a scene by each technique, and measures them.
#pragma once

#include "stage.hpp"
#include "technique.hpp"

#include <renderer.hpp>

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// Times of several frames in milliseconds; 0 if they were not timed.
struct Times {
    double median = 0, least = 0, most = 0;
};

/// What was measured of one technique in one view.
struct Row {
    std::string table, scene, view, technique;  ///< the technique's name includes the bits of its G-buffer
    std::size_t lights = 0;
    std::uint64_t evaluations = 0, words = 0;  ///< 0 if this OpenGL can't count
    Times frame;
    std::vector<std::pair<std::string, Times>> passes;
    std::size_t bytes = 0;
    std::size_t pixels = 0;
    std::size_t different = 0;  ///< pixels that differ from the reference picture
    int difference = 0;         ///< largest difference of a colour component, of 255
    bool as_stated = true;      ///< the difference is within the technique's tolerance
};

/// What the run asks of all frames.
struct RunSettings {
    int width = 0, height = 0, tile_size = 0;
    int timed_frames = 3;
};

/// Messages about what is not drawn, and why; each is printed once.
class LeftOut {
public:
    void say(const std::string& who, const std::string& why);
    const std::vector<std::string>& lines() const { return lines_; }

private:
    std::vector<std::string> lines_;
};

/// One scene.
class Runner {
public:
    Runner(const Scene& scene, const RunSettings& settings, int glsl, LeftOut& left_out);

    /// Draws a view by every technique, after the reference picture, with these settings where a technique has none.
    std::vector<Row> run(const std::string& table, const Camera& camera,
                         const std::vector<Technique>& techniques, Settings wanted);

private:
    Row draw(const Technique& technique, const Camera& camera, Settings wanted, int timed_frames);
    void compare(Row& row) const;

    const Scene& scene_;
    RunSettings run_;
    Stage stage_;
    Renderer meter_;
    LeftOut& left_out_;
    Technique every_light_;
    std::set<std::string> has_programs_;
    std::vector<std::uint8_t> reference_, picture_;
};
