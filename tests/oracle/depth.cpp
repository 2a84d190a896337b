// SPDX-License-Identifier: MIT
// Compares reduce_depth() with exact view depths on every instruction set: a tile's bounds hold every sample and every
// depth that may have left it, and are no wider than rounding to float and the format's step explain. And looks at the
// depths and the lists of random views with an oblique near plane.
#include "families.hpp"
#include "harness.hpp"

#include <cstdlib>
#include <set>
#include <tuple>

using namespace oracle;
using lightbin::DepthFormat;

namespace {

constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();

Rational of(float value) {
    return exact(static_cast<double>(value));
}
Rational clamped(const Rational& v) {
    return v < 0 ? Rational(0) : v > 1 ? Rational(1) : v;
}

Rational step_of(DepthFormat format) {
    if (format == DepthFormat::unorm24) return Rational(1) / ((1 << 24) - 1);
    if (format == DepthFormat::unorm16) return Rational(1) / ((1 << 16) - 1);
    return 0;
}

/// Returns the float next to a number: the nearest one (direction 0), or the one not above (-1) or not below (1).
float float_next_to(const Rational& value, int direction) {
    float best = static_cast<float>(value.convert_to<double>());
    for (const float other : {std::nextafter(best, -inf), std::nextafter(best, inf)})
        if (abs(of(other) - value) < abs(of(best) - value)) best = other;
    return direction * (of(best) - value) < 0 ? std::nextafter(best, static_cast<float>(direction) * inf) : best;
}

/// Returns what a depth buffer may hold for a fragment: one of the format's two neighbouring values, as one of the two
/// neighbouring floats; denormal floats may become zero.
float stored(const Rational& fragment, DepthFormat format, Random& random) {
    const int rounding = random.integer(-1, 1);
    if (format == DepthFormat::float32) {
        const float value = float_next_to(fragment, rounding);
        return value < FLT_MIN && random.chance(0.3) ? 0.0f : value;
    }
    const Rational steps = fragment / step_of(format) + (rounding == 0 ? Rational(1) / 2 : Rational(0));
    boost::multiprecision::mpz_int whole = numerator(steps) / denominator(steps);
    if (rounding > 0 && Rational(whole) < steps) ++whole;
    return float_next_to(Rational(whole) * step_of(format), random.integer(-1, 1));
}

/// A view depth; no value is +infinity.
using Depth = std::optional<Rational>;

bool below(float bound, const Depth& depth) {  // bound <= depth
    if (std::isnan(bound)) return false;
    if (std::isinf(bound)) return bound < 0 || !depth;
    return !depth || of(bound) <= *depth;
}
bool above(float bound, const Depth& depth) {  // bound >= depth
    if (std::isnan(bound)) return false;
    if (std::isinf(bound)) return bound > 0;
    return depth && of(bound) >= *depth;
}

struct Counts {
    std::uint64_t samples = 0, tiles = 0, unknown = 0, empty = 0, endless = 0, outside = 0, loose = 0;
};

struct Sample {
    float value;
    int x, y;  ///< its pixel
};

/// Returns a sample in one of several styles, also values that no rasteriser should leave.
float odd_sample(Random& random, int style) {
    const double styles[] = {random.uniform(),
                             1 - random.power_of_two(-24, 0),  // far away, or close if Z is reversed
                             random.power_of_two(-60, 0),
                             0,
                             1,
                             random.chance(0.5) ? 0.0 : 1.0};
    const float odd[] = {nan, -inf, inf, FLT_TRUE_MIN, -0.0f, static_cast<float>(random.uniform(-2, 0)),
                         static_cast<float>(random.uniform(1, 3))};
    if (style < 6) return static_cast<float>(styles[style]);
    const int pick = random.integer(0, 90);
    return pick < 7 ? odd[pick] : static_cast<float>(random.uniform(0.4, 0.6));
}

class DepthExaminer {
public:
    DepthExaminer(Camera camera, int width, int height, int tile, Counts& counts)
        : camera_(resized(std::move(camera), width, height, tile)), oracle_(camera_), view_(view_of(camera_)),
          counts_(counts) {
        const Rational middle[2] = {Rational(width) / 2, Rational(height) / 2};
        const Depth at_0 = oracle_.view_depth(0, middle[0], middle[1]),
                    at_1 = oracle_.view_depth(1, middle[0], middle[1]);
        reversed_ = !at_0 || (at_1 && *at_0 > *at_1);
        CHECK(reversed_ == view_.reversed_z());
    }

