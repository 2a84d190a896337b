// What a View takes from a matrix, and what it refuses by name.
#include <doctest/doctest.h>

#include <lightbin/view.hpp>

#define GLM_FORCE_CTOR_INIT
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

using lightbin::ClipDepth;
using lightbin::ErrorCode;
using lightbin::View;
using lightbin::ViewOptions;
using lightbin::WindowOrigin;

namespace {

constexpr lightbin::Extent full_hd = {1920, 1080};

template <class Matrix>
ErrorCode refusal(const Matrix& matrix, lightbin::Extent viewport = full_hd, ViewOptions options = {}) {
    const auto view = View::from_projection(matrix, viewport, options);
    REQUIRE(!view);
    CHECK(view.error().message().size() > 20);
    return view.error().code;
}

void check_depths(const glm::mat4& matrix, const ViewOptions& options, double near, double far) {
    const auto view = View::from_projection(matrix, full_hd, options);
    REQUIRE(view);
    CHECK(view->near_depth() == doctest::Approx(near).epsilon(1e-4));
    if (std::isinf(far))
        CHECK(view->far_depth() == static_cast<float>(far));
    else
        CHECK(view->far_depth() ==
              doctest::Approx(far).epsilon(2e-2));  // a float matrix knows its far plane badly
}

}  // namespace

TEST_CASE("near and far plane come out of the matrix") {
    constexpr double none = std::numeric_limits<double>::infinity();
    const ViewOptions gl = {}, zero_to_one = {.clip_depth = ClipDepth::zero_to_one};
    constexpr float fov = 1.0f, aspect = 16.0f / 9, near = 0.25f, far = 512.0f;

    check_depths(glm::perspectiveRH_NO(fov, aspect, near, far), gl, near, far);
    check_depths(glm::perspectiveLH_NO(fov, aspect, near, far), gl, near, far);
    check_depths(glm::perspectiveRH_ZO(fov, aspect, near, far), zero_to_one, near, far);
    check_depths(glm::perspectiveLH_ZO(fov, aspect, near, far), zero_to_one, near, far);
    check_depths(glm::infinitePerspective(fov, aspect, near), gl, near, none);
    check_depths(glm::perspectiveRH_ZO(fov, aspect, far, near), zero_to_one, near, far);  // reversed Z
    check_depths(glm::frustumRH_NO(-1.0f, 2.0f, -3.0f, 0.5f, near, far), gl, near, far);
    check_depths(glm::orthoRH_NO(-4.0f, 4.0f, -3.0f, 3.0f, near, far), gl, near, far);
    check_depths(glm::orthoLH_ZO(-4.0f, 4.0f, -3.0f, 3.0f, -near, far), zero_to_one, -near, far);
    check_depths(glm::orthoRH_ZO(-4.0f, 4.0f, -3.0f, 3.0f, far, near),
                 {.clip_depth = ClipDepth::zero_to_one, .reversed_z = true}, near, far);

    glm::mat4 reversed_infinite(0.0f);
    reversed_infinite[0][0] = reversed_infinite[1][1] = 1;
    reversed_infinite[2][3] = -1;
    reversed_infinite[3][2] = near;
    check_depths(reversed_infinite, zero_to_one, near, none);
    CHECK(View::from_projection(reversed_infinite, full_hd, zero_to_one)->reversed_z());
    check_depths(3.0f * glm::perspectiveRH_NO(fov, aspect, near, far), gl, near, far);
}

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

TEST_CASE("sizes out of range are refused, and the text names them") {
    const auto matrix = glm::perspective(1.0f, 1.5f, 0.1f, 100.0f);
    CHECK(refusal(matrix, {-1, 1080}) == ErrorCode::viewport_out_of_range);
    CHECK(refusal(matrix, {1920, 40000}) == ErrorCode::viewport_out_of_range);
    CHECK(refusal(matrix, full_hd, {.tile_size = 0}) == ErrorCode::tile_size_out_of_range);
    CHECK(refusal(matrix, full_hd, {.tile_size = -8}) == ErrorCode::tile_size_out_of_range);
    const auto message = [&](lightbin::Extent viewport, ViewOptions options) {
        return View::from_projection(matrix, viewport, options).error().message();
    };
    CHECK(message({1920, 40000}, {}).find("40000") != std::string::npos);
    CHECK(message({1920, 40000}, {}).find("32768") != std::string::npos);
    CHECK(message(full_hd, {.tile_size = -8}).find("-8") != std::string::npos);
}

