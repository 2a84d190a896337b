// SPDX-License-Identifier: MIT
// The shaders' projection of lights, under the worst arithmetic that GLSL, Vulkan and WGSL allow: the text of the pass
// `project` is compiled as C++ over a number type whose sums and products are rounded up or down at will, whose
// quotients are off by up to 2.5 units in the last place, and whose roots are 1 / inversesqrt(x), with 2 such units in
// the latter. Every rectangle must hold the one that the Binner finds. With a margin of 2^-21 instead of the shaders'
// own, some must not.
//
// cull_twin [LIGHTS [BOXES]]   how many lights, and how many boxes, for each view, kind of light and arithmetic
#include <lightbin/box.hpp>
#include <lightbin/lightbin.hpp>
#include <lightbin/shader_cull.hpp>
#include <lightbin/spot.hpp>

#define GLM_FORCE_SWIZZLE
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

namespace {

enum class Rounding { nearest, up, down, either, anywhere };

Rounding rounding = Rounding::nearest;
std::uint64_t random_state = 88172645463325252u;

double uniform() {
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return static_cast<double>(random_state >> 11) / 9007199254740992.0;
}

/// Returns where between the limits of its error (-1 to 1) an operation's result lies.
double place() {
    return rounding == Rounding::up       ? 1
           : rounding == Rounding::down   ? -1
           : rounding == Rounding::either ? (uniform() < 0.5 ? -1 : 1)
                                          : 2 * uniform() - 1;
}

float rounded_sum(double exact) {
    const float nearest = static_cast<float>(exact);
    if (rounding == Rounding::nearest) return nearest;
    const bool up = place() > 0;
    const float infinity = std::numeric_limits<float>::infinity();
    if (up) return static_cast<double>(nearest) < exact ? std::nextafter(nearest, infinity) : nearest;
    return static_cast<double>(nearest) > exact ? std::nextafter(nearest, -infinity) : nearest;
}

float off_by(double exact, double units) {
    if (rounding == Rounding::nearest || exact == 0 || !std::isfinite(exact))
        return static_cast<float>(exact);
    int exponent = 0;
    std::frexp(exact, &exponent);
    return static_cast<float>(exact + place() * units * std::ldexp(1.0, exponent - 24));
}

struct Real {
    Real() = default;
    Real(double of) : v(static_cast<float>(of)) {}
    explicit operator std::uint32_t() const { return static_cast<std::uint32_t>(v); }
    static Real exact(float of) {
        Real r;
        r.v = of;
        return r;
    }
    double d() const { return static_cast<double>(v); }

    friend Real operator+(Real a, Real b) { return exact(rounded_sum(a.d() + b.d())); }
    friend Real operator-(Real a, Real b) { return exact(rounded_sum(a.d() - b.d())); }
    friend Real operator*(Real a, Real b) { return exact(rounded_sum(a.d() * b.d())); }
    friend Real operator/(Real a, Real b) { return exact(off_by(a.d() / b.d(), 2.5)); }
    friend Real operator-(Real a) { return exact(-a.v); }
    friend Real& operator+=(Real& a, Real b) { return a = a + b; }
    friend bool operator<(Real a, Real b) { return a.v < b.v; }
    friend bool operator>(Real a, Real b) { return a.v > b.v; }
    friend bool operator<=(Real a, Real b) { return a.v <= b.v; }
    friend bool operator>=(Real a, Real b) { return a.v >= b.v; }
    friend Real abs(Real a) { return exact(std::fabs(a.v)); }
    friend Real min(Real a, Real b) { return b.v < a.v ? b : a; }
    friend Real max(Real a, Real b) { return a.v < b.v ? b : a; }
    friend Real clamp(Real a, Real low, Real high) { return min(max(a, low), high); }
    friend Real sqrt(Real a) { return exact(off_by(1 / exact(off_by(1 / std::sqrt(a.d()), 2)).d(), 2.5)); }

