// SPDX-License-Identifier: MIT
// The other error of tiled shading: a light ends at its range, where inverse-square light never does. How
// much picture is lost against what the shorter lists save, by the cutoff: the illuminance at which a light
// is ended, so range = sqrt(intensity / cutoff). Writes cutoff.csv, which plot.gp draws.
//
// White surfaces (Lambert) under the scene's lights, their intensity the square of the scene's range, without
// shadows, at 480 x 270. The reference sums every light everywhere, I cos / max(d^2, 0.01^2). Against it:
//   hard     the same up to the range and nothing beyond it
//   smooth   times (1 - (d / range)^4)^2, which ends without an edge (Karis, "Real Shading in Unreal Engine
//            4", 2013; Lagarde and de Rousiers, "Moving Frostbite to PBR", 2014)
// Linear light; 1 is white, which 95 % of the drawn pixels of the reference do not exceed.
//
// Columns: cutoff as a part of white; rmse, largest: of the difference; lost: its mean, the picture's missing
// light; rmse_lifted: rmse after adding that mean to every pixel, as an ambient term can; evals: lights in a
// pixel's list, of 16-pixel tiles at 1920 x 1080; build_us: of those lists; us: of them and of shading the
// 480 x 270 picture from lists of the same cells, on one core.
//
// What to take. Where ranges are part of what an artist makes, there is no error; a cutoff is for lights that
// come as intensities. Take the smooth window: the hard one is as near to the reference with twice the
// cutoff, but each of its edges is a step of the cutoff's size, to be seen from about a hundredth of white
// on. What is lost is not one light's tail but those of hundreds, nearly the same everywhere, so halving the
// cutoff costs 1.6 to 2.5 times the evaluations and takes off only 17 to 45 % of the error, while one
// constant takes off more than half. So white / 64 with the mean put back as ambient (17 to 26 evaluations in
// these scenes, rmse 0.05 to 0.13) is nearer to unbounded lights than white / 256 without (50 to 92
// evaluations, 0.10 to 0.18); from white / 256 on no light's own loss is more than a step of 8 bits.
// Unbounded lights shine through walls, though: much of what is lost should be.
#include "arguments.hpp"
#include "glb_scenes.hpp"
#include "ladder.hpp"

#include <glm/geometric.hpp>

#include <exception>

namespace {

constexpr lightbin::Extent small = {480, 270};
constexpr Method method = {Footprint::rectangle, DepthTest::box};

/// What a picture's drawn pixels are lit from.
struct Surface {
    std::vector<std::size_t> pixel;
    std::vector<float> x, y, z, normal_x, normal_y, normal_z;

    Surface(const BenchScene& scene, const Picture& picture) {
        const Frustum frustum(scene.projection);
        for (int py = 0, i = 0; py < picture.size.height; ++py)
            for (int px = 0; px < picture.size.width; ++px, ++i) {
                const std::size_t at = static_cast<std::size_t>(i);
                if (picture.triangle[at] == Picture::nothing) continue;
                const glm::vec3 point = point_at(frustum, picture.size, px, py, picture.view_depth[at]);
                const glm::vec3* const corner = &scene.triangles[3 * std::size_t{picture.triangle[at]}];
                glm::vec3 normal = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
                if (glm::dot(normal, point) > 0) normal = -normal;  // both sides are drawn
                pixel.push_back(at);
                x.push_back(point.x), y.push_back(point.y), z.push_back(point.z);
                normal_x.push_back(normal.x), normal_y.push_back(normal.y), normal_z.push_back(normal.z);
            }
    }

    std::size_t size() const { return pixel.size(); }
};

enum class Window { none, hard, smooth };
constexpr const char* window_names[] = {"none", "hard", "smooth"};

/// What one light gives pixel i of the surface; light.w is its range.
template <Window window>
float light_at(const Surface& surface, std::size_t i, const glm::vec4& light, float intensity) {
    const float dx = light.x - surface.x[i], dy = light.y - surface.y[i], dz = light.z - surface.z[i];
    const float squared = std::max(dx * dx + dy * dy + dz * dz, 1e-4f);
    const float along = dx * surface.normal_x[i] + dy * surface.normal_y[i] + dz * surface.normal_z[i];
    const float lit = intensity * std::max(along, 0.0f) / (squared * std::sqrt(squared));
    if constexpr (window == Window::none) return lit;
    const float part = squared / (light.w * light.w), rest = std::max(1 - part * part, 0.0f);
    if constexpr (window == Window::hard) return part < 1 ? lit : 0;
    return lit * rest * rest;
}

std::vector<float> reference(const Surface& surface, const Lights& lights) {
    std::vector<float> sum(surface.size());
    for (const glm::vec4& light : lights)
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += light_at<Window::none>(surface, i, light, light.w * light.w);
    return sum;
}

template <Window window, class Grid>
void shade(const Surface& surface, const TiledView& view, const Lights& lights,
           const std::vector<float>& intensity, const Grid& grid, std::vector<float>& sum) {
    const int t = view.view.tile_size();
    for (std::size_t i = 0; i < sum.size(); ++i) {
        const int pixel = static_cast<int>(surface.pixel[i]);
        float light = 0;
        for (const std::uint32_t id : grid.lights_in(pixel % small.width / t, pixel / small.width / t))
            light += light_at<window>(surface, i, lights[id], intensity[id]);
        sum[i] = light;
    }
}

struct Difference {
    double rmse = 0, largest = 0, lost = 0, rmse_lifted = 0;
};
Difference compare(const std::vector<float>& picture, const std::vector<float>& truth, double white) {
    Difference d;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double less = static_cast<double>(truth[i] - picture[i]) / white;
        d.lost += less, d.rmse += less * less, d.largest = std::max(d.largest, std::fabs(less));
    }
    d.lost /= static_cast<double>(truth.size()), d.rmse /= static_cast<double>(truth.size());
    d.rmse_lifted = std::sqrt(d.rmse - d.lost * d.lost);
    d.rmse = std::sqrt(d.rmse);
    return d;
}

