// reduce_depth: what counts, where it lies, what it refuses. Exact values are compared with rationals in
// tests/oracle.
#include "scene.hpp"

#include <limits>

using namespace lightbin;

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

struct Reduced {
    std::vector<float> min, max;
};

Reduced reduce(const View& view, const DepthBuffer& buffer) {
    Reduced reduced{std::vector<float>(view.tile_count()), std::vector<float>(view.tile_count())};
    REQUIRE(reduce_depth(view, buffer, {.min = reduced.min, .max = reduced.max}));
    return reduced;
}

/// Window depth of a view depth for test::view().
float window_depth(double z) {
    constexpr double near = 0.1, far = 1000.0;
    return static_cast<float>(0.5 + 0.5 * ((far + near) / (far - near) - 2 * far * near / (far - near) / z));
}

/// And back, through the float matrix that the view has read.
double view_depth(double window) {
    const glm::dmat4 projection(glm::perspectiveRH_NO(1.0471976f, 1.0f, 0.1f, 1000.0f));
    return projection[3][2] / (2 * window - 1 + projection[2][2]);
}

}  // namespace

TEST_CASE("each sample lands in its own tile: partial tiles, several samples, a row pitch") {
    const View view = test::view({37, 21}, 8);  // 5 x 3 tiles
    for (const int samples : {1, 2, 4, 8}) {
        const std::size_t pitch = static_cast<std::size_t>(37 * samples + 5);
        for (int y : {0, 7, 8, 20})
            for (int x : {0, 7, 8, 31, 32, 36})
                for (const int sample : {0, samples - 1}) {
                    std::vector<float> depth(pitch * 21, window_depth(10));
                    for (std::size_t row = 0; row < 21; ++row)  // padding must not be read
                        std::fill_n(depth.begin() + static_cast<std::ptrdiff_t>(row * pitch) + 37 * samples,
                                    5, 0.0f);
                    depth[static_cast<std::size_t>(y) * pitch +
                          static_cast<std::size_t>(x * samples + sample)] = window_depth(50);
                    const Reduced reduced =
                        reduce(view, {.depth = depth, .samples = samples, .row_pitch = pitch});
                    for (int ty = 0; ty < 3; ++ty)
                        for (int tx = 0; tx < 5; ++tx) {
                            const std::size_t tile = static_cast<std::size_t>(ty * 5 + tx);
                            const bool here = tx == x / 8 && ty == y / 8;
                            CHECK(reduced.min[tile] == doctest::Approx(10).epsilon(1e-3));
                            CHECK(reduced.max[tile] == doctest::Approx(here ? 50 : 10).epsilon(1e-3));
                        }
                }
    }
}

TEST_CASE("tiles of which 8 samples a pixel are more than 32 bits count") {
    const std::vector<float> depth(37 * 21 * 8, window_depth(10));
    for (const int tile_size : {64, 1 << 29, (1 << 29) + 1, std::numeric_limits<int>::max()}) {
        const Reduced reduced = reduce(test::view({37, 21}, tile_size), {.depth = depth, .samples = 8});
        CHECK(reduced.max == reduce(test::view({37, 21}, 37), {.depth = depth, .samples = 8}).max);
    }
}