    float v;  // without an initializer, as GLM keeps it in unions
};

std::uint32_t max(std::uint32_t a, std::uint32_t b) {
    return a < b ? b : a;
}

using uint = std::uint32_t;
using vec2 = glm::vec<2, Real>;
using vec3 = glm::vec<3, Real>;
using vec4 = glm::vec<4, Real>;
using glm::uvec2;
using glm::uvec4;

vec4 abs(const vec4& v) {
    return {abs(v.x), abs(v.y), abs(v.z), abs(v.w)};
}

Real uintBitsToFloat(uint bits) {
    return Real::exact(std::bit_cast<float>(bits));
}

// What the text reads and writes.
std::vector<uint> p_lights, p_scratch;
uvec4 p_grid;
vec4 p_axis_x, p_axis_y, p_signs, p_planes, p_origin, p_column_x, p_column_y, p_column_z, p_origin_image;
void p_mark(uint, uvec2, uvec2, uvec2) {}
void p_store_word(uint at, uint word) {
    p_scratch[at] = word;
}

#define xyz xyz()
#define xy xy()
#define zw zw()
#define float Real
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include "cull_twin_text.inc"
#pragma GCC diagnostic pop
#undef float
#undef xyz
#undef xy
#undef zw

using namespace lightbin;

void set_constants(const CullConstants& c, double margin) {
    const auto real = [](auto n) { return Real::exact(n); };
    p_grid = {c.tiles_x, c.tiles_y, 1, 0};
    p_axis_x = {real(c.scale_x), real(c.offset_x),
                real(static_cast<float>(static_cast<double>(c.margin_x) * margin)), real(c.limit_x)};
    p_axis_y = {real(c.scale_y), real(c.offset_y),
                real(static_cast<float>(static_cast<double>(c.margin_y) * margin)), real(c.limit_y)};
    p_signs = {real(c.sign_x), real(c.sign_y), real(c.sign_z), real(c.depth_margin)};
    p_planes = {real(c.near_depth), real(c.front), real(c.back), real(c.near_fast)};
    const auto column = [&](const auto& three, auto fourth) {
        return vec4{real(three[0]), real(three[1]), real(three[2]), real(fourth)};
    };
    p_origin = column(c.origin, c.stretch);
    p_column_x = column(c.column_x, c.error_rate);
    p_column_y = column(c.column_y, c.error_at_origin);
    p_column_z = column(c.column_z, c.cone_error);
    p_origin_image = column(c.origin_image, c.max_distance);
}

class LightMaker {
public:
    LightMaker(unsigned seed, const View& view) : engine_(seed), camera_(detail::camera_of(view)) {}

    /// Returns a light in view space: ordinary, around the eye or touching it, through the near plane or touching it,
    /// with an extreme radius, or ending near a tile's edge.
    Sphere next() {
        double z = std::pow(10.0, real(-1, 2.3)), y = z * real(-0.7, 0.7), x = z * real(-1.2, 1.2),
               r = z * std::pow(2.0, real(-14, 1));
        const unsigned trouble = engine_() % 16;
        const double near_depth = static_cast<double>(camera_.near_depth);
        if (trouble < 3) {
            r = std::sqrt(x * x + y * y + z * z) * (1 + real(-0.5, 0.5) * std::pow(2.0, -real(0, 23)));
        } else if (trouble < 6) {
            z = near_depth + real(-2, 2) * r;
        } else if (trouble == 6) {
            r = std::fabs(z - near_depth);
            if (engine_() & 1) r *= 1 + (engine_() & 1 ? 0x1p-23 : -0x1p-23);
        } else if (trouble == 7) {
            r = std::pow(2.0, real(-60, 60));
        } else if (trouble < 12) {
            const double edge = static_cast<double>(engine_() % static_cast<unsigned>(camera_.x.tiles)),
                         slope = (edge - camera_.x.offset) / camera_.x.scale * (1 + real(-1, 1) * 0x1p-20);
            r = static_cast<double>(static_cast<float>(z * real(0.001, 0.4)));
            const double side = engine_() & 1 ? 1 : -1;
            x = static_cast<double>(camera_.x.sign) *
                (camera_.orthographic ? slope - side * r
                                      : slope * z - side * r * std::sqrt(1 + slope * slope));
        }
        return {static_cast<float>(x), static_cast<float>(y),
                static_cast<float>(static_cast<double>(camera_.z_sign) * z), static_cast<float>(r)};
    }
    Spot next_spot() {
        const Sphere s = next();
        const double cosine = engine_() % 8 == 0 ? real(-1, 0.1) : real(0.3, 1);
        const auto axis = [&] { return static_cast<float>(real(-1, 1)); };
        return {s.x, s.y, s.z, s.radius, axis(), axis(), axis(), static_cast<float>(cosine)};
    }