    void odd_buffer(int samples, DepthFormat format, bool skip_background, Random& random) {
        const std::size_t w = static_cast<std::size_t>(camera_.width),
                          h = static_cast<std::size_t>(camera_.height);
        const std::size_t s = static_cast<std::size_t>(samples), pitch = w * s + 3;
        std::vector<int> style(view_.tile_count());
        for (int& v : style)
            v = random.integer(0, 7);
        std::vector<float> depth(pitch * h, nan);  // the gaps between rows are not to be read
        std::vector<std::vector<Sample>> in_tile(view_.tile_count());
        for (std::size_t y = 0; y < h; ++y)
            for (std::size_t i = 0; i < w * s; ++i) {
                const std::size_t t = static_cast<std::size_t>(camera_.tile);
                const std::size_t tile = y / t * static_cast<std::size_t>(view_.tiles_x()) + i / s / t;
                const float value = odd_sample(random, style[tile]);
                depth[y * pitch + i] = value;
                if (!(skip_background && value == (reversed_ ? 0.0f : 1.0f))) 
                    in_tile[tile].push_back({value, static_cast<int>(i / s), static_cast<int>(y)});
            }
        reduce({depth, samples, pitch, format, skip_background});
        for (std::size_t tile = 0; tile < in_tile.size(); ++tile)
            examine_tile(tile, in_tile[tile], samples > 1, format);
    }

    /// Reduces a depth buffer with one sample in each tile. A fragment's depth may differ a little from the stored one;
    /// it must lie within the tile's bounds.
    void fragments(DepthFormat format, Random& random) {
        std::vector<Rational> fragment;
        std::vector<float> depth;
        const int steps = format == DepthFormat::unorm16 ? (1 << 16) - 1 : (1 << 24) - 1;
        for (std::size_t tile = 0; tile < view_.tile_count(); ++tile) {
            // A depth half way between two steps of the format, or just beside it; above 1/2 floats are coarsest.
            const auto half_way = [&](int step) {
                return (step + Rational(1) / 2) / steps + exact(random.sign() * std::exp2(-random.integer(40, 60)));
            };
            const Rational fragments[] = {exact(random.uniform()), exact(1 - random.power_of_two(-24, 0)),
                                          half_way(random.integer(1, steps - 1)),
                                          half_way(steps / 2 + random.integer(0, 40)),
                                          exact(random.power_of_two(-151, -120))};  // denormal floats
            fragment.push_back(clamped(fragments[tile % 5]));
            depth.push_back(stored(fragment.back(), format, random));
        }
        reduce({depth, 1, 0, format, false});
        for (std::size_t tile = 0; tile < fragment.size(); ++tile) {
            ++counts_.samples;
            const int x = static_cast<int>(tile) % camera_.width, y = static_cast<int>(tile) / camera_.width;
            if (!contains(tile, depths_at(fragment[tile], x, y, false).front()))
                report(counts_.outside, "fragment outside", tile, fragment[tile].convert_to<double>(), format);
        }
    }

private:
    static Camera resized(Camera camera, int width, int height, int tile) {
        camera.width = width, camera.height = height, camera.tile = tile;
        return camera;
    }

    void reduce(const lightbin::DepthBuffer& buffer) {
        for (auto* side : {&min_, &max_})
            side->assign(view_.tile_count(), nan);
        const auto all = lightbin::reduce_depth(view_, buffer, {min_, max_});
        REQUIRE(all.has_value());
        std::vector<float> alone(view_.tile_count(), nan), other[2] = {alone, alone};
        for (const lightbin::Isa isa : {lightbin::Isa::scalar, lightbin::Isa::simd128, lightbin::Isa::avx2}) {
            REQUIRE(lightbin::reduce_depth(view_, buffer, {other[0], other[1]}, isa).has_value());
            CHECK((other[0] == min_ && other[1] == max_));
        }
        const auto only_min = lightbin::reduce_depth(view_, buffer, {.min = alone});
        REQUIRE(only_min.has_value());
        CHECK((alone == min_ && only_min->max.empty()));
        const auto only_max = lightbin::reduce_depth(view_, buffer, {.max = alone});
        REQUIRE(only_max.has_value());
        CHECK((alone == max_ && only_max->min.empty()));
    }

