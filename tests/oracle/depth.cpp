// SPDX-License-Identifier: MIT
// Compares reduce_depth() with exact view depths on every instruction set: a tile's bounds hold every sample and every
// depth that may have left it, and are no wider than rounding to float and the format's step explain.
#include "harness.hpp"

#include <set>

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
        const Depth at_0 = oracle_.view_depth(0), at_1 = oracle_.view_depth(1);
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
        std::vector<std::vector<float>> in_tile(view_.tile_count());
        for (std::size_t y = 0; y < h; ++y)
            for (std::size_t i = 0; i < w * s; ++i) {
                const std::size_t t = static_cast<std::size_t>(camera_.tile);
                const std::size_t tile = y / t * static_cast<std::size_t>(view_.tiles_x()) + i / s / t;
                const float value = odd_sample(random, style[tile]);
                depth[y * pitch + i] = value;
                if (!(skip_background && value == (reversed_ ? 0.0f : 1.0f))) in_tile[tile].push_back(value);
            }
        reduce({depth, samples, pitch, format, skip_background});
        for (std::size_t tile = 0; tile < in_tile.size(); ++tile)
            examine_tile(tile, in_tile[tile], format);
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
            if (!contains(tile, oracle_.view_depth(fragment[tile])))
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

    void examine_tile(std::size_t tile, const std::vector<float>& samples, DepthFormat format) {
        ++counts_.tiles;
        if (samples.empty()) {
            ++counts_.empty;
            CHECK(min_[tile] == inf);
            CHECK(max_[tile] == -inf);
            return;
        }
        Rational lowest = 1, highest = 0;  // window depth
        const bool unknown =
            std::any_of(samples.begin(), samples.end(), [](float v) { return std::isnan(v); });
        if (unknown) {
            lowest = 0, highest = 1;  // near to far, and anything between
            ++counts_.unknown;
        } else {
            for (const float sample : std::set<float>(samples.begin(), samples.end())) {
                const Rational window =
                    std::isinf(sample) ? Rational(sample > 0 ? 1 : 0) : clamped(of(sample));
                lowest = std::min(lowest, window);
                highest = std::max(highest, window);
                ++counts_.samples;
                if (!contains(tile, oracle_.view_depth(window)))
                    report(counts_.outside, "sample outside", tile, static_cast<double>(sample), format);
                // The next float: the documentation allows that a sample is off by one ulp.
                if (format != DepthFormat::float32 || !(sample >= FLT_MIN && sample < 1)) continue;
                for (const float end : {0.0f, 1.0f})
                    if (!contains(tile, oracle_.view_depth(of(std::nextafter(sample, end)))))
                        report(counts_.outside, "neighbour outside", tile, static_cast<double>(sample), format);
            }
        }
        for (const Rational& window : {lowest, highest})
            if (!contains(tile, oracle_.view_depth(window)))
                report(counts_.outside, "end outside", tile, window.convert_to<double>(), format);
        examine_tightness(tile, unknown ? Rational(0) : lowest, unknown ? Rational(1) : highest, format);
    }

    /// From above: no bound is further out than the view depth of a window depth further by the format's step
    /// (twice, for its rounding to float; two ulps of a float format), then a few ulps. The entries of the
    /// matrix cancel in double precision where depth is far: 2^-49 of window depth.
    void examine_tightness(std::size_t tile, const Rational& lowest, const Rational& highest,
                           DepthFormat format) {
        const auto further = [&](const Rational& window, int direction) {
            const Rational format_step =
                format == DepthFormat::float32 ? Rational(window / (1 << 22)) : 2 * step_of(format);
            return clamped(window + direction * format_step) +
                   direction * Rational(1) / (std::int64_t{1} << 49);
        };
        const Depth least = oracle_.view_depth(reversed_ ? further(highest, 1) : further(lowest, -1));
        const Depth most = oracle_.view_depth(reversed_ ? further(lowest, -1) : further(highest, 1));
        // Floats end at FLT_MAX; a bound beyond is infinite.
        const bool min_tight = least ? above(min_[tile], *least - abs(*least) / (1 << 22)) : min_[tile] > 0;
        const bool max_tight = most ? below(max_[tile], *most + abs(*most) / (1 << 22)) : true;
        counts_.endless += !most && max_[tile] == inf;
        if (!min_tight || !max_tight) report(counts_.loose, "loose", tile, nearly(lowest), format);
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

}  // namespace

TEST_CASE("depths of every kind of camera") {
    for (const CameraKind& kind : camera_kinds())
        prove_depths(kind.name, kind.cameras().front());
}