TEST_CASE("background, NaN and out-of-range samples") {
    const View view = test::view({32, 16}, 16);  // two tiles
    const float near = view.near_depth(), far = view.far_depth();
    std::vector<float> depth(32 * 16, 1.0f);  // cleared
    const std::size_t left = 3, right = 20;
    depth[right] = window_depth(10);

    const Reduced kept = reduce(view, {.depth = depth});
    CHECK(kept.max[0] == far);
    CHECK(kept.min[0] == doctest::Approx(1000).epsilon(0.01));
    CHECK(kept.max[1] == far);
    const Reduced skipped = reduce(view, {.depth = depth, .skip_background = true});
    CHECK(skipped.min[0] == infinite);
    CHECK(skipped.max[0] == -infinite);
    CHECK(skipped.min[1] == doctest::Approx(10).epsilon(1e-3));
    CHECK(skipped.max[1] == doctest::Approx(10).epsilon(1e-3));

    for (const bool skip : {false, true}) {
        depth[left] = std::nanf("");
        const Reduced unknown = reduce(view, {.depth = depth, .skip_background = skip});
        CHECK(unknown.min[0] == near);
        CHECK(unknown.max[0] == far);
        depth[left] = -std::nanf("");
        CHECK(reduce(view, {.depth = depth, .skip_background = skip}).min[0] == near);
    }
    for (const float beyond : {-1.0f, -infinite, -0.0f}) {
        depth[left] = beyond;
        CHECK(reduce(view, {.depth = depth, .skip_background = true}).min[0] == near);
    }
    for (const float beyond : {1.5f, infinite}) {
        depth[left] = beyond;
        CHECK(reduce(view, {.depth = depth, .skip_background = true}).max[0] == far);
    }
}

TEST_CASE("reversed Z: the far end is zero") {
    glm::mat4 projection(0.0f);
    projection[0][0] = projection[1][1] = 1;
    projection[2][3] = -1;
    projection[3][2] = 0.1f;
    const View view =
        *View::from_projection(projection, {16, 16}, {.tile_size = 16, .clip_depth = ClipDepth::zero_to_one});
    std::vector<float> depth(256, 0.0f);
    depth[5] = 0.1f / 20;
    depth[6] = 0.1f / 40;
    const Reduced kept = reduce(view, {.depth = depth});
    CHECK(kept.min[0] == doctest::Approx(20));
    CHECK(kept.max[0] == infinite);
    const Reduced skipped = reduce(view, {.depth = depth, .skip_background = true});
    CHECK(skipped.min[0] == doctest::Approx(20));
    CHECK(skipped.max[0] == doctest::Approx(40));
}

TEST_CASE("one side alone, and the formats' steps") {
    const View view = test::view({64, 64}, 32);
    const std::vector<float> depth(64 * 64, window_depth(100));
    std::vector<float> min(4, -1.0f), max(4, -1.0f);
    const auto only_max = reduce_depth(view, {.depth = depth}, {.max = max});
    REQUIRE(only_max);
    CHECK(only_max->min.empty());
    CHECK(only_max->max.size() == 4);
    CHECK(max[3] == doctest::Approx(100).epsilon(1e-2));
    const auto only_min = reduce_depth(view, {.depth = depth}, {.min = min});
    REQUIRE(only_min);
    CHECK(only_min->max.empty());
    CHECK(min[3] == doctest::Approx(100).epsilon(1e-2));

    for (const auto& [format, step] : {std::pair(DepthFormat::float32, std::ldexp(1.0, -24)),
                                       std::pair(DepthFormat::unorm24, 1 / (std::ldexp(1.0, 24) - 1)),
                                       std::pair(DepthFormat::unorm16, 1 / (std::ldexp(1.0, 16) - 1))}) {
        const Reduced reduced = reduce(view, {.depth = depth, .format = format});
        const double nearer = view_depth(static_cast<double>(depth[0]) - step);
        const double farther = view_depth(static_cast<double>(depth[0]) + step);
        CHECK(static_cast<double>(reduced.min[0]) <= nearer);
        CHECK(static_cast<double>(reduced.max[0]) >= farther);
        CHECK(static_cast<double>(reduced.max[0] - reduced.min[0]) < 2.2 * (farther - nearer));
    }
}

