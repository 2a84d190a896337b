// Footprints as the projection leaves them: the same in all tiers and with any number of threads, and row spans
// that no tile of the sphere is outside of.
#include "scene.hpp"

#include <array>
#include <cstring>
#include <string>
#include <tuple>

using namespace lightbin;

namespace {

using Silhouettes = Footprints<Footprint::silhouette, false>;

/// Cameras and lights of every order of magnitude; some lights touch the eye's plane or hold the eye, some are
/// bad.
struct Scene {
    View view;
    std::vector<glm::vec4> lights;
};

Scene wild_scene(std::uint32_t seed, std::size_t count) {
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto some = [&](double low, double high) { return static_cast<float>(between(low, high)); };
    const auto near = static_cast<float>(std::exp(between(-40, 0)));
    const glm::mat4 projections[] = {
        glm::ortho(-20.0f, 20.0f, -10.0f, 10.0f, 0.0f, 100.0f),
        glm::perspective(some(0.01, 3.1), some(0.3, 3), near, 1000.0f),
        glm::frustum(-some(0, 1), some(0.01, 3), -0.5f, 1.0f, 1.0f, 100.0f),
        glm::infinitePerspective(1.0f, 1.5f, 1e-3f),
    };
    const Extent viewport = {static_cast<int>(between(1, 1500)), static_cast<int>(between(1, 1000))};
    const int tile_size = static_cast<int>(between(2, 60));
    Scene scene = {*View::from_projection(projections[seed % 4], viewport, {.tile_size = tile_size}), {}};
    const double scale = std::exp(between(-3, 4));
    for (std::size_t i = 0; i < count; ++i) {
        const double z = between(-60, 100), side = std::exp(between(-2, 1)) * (std::fabs(z) + 2);
        glm::vec4 light = {some(-1, 1) * side, some(-1, 1) * side, -z, scale * std::exp(between(-1.5, 1.5))};
        switch (static_cast<int>(between(0, 60))) {
        case 0:
            light *= static_cast<float>(std::exp(between(-90, 90)));
            break;
        case 1:
            light.w = 0;
            break;
        case 2:
            light.w = HUGE_VALF;
            break;
        case 3:
            light.w = std::fabs(light.z);  // touches the eye's plane
            break;
        case 4:
            light.w = std::hypot(light.x, light.y, light.z);  // the eye on the surface
            break;
        case 5:
            light.x = light.y = 0;
            break;
        case 6:
            light[static_cast<int>(between(0, 3.9))] = std::nanf("");
            break;
        case 7:
            light.w = -1;
            break;
        default:
            break;
        }
        scene.lights.push_back(light);
    }
    return scene;
}

/// Everything that the projection says, light by light.
std::vector<std::uint32_t> words(const Silhouettes& footprints) {
    const detail::FootprintArrays& a = footprints.arrays();
    std::vector<std::uint32_t> all = {footprints.visible(), footprints.rejected(),
                                      static_cast<std::uint32_t>(footprints.area())};
    for (const detail::FootprintRun& run : footprints.runs())
        for (std::uint32_t i = run.begin; i < run.end; ++i) {
            all.insert(all.end(), {a.ids[i], a.x0[i], a.y0[i], a.x1[i], a.y1[i]});
            const bool whole = a.span_begin[i] == detail::FootprintArrays::whole_rectangle;
            all.push_back(whole);
            for (std::uint32_t row = 0; !whole && row <= a.y1[i] - std::uint32_t{a.y0[i]}; ++row) {
                const detail::RowSpan span = a.spans[a.span_begin[i] + row];
                all.insert(all.end(), {span.first, span.last});
            }
        }
    return all;
}

/// Least squared distance from a point to the part of space seen through the window [u0, u1] x [v0, v1] of slopes
/// (orthographic: coordinates), by the stationary points of a convex function of depth.
long double distance2(bool orthographic, const std::array<long double, 3>& c,
                      const std::array<long double, 4>& window) {
    const long double u0 = window[0], u1 = window[1], v0 = window[2], v1 = window[3];
    const auto outside = [](long double v, long double low, long double high) {
        return v < low ? low - v : v > high ? v - high : 0.0L;
    };
    const auto at = [&](long double z) {
        z = orthographic ? 1 : (std::max)(z, 0.0L);
        const long double x = outside(c[0], u0 * z, u1 * z), y = outside(c[1], v0 * z, v1 * z),
                          along = orthographic ? 0 : z - c[2];
        return x * x + y * y + along * along;
    };
    long double least = at(0);
    for (const long double u : {0.0L, u0, u1})
        for (const long double v : {0.0L, v0, v1})
            least = (std::min)(least, at((c[2] + u * c[0] + v * c[1]) / (1 + u * u + v * v)));
    return least;
}

}  // namespace

