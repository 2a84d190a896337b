// SPDX-License-Identifier: MIT
#include "plan.hpp"

#include "cases.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <utility>

namespace {

void add(SceneJobs& scene, const std::string& table, const std::vector<Camera>& cameras,
         const std::vector<Technique>& techniques, const Settings& settings = {}) {
    for (const Camera& camera : cameras)
        scene.jobs.push_back({table, camera, techniques, settings});
}

template <class T> std::vector<T> every(std::size_t step, const std::vector<T>& all) {
    std::vector<T> some;
    for (std::size_t i = 0; i < all.size(); i += step)
        some.push_back(all[i]);
    return some;
}

constexpr std::size_t views_of_a_path = 10;  // a file of so many views or more is a camera's path

// Whether a camera path is also drawn with few lights, which move along the positions of the scene's many lights.
enum class FewLights { no, along_a_path };

void add_scene(std::vector<SceneJobs>& plan, const Scene& scene, std::vector<Camera> views,
               FewLights with_few_lights, bool quick) {
    const bool is_path = views.size() >= views_of_a_path;
    if (is_path) std::ranges::stable_sort(views, {}, [](const Camera& c) { return frame_of(c.name); });
    const std::vector<Camera> some = every(is_path ? (quick ? 5 : 1) : 2, views);
    const std::vector<Technique> all = every_technique();
    SceneJobs own{scene, {}}, few{scene, {}};
    if (is_path) {
        add(own, "path", some, all);
        const double first = frame_of(views.front().name), last = frame_of(views.back().name);
        for (const Camera& camera : some) {
            if (with_few_lights == FewLights::no) break;
            const double time = last > first ? (frame_of(camera.name) - first) / (last - first) : 0;
            few.jobs.push_back({"path with few lights", camera, all, {}, few_lights(scene.lights, time)});
        }
    } else {
        add(own, "from within", some, all);
    }
    add(own, "from above", {camera_from_above(scene, views)}, all);
    for (SceneJobs& jobs : {std::ref(own), std::ref(few)})
        if (!jobs.jobs.empty()) plan.push_back(std::move(jobs));
}

// Adds the scene of a file. Spots become points and other lights are left out: techniques are compared on points.
void add_file(std::vector<SceneJobs>& plan, const std::string& file, bool quick) {
    Scene scene = load_glb(file, 0.05f);
    scene.suns.clear();
    for (Light& light : scene.lights)
        light.spot = false;
    const auto orthographic = std::erase_if(scene.cameras, [](const Camera& c) { return c.orthographic; });
    if (orthographic > 0)
        std::printf("%s: %s left out\n", scene.name.c_str(),
                    counted(orthographic, "orthographic view").c_str());
    if (scene.cameras.empty()) scene.cameras = {framing_camera(scene.triangles)};
    // The scene's robots carry these lights, which are in the order of the robots' paths.
    add_scene(plan, scene, scene.cameras, FewLights::along_a_path, quick);
}

}  // namespace

std::vector<SceneJobs> make_plan(const std::vector<std::string>& files, bool quick) {
    std::vector<SceneJobs> plan;
    Scene made = make_scene(1024);
    const std::vector<Camera> flight = made_flight(views_of_a_path),
                              still = {made.cameras[0], made.cameras[1]};
    add_scene(plan, made, flight, FewLights::no, quick);
    for (const std::size_t lights : {128u, 1024u}) {
        SceneJobs random{with_random_lights(made, lights), {}};
        add(random, "random lights", still, every_technique());
        plan.push_back(std::move(random));
    }
    for (const int lights : {64, 256, 1000, 4000}) {
        SceneJobs some{make_scene(lights), {}};
        some.scene.name += ", " + std::to_string(lights) + " lights";
        add(some, lists_and_masks, still, without_pre_pass());
        plan.push_back(std::move(some));
    }
    for (const std::string& file : files)
        add_file(plan, file, quick);
    return plan;
}