TEST_CASE("sizes that do not fit are errors that name what is needed") {
    const View view = test::view({64, 48}, 16);
    const std::vector<float> depth(64 * 48);
    std::vector<float> min(12), max(12);
    const auto code = [&](const DepthBuffer& buffer, std::span<float> a, std::span<float> b) {
        const auto bounds = reduce_depth(view, buffer, {.min = a, .max = b});
        REQUIRE(!bounds);
        const auto needed =
            static_cast<std::int64_t>(bounds.error().needed);  // a sample count may be negative
        CHECK(bounds.error().message().find(std::to_string(needed)) != std::string::npos);
        return bounds.error().code;
    };
    const std::span<const float> short_depth(depth.data(), depth.size() - 1);
    CHECK(code({.depth = short_depth}, min, max) == ErrorCode::depth_buffer_too_small);
    CHECK(code({.depth = depth, .samples = 2}, min, max) == ErrorCode::depth_buffer_too_small);
    CHECK(code({.depth = depth, .row_pitch = 65}, min, max) == ErrorCode::depth_buffer_too_small);
    CHECK(code({.depth = depth, .row_pitch = 63}, min, max) == ErrorCode::row_pitch_too_small);
    // Pitches of which 63, or 64, make 0 or little where sizes wrap.
    constexpr std::size_t most = (std::numeric_limits<std::size_t>::max)();
    for (const std::size_t pitch :
         {most, most - 63, most / 2 + 1, most / 64 + 1, most / 63 + 1, most / 63 + 2})
        for (const int height : {64, 65}) {
            const auto tall =
                reduce_depth(test::view({64, height}, 32), {.depth = depth, .row_pitch = pitch}, {});
            REQUIRE(!tall);
            CHECK(tall.error().code == ErrorCode::depth_buffer_too_small);
            CHECK(static_cast<double>(tall.error().needed) ==
                  doctest::Approx((std::min)(static_cast<double>(pitch) * (height - 1) + 64, 0x1p64)));
        }
    CHECK(code({.depth = depth, .samples = 0}, min, max) == ErrorCode::samples_out_of_range);
    CHECK(code({.depth = depth, .samples = 9}, min, max) == ErrorCode::samples_out_of_range);
    CHECK(code({.depth = depth, .samples = -1}, min, max) == ErrorCode::samples_out_of_range);
    CHECK(code({.depth = depth}, std::span(min).first(11), max) == ErrorCode::z_bounds_too_small);
    CHECK(code({.depth = depth}, min, std::span(max).first(11)) == ErrorCode::z_bounds_too_small);
}

