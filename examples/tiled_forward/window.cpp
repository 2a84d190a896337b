// SPDX-License-Identifier: MIT
#include "window.hpp"

#include "moving_lights.hpp"

#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>
#include <vector>

namespace {

// Ends GLFW, and with it the window, when it goes.
struct Glfw {
    bool running = glfwInit() == GLFW_TRUE;
    Glfw() = default;
    ~Glfw() { glfwTerminate(); }
    Glfw(const Glfw&) = delete;
    Glfw& operator=(const Glfw&) = delete;
};

GLFWwindow* open_window(const char* title, const FrameSettings& settings, int wanted_glsl, int& glsl) {
    for (const int version : {430, 330, 310, 300}) {
        const bool es = version < 330;
        if (wanted_glsl != version && (wanted_glsl != 0 || es)) continue;
        glfwWindowHint(GLFW_CLIENT_API, es ? GLFW_OPENGL_ES_API : GLFW_OPENGL_API);
        glfwWindowHint(GLFW_OPENGL_PROFILE, es ? GLFW_OPENGL_ANY_PROFILE : GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, es ? GLFW_FALSE : GLFW_TRUE);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, version / 100);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, version / 10 % 10);
        glsl = version;
        if (GLFWwindow* window = glfwCreateWindow(settings.width, settings.height, title, nullptr, nullptr))
            return window;
    }
    throw std::runtime_error("no usable OpenGL: no window with such a context can be opened");
}

// W A S D and Q E move, a held mouse button turns, shift hurries.
class FreeCamera {
public:
    FreeCamera(const Camera& start, double metres_per_second) : camera_(start), speed_(metres_per_second) {
        const glm::dvec3 forward = -glm::dvec3(start.to_world[2]);
        yaw_ = std::atan2(-forward.x, -forward.z);
        pitch_ = std::asin(std::clamp(forward.y, -1.0, 1.0));
    }

    void move(GLFWwindow* window, double seconds) {
        double x = 0, y = 0;
        glfwGetCursorPos(window, &x, &y);
        if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
            yaw_ -= 0.004 * (x - mouse_x_);
            pitch_ = std::clamp(pitch_ - 0.004 * (y - mouse_y_), -1.55, 1.55);
        }
        mouse_x_ = x;
        mouse_y_ = y;

        const glm::dmat4 turn =
            glm::rotate(glm::rotate(glm::dmat4(1), yaw_, glm::dvec3(0, 1, 0)), pitch_, glm::dvec3(1, 0, 0));
        const auto key = [&](int forth, int back) {
            return static_cast<double>(glfwGetKey(window, forth)) -
                   static_cast<double>(glfwGetKey(window, back));
        };
        const glm::dvec3 step(key(GLFW_KEY_D, GLFW_KEY_A), key(GLFW_KEY_E, GLFW_KEY_Q),
                              key(GLFW_KEY_S, GLFW_KEY_W));
        const double hurry = glfwGetKey(window, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ? 4 : 1;
        const glm::dvec3 place =
            glm::dvec3(camera_.to_world[3]) + glm::dmat3(turn) * step * (speed_ * hurry * seconds);
        camera_.to_world = turn;
        camera_.to_world[3] = glm::dvec4(place, 1);
    }

    const Camera& camera() const { return camera_; }

private:
    Camera camera_;
    double speed_;
    double yaw_ = 0, pitch_ = 0;
    double mouse_x_ = 0, mouse_y_ = 0;
};

// Sees a key go down: once, however long it stays there.
struct Tap {
    int key;
    bool is_down = false;

    bool happened(GLFWwindow* window) {
        const bool was_down = std::exchange(is_down, glfwGetKey(window, key) == GLFW_PRESS);
        return is_down && !was_down;
    }
};

// A light's range a second: a step that fits the scene, whatever its size.
double walking_speed(const Scene& scene) {
    std::vector<float> ranges;
    for (const Light& light : scene.lights)
        ranges.push_back(light.range);
    const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
    std::nth_element(ranges.begin(), middle, ranges.end());
    return std::isfinite(*middle) ? static_cast<double>(*middle) : 5.0;
}

}  // namespace

void show_in_window(Scene scene, int wanted_glsl, int view, FrameSettings settings, float exposure_stops,
                    bool heat_map) {
    const Glfw glfw;
    if (!glfw.running) return;
    int glsl = 0;
    GLFWwindow* const window = open_window(scene.name.c_str(), settings, wanted_glsl, glsl);
    glfwMakeContextCurrent(window);
    glfwSwapInterval(1);
    glfwSetInputMode(window, GLFW_STICKY_KEYS, GLFW_TRUE);  // a key tapped within a slow frame counts
    Renderer renderer(scene, glsl);

    std::printf("W A S D Q E: move (shift: faster), mouse button held: turn, 1-9: views, H: heat map, V: "
                "check the view, L: check "
                "the lists (what is wrong is magenta), space: stop or start the lights, Escape: end\n");
    const double speed = walking_speed(scene);
    FreeCamera walker(scene.cameras[0], speed);
    const auto go_to = [&](std::size_t index) {
        walker = FreeCamera(scene.cameras[index], speed);
        settings.exposure = renderer.meter(scene.cameras[index], settings) * std::exp2(exposure_stops);
    };
    go_to(static_cast<std::size_t>(view));

    const std::vector<Light> places = scene.lights;
    bool lights_move = true;
    double last = glfwGetTime(), last_title = 0, light_seconds = 0;
    Tap h{GLFW_KEY_H}, v{GLFW_KEY_V}, l{GLFW_KEY_L}, space{GLFW_KEY_SPACE};
    while (!glfwWindowShouldClose(window)) {
        glfwPollEvents();
        if (glfwGetKey(window, GLFW_KEY_ESCAPE) == GLFW_PRESS) break;
        if (h.happened(window)) heat_map = !heat_map;
        if (v.happened(window)) settings.checks.view = !settings.checks.view;
        if (l.happened(window)) settings.checks.lists = !settings.checks.lists;
        if (space.happened(window)) lights_move = !lights_move;
        for (int i = 0; i < 9; ++i)
            if (static_cast<std::size_t>(i) < scene.cameras.size() &&
                glfwGetKey(window, GLFW_KEY_1 + i) == GLFW_PRESS)
                go_to(static_cast<std::size_t>(i));
        const double now = glfwGetTime();
        walker.move(window, now - last);
        if (lights_move) light_seconds += now - last;
        move_lights(places, light_seconds, scene.lights);
        last = now;

        glfwGetFramebufferSize(window, &settings.width, &settings.height);
        if (settings.width < 1 || settings.height < 1) {  // minimised
            glfwWaitEventsTimeout(0.1);
            continue;
        }
        const FrameReport report = renderer.draw(walker.camera(), settings);
        if (heat_map) renderer.draw_heat_map(report, settings);
        renderer.show();
        glfwSwapBuffers(window);

        if (now - last_title > 0.5) {
            last_title = now;
            char title[160];
            std::snprintf(title, sizeof title,
                          "%s: %llu lights in view, %.1f evaluations a pixel, bin %.2f ms, draw %.1f ms",
                          scene.name.c_str(), static_cast<unsigned long long>(report.lights_in_view),
                          report.evaluations_per_pixel, report.milliseconds.bin, report.milliseconds.draw);
            glfwSetWindowTitle(window, title);
        }
    }
}
