// What a View takes from a matrix, and what it refuses by name.
#include <doctest/doctest.h>

#include <lightbin/view.hpp>

#define GLM_FORCE_CTOR_INIT
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

using lightbin::ClipDepth;
using lightbin::ErrorCode;
using lightbin::View;
using lightbin::ViewOptions;
using lightbin::WindowOrigin;

namespace {

constexpr lightbin::ImageSize full_hd = {1920, 1080};

template <class Matrix>
ErrorCode refusal(const Matrix& matrix, lightbin::ImageSize viewport = full_hd, ViewOptions options = {}) {
    const auto view = View::from_projection(matrix, viewport, options);
    REQUIRE(!view);
    CHECK(std::string(view.error().message()).size() > 20);
    return view.error().code;
}

}  // namespace

TEST_CASE("the wrong clip depth can only be wrong on the side that is documented") {
    const auto matrix = glm::perspectiveRH_ZO(1.0f, 1.5f, 0.25f, 512.0f);
    CHECK(View::from_projection(matrix, full_hd)->near_depth() < 0.25f);
}

TEST_CASE("tile grids") {
    const auto matrix = glm::perspective(1.0f, 1.5f, 0.1f, 100.0f);
    const auto tiles = [&](int width, int height, int size) {
        const auto view = View::from_projection(matrix, {width, height}, {.tile_size = size});
        REQUIRE(view);
        CHECK(view->tile_count() ==
              static_cast<std::size_t>(view->tiles_x()) * static_cast<std::size_t>(view->tiles_y()));
        return std::pair(view->tiles_x(), view->tiles_y());
    };
    CHECK(tiles(1920, 1080, 32) == std::pair(60, 34));
    CHECK(tiles(1920, 1088, 32) == std::pair(60, 34));
    CHECK(tiles(1919, 1089, 32) == std::pair(60, 35));
    CHECK(tiles(1, 1, 1) == std::pair(1, 1));
    CHECK(tiles(640, 480, 1) == std::pair(640, 480));
    CHECK(tiles(640, 480, 1000) == std::pair(1, 1));
    CHECK(tiles(640, 480, std::numeric_limits<int>::max()) == std::pair(1, 1));
    CHECK(tiles(0, 0, 16) == std::pair(0, 0));
    CHECK(tiles(0, 480, 16) == std::pair(0, 30));
    CHECK(tiles(16384, 16384, 1) == std::pair(16384, 16384));
}

TEST_CASE("numbers of columns and rows: each pixel is in the tile of its centre, up to the largest sizes") {
    const auto matrix = glm::perspective(1.0f, 1.5f, 0.1f, 100.0f);
    for (const int width : {1, 2, 7, 640, 1919, 32768})
        for (const int columns : {1, 2, 3, 16, 639, 1919, 32767, 32768}) {
            const View view = *View::from_projection(matrix, {width, 1080}, {.columns = columns, .rows = 9});
            CHECK(view.tiles_x() == columns);
            CHECK(view.tiles_y() == 9);
            CHECK(view.tile_size() == 0);
            bool right = true;
            for (int x = 0; x < width; ++x) {
                const long double tiles = (x + 0.5L) * columns / width;  // exact
                right = right && view.tile_of_pixel(x, 600)->x == static_cast<int>(tiles);
                right = right && view.tile_at({x + 0.9, 600, 1})->x == static_cast<int>(tiles);
            }
            CHECK(right);
            CHECK(!view.tile_of_pixel(width, 600));
        }
    const View view = *View::from_projection(glm::perspective(1.0f, 16 / 9.0f, 0.1f, 100.0f), full_hd,
                                             {.columns = 16, .rows = 9});
    CHECK(view.with_tile_size(24)->tiles_x() == 80);
    const std::string line(to_string(view.summary()));
    CHECK(line.find("1920 x 1080 pixels in 16 x 9 tiles") != std::string::npos);
    CHECK(line.find('?') == std::string::npos);
    CHECK(View::from_projection(matrix, {0, 480}, {.columns = 16, .rows = 9})->tile_count() == 0);
}