TEST_CASE("gaps lie between a tile's two groups of samples, in every tier") {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(0, 1);
    for (const bool reversed : {false, true})
        for (const int samples : {1, 3}) {
            const glm::mat4 projection = reversed ? glm::perspectiveRH_ZO(1.0f, 1.5f, 100.0f, 0.5f)
                                                  : glm::perspectiveRH_ZO(1.0f, 1.5f, 0.5f, 100.0f);
            const View view = *View::from_projection(projection, {70, 45},
                                                     {.tile_size = 7, .clip_depth = ClipDepth::zero_to_one});
            // A wall before or behind, holes to the background, and a NaN in one tile.
            const std::size_t width = 70 * static_cast<std::size_t>(samples),
                              size = 7 * static_cast<std::size_t>(samples);
            std::vector<float> depth(width * 45);
            for (std::size_t i = 0; i < depth.size(); ++i) {
                const std::size_t tile = i % width / size;
                const float view_depth = unit(random) < 0.5f ? 1 + unit(random) : 30 + 40 * unit(random);
                const double nearer = 1 / static_cast<double>(tile % 4 == 1 ? 5.0f : view_depth);
                const double window = (nearer - 0.01) / (2 - 0.01);  // 1 at the near plane, 0 at the far
                depth[i] = unit(random) < 0.1f ? (reversed ? 0.0f : 1.0f)
                                               : static_cast<float>(reversed ? window : 1 - window);
            }
            depth[3 * size] = std::nanf("");
            const std::size_t tiles = view.tile_count();
            const DepthBuffer buffer = {.depth = depth, .samples = samples, .skip_background = true};
            std::vector<float> min(tiles), max(tiles), gap_min(tiles), gap_max(tiles);
            const ZBounds bounds =
                *reduce_depth(view, buffer, {.min = min, .max = max, .gap_min = gap_min, .gap_max = gap_max});
            REQUIRE((bounds.gap_min.size() == tiles && bounds.gap_max.size() == tiles));
            std::size_t gaps = 0;
            for (std::size_t tile = 0; tile < tiles; ++tile) {
                const std::size_t columns = static_cast<std::size_t>(view.tiles_x());
                const std::size_t x = tile % columns * size, y = tile / columns * 7;
                const float middle = 0.5f * (min[tile] + max[tile]);
                float nearer = -HUGE_VALF, farther = HUGE_VALF;
                bool unknown = false;
                for (std::size_t row = y; row < std::min<std::size_t>(y + 7, 45); ++row)
                    for (std::size_t i = x; i < std::min(x + size, width); ++i) {
                        const float sample = depth[row * width + i];
                        unknown |= std::isnan(sample);
                        if (sample == (reversed ? 0.0f : 1.0f) || std::isnan(sample)) continue;
                        const DepthInterval at =
                            view.view_depths(static_cast<double>(sample), static_cast<double>(sample));
                        CHECK(!(gap_min[tile] < gap_max[tile] && at.min > gap_min[tile] &&
                                at.max < gap_max[tile]));
                        if (at.max < middle)
                            nearer = std::max(nearer, at.max);
                        else
                            farther = std::min(farther, at.min);
                    }
                if (unknown || nearer < 0 || farther == HUGE_VALF) {
                    CHECK(!(gap_min[tile] < gap_max[tile]));
                    continue;
                }
                ++gaps;
                CHECK(gap_min[tile] >= nearer);
                CHECK(gap_min[tile] == doctest::Approx(nearer).epsilon(1e-4));
                CHECK(gap_max[tile] <= farther);
                CHECK(gap_max[tile] == doctest::Approx(farther).epsilon(1e-3));
            }
            CHECK(gaps > tiles / 2);
            for (const Isa isa : {Isa::scalar, Isa::sse2, Isa::avx2}) {
                std::vector<float> other[4];
                for (auto& side : other)
                    side.resize(tiles);
                REQUIRE(reduce_depth(view, buffer, {other[0], other[1], other[2], other[3]}, isa));
                CHECK((other[0] == min && other[1] == max && other[2] == gap_min && other[3] == gap_max));
            }
        }
}

TEST_CASE("a denormal depth may be any near it") {
    // Reversed Z with an infinite far plane: depth is near / window depth.
    const double near = 1e-10;
    glm::dmat4 projection(0);
    projection[0][0] = projection[1][1] = 1;
    projection[2][3] = -1;
    projection[3][2] = near;
    const View view =
        *View::from_projection(projection, {1, 1}, {.tile_size = 1, .clip_depth = ClipDepth::zero_to_one});
    for (const double unit : {0x1p-149, 0x1p-140, 0x1p-127, 0x1p-126, 0x1p-125})
        for (const double units : {0.3, 0.6, 1.2, 1.4, 1.6}) {
            const double drawn = units * unit;
            // As it is rounded, to the nearest or to the other side, or flushed to zero.
            const float nearest = static_cast<float>(drawn),
                        other = std::nextafter(nearest, static_cast<double>(nearest) < drawn ? 1.0f : 0.0f);
            for (const float stored : {nearest, other, drawn < 0x1p-126 ? 0.0f : nearest}) {
                float min[1], max[1];
                REQUIRE(reduce_depth(view, {.depth = std::span(&stored, 1)}, {.min = min, .max = max}));
                CHECK(static_cast<double>(min[0]) <= near / drawn);
                CHECK(static_cast<double>(max[0]) >= near / drawn);
            }
        }
}

