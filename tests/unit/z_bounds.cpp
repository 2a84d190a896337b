// reduce_depth(): sizes of its buffers, and buffers of view depths. tests/oracle/depth.cpp compares bounds of window
// depths with exact ones.
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

/// Returns the window depth of a view depth in test::view().
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
    // Pitches (row lengths) that give 0 or little when they are multiplied by 63 or 64 and overflow.
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

TEST_CASE("a buffer of view depths is taken as it is") {
    const View view = test::view({64, 32}, 32);
    constexpr float inf = std::numeric_limits<float>::infinity();
    std::vector<float> depth(64 * 32, 7.0f);
    depth[0] = 5, depth[64 + 1] = 9, depth[40] = inf, depth[41] = -3;
    Reduced reduced = reduce(view, {.depth = depth, .format = DepthFormat::view_depth, .skip_background = true});
    constexpr float widened = 0x1p-18f;
    CHECK(reduced.min[0] <= 5 * (1 - widened));
    CHECK(reduced.min[0] >= 5 * (1 - 2 * widened));
    CHECK(reduced.max[0] >= 9 * (1 + widened));
    CHECK(reduced.max[0] <= 9 * (1 + 2 * widened));
    CHECK(reduced.min[1] <= -3 * (1 + widened));
    CHECK(reduced.max[1] <= 7 * (1 + 2 * widened));
    reduced = reduce(view, {.depth = depth, .format = DepthFormat::view_depth});
    CHECK(reduced.max == std::vector<float>{reduced.max[0], inf});
    depth[2] = std::nanf("");
    reduced = reduce(view, {.depth = depth, .format = DepthFormat::view_depth});
    CHECK(reduced.min[0] == -inf);
    CHECK(reduced.max[0] == inf);
    const std::vector<float> nothing(64 * 32, inf);
    reduced = reduce(view, {.depth = nothing, .format = DepthFormat::view_depth, .skip_background = true});
    CHECK(reduced.min == std::vector<float>{inf, inf});
    CHECK(reduced.max == std::vector<float>{-inf, -inf});
}

// As it was reported: its depths taken for window depths of the matrix, most lights are missed where they shine.
TEST_CASE("a logarithmic depth buffer, converted to view depths, misses no light") {
    constexpr int width = 640, height = 360;
    const View view = *View::from_projection(glm::perspective(1.0471976f, 16 / 9.0f, 1.0f, 1000.0f), {width, height});
    const auto surface = [](int x, int y) { return 20 + 17 * std::sin(9.0 * x / width) * std::cos(5.0 * y / height); };
    std::vector<float> logarithmic, converted;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double steps = 0x1p24 - 1;
            const double window = std::round(std::log2(1 + surface(x, y)) / std::log2(1001.0) * steps) / steps;
            logarithmic.push_back(static_cast<float>(window));
            converted.push_back(std::exp2(logarithmic.back() * std::log2(1001.0f)) - 1);
        }
    const auto point_at = [&](int x, int y) { return view.view_point({x + 0.5, y + 0.5, surface(x, y)}); };
    std::mt19937 random(7);
    std::uniform_real_distribution<float> radius(0.5f, 3);
    std::vector<Sphere> lights;
    for (int i = 0; i < 300; ++i) {
        const ViewPoint at = point_at(static_cast<int>(random() % width), static_cast<int>(random() % height));
        lights.push_back(
            {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z), radius(random)});
    }
    // How many pairs of a pixel and a light that reaches it the lists lack.
    std::size_t pairs = 0;
    const auto missed = [&](const std::vector<float>& depth, DepthFormat format) {
        const Reduced bounds = reduce(view, {.depth = depth, .format = format});
        const auto lists = test::lists<Options{.depth_test = true}>(view, lights, {bounds.min, bounds.max});
        std::size_t count = pairs = 0;
        for (int y = 0; y < height; y += 4)
            for (int x = 0; x < width; x += 4)
                for (std::uint32_t id = 0; id < lights.size(); ++id) {
                    const Sphere& light = lights[id];
                    const ViewPoint at = point_at(x, y);
                    if (std::hypot(at.x - static_cast<double>(light.x), at.y - static_cast<double>(light.y),
                                   at.z - static_cast<double>(light.z)) > static_cast<double>(light.radius))
                        continue;
                    const auto& list = lists[static_cast<std::size_t>(y / 32 * view.tiles_x() + x / 32)];
                    ++pairs;
                    count += !std::binary_search(list.begin(), list.end(), id);
                }
        return count;
    };
    CHECK(missed(converted, DepthFormat::view_depth) == 0);
    CHECK(pairs > 20000);
    CHECK(missed(logarithmic, DepthFormat::unorm24) > pairs / 2);
}