TEST_CASE("at most so many tiles: about square ones") {
    const auto matrix = glm::perspective(1.0f, 1.5f, 0.1f, 100.0f);
    const auto tiles = [&](int width, int height, int most) {
        const View view = *View::from_projection(matrix, {width, height}, {.max_tiles = most});
        return std::pair(view.tiles_x(), view.tiles_y());
    };
    CHECK(tiles(1920, 1080, 4096 / 24) == std::pair(17, 10));
    CHECK(tiles(1080, 1920, 4096 / 24) == std::pair(10, 17));
    CHECK(tiles(1000, 1000, 1) == std::pair(1, 1));
    CHECK(tiles(1, 32768, 170) == std::pair(1, 170));
    CHECK(tiles(32768, 1, 170) == std::pair(170, 1));
    CHECK(tiles(4, 2, 170) == std::pair(4, 2));  // no tile is less than a pixel
    CHECK(tiles(32768, 32768, std::numeric_limits<int>::max()) == std::pair(32768, 32768));
    CHECK(tiles(0, 100, 170).first == 0);
    for (int most = 1; most < 6000; most += 7)
        for (const auto& [width, height] : {std::pair(1920, 1080), {3440, 1440}, {1080, 2400}, {800, 800}}) {
            const auto [columns, rows] = tiles(width, height, most);
            CHECK(columns * rows <= most);
            const double shape = 1.0 * width / columns / (1.0 * height / rows);
            if (most > 100) CHECK(std::fabs(std::log2(shape)) < 0.25);
        }
}

TEST_CASE("sizes out of range are refused, and the text names them") {
    const auto matrix = glm::perspective(1.0f, 1.5f, 0.1f, 100.0f);
    CHECK(refusal(matrix, {-1, 1080}) == ErrorCode::viewport_out_of_range);
    CHECK(refusal(matrix, {1920, 40000}) == ErrorCode::viewport_out_of_range);
    CHECK(refusal(matrix, full_hd, {.tile_size = 0}) == ErrorCode::tile_size_out_of_range);
    CHECK(refusal(matrix, full_hd, {.tile_size = -8}) == ErrorCode::tile_size_out_of_range);
    const auto message = [&](lightbin::ImageSize viewport, ViewOptions options) -> std::string {
        return View::from_projection(matrix, viewport, options).error().message();
    };
    CHECK(message({1920, 40000}, {}).find("40000") != std::string::npos);
    CHECK(message({1920, 40000}, {}).find("32768") != std::string::npos);
    CHECK(message(full_hd, {.tile_size = -8}).find("-8") != std::string::npos);
    for (const auto& [columns, rows, max_tiles, given] :
         {std::tuple(3, 0, 0, " 0"), {0, 3, 0, " 0"}, {-2, 3, 0, "-2"}, {3, 32769, 0, "32769"}, {0, 0, -7, "-7"}}) {
        const ViewOptions options = {.columns = columns, .rows = rows, .max_tiles = max_tiles};
        CHECK(refusal(matrix, full_hd, options) == ErrorCode::tile_count_out_of_range);
        CHECK(message(full_hd, options).find(given) != std::string::npos);
    }
}