    /// Returns a box in or around the sphere of next(): any parallelepiped, at right angles, thin, flat, a line
    /// segment, a frustum, or a beam from about the near plane; whole or cut by a ball around it, around one of
    /// its corners, or touching them.
    Box next_box() {
        const Sphere s = next();
        const double size = static_cast<double>(s.radius);
        const unsigned shape = engine_() % 8, ball = engine_() % 8;
        double axes[3][3];
        for (auto& axis : axes)
            for (double& number : axis)
                number = real(-1, 1);
        if (shape < 5)  // the second at right angles to the first, the third to both
            for (int i = 0; i < 2; ++i)
                for (int k = 0; k < 3; ++k) {
                    const int a = (k + 1) % 3, b = (k + 2) % 3;
                    double(&of)[3] = axes[i + 1], (&first)[3] = axes[i == 0 ? 2 : 0], (&second)[3] = axes[i];
                    of[k] = first[a] * second[b] - first[b] * second[a];
                }
        Box box = {s.x, s.y, s.z, s.radius, s.x, s.y, s.z, {}, 1};
        for (unsigned i = 0; i < 3; ++i) {
            const bool none = (shape == 0 && i > 0) || (shape == 1 && i == 2);
            const double scale = none ? 0 : size * std::pow(2.0, real(-8, 1));
            for (unsigned k = 0; k < 3; ++k)
                box.half_axes[i][k] = static_cast<float>(axes[i][k] * scale);
        }
        if (!camera_.orthographic && engine_() % 4 == 0) make_beam(box);
        if (engine_() % 4 == 0) box.taper = engine_() % 2 == 0 ? 0.0f : static_cast<float>(real(0, 1));
        if (ball < 3) {
            box.radius = std::numeric_limits<float>::infinity();
        } else if (ball < 5) {  // that of its corners, or a little less
            box = clipped_sphere(detail::sphere_of_corners(box), box);
            box.radius *= static_cast<float>(1 + real(-1, 0.5) * std::pow(2.0, -real(0, 20)));
        } else if (ball == 5) {
            for (unsigned i = 0; i < 3; ++i)
                (i == 0 ? box.box_x : i == 1 ? box.box_y : box.box_z) += box.half_axes[0][i] + box.half_axes[1][i];
        }
        return box;
    }

private:
    /// Makes a box a thin beam in view, from about the near plane to far away. In the picture, errors that grow with a
    /// box's size are largest there.
    void make_beam(Box& box) {
        double depth = static_cast<double>(camera_.near_depth) * std::pow(2.0, real(-1, 4));
        const double width = depth / static_cast<double>(box.radius);
        const auto next_end = [&](double farther, float(&end)[3]) {
            depth *= farther;
            for (float& number : end)
                number = static_cast<float>(depth * real(-1, 1));
            end[2] = camera_.z_sign * static_cast<float>(depth);
        };
        float first[3], last[3];
        next_end(1, first);
        next_end(std::pow(2.0, real(4, 11)), last);
        float* const middle[] = {&box.box_x, &box.box_y, &box.box_z};
        for (unsigned k = 0; k < 3; ++k) {
            *middle[k] = (first[k] + last[k]) / 2;
            box.half_axes[0][k] = (last[k] - first[k]) / 2;
            for (unsigned i = 1; i < 3; ++i)
                box.half_axes[i][k] *= static_cast<float>(width);
        }
    }

    double real(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 8) / 16777216.0;
    }

    std::mt19937 engine_;
    const detail::Camera& camera_;
};

/// Counts rectangles, and those that do not contain the Binner's rectangle.
struct Tally {
    std::uint64_t rectangles = 0, lost = 0;
};