TEST_CASE("all tiers project to the same bytes") {
    for (std::uint32_t seed = 0; seed < 120; ++seed) {
        const Scene scene = wild_scene(seed, seed * 7);
        Silhouettes footprints;
        footprints.project(Isa::scalar, scene.view, view_space(scene.lights), {});
        const auto expected = words(footprints);
        for (const Isa isa : test::machine_tiers()) {
            footprints.project(isa, scene.view, view_space(scene.lights), {});
            CHECK((words(footprints) == expected));
        }
    }
}

TEST_CASE("all tiers project lights that all but touch the sides of the view to the same bytes") {
    std::mt19937 random(5);
    const auto between = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    for (int camera = 0; camera < 40; ++camera) {
        const float slope = std::exp(between(-2, 1)), slant = std::hypot(slope, 1.0f);
        const auto projection = glm::perspective(2 * std::atan(slope), 1.0f, 0.1f, 1000.0f);
        const View view = *View::from_projection(projection, {1000, 1000}, {.tile_size = 20});
        std::vector<glm::vec4> lights(2000);
        for (glm::vec4& light : lights) {
            const float depth = std::exp(between(0, 6)), radius = depth * std::exp(between(-6, 0)),
                        aside = depth * slope + radius * slant + depth * between(0, 0x1p-19f);
            light = {camera % 2 == 0 ? aside : 0, camera % 2 == 0 ? 0 : -aside, -depth, radius};
        }
        Silhouettes footprints;
        footprints.project(Isa::scalar, view, view_space(lights), {});
        const auto expected = words(footprints);
        for (const Isa isa : test::machine_tiers()) {
            footprints.project(isa, view, view_space(lights), {});
            CHECK((words(footprints) == expected));
        }
    }
}

TEST_CASE("threads project to the same bytes") {
    const Scene scene = wild_scene(3, 40000);
    Silhouettes footprints;
    const Isa isa = test::widest_tier();
    footprints.project(isa, scene.view, view_space(scene.lights), {});
    CHECK(footprints.runs().size() == 1);
    const auto expected = words(footprints);
    for (const std::size_t workers : {2u, 3u, 64u}) {
        footprints.project(isa, scene.view, view_space(scene.lights), {workers, test::backwards, 0});
        CHECK(footprints.runs().size() > 1);
        CHECK((words(footprints) == expected));
    }
}