TEST_CASE("matrices that are no projection of the promised kinds are refused by name") {
    const glm::mat4 good = glm::perspective(1.0f, 1.5f, 0.1f, 100.0f);
    const auto with = [&](int column, int row, float value, glm::mat4 matrix) {
        matrix[column][row] = value;
        return matrix;
    };
    const auto all_are = [](ErrorCode code, const std::vector<glm::mat4>& matrices) {
        for (const glm::mat4& matrix : matrices)
            CHECK(refusal(matrix) == code);
    };
    for (const float bad : {std::nanf(""), HUGE_VALF, -HUGE_VALF})
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                CHECK(refusal(with(column, row, bad, good)) == ErrorCode::matrix_not_finite);

    const glm::mat4 box = glm::ortho(-1.0f, 1.0f, -1.0f, 1.0f, 0.0f, 10.0f);
    all_are(ErrorCode::not_a_projection,
            {glm::mat4(0.0f), with(0, 3, 0.1f, good), with(1, 3, 0.1f, good),
             -glm::ortho(-1.0f, 1.0f, -1.0f, 1.0f, 0.0f, 1.0f)});  // the last has w < 0: nothing in view
    all_are(ErrorCode::eye_not_at_origin,
            {with(3, 3, 1.0f, good), with(3, 0, 1.0f, good), with(3, 1, 1.0f, good),
             good * glm::translate(glm::mat4(1.0f), {0.0f, 0.0f, -5.0f})});
    all_are(ErrorCode::image_axes_rotated, {with(1, 0, 0.1f, good), with(0, 1, 0.1f, good),
                                            with(2, 0, 0.1f, box), with(2, 1, 0.1f, box)});
    all_are(ErrorCode::degenerate_scale, {with(0, 0, 0.0f, good), with(1, 1, 0.0f, good),
                                          with(1, 1, 1e30f, good), with(0, 0, 1e-30f, good)});
    for (const float much : {1e30f, -1e30f})
        all_are(ErrorCode::image_offset_out_of_range, {with(2, 0, much, good), with(2, 1, much, good),
                                                       with(3, 0, much, box), with(3, 1, much, box)});
    all_are(ErrorCode::depth_range_not_finite, {with(2, 2, 0.0f, box), with(2, 2, 1e-39f, box)});
    // With the last matrix, all points with a depth of -1 to 1 lie behind the eye.
    all_are(ErrorCode::no_near_plane, {with(3, 2, 0.0f, good), with(2, 2, 5, good)});
    CHECK(refusal(with(3, 2, -1e-39f, good)) == ErrorCode::near_plane_too_close);
    // Reversed Z without any point between the planes: clip z is w plus a constant, more than w everywhere.
    CHECK(refusal(with(3, 2, 1, with(2, 2, -1, good))) == ErrorCode::no_near_plane);
    // Oblique near planes through the eye, and such that cut off all of the image; and one that cuts off its middle.
    const glm::mat4 oblique = with(0, 2, 0.5f, good);
    all_are(ErrorCode::no_near_plane, {with(3, 2, 0.0f, oblique), with(2, 2, 5, oblique)});
    for (const lightbin::ImageSize viewport : {full_hd, {0, 0}})
        CHECK(View::from_projection(with(2, 2, 1, oblique), viewport));
    for (const float huge : {1e38f, -1e38f})
        all_are(ErrorCode::near_plane_too_close, {with(0, 2, huge, good)});
    all_are(ErrorCode::depth_range_not_finite, {with(0, 2, FLT_MAX, with(2, 2, -1e-30f, box))});
    glm::dmat4 closer(good);
    for (const double offset : {-1e-60, -1e-320}) {
        closer[3][2] = offset;
        CHECK(refusal(closer) == ErrorCode::near_plane_too_close);
    }
    const glm::mat4 reversed_infinite = with(3, 2, 1e-39f, with(2, 2, 0, good));
    CHECK(refusal(reversed_infinite, full_hd, {.clip_depth = ClipDepth::zero_to_one}) ==
          ErrorCode::near_plane_too_close);
    CHECK(refusal(with(3, 2, 0, reversed_infinite)) == ErrorCode::no_near_plane);  // its near plane is at 0
}

TEST_CASE("a transposed matrix is refused as that, where it can be told") {
    const auto transposed = [](const glm::mat4& matrix) { return refusal(glm::transpose(matrix)); };
    CHECK(transposed(glm::frustum(-1.0f, 2.0f, -3.0f, 0.5f, 0.2f, 512.0f)) ==
          ErrorCode::projection_transposed);
    CHECK(transposed(glm::ortho(-4.0f, 4.0f, -3.0f, 3.0f, 0.0f, 10.0f)) == ErrorCode::projection_transposed);
    CHECK(transposed(glm::ortho(-4.0f, 9.0f, -3.0f, 3.0f, -5.0f, 10.0f)) == ErrorCode::projection_transposed);

    glm::mat4 turned = glm::frustum(-1.0f, 2.0f, -3.0f, 0.5f, 0.2f, 512.0f);
    for (int column = 0; column < 4; ++column)
        std::swap(turned[column].x, turned[column].y);
    CHECK(View::from_projection(turned, full_hd)->turned());
    CHECK(transposed(turned) == ErrorCode::projection_transposed);

    // A matrix that is refused for another reason keeps that reason.
    const glm::mat4 view = glm::lookAt(glm::vec3(1, 2, 3), glm::vec3(0, 0, 0), glm::vec3(0, 1, 0)),
                    good = glm::perspective(1.0f, 1.5f, 0.1f, 100.0f);
    CHECK(refusal(good * view) == ErrorCode::not_a_projection);
    CHECK(transposed(good * view) == ErrorCode::not_a_projection);
    CHECK(refusal(view) == ErrorCode::image_axes_rotated);
}

