// SPDX-License-Identifier: MIT
// formulas LIGHTS_A_FAMILY: how far off, at worst, are the screen bounds of spheres by our formulas and by the
// textbooks', all in float32 (ours in double where the library is), against quadruple precision? On the perspective
// cameras and lights of the families; a line a family.
#include "families.hpp"

#include <lightbin/project.hpp>

#include <quadmath.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

using namespace oracle;

namespace {

using Quad = __float128;

struct Slopes {
    double low, high;
};

// In the (c, z) plane: a disc of centre (c, z) and radius r, z - r > near, or cut by z = near.

/// The largest slope: the tangent's if the disc is whole or it touches beyond the near plane, else the corner's.
Quad true_slope(Quad c, Quad z, Quad r, Quad n, bool cut) {
    const Quad t2 = (fabsq(c) - r) * (fabsq(c) + r) + z * z;
    if (t2 > 0 && (c < 0 || z > r)) {
        const Quad t = sqrtq(t2),
                   s = c >= 0 ? (c * z + r * t) / ((z - r) * (z + r)) : (r - c) * (r + c) / (r * t - c * z);
        if (!cut || z - r * s / sqrtq(1 + s * s) >= n) return s;
    }
    const Quad w = n - z, h2 = (r - w) * (r + w);
    return (c + sqrtq(h2 > 0 ? h2 : 0)) / n;
}

/// The library's, but for the margin in tiles.
Slopes ours(float c, float z, float r, float n) {
    namespace scalar = lightbin::detail::scalar;
    const float size = 2 * std::abs(c) + std::abs(z) + r;
    const double c2 = static_cast<double>(c), z2 = static_cast<double>(z), r2 = static_cast<double>(r);
    if (size <= 0x1p40f && r >= 0x1p-40f && z - r > std::max(n, 0x1p-40f)) {
        float low, high;
        const float e = (z - r) * (z + r);
        scalar::tangent_slopes(c, z, r, e, 1 / e, low, high);
        return {static_cast<double>(low), static_cast<double>(high)};
    }
    Slopes slopes;
    const double e = (z2 - r2) * (z2 + r2);
    if (z2 - r2 > static_cast<double>(n))
        scalar::tangent_slopes(c2, z2, std::max(r2, 0x1p-400), e, 1 / e, slopes.low, slopes.high);
    else
        scalar::clipped_slopes(c2, z2, std::max(r2, 0x1p-400), static_cast<double>(n), slopes.low,
                               slopes.high);
    return slopes;
}

/// Mara and McGuire, "2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D Sphere", JCGT 2(2), 2013: the
/// centre turned by the tangent's angle, cut at the near plane.
Slopes mara_mcguire(float c, float z, float r, float n) {
    const float d2 = c * c + z * z, t2 = d2 - r * r;
    const bool inside = !(t2 > 0), cut = z - r <= n;
    const float cosine = std::sqrt(t2) / std::sqrt(d2), sine = r / std::sqrt(d2);
    const float h = std::sqrt(std::max(r * r - (n - z) * (n - z), 0.0f));
    const auto bound = [&](float sign) {
        const float x = cosine * (cosine * c + sign * sine * z), y = cosine * (cosine * z - sign * sine * c);
        if (cut && (inside || y < n)) return static_cast<double>((c + sign * h) / n);
        return static_cast<double>(x / y);
    };
    return {bound(-1), bound(1)};
}

/// The roots of  (z^2 - r^2) s^2 - 2 c z s + c^2 - r^2 = 0.
Slopes quadratic(float c, float z, float r, float) {
    const float root = r * std::sqrt(c * c + z * z - r * r), e = z * z - r * r;
    return {static_cast<double>((c * z - root) / e), static_cast<double>((c * z + root) / e)};
}

/// The tangent planes' normals (Lengyel, "Mathematics for 3D Game Programming", 2002; Lauritzen, "Deferred Rendering
/// for Current and Future Rendering Pipelines", SIGGRAPH 2010).
Slopes lengyel_lauritzen(float c, float z, float r, float) {
    const float d2 = c * c + z * z, root = std::sqrt(r * r * c * c - d2 * (r * r - z * z));
    const auto bound = [&](float sign) {
        const float nx = (r * c + sign * root) / d2, nz = (r - nx * c) / z;
        return static_cast<double>(-nz / nx);
    };
    const double a = bound(-1), b = bound(1);
    return {std::min(a, b), std::max(a, b)};
}

struct Method {
    const char* name;
    Slopes (*slopes)(float c, float z, float r, float n);
    bool cuts;  ///< knows a near plane
};
constexpr std::array<Method, 4> methods = {{{"ours", ours, true},
                                            {"Mara-McGuire", mara_mcguire, true},
                                            {"quadratic", quadratic, false},
                                            {"Lengyel-Lauritzen", lengyel_lauritzen, false}}};

struct Worst {
    std::uint64_t bounds = 0;  ///< a light's end along an axis, with the truth inside the viewport
    std::uint64_t missed = 0;  ///< of these, ends that leave out a tile that the truth is in; or NaN
    double ulps = 0, pixels = 0;
    std::uint64_t endless = 0;  ///< ends said to be unbounded
};

/// One end of one light, towards smaller (side -1) or larger coordinates.
void compare(Worst& worst, const lightbin::detail::ImageAxis& axis, int tile_size, Quad truth, double slope,
             int side, bool with_margin) {
    const Quad place = truth * static_cast<Quad>(axis.scale) + static_cast<Quad>(axis.offset);
    if (!(place >= 0 && place <= static_cast<Quad>(axis.limit))) return;
    ++worst.bounds;
    if (std::isinf(slope) && (slope > 0) == (side > 0)) {
        ++worst.endless;
        return;
    }
    const float at =
        static_cast<float>(slope) * static_cast<float>(axis.scale) + static_cast<float>(axis.offset);
    const float margin = with_margin ? axis.margin : 0;
    const Quad tile = floorq(place);
    const float end = std::floor(side < 0 ? at - margin : at + margin);
    if (!(side < 0 ? static_cast<Quad>(end) <= tile : static_cast<Quad>(end) >= tile)) ++worst.missed;
    if (!std::isfinite(slope)) return;
    const Quad error = fabsq(static_cast<Quad>(slope) - truth);
    int exponent = 0;
    frexpq(truth, &exponent);
    if (truth != 0) worst.ulps = std::max(worst.ulps, static_cast<double>(ldexpq(error, 24 - exponent)));
    const Quad pixels = fabsq(static_cast<Quad>(at) - place) * tile_size;
    worst.pixels = std::max(worst.pixels, static_cast<double>(pixels));
}

void run(const Family& family, double lights) {
    std::array<std::array<Worst, 2>, methods.size()> worst;  // method; whole or cut
    for (std::uint64_t seed = 0; static_cast<double>(seed * family.lights) < lights; ++seed) {
        Random random(seed_of(family.name) + seed * 0x9e3779b97f4a7c15u + 1);
        const Scene scene = family.make(random, family.lights);
        const Camera& camera = scene.camera;
        const auto view = lightbin::View::from_projection(
            camera.m, {camera.width, camera.height},
            {.tile_size = camera.tile,
             .clip_depth = camera.zero_to_one ? lightbin::ClipDepth::zero_to_one
                                              : lightbin::ClipDepth::minus_one_to_one,
             .origin = camera.upper_left ? lightbin::WindowOrigin::upper_left
                                         : lightbin::WindowOrigin::lower_left});
        if (!view || view->orthographic()) continue;
        const auto& constants = lightbin::detail::camera_of(*view);
        const float n = constants.near_depth;
        for (const Light& light : scene.lights) {
            const float z = constants.z_sign * light.z, r = light.w;
            if (is_bad(light) || std::isinf(r)) continue;
            if (static_cast<double>(z) + static_cast<double>(r) < static_cast<double>(n)) continue;
            const bool cut = !(static_cast<double>(z) - static_cast<double>(r) > static_cast<double>(n));
            for (const auto& [axis, v] : {std::pair(constants.x, light.x), std::pair(constants.y, light.y)}) {
                const float c = axis.sign * v;
                const Quad high = true_slope(c, z, r, n, cut), low = -true_slope(-c, z, r, n, cut);
                for (std::size_t i = 0; i < methods.size(); ++i) {
                    if (cut && !methods[i].cuts) continue;
                    const Slopes slopes = methods[i].slopes(c, z, r, n);
                    compare(worst[i][cut], axis, camera.tile, low, slopes.low, -1, i == 0);
                    compare(worst[i][cut], axis, camera.tile, high, slopes.high, 1, i == 0);
                }
            }
        }
    }
    for (const int cut : {0, 1}) {
        const std::size_t known = cut ? 2 : methods.size();
        if (worst[0][static_cast<std::size_t>(cut)].bounds == 0) continue;
        std::printf("| %s%s | %.3g", family.name.c_str(), cut ? ", cut by the near plane" : "",
                    static_cast<double>(worst[0][static_cast<std::size_t>(cut)].bounds));
        for (std::size_t i = 0; i < methods.size(); ++i) {
            const Worst& w = worst[i][static_cast<std::size_t>(cut)];
            if (i < known)
                std::printf(" | %.3g | %.2g | %llu", w.ulps, w.pixels,
                            static_cast<unsigned long long>(w.missed));
            else
                std::printf(" | | |");
        }
        std::printf(" |\n");
    }
    std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
    const double lights = count > 1 ? std::atof(words[1]) : 0;
    if (lights < 1) return 2;
    std::printf("| family | bounds");
    for (const Method& method : methods)
        std::printf(" | %s: ulps | px | missed", method.name);
    std::printf(" |\n| --- | ---");
    for (std::size_t i = 0; i < methods.size(); ++i)
        std::printf(" | --- | --- | ---");
    std::printf(" |\n");
    for (const Family& family : all_families())
        run(family, lights);
}