namespace {

/// A window depth in units of 2^-40, exact as a double.
using Window = std::uint64_t;
constexpr Window one = Window{1} << 40;

double number_of(Window depth) {
    return static_cast<double>(depth) / static_cast<double>(one);
}

/// The float next to a number that a double holds: 0 the nearest, -1 not above, 1 not below.
float float_next_to(double number, int direction) {
    const float nearest = static_cast<float>(number);
    const double excess = static_cast<double>(nearest) - number;
    return excess * direction < 0 ? std::nextafter(nearest, static_cast<float>(direction) * infinite)
                                  : nearest;
}

std::uint64_t steps_of(DepthFormat format) {
    return format == DepthFormat::unorm24 ? 0xffffff : 0xffff;
}

/// What a buffer has of a depth, rounded to nearest (0), down (-1) or up (1), and then read as a float, rounded in any way.
float stored(Window depth, DepthFormat format, int rounding, int float_rounding) {
    if (format == DepthFormat::float32) return float_next_to(number_of(depth), rounding);
    const std::uint64_t steps = steps_of(format);
    const Window added = rounding == 0 ? one / 2 : rounding > 0 ? one - 1 : 0;
    const std::uint64_t step = (depth * steps + added) / one;
    // The quotient is a double's error off, and no float but 0 and 1, which are exact, is as close as that.
    return float_next_to(static_cast<double>(step) / static_cast<double>(steps), float_rounding);
}

/// Depths that roundings move farthest, near both ends and where floats are coarsest, and any.
std::vector<Window> depths_to_store(DepthFormat format) {
    std::vector<Window> depths = {0, 1, one - 1, one};
    const std::uint64_t steps = format == DepthFormat::float32 ? 0xffffff : steps_of(format);
    std::mt19937_64 random(5);
    const auto add_around = [&](std::uint64_t step) {
        const Window at = step * one / steps, half = one / steps / 2;  // just below the step, or at it
        for (const Window depth : {at, at + 1, at + half, at + half + 1, at - 1})
            if (depth <= one) depths.push_back(depth);
    };
    for (const std::uint64_t step :
         {std::uint64_t{1}, std::uint64_t{2}, steps / 2, steps / 2 + 1, steps / 2 + 7, steps - 2, steps - 1})
        add_around(step);
    for (int i = 0; i < 800; ++i) {
        add_around(1 + random() % (steps - 1));
        add_around(steps / 2 + random() % (steps / 2));
        depths.push_back(random() % one);
    }
    return depths;
}

/// A view of one tile a sample, and its matrix in doubles.
struct DepthCamera {
    glm::dmat4 projection;
    ViewOptions options;