TEST_CASE("a projection along x or y is refused by name, and taken with the columns in the order that the text says") {
    // As Panda3D's lenses make them, which have z up in view space: x right, depth along y.
    const glm::mat4 perspective = {{1.5f, 0, 0, 0}, {0, 0, 1001 / 999.0f, 1}, {0, 2, 0, 0}, {0, 0, -2000 / 999.0f, 0}},
                    flat = {{0.1f, 0, 0, 0}, {0, 0, 2 / 999.0f, 0}, {0, 0.2f, 0, 0}, {0, 0, -1001 / 999.0f, 1}};
    for (const glm::mat4& along_y : {perspective, flat}) {
        const glm::mat4 along_x(along_y[1], along_y[0], along_y[2], along_y[3]),
            reordered(along_y[0], along_y[2], along_y[1], along_y[3]);
        CHECK((reordered == glm::mat4(along_x[1], along_x[2], along_x[0], along_x[3])));
        const auto text = [](const glm::mat4& matrix) -> std::string {
            return View::from_projection(matrix, full_hd).error().message();
        };
        CHECK(refusal(along_x) == ErrorCode::looks_along_x);
        CHECK(refusal(along_y) == ErrorCode::looks_along_y);
        CHECK(text(along_x).find("in the order y, z, x, w") != std::string::npos);
        CHECK(text(along_y).find("in the order x, z, y, w") != std::string::npos);
        const auto summary = View::from_projection(reordered, full_hd)->summary();
        CHECK(summary.near_depth == doctest::Approx(1).epsilon(1e-4));
        CHECK(summary.far_depth == doctest::Approx(1000).epsilon(1e-4));
        CHECK(!summary.looks_down_negative_z);
        CHECK(!summary.y_flipped);
    }
}

TEST_CASE("a view says what it read, and what is seldom meant") {
    const auto summary = [](const glm::mat4& matrix, lightbin::ImageSize viewport = full_hd, ViewOptions options = {}) {
        const auto view = View::from_projection(matrix, viewport, options);
        REQUIRE(view);
        return view->summary();
    };
    const glm::mat4 good = glm::perspective(glm::radians(60.0f), 16.0f / 9, 0.25f, 512.0f),
                    flipped = glm::scale(glm::mat4(1.0f), {1.0f, -1.0f, 1.0f}),
                    reversed = glm::orthoRH_ZO(-4.0f, 4.0f, -4.0f, 4.0f, 100.0f, 0.1f);
    const ViewOptions zero_to_one = {.clip_depth = ClipDepth::zero_to_one};
    CHECK(std::string(to_string(summary(good))) ==
          "perspective, 91.49 x 60 degrees, aspect 1.778, near 0.25, far 512, looks down -z "
          "(right-handed), 1920 x 1080 pixels in tiles of 32");

    // The properties of a view that are doubtful; each is a question in the text.
    const auto check = [](const lightbin::ViewSummary& of, const std::string& expected) {
        const std::pair<bool, const char*> all[] = {
            {of.looks_transposed, "transposed"}, {of.looks_like_view_matrix, "view matrix"},
            {of.looks_turned, "turned"},         {of.looks_behind, "behind"},
            {of.looks_zero_to_one, "0 to 1"},    {of.pixels_not_square, "pixels"},
            {of.viewport_empty, "empty"}};
        std::string doubts;
        std::ptrdiff_t count = 0;
        for (const auto& [doubted, name] : all)
            if (doubted) doubts += (count++ == 0 ? "" : ", ") + std::string(name);
        CHECK(doubts == expected);
        const std::string line = to_string(of);
        CHECK(std::count(line.begin(), line.end(), '?') == count);
    };
    check(summary(good), "");
    check(summary(3.0f * good), "");
    check(summary(good, {}), "empty");
    check(summary(good, {0, 1080}), "empty");
    check(summary(good, {1920, 0}), "empty");
    check(summary(flipped * glm::perspectiveLH_ZO(1.0f, 1.5f, 100.0f, 0.25f), {150, 100}, zero_to_one), "");
    check(summary(glm::ortho(-4.0f, 12.0f, -3.0f, 6.0f, 0.0f, 10.0f)), "");
    check(summary(good, {1366, 768}), "");
    check(summary(glm::infinitePerspective(1.0f, 16.0f / 9, 0.1f)), "");
    for (const float z_near : {0.1f, 0.2f, 0.4f, 1.0f, 3.0f})
        check(summary(glm::transpose(glm::perspective(1.0f, 16.0f / 9, z_near, 512.0f))), "transposed");
    check(summary(glm::mat4(1.0f), {100, 100}), "view matrix");
    check(summary(glm::translate(glm::mat4(1.0f), {1.0f, 2.0f, 3.0f}), {100, 100}), "view matrix, behind");
    check(summary(glm::perspective(60.0f, 16.0f / 9, 0.25f, 512.0f)), "turned");
    check(summary(good, {1080, 1920}), "pixels");
    check(summary(good, {1280, 1024}), "pixels");
    check(summary(reversed, {100, 100}, zero_to_one), "behind");
    check(summary(reversed, {100, 100}, {.clip_depth = ClipDepth::zero_to_one, .reversed_z = true}), "");
    for (const float z_far : {1.0f, 512.0f, 1e9f}) {
        const glm::mat4 matrix = glm::perspectiveRH_ZO(1.0f, 16.0f / 9, z_far, 0.25f);
        check(summary(matrix), "0 to 1");
        check(summary(matrix, full_hd, zero_to_one), "");
        check(summary(glm::perspectiveRH_NO(1.0f, 16.0f / 9, z_far, 0.25f)), "");
    }
}