    /// The depths that a sample of a pixel may have: that of the pixel's centre, or one between those of its corners if
    /// the pixel has several. Without an oblique near plane they are the same all over the image.
    std::vector<Depth> depths_at(const Rational& window, int x, int y, bool many) const {
        if (!oblique()) return {oracle_.view_depth(window, 0, 0)};
        if (!many) return {oracle_.view_depth(window, x + Rational(1) / 2, y + Rational(1) / 2)};
        std::vector<Depth> depths;
        for (const int right : {0, 1})
            for (const int down : {0, 1})
                depths.push_back(oracle_.view_depth(window, x + right, y + down));
        return depths;
    }
    bool oblique() const { return camera_.m[0][2] != 0 || camera_.m[1][2] != 0; }

    void examine_tile(std::size_t tile, const std::vector<Sample>& samples, bool many, DepthFormat format) {
        ++counts_.tiles;
        if (samples.empty()) {
            ++counts_.empty;
            CHECK(min_[tile] == inf);
            CHECK(max_[tile] == -inf);
            return;
        }
        std::set<std::tuple<Rational, int, int>> seen;  // window depths, and where they are
        bool unknown = false;
        for (const auto& [value, x, y] : samples) {
            const auto see = [&](const Rational& depth) { seen.insert({depth, oblique() ? x : 0, oblique() ? y : 0}); };
            unknown |= std::isnan(value);
            if (std::isnan(value))  // near to far, and anything between
                see(0), see(1);
            else
                see(std::isinf(value) ? Rational(value > 0 ? 1 : 0) : clamped(of(value)));
        }
        counts_.unknown += unknown;
        // From above: no bound is further out than the view depth of a window depth further by the format's step
        // (twice, for its rounding to float; two ulps of a float format), then a few ulps. The entries of the matrix
        // cancel in double precision where depth is far: 2^-49 of window depth, and more where they are oblique.
        const auto further = [&](const Rational& window, int direction) {
            const Rational format_step =
                format == DepthFormat::float32 ? Rational(window / (1 << 22)) : 2 * step_of(format);
            return clamped(window + direction * format_step) +
                   direction * Rational(1) / (std::int64_t{1} << (oblique() ? 44 : 49));
        };
        Depth least;
        Depth most = Rational(-(std::int64_t{1} << 62));
        for (const auto& [window, x, y] : seen) {
            ++counts_.samples;
            const double value = window.convert_to<double>();
            const auto check = [&](const Rational& at, const char* what) {
                for (const Depth& depth : depths_at(at, x, y, many))
                    if (!contains(tile, depth)) report(counts_.outside, what, tile, value, format);
            };
            check(window, "sample outside");
            // The next float: the documentation allows that a sample is off by one ulp.
            if (format == DepthFormat::float32 && !unknown && value >= static_cast<double>(FLT_MIN) && value < 1)
                for (const float end : {0.0f, 1.0f})
                    check(of(std::nextafter(static_cast<float>(value), end)), "neighbour outside");
            for (const Depth& depth : depths_at(further(window, reversed_ ? 1 : -1), x, y, many))
                if (!least || (depth && *depth < *least)) least = depth;
            for (const Depth& depth : depths_at(further(window, reversed_ ? -1 : 1), x, y, many))
                if (!depth || (most && *depth > *most)) most = depth;
        }
        // Floats end at FLT_MAX; a bound beyond is infinite.
        const bool min_tight = least ? above(min_[tile], *least - abs(*least) / (1 << 22)) : min_[tile] > 0;
        const bool max_tight = most ? below(max_[tile], *most + abs(*most) / (1 << 22)) : true;
        counts_.endless += !most && max_[tile] == inf;
        if (!min_tight || !max_tight) report(counts_.loose, "loose", tile, min_tight ? 1 : 0, format);
    }

    bool contains(std::size_t tile, const Depth& depth) const {
        return below(min_[tile], depth) && above(max_[tile], depth);
    }

