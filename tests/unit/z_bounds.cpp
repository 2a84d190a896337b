// reduce_depth: sizes, and gaps. What the bounds hold is compared with rationals in tests/oracle.
#include "scene.hpp"

#include <limits>

using namespace lightbin;

namespace {

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

}  // namespace

TEST_CASE("tiles of which 8 samples a pixel are more than 32 bits count") {
    const std::vector<float> depth(37 * 21 * 8, window_depth(10));
    for (const int tile_size : {64, 1 << 29, (1 << 29) + 1, std::numeric_limits<int>::max()}) {
        const Reduced reduced = reduce(test::view({37, 21}, tile_size), {.depth = depth, .samples = 8});
        CHECK(reduced.max == reduce(test::view({37, 21}, 37), {.depth = depth, .samples = 8}).max);
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
        CHECK(std::string(bounds.error().message()).find(std::to_string(needed)) != std::string::npos);
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

TEST_CASE("gaps lie between a tile's two groups of samples") {
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
        }
}