namespace {

/// What a projection matrix is made of.
struct Made {
    bool flat;
    ClipDepth clip;
    bool reversed;
    double forward, far;
    int flip_x, flip_y;
};

void check_summary(const Made& made, lightbin::ImageSize viewport) {
    const auto [flat, clip, reversed, forward, far, flip_x, flip_y] = made;
    const double left = -0.3, right = 0.5, low = -0.2,
                 high = 0.7;  // where depth is 1; orthographic: anywhere
    // z_clip = a depth + b, such that z_ndc is `first` on the near plane and `last` on the far plane.
    const double near = 0.25, lower = clip == ClipDepth::zero_to_one ? 0 : -1, first = reversed ? 1 : lower,
                 last = reversed ? lower : 1;
    double a = (last - first) / (far - near), b = first - a * near;
    if (!flat) {
        b = std::isinf(far) ? (first - last) * near : (first - last) * near * far / (far - near);
        a = std::isinf(far) ? last : first - b / near;
    }
    double m[4][4] = {};
    double* const shift = m[flat ? 3 : 2];
    m[0][0] = flip_x * 2 / (right - left);
    m[1][1] = flip_y * 2 / (high - low);
    shift[0] = flip_x * (right + left) / (left - right) * (flat ? 1 : forward);
    shift[1] = flip_y * (high + low) / (low - high) * (flat ? 1 : forward);
    m[2][2] = forward * a;
    m[3][2] = b;
    shift[3] = flat ? 1 : forward;
    const auto view = View::from_projection(m, viewport, {.clip_depth = clip, .reversed_z = reversed});
    REQUIRE(view);

    const auto read = view->summary();
    const auto is = [](double value) { return doctest::Approx(value).epsilon(1e-9); };
    const auto degrees = [](double from, double to) { return glm::degrees(std::atan(to) - std::atan(from)); };
    CHECK(read.orthographic == flat);
    CHECK(read.x_size == is(flat ? right - left : degrees(left, right)));
    CHECK(read.y_size == is(flat ? high - low : degrees(low, high)));
    CHECK(read.aspect == is((right - left) / (high - low)));
    CHECK(read.near_depth == is(near));
    if (std::isinf(far))
        CHECK(read.far_depth == far);
    else
        CHECK(read.far_depth == is(far));
    CHECK(read.looks_down_negative_z == (forward < 0));
    CHECK(read.reversed_z == reversed);
    CHECK(read.x_flipped == (flip_x < 0));
    CHECK(read.y_flipped == (flip_y < 0));
    CHECK(!read.looks_zero_to_one);
    CHECK(read.viewport_empty == (viewport.width == 0 || viewport.height == 0));
    CHECK(read.pixels_not_square == !read.viewport_empty);
    CHECK(std::string(to_string(read)).find("nan") == std::string::npos);
}

}  // namespace

