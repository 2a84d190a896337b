// SPDX-License-Identifier: MIT
// Several views of one set of world-space lights in a frame, binned one after the other by one Binner.
#pragma once

#include "measure.hpp"
#include "world.hpp"

#include <lightbin/binner.hpp>

#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

/// Views of what a camera stands among: how each is turned or moved from the camera's own, and the lens of all.
struct SeveralViews {
    const char* name;
    Lens lens;
    std::vector<glm::mat4> from_camera;
};

/// 64 mm apart, where a unit is a metre.
inline SeveralViews two_eyes(const Lens& lens) {
    const auto shift = [](float x) { return glm::translate(glm::mat4(1), glm::vec3(x, 0, 0)); };
    return {"two eyes", lens, {shift(0.032f), shift(-0.032f)}};
}

/// The first looks where the camera does.
inline SeveralViews cube_faces() {
    Lens lens;
    lens.tan_half_height = 1;
    lens.screen = {1024, 1024};
    const auto turn = [](float degrees, glm::vec3 axis) {
        return glm::rotate(glm::mat4(1), glm::radians(degrees), axis);
    };
    const glm::vec3 up = {0, 1, 0}, right = {1, 0, 0};
    return {"six cube faces",
            lens,
            {glm::mat4(1), turn(90, up), turn(180, up), turn(270, up), turn(90, right), turn(-90, right)}};
}

struct SeveralViewsResult {
    std::string name, set, tier;
    std::size_t lights;
    double one, all;  ///< seconds: the first view's build, and all views'
};

/// In turns: the first view, and all of them, of another frame.
template <lightbin::Options options>
SeveralViewsResult time_several_views(const SeveralViews& views, const std::string& set, int tile_size,
                                      const std::vector<WorldFrame>& frames, double seconds_a_case) {
    const lightbin::View view = views.lens.view(tile_size);
    lightbin::Binner<options> binner;
    std::vector<double> one, all;
    const auto build = [&](std::size_t count, const WorldFrame& frame) {
        return seconds([&] {
            for (std::size_t i = 0; i < count; ++i)
                *binner.bin(view,
                            lightbin::world_space(frame.lights, views.from_camera[i] * frame.view_matrix));
        });
    };
    const double end = time_now() + 2 * seconds_a_case;
    for (std::size_t turn = 0; time_now() < end || turn < 5; ++turn) {
        one.push_back(build(1, frames[turn % frames.size()]));
        all.push_back(build(views.from_camera.size(), frames[(turn + frames.size() / 2) % frames.size()]));
    }
    return {views.name, set, to_string(options.isa), frames[0].lights.size(), median(one), median(all)};
}

inline void write_several_views_csv(const std::vector<SeveralViewsResult>& results, const char* path) {
    std::FILE* const csv = open_report(path, "set,n,views,tier,ms_first,ms_all");
    for (const SeveralViewsResult& r : results)
        std::fprintf(csv, "%s,%zu,%s,%s,%.4f,%.4f\n", r.set.c_str(), r.lights, r.name.c_str(), r.tier.c_str(),
                     1e3 * r.one, 1e3 * r.all);
    std::fclose(csv);
}