TEST_CASE("a row span leaves out no tile that the sphere is seen in, and little else") {
    // The cameras' scales and offsets are exact, so the windows below are.
    std::size_t rows = 0, spanned = 0, seen = 0, misses = 0;
    const bool few = test::share_of_cases(1) > 1;
    const std::uint32_t cameras = few ? 3 : 12;  // 3: one of each kind
    for (std::uint32_t seed = 0; seed < cameras; ++seed) {
        std::mt19937 random(seed);
        const auto between = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        const bool orthographic = seed % 3 == 2;
        const double zoom = std::exp2(std::floor(between(-2, 3))), shift = seed % 2 == 0 ? 0 : 0.5 * seed;
        glm::mat4 projection = orthographic ? glm::ortho(-16.0, 16.0, -16.0, 16.0, 0.0, 100.0)
                                            : glm::infinitePerspective(1.0, 1.0, 0.125);
        projection[0][0] = static_cast<float>(orthographic ? zoom / 16 : zoom);
        projection[1][1] = projection[0][0];
        projection[orthographic ? 3 : 2][0] = static_cast<float>(shift);
        const View view = *View::from_projection(projection, {512, 512}, {.tile_size = 8});
        const auto edge_x = [&](int x) {
            return ((x / 32.0L - 1) + (orthographic ? -shift : shift)) /
                   static_cast<long double>(projection[0][0]);
        };
        const auto edge_y = [&](int y) {
            return (y / 32.0L - 1) / static_cast<long double>(projection[1][1]);
        };

        std::vector<Sphere> lights(few ? 100 : 400);
        for (Sphere& light : lights) {
            // A point of the image, a corner of tiles more often than not, and a sphere that touches the ray there.
            const bool corner = between(0, 3) > 1;
            const double tx = between(-5, 70), ty = between(-5, 70), depth = std::exp(between(0, 5));
            const auto u =
                static_cast<double>(edge_x(0) + (edge_x(1) - edge_x(0)) * (corner ? std::floor(tx) : tx));
            const auto v =
                static_cast<double>(edge_y(0) + (edge_y(1) - edge_y(0)) * (corner ? std::floor(ty) : ty));
            const double angle = between(0, 6.2831853),
                         radius = std::exp(between(-5, 0)) * (orthographic ? 20 : depth);
            const double away =
                orthographic ? 1 : std::sqrt(1 + std::pow(u * std::cos(angle) + v * std::sin(angle), 2));
            const double z = orthographic ? 1 : depth;
            light = {static_cast<float>(u * z + radius * away * std::cos(angle)),
                     static_cast<float>(v * z + radius * away * std::sin(angle)), static_cast<float>(-depth),
                     static_cast<float>(radius)};
        }
        if (orthographic)  // 3, 4, 5: touches corners exactly
            for (int i = 0; i < 40; ++i)
                lights.push_back({static_cast<float>(edge_x(20 + i % 7) + 3 * (edge_x(1) - edge_x(0))),
                                  static_cast<float>(edge_y(4 + i) + 4 * (edge_x(1) - edge_x(0))), -50,
                                  static_cast<float>(5 * (edge_x(1) - edge_x(0)))});
        Silhouettes footprints;
        footprints.project(test::widest_tier(), view, view_space(lights), {});
        const detail::FootprintArrays& a = footprints.arrays();
        for (std::uint32_t i = 0; i < footprints.visible(); ++i) {
            if (a.span_begin[i] == detail::FootprintArrays::whole_rectangle) continue;
            const Sphere& light = lights[a.ids[i]];
            const long double radius = light.radius, reach2 = radius * radius;
            for (int y = a.y0[i]; y <= a.y1[i]; ++y, ++rows) {
                const detail::RowSpan span =
                    a.spans[a.span_begin[i] + static_cast<std::uint32_t>(y - a.y0[i])];
                const auto met = [&](int x0, int x1) {
                    return distance2(orthographic, {light.x, light.y, -static_cast<long double>(light.z)},
                                     {edge_x(x0), edge_x(x1), edge_y(y), edge_y(y + 1)}) <= reach2;
                };
                REQUIRE((a.x0[i] <= span.first && span.first <= span.last && span.last <= a.x1[i]));
                misses += span.first > a.x0[i] && met(a.x0[i], span.first);
                misses += span.last < a.x1[i] && met(span.last + 1, a.x1[i] + 1);
                spanned += span.last - span.first + 1u;
                for (int x = span.first; x <= span.last; ++x)
                    seen += met(x, x + 1);
            }
        }
    }
    CHECK(misses == 0);
    CHECK(rows > 2 * (few ? 100 : 400) * cameras);
    CHECK(spanned < seen + seen / 100);
}