TEST_CASE("a summary has the numbers that the matrix was made of") {
    const double inf = std::numeric_limits<double>::infinity();
    for (const bool flat : {false, true})
        for (const ClipDepth clip : {ClipDepth::minus_one_to_one, ClipDepth::zero_to_one})
            for (const bool reversed : {false, true})
                for (const double forward : {-1.0, 1.0})
                    for (const double far : {3.0, 100.0, 1e5, flat ? 7.0 : inf})
                        for (const auto& [flip_x, flip_y] : {std::pair(1, 1), {-1, 1}, {1, -1}})
                            for (const lightbin::ImageSize viewport : {full_hd, {0, 0}, {640, 0}, {0, 480}}) {
                                CAPTURE(flat);
                                CAPTURE(to_string(clip));
                                CAPTURE(reversed);
                                CAPTURE(far);
                                CAPTURE(viewport.width);
                                check_summary({flat, clip, reversed, forward, far, flip_x, flip_y}, viewport);
                            }
}

TEST_CASE("a view's grid can be made anew with other tiles") {
    const glm::mat4 jittered = glm::frustumRH_ZO(-1.1f, 2.0f, 0.6f, -0.5f, 30.0f, 0.25f),
                    flat = glm::orthoRH_ZO(-4.0f, 4.0f, -3.0f, 3.0f, 50.0f, 1.0f);
    const auto all_of = [](const View& view) {
        const lightbin::ImagePoint at = view.image_point({1, 2, -3});
        return std::tuple(view.tile_size(), view.tiles_x(), view.tiles_y(), view.origin(), view.reversed_z(),
                          view.near_depth(), view.far_depth(), at.x, at.y);
    };
    for (const auto& [matrix, reversed] : {std::pair(jittered, false), std::pair(flat, true)}) {
        ViewOptions options = {.tile_size = 8, .clip_depth = ClipDepth::zero_to_one};
        options.origin = WindowOrigin::upper_left;
        options.reversed_z = reversed;
        const View view = *View::from_projection(matrix, {1919, 1079}, options);
        for (const int size : {1, 8, 17, 64, 5000}) {
            options.tile_size = size;
            CHECK(view.with_tile_size(size)->tile_size() == size);
            CHECK((all_of(*view.with_tile_size(size)) ==
                   all_of(*View::from_projection(matrix, {1919, 1079}, options))));
        }
        CHECK(view.with_tile_size(0).error().code == ErrorCode::tile_size_out_of_range);
    }
}

namespace {

/// A projection matrix and its viewing direction: view depth is `forward` times z.
struct Projected {
    glm::dmat4 matrix;
    double forward;
    bool perspective = true;
};

std::vector<Projected> all_kinds() {
    glm::dmat4 jittered = glm::perspectiveRH_NO(1.0, 1.5, 0.1, 100.0);
    jittered[2][0] += 0.003;
    jittered[2][1] -= 0.002;
    glm::dmat4 flipped = glm::perspectiveRH_ZO(0.7, 0.8, 0.1, 100.0);
    flipped[0][0] = -flipped[0][0];
    flipped[1][1] = -flipped[1][1];
    std::vector<Projected> all = {
        {glm::dmat4(glm::perspectiveRH_NO(1.0f, 1.5f, 0.1f, 100.0f)), -1},
        {jittered, -1},
        {flipped, -1},
        {3.0 * jittered, -1},
        {glm::perspectiveLH_ZO(2.5, 1.0, 0.1, 100.0), 1},
        {glm::perspectiveRH_ZO(1.0, 1.5, 100.0, 0.1), -1},  // reversed Z
        {glm::infinitePerspective(1.0, 1.5, 0.1), -1},
        {glm::frustumRH_NO(0.1, 0.3, -0.5, -0.1, 0.1, 100.0), -1},
        {glm::orthoRH_NO(-4.0, 9.0, -3.0, 5.0, 0.1, 100.0), -1, false},
        {glm::orthoLH_ZO(-4.0, 4.0, 3.0, -3.0, -50.0, 100.0), 1, false},
    };
    for (std::size_t i = 0, upright = all.size(); i < 2 * upright; ++i) {  // turned by 90 and 270 degrees
        Projected made = all[i / 2];
        const double up = i % 2 == 0 ? 1 : -1;
        for (int column = 0; column < 4; ++column) {
            const glm::dvec4& of = all[i / 2].matrix[column];
            made.matrix[column] = {up * of.y, -up * of.x, of.z, of.w};
        }
        all.push_back(made);
    }
    return all;
}

/// Checks the pixel coordinates of a point against their definition: matrix, division by w, viewport.
void check_place(const View& view, const Projected& made, const lightbin::ViewPoint& point) {
    const long double p[] = {point.x, point.y, point.z, 1};
    long double clip[4] = {};
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            clip[row] += static_cast<long double>(made.matrix[column][row]) * p[column];
    const auto [width, height] = view.viewport();
    const long double x = (clip[0] / clip[3] + 1) / 2 * width, up = (clip[1] / clip[3] + 1) / 2 * height,
                      y = view.origin() == WindowOrigin::lower_left ? up : height - up;

    const lightbin::ImagePoint place = view.image_point(point);
    // The allowed error: the largest terms of the sums, times some roundings of doubles.
    const long double error = 1e-14L * (std::fabs(x) + std::fabs(y) + width + height) *
                              (1 + std::fabs(made.matrix[2][0]) + std::fabs(made.matrix[2][1]));
    CHECK(std::fabs(x - static_cast<long double>(place.x)) <= error);
    CHECK(std::fabs(y - static_cast<long double>(place.y)) <= error);
    CHECK(place.depth == made.forward * point.z);

    const lightbin::ViewPoint back = view.view_point(place);
    CHECK(back.x == doctest::Approx(point.x).epsilon(1e-9));
    CHECK(back.y == doctest::Approx(point.y).epsilon(1e-9));
    CHECK(back.z == point.z);
}

}  // namespace