    View view(std::size_t samples) const {
        ViewOptions with_tiles = options;
        with_tiles.tile_size = 1;
        return *View::from_projection(projection, {static_cast<int>(samples), 1}, with_tiles);
    }
    /// By the definition of clip space, in an arithmetic that is finer than a view's. All of them look down -z.
    long double view_depth(Window window) const {
        long double v = static_cast<long double>(window) / static_cast<long double>(one);
        if (options.clip_depth == ClipDepth::minus_one_to_one) v = 2 * v - 1;
        const auto& m = projection;
        return (v * static_cast<long double>(m[3][3]) - static_cast<long double>(m[3][2])) /
               (v * static_cast<long double>(m[2][3]) - static_cast<long double>(m[2][2]));
    }
};

std::vector<DepthCamera> depth_cameras() {
    constexpr ViewOptions gl = {}, zo = {.clip_depth = ClipDepth::zero_to_one};
    ViewOptions gl_reversed = gl, zo_reversed = zo;
    gl_reversed.reversed_z = zo_reversed.reversed_z = true;
    return {{glm::perspectiveRH_NO(1.0, 1.5, 0.1, 1000.0), gl},
            {glm::perspectiveRH_NO(1.0, 1.5, 1000.0, 0.1), gl},  // reversed
            {glm::perspectiveRH_ZO(1.0, 1.5, 0.1, 1000.0), zo},
            {glm::perspectiveRH_ZO(1.0, 1.5, 1000.0, 0.1), zo},
            {glm::orthoRH_NO(-1.0, 1.0, -1.0, 1.0, -3.0, 500.0), gl},
            {glm::orthoRH_NO(-1.0, 1.0, -1.0, 1.0, 500.0, -3.0), gl_reversed},
            {glm::orthoRH_ZO(-1.0, 1.0, -1.0, 1.0, 0.1, 500.0), zo},
            {glm::orthoRH_ZO(-1.0, 1.0, -1.0, 1.0, 500.0, 0.1), zo_reversed}};
}

/// How many of the depths' view depths lie outside of the bounds that their samples give.
std::size_t outside(const DepthCamera& camera, const std::vector<Window>& depths,
                    const std::vector<float>& samples, DepthFormat format) {
    const Reduced reduced = reduce(camera.view(samples.size()), {.depth = samples, .format = format});
    std::size_t count = 0;
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const long double depth = camera.view_depth(depths[i]);
        count += !(static_cast<long double>(reduced.min[i]) <= depth &&
                   depth <= static_cast<long double>(reduced.max[i]));
    }
    return count;
}

}  // namespace

TEST_CASE("bounds hold what was drawn, whichever way the buffer rounds it") {
    for (const DepthFormat format : {DepthFormat::float32, DepthFormat::unorm24, DepthFormat::unorm16}) {
        const std::vector<Window> depths = depths_to_store(format);
        for (const int rounding : {-1, 0, 1})
            for (const int float_rounding : {-1, 0, 1}) {
                std::vector<float> samples;
                for (const Window depth : depths)
                    samples.push_back(stored(depth, format, rounding, float_rounding));
                for (const DepthCamera& camera : depth_cameras()) {
                    const std::string name = to_string(format);
                    CAPTURE(name);
                    CAPTURE(rounding);
                    CAPTURE(float_rounding);
                    CHECK(camera.view(1).reversed_z() == (camera.view_depth(0) > camera.view_depth(one)));
                    CHECK(outside(camera, depths, samples, format) == 0);
                }
            }
    }
}

TEST_CASE("bounds don't hold what was drawn further off than the format rounds") {
    for (const DepthCamera& camera : depth_cameras()) {
        // Four steps off: two are the most that are allowed for, and orthographic bounds are rounded by one.
        for (const DepthFormat format : {DepthFormat::float32, DepthFormat::unorm24, DepthFormat::unorm16}) {
            const std::uint64_t steps = format == DepthFormat::float32 ? 1 << 24 : steps_of(format);
            std::vector<Window> depths;
            std::vector<float> samples;
            for (std::uint64_t step = steps * 3 / 4; step < steps * 3 / 4 + 20; ++step)
                for (const int off : {-4, 4}) {
                    depths.push_back(step * one / steps);
                    const Window other = (step + static_cast<std::uint64_t>(off)) * one / steps;
                    samples.push_back(stored(other, format, 0, 0));
                }
            CHECK(outside(camera, depths, samples, format) == depths.size());
        }
        // A buffer of 16 bits that is said to be a finer one.
        std::vector<Window> depths;
        std::vector<float> samples;
        for (std::uint64_t step = 1; step < 0xffff; step += 99) {
            depths.push_back(step * one / 0xffff + one / 0x40000);  // a quarter of a step beside
            samples.push_back(stored(depths.back(), DepthFormat::unorm16, 0, 0));
        }
        CHECK(outside(camera, depths, samples, DepthFormat::unorm16) == 0);
        CHECK(outside(camera, depths, samples, DepthFormat::unorm24) == depths.size());
        CHECK(outside(camera, depths, samples, DepthFormat::float32) == depths.size());
    }
}