/// Projects lights by the shader's text under each arithmetic, and compares the rectangles with the Binner's.
template <class Light>
void compare(const View& view, const CullOptions& options, const std::vector<Light>& made,
             const Matrix* to_view, double margin, Tally& tally) {
    detail::Footprints projected;
    const auto project = [&](const auto& by_binner) {
        projected.project(machine_isa(), view, detail::as_lights(by_binner), Parallel{});
    };
    if (to_view != nullptr)
        project(world_space(made, *to_view));
    else
        project(made);
    const detail::FootprintArrays& expected = projected.arrays();
    set_constants(plan_cull(view, options, {static_cast<uint>(made.size()), 0}, nullptr, to_view)->constants,
                  margin);
    p_lights.resize(made.size() * sizeof(Light) / 4);
    std::memcpy(p_lights.data(), made.data(), made.size() * sizeof(Light));
    constexpr uint totals = sizeof(CullTotals) / 4;  // before the records
    p_scratch.resize(totals + made.size() * 2);
    const bool boxes = options.kind == CullKind::box;
    const auto by_text = options.kind == CullKind::spot ? spot::p_project
                         : to_view != nullptr           ? (boxes ? world_box::p_project : world::p_project)
                         : options.orthographic         ? (boxes ? flat_box::p_project : flat::p_project)
                                                        : (boxes ? box::p_project : sphere::p_project);
    for (const Rounding way :
         {Rounding::nearest, Rounding::up, Rounding::down, Rounding::either, Rounding::anywhere}) {
        rounding = way;
        for (uint i = 0; i < projected.visible(); ++i) {
            const uint id = expected.ids[i];
            by_text(id, 0);
            const uint first = p_scratch[totals + 2 * id], last = p_scratch[totals + 2 * id + 1];
            ++tally.rectangles;
            tally.lost += (first & 0xffff) > expected.x0[i] || first >> 16 > expected.y0[i] ||
                          (last & 0xffff) < expected.x1[i] || last >> 16 < expected.y1[i];
        }
    }
    rounding = Rounding::nearest;
}

}  // namespace

int main(int count, char** arguments) {
    const auto number = [&](int i) { return count > i ? std::strtoul(arguments[i], nullptr, 10) : 4000; };
    const std::size_t light_count = number(1), box_count = number(2);
    constexpr float
        perspective[4][4] = {{0.974f, 0, 0, 0}, {0, 1.732f, 0, 0}, {0, 0, -1.001f, -1}, {0, 0, -0.2001f, 0}},
        off_centre[4][4] = {{2.2f, 0, 0, 0}, {0, 3.9f, 0, 0}, {0.37f, -0.81f, -1, -1}, {0, 0, -0.02f, 0}},
        flat[4][4] = {{0.02f, 0, 0, 0}, {0, -0.035f, 0, 0}, {0, 0, -0.01f, 0}, {0.1f, 0, -1, 1}},
        moved[4][4] = {{0.6f, 0, -0.8f, 0}, {0, 1, 0, 0}, {0.8f, 0, 0.6f, 0}, {13, -20, -7, 1}};
    const Matrix to_view = detail::to_matrix(moved);
    Tally all, boxed, narrow;
    unsigned seed = 1;
    for (const auto& matrix : {perspective, off_centre, flat})
        for (const int tile_size : {32, 1}) {
            const View view = *View::from_projection(matrix, {1920, 1080}, {.tile_size = tile_size});
            LightMaker make(seed++, view);
            std::vector<Sphere> spheres;
            std::vector<Spot> spots;
            for (std::size_t i = 0; i < light_count; ++i) {
                spheres.push_back(make.next());
                spots.push_back(make.next_spot());
            }
            std::vector<Box> boxes;
            for (std::size_t i = 0; i < box_count; ++i)
                boxes.push_back(make.next_box());
            CullOptions options;
            options.orthographic = view.orthographic();
            options.kind = CullKind::box;
            compare(view, options, boxes, nullptr, 1, boxed);
            if (!options.orthographic) {
                options.world_space = true;
                compare(view, options, boxes, &to_view, 1, boxed);
                options.world_space = false;
            }
            options.kind = CullKind::sphere;
            compare(view, options, spheres, nullptr, 1, all);
            compare(view, options, spheres, nullptr, 0.2, narrow);
            if (options.orthographic) continue;
            options.kind = CullKind::spot;
            compare(view, options, spots, nullptr, 1, all);
            options.kind = CullKind::sphere;
            options.world_space = true;
            compare(view, options, spheres, &to_view, 1, all);
        }
    std::printf("%llu rectangles, %llu lost; of boxes %llu, %llu lost; with a margin of 2^-21 %llu of %llu are\n",
                static_cast<unsigned long long>(all.rectangles), static_cast<unsigned long long>(all.lost),
                static_cast<unsigned long long>(boxed.rectangles), static_cast<unsigned long long>(boxed.lost),
                static_cast<unsigned long long>(narrow.lost),
                static_cast<unsigned long long>(narrow.rectangles));
    return all.rectangles == 0 || all.lost > 0 || boxed.rectangles == 0 || boxed.lost > 0 || narrow.lost == 0;
}