TEST_CASE("a point of view space lies where the matrix puts it, and back") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> side(-1.2, 1.2), depth(-5, 60);
    for (const Projected& made : all_kinds())
        for (const lightbin::ImageSize viewport :
             {full_hd, lightbin::ImageSize{1919, 1079}, lightbin::ImageSize{3, 500}})
            for (const WindowOrigin origin : {WindowOrigin::lower_left, WindowOrigin::upper_left}) {
                const auto view = View::from_projection(
                    made.matrix, viewport,
                    {.tile_size = 17, .max_tiles = viewport.width == 3 ? 90 : 0,
                     .clip_depth = ClipDepth::zero_to_one, .origin = origin});
                REQUIRE(view);
                CHECK(view->turned() == (made.matrix[0][0] == 0));
                for (int i = 0; i < 200; ++i) {
                    const double distance = depth(random), reach = made.perspective ? distance : 5;
                    const lightbin::ViewPoint point = {side(random) * reach, side(random) * reach,
                                                       made.forward * distance};
                    check_place(*view, made, point);
                }
            }
}

TEST_CASE("the tile of each pixel, and of what is none") {
    const auto view =
        View::from_projection(glm::perspectiveRH_NO(1.0f, 1.5f, 0.1f, 100.0f), {50, 31}, {.tile_size = 8});
    REQUIRE(view);
    for (int y = 0; y < 31; ++y)
        for (int x = 0; x < 50; ++x)
            for (const double within : {0.0, 0.5, 0.999}) {
                const auto tile = view->tile_at({x + within, y + within, 1});
                REQUIRE(tile);
                CHECK(tile->x == x / 8);
                CHECK(tile->y == y / 8);
                CHECK(view->tile_of_pixel(x, y)->x == x / 8);
                CHECK(view->tile_of_pixel(x, y)->y == y / 8);
            }
    for (const auto& [x, y] : {std::pair(-1, 0), {0, -1}, {50, 0}, {0, 31}})
        CHECK(!view->tile_of_pixel(x, y));
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    for (const double bad : {-0.001, 50.0, inf, nan})
        CHECK(!view->tile_at({bad, 1, 1}));
    for (const double bad : {-1.0, 31.0, -inf, nan})
        CHECK(!view->tile_at({1, bad, 1}));
    for (const double bad : {0.0, -3.0, nan})
        CHECK(!view->tile_at({1, 1, bad}));
    CHECK(!view->tile_at(view->image_point({0, 0, 0})));  // the eye itself
    CHECK(!view->tile_at(view->image_point({0, 0, 1})));  // behind it
    const auto empty = View::from_projection(glm::perspectiveRH_NO(1.0f, 1.5f, 0.1f, 100.0f), {0, 31});
    REQUIRE(empty);
    CHECK(!empty->tile_at(empty->image_point({0, 0, -1})));
}