Lights with_cutoff(Lights lights, double cutoff) {
    for (glm::vec4& light : lights)
        light.w = lightbin::light_range(light.w * light.w, static_cast<float>(cutoff));
    return lights;
}

/// One scene: the reference, then each cutoff.
void study(const BenchScene& scene, bool quick, std::FILE* csv) {
    const Picture picture = rasterise(scene, small);
    const TiledView large(scene, rasterise(scene, screen), 16), view(scene, picture, 4);
    const Surface surface(scene, picture);
    const Lights lights = scene.lights(0);
    std::vector<float> intensity;
    for (const glm::vec4& light : lights)
        intensity.push_back(light.w * light.w);
    const std::vector<float> truth = reference(surface, lights);
    std::vector<float> sorted = truth;
    std::sort(sorted.begin(), sorted.end());
    const double white = static_cast<double>(sorted[sorted.size() * 95 / 100]);

    Bin<method> bin;
    std::vector<float> sum(surface.size());
    for (int k = 2; k <= (quick ? 256 : 4096); k *= 2) {
        const Lights ranged = with_cutoff(lights, white / k);
        std::vector<double> builds, shadings[2];
        for (std::uint32_t seed = 1; seed <= (quick ? 4 : 24); ++seed) {
            const Lights set = with_cutoff(scene.lights(seed), white / k);
            builds.push_back(seconds([&] { bin(large, set); }));
        }
        const double evaluations = large.evaluations(bin(large, ranged).ranges());

        const auto grid = bin(view, ranged);
        Difference differences[2];
        double spent = 0;
        for (int turn = 0; turn < 9 && spent < 0.3; ++turn) {
            shadings[0].push_back(
                seconds([&] { shade<Window::hard>(surface, view, ranged, intensity, grid, sum); }));
            if (turn == 0) differences[0] = compare(sum, truth, white);
            shadings[1].push_back(
                seconds([&] { shade<Window::smooth>(surface, view, ranged, intensity, grid, sum); }));
            if (turn == 0) differences[1] = compare(sum, truth, white);
            spent += shadings[0].back() + shadings[1].back();
        }
        for (const int window : {0, 1}) {
            const Difference& d = differences[window];
            const double build = 1e6 * median(builds), us = build + 1e6 * median(shadings[window]);
            std::fprintf(csv, "%s,%zu,%s,%.6f,%.1f,%.0f,%.6f,%.6f,%.6f,%.6f,%.3f\n", scene.name.c_str(),
                         lights.size(), window_names[window + 1], 1.0 / k, build, us, d.rmse, d.largest,
                         d.lost, d.rmse_lifted, evaluations);
            std::printf("%-12s %-6s white/%-4d  rmse %.4f (lifted %.4f)  largest %.4f  evals %7.2f of %zu  "
                        "build %7.1f us, with shading %8.0f us\n",
                        scene.name.c_str(), window_names[window + 1], k, d.rmse, d.rmse_lifted, d.largest,
                        evaluations, lights.size(), build, us);
        }
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) try {
    Arguments arguments(argc, argv);
    const bool quick = arguments.take("--quick");

    std::FILE* const csv = open_report(
        "cutoff.csv", "scene,lights,window,cutoff,build_us,us,rmse,largest,lost,rmse_lifted,evals");
    for (const BenchScene& scene : {scenes::field_with_depth(), scenes::street(), scenes::corridor()})
        study(scene, quick, csv);
    for (const std::string& path : arguments.scenes_or_fixtures())
        study(glb_scenes(path).front(), quick, csv);
    std::fclose(csv);
} catch (const std::exception& problem) {
    std::fprintf(stderr, "cutoff: %s\n", problem.what());
    return EXIT_FAILURE;
}