TEST_CASE("matrices that are no projection of the promised kinds are refused by name") {
    const glm::mat4 good = glm::perspective(1.0f, 1.5f, 0.1f, 100.0f);
    const auto with = [&](int column, int row, float value, glm::mat4 matrix) {
        matrix[column][row] = value;
        return matrix;
    };
    for (const float bad : {std::nanf(""), HUGE_VALF, -HUGE_VALF})
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                CHECK(refusal(with(column, row, bad, good)) == ErrorCode::matrix_not_finite);

    CHECK(refusal(glm::mat4(0.0f)) == ErrorCode::not_a_projection);
    CHECK(refusal(with(0, 3, 0.1f, good)) == ErrorCode::not_a_projection);
    CHECK(refusal(with(1, 3, 0.1f, good)) == ErrorCode::not_a_projection);
    CHECK(refusal(-glm::ortho(-1.0f, 1.0f, -1.0f, 1.0f, 0.0f, 1.0f)) ==
          ErrorCode::not_a_projection);  // w < 0: nothing in view
    CHECK(refusal(with(3, 3, 1.0f, good)) == ErrorCode::eye_not_at_origin);
    CHECK(refusal(with(3, 0, 1.0f, good)) == ErrorCode::eye_not_at_origin);
    CHECK(refusal(with(3, 1, 1.0f, good)) == ErrorCode::eye_not_at_origin);
    CHECK(refusal(good * glm::translate(glm::mat4(1.0f), {0.0f, 0.0f, -5.0f})) ==
          ErrorCode::eye_not_at_origin);
    CHECK(refusal(with(1, 0, 0.1f, good)) == ErrorCode::image_axes_rotated);
    CHECK(refusal(with(0, 1, 0.1f, good)) == ErrorCode::image_axes_rotated);
    CHECK(refusal(with(0, 2, 0.1f, good)) == ErrorCode::oblique_depth);
    CHECK(refusal(with(1, 2, 0.1f, good)) == ErrorCode::oblique_depth);
    CHECK(refusal(with(0, 0, 0.0f, good)) == ErrorCode::degenerate_scale);
    CHECK(refusal(with(1, 1, 0.0f, good)) == ErrorCode::degenerate_scale);
    CHECK(refusal(with(1, 1, 1e30f, good)) == ErrorCode::degenerate_scale);
    CHECK(refusal(with(0, 0, 1e-30f, good)) == ErrorCode::degenerate_scale);
    CHECK(refusal(with(3, 2, 0.0f, good)) == ErrorCode::no_near_plane);

    glm::mat4 behind = good;  // all depths -1..1 lie behind the eye
    behind[2][2] = 5;
    CHECK(refusal(behind) == ErrorCode::no_near_plane);

    const glm::mat4 box = glm::ortho(-1.0f, 1.0f, -1.0f, 1.0f, 0.0f, 10.0f);
    CHECK(refusal(with(2, 0, 0.1f, box)) == ErrorCode::image_axes_rotated);
    CHECK(refusal(with(2, 1, 0.1f, box)) == ErrorCode::image_axes_rotated);
    CHECK(refusal(with(0, 2, 0.1f, box)) == ErrorCode::oblique_depth);
    CHECK(refusal(with(2, 2, 0.0f, box)) == ErrorCode::no_near_plane);
}

TEST_CASE("any matrix indexable as m[column][row] will do") {
    const glm::mat4 m = glm::perspective(1.0f, 1.5f, 0.1f, 100.0f);
    float plain[4][4];
    double wide[4][4];
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            plain[column][row] = m[column][row], wide[column][row] = static_cast<double>(m[column][row]);
    const float near = View::from_projection(m, full_hd)->near_depth();
    CHECK(View::from_projection(plain, full_hd)->near_depth() == near);
    CHECK(View::from_projection(wide, full_hd)->near_depth() == near);
    CHECK(View::from_projection(glm::dmat4(m), full_hd)->near_depth() == near);
}

TEST_CASE("a view's grid can be made anew with other tiles") {
    const glm::mat4 jittered = glm::frustumRH_ZO(-1.1f, 2.0f, 0.6f, -0.5f, 30.0f, 0.25f);
    const ViewOptions options = {
        .tile_size = 8, .clip_depth = ClipDepth::zero_to_one, .origin = WindowOrigin::upper_left};
    const auto view = View::from_projection(jittered, {1919, 1079}, options);
    const glm::mat4 flat = glm::orthoRH_ZO(-4.0f, 4.0f, -3.0f, 3.0f, 50.0f, 1.0f);
    ViewOptions reversed = options;
    reversed.reversed_z = true;
    const auto orthographic = View::from_projection(flat, {1919, 1079}, reversed);
    REQUIRE(view);
    REQUIRE(orthographic);
    for (const int size : {1, 8, 17, 64, 5000}) {
        ViewOptions other = options;
        other.tile_size = reversed.tile_size = size;
        for (const auto& [made_anew, direct] :
             {std::pair(view->with_tile_size(size), View::from_projection(jittered, {1919, 1079}, other)),
              std::pair(orthographic->with_tile_size(size),
                        View::from_projection(flat, {1919, 1079}, reversed))}) {
            REQUIRE(made_anew);
            CHECK(made_anew->tile_size() == size);
            CHECK(made_anew->tiles_x() == direct->tiles_x());
            CHECK(made_anew->tiles_y() == direct->tiles_y());
            CHECK(made_anew->origin() == direct->origin());
            CHECK(made_anew->reversed_z() == direct->reversed_z());
            CHECK(made_anew->near_depth() == direct->near_depth());
            CHECK(made_anew->far_depth() == direct->far_depth());
            CHECK(made_anew->camera().x.scale == direct->camera().x.scale);
            CHECK(made_anew->camera().y.offset == direct->camera().y.offset);
        }
    }
    CHECK(view->with_tile_size(0).error().code == ErrorCode::tile_size_out_of_range);
}