    void report(std::uint64_t& count, const std::string& what, std::size_t tile, double window, DepthFormat format) {
        char number[40];
        std::snprintf(number, sizeof number, "%a", window);
        if (++count <= 5)
            MESSAGE(what << ": " << camera_.name << " tile " << tile << " window depth "
                         << std::string(number) << " format " << static_cast<int>(format) << " bounds "
                         << min_[tile] << " " << max_[tile]);
    }

    Camera camera_;
    Oracle oracle_;
    lightbin::View view_;
    Counts& counts_;
    bool reversed_ = false;
    std::vector<float> min_, max_;
};

void prove_depths(const std::string& kind, const Camera& camera) {
    Counts counts;
    Random random(seed_of(kind));
    DepthExaminer partial_tiles(camera, 37, 29, 8, counts), one_tile(camera, 5, 3, 64, counts),
        pixels(camera, 60, 50, 1, counts);
    for (const DepthFormat format : {DepthFormat::float32, DepthFormat::unorm24, DepthFormat::unorm16}) {
        for (int samples = 1; samples <= 8; ++samples)
            for (const bool skip : {false, true}) {
                partial_tiles.odd_buffer(samples, format, skip, random);
                for (int i = 0; i < 10; ++i)
                    one_tile.odd_buffer(samples, format, skip, random);
            }
        pixels.odd_buffer(1, format, true, random);
        for (int i = 0; i < 3; ++i)
            pixels.fragments(format, random);
    }
    MESSAGE(kind << ": " << counts.samples << " samples in " << counts.tiles << " tiles, " << counts.unknown
                 << " with NaN, " << counts.empty << " empty, " << counts.endless << " without end");
    CHECK(counts.outside == 0);
    CHECK(counts.loose == 0);
    CHECK(counts.samples > 50000);
    CHECK(counts.unknown > 100);
    CHECK(counts.empty > 100);
}

/// A lens of any settings whose near plane is oblique: before the eye, or seldom behind it, near or far, and any way
/// turned, with the corner that set_oblique_plane() looks for in front of it.
Lens oblique_lens(double aspect, Random& random) {
    for (;;) {
        Lens lens = families::any_lens(aspect, random);
        if (random.chance(0.1)) families::shift(lens, random.uniform(-9, 9), random.uniform(-9, 9));
        const double distance = lens.orthographic ? random.uniform(lens.near_plane, lens.far_plane)
                                                  : lens.near_plane * random.power_of_two(-4, 12),
                     steep = random.power_of_two(-6, 3);
        oblique(lens, random.uniform(-1, 1), random.uniform(-1, 1), random.sign() * steep,
                (random.chance(0.05) ? 1 : -1) * distance);
        const Matrix m = projection(lens);
        if (std::isfinite(m[2][2]) && std::isfinite(m[3][2]) && m[0][2] != 0) return lens;
    }
}

struct ObliqueCounts {
    std::uint64_t views = 0, refused = 0, endless = 0, entries = 0, decided = 0, missed = 0, outside = 0, wide = 0;
};

/// Whether a part of the whole clip volume lies at depths up to `end`, or from it on: decided by half-spaces alone.
bool reaches(const Oracle& oracle, const Rational& end, int direction) {
    auto volume = oracle.half_spaces(oracle.columns(0, oracle.tiles_x()), oracle.rows(0, oracle.tiles_y()), {});
    volume.push_back({{0, 0, Rational(direction * oracle.depth_sign())}, -direction * end});
    return nearest_point(volume, {}).has_value();
}

void examine_oblique_view(Random& random, ObliqueCounts& counts) {
    static lightbin::Binner<> binner;
    const int tile = random.integer(1, 40);
    const auto side = [&] { return std::max(1, tile * random.integer(1, 4) - random.integer(0, tile - 1)); };
    const Screen screen = {side(), side(), tile, random.chance(0.5)};
    const Camera camera = camera_of("oblique", oblique_lens(aspect_of(screen), random), screen);
    const Oracle oracle(camera);
    const Depths& range = oracle.range();
    const auto view = library_view(camera);
    if (!view) {  // right if nothing is drawn, or something at the eye
        ++counts.refused;
        CHECK((range.empty || *range.min <= 0));
        return;
    }
    ++counts.views;
    REQUIRE(!range.empty);

    // The depths: none of the clip volume is outside, and little else is inside.
    counts.outside += !below(view->near_depth(), *range.min) || !above(view->far_depth(), range.max);
    counts.endless += !range.max;
    const Rational allowed = Rational(1) / (1 << 21);
    counts.wide += !above(view->near_depth(), *range.min - abs(*range.min) * allowed) ||
                   (range.max && !below(view->far_depth(), *range.max + abs(*range.max) * allowed));
    if (random.chance(0.05)) {
        const Rational hair = (abs(*range.min) + exact(0x1p-100)) / (std::int64_t{1} << 40);
        CHECK(reaches(oracle, *range.min, -1));
        CHECK(!reaches(oracle, *range.min - hair, -1));
        const Rational far_away = range.max ? *range.max : Rational((abs(*range.min) + 1) * (std::int64_t{1} << 60));
        CHECK(reaches(oracle, far_away, 1));
        const Rational beyond = far_away + (abs(far_away) + exact(0x1p-100)) / (std::int64_t{1} << 40);
        CHECK(reaches(oracle, beyond, 1) == !range.max);
    }

    // The lists: at the ends of the range and in it, of cells of which the oblique planes leave something.
    const Aim aim(camera);
    std::vector<lightbin::Sphere> spheres;
    for (int i = 0; i < 3; ++i) {
        const double depth = random.chance(0.3) ? aim.near_plane : aim.depth(random),
                     radius = aim.half_height(std::max(std::abs(depth), aim.unit)) * random.power_of_two(-8, 1);
        const Light light = aim.light(aim.at(0, aim.pixel(0, random), depth), aim.at(1, aim.pixel(1, random), depth),
                                      depth + random.sign() * radius * random.uniform(), radius);
        spheres.push_back({light.x, light.y, light.z, light.w});
    }
    const auto grid = binner.bin(*view, spheres);
    REQUIRE(grid.has_value());
    counts.entries += grid->ids().size();
    const auto in = membership(*grid, spheres.size());
    Filter filter(oracle);
    const FlatDepths flat(range);
    for (std::size_t id = 0; id < spheres.size(); ++id) {
        const Ball ball = exact_ball(spheres[id].x, spheres[id].y, spheres[id].z, spheres[id].radius);
        const CameraBall seen = oracle.in_camera(ball);
        const FlatBall flat_ball = {nearly(seen.x), nearly(seen.y), nearly(seen.depth), nearly(seen.radius)};
        for (int y = 0; y < oracle.tiles_y(); ++y)
            for (int x = 0; x < oracle.tiles_x(); ++x) {
                if (in[static_cast<std::size_t>(y * oracle.tiles_x() + x)][id]) continue;
                ++counts.decided;
                if (filter.apart(x, x + 1, y, y + 1, flat, flat_ball)) continue;
                counts.missed += meets(oracle.half_spaces(oracle.columns(x, x + 1), oracle.rows(y, y + 1), {}), ball);
            }
    }
}

}  // namespace

// LIGHTBIN_ROUNDS=250 examines a million views.
TEST_CASE("oblique near planes: the depths and lists of random views") {
    const char* const rounds = std::getenv("LIGHTBIN_ROUNDS");
    const int views = 4000 * (rounds != nullptr ? std::atoi(rounds) : 1);
    Random random(seed_of("oblique"));
    ObliqueCounts counts;
    for (int i = 0; i < views; ++i)
        examine_oblique_view(random, counts);
    MESSAGE(counts.views << " views, " << counts.refused << " refused, " << counts.endless << " without end; "
                         << counts.entries << " entries; " << counts.decided << " cells without a light, "
                         << counts.missed << " of them missed; depths outside: " << counts.outside
                         << ", more than 2^-21 too wide: " << counts.wide);
    CHECK(counts.missed == 0);
    CHECK(counts.outside == 0);
    CHECK(counts.wide < counts.views / 100);
    CHECK(counts.views > static_cast<std::uint64_t>(views) * 9 / 10);
    CHECK(counts.entries > counts.views);
    CHECK(counts.endless < counts.views);
}

TEST_CASE("depths of every kind of camera") {
    for (const CameraKind& kind : camera_kinds())
        prove_depths(kind.name, kind.cameras().front());
}
