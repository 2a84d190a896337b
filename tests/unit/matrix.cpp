// Matrices of other libraries, each as that library's users have it: all are the same view, and the same view matrix.
#include <doctest/doctest.h>

#include <lightbin/lightbin.hpp>

#define GLM_FORCE_CTOR_INIT
#include <Eigen/Geometry>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

using namespace lightbin;

namespace {

/// Rows, for v M, as DirectXMath's XMFLOAT4X4 has them.
struct DirectXMatrix {
    explicit DirectXMatrix(const glm::mat4& columns) : m{} {
        std::copy_n(glm::value_ptr(columns), 16, m[0]);
        _11 = m[0][0];
        _44 = m[3][3];
    }
    float operator()(std::size_t row, std::size_t column) const { return m[row][column]; }

    float m[4][4], _11, _44;
};

/// Rows, for v M, as OpenSceneGraph's Matrixd has them.
class SceneGraphMatrix {
public:
    explicit SceneGraphMatrix(const glm::mat4& columns) {
        std::copy_n(glm::value_ptr(columns), 16, numbers_);
    }
    double operator()(int row, int column) const { return numbers_[4 * row + column]; }
    const double* ptr() const { return numbers_; }
    std::array<double, 3> getTrans() const { return {numbers_[12], numbers_[13], numbers_[14]}; }

private:
    double numbers_[16];
};

/// Calls `use` with a matrix in every type that is taken as it is, and as numbers in each layout.
template <class Use> void each_type(const glm::mat4& matrix, const Use& use) {
    use(matrix);
    use(glm::dmat4(matrix));
    float columns[4][4];
    double wide[4][4];
    std::vector<float> flat;
    std::array<double, 16> rows;
    Eigen::Matrix4f eigen;
    Eigen::Matrix<double, 4, 4, Eigen::RowMajor> eigen_rows;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) {
            columns[column][row] = matrix[column][row];
            wide[column][row] = static_cast<double>(matrix[column][row]);
            flat.push_back(matrix[column][row]);
            rows[static_cast<std::size_t>(4 * row + column)] = wide[column][row];
            eigen(row, column) = matrix[column][row];
            eigen_rows(row, column) = wide[column][row];
        }
    use(columns);
    use(wide);
    use(std::array<glm::vec4, 4>{matrix[0], matrix[1], matrix[2], matrix[3]});
    use(eigen);
    use(eigen_rows);
    use(eigen.cast<double>());
    use(Eigen::MatrixXf(eigen));
    use(Eigen::Projective3f(eigen));
    use(DirectXMatrix(matrix));
    use(SceneGraphMatrix(matrix));

    use(lightbin::matrix(flat, MatrixLayout::column_major));
    use(lightbin::matrix(flat.data(), MatrixLayout::column_major));
    use(lightbin::matrix(std::span(flat), MatrixLayout::column_major));
    use(lightbin::matrix(rows, MatrixLayout::row_major));
    use(lightbin::matrix(eigen_rows.data(), MatrixLayout::row_major));
    use(lightbin::matrix(SceneGraphMatrix(matrix).ptr(), MatrixLayout::row_vectors));
    float numbers[16];
    std::copy(flat.begin(), flat.end(), numbers);
    use(lightbin::matrix(numbers, MatrixLayout::row_vectors));
}

}  // namespace

TEST_CASE("a projection is the same in any type") {
    const glm::mat4 projection = glm::frustum(-0.1f, 0.3f, -0.25f, 0.15f, 0.2f, 90.0f);
    int types = 0;
    each_type(projection, [&](const auto& as_it_is) {
        const auto view = View::from_projection(as_it_is, {64, 48}, {.tile_size = 4});
        REQUIRE(view);
        ++types;
        const glm::vec4 clip = projection * glm::vec4(0.5f, -0.25f, -2, 1);
        const ImagePoint there = view->image_point({0.5, -0.25, -2});
        CHECK(there.x == doctest::Approx(32 * (clip.x / clip.w + 1)));
        CHECK(there.y == doctest::Approx(24 * (clip.y / clip.w + 1)));
        CHECK(view->near_depth() == doctest::Approx(0.2));
        CHECK(view->far_depth() == doctest::Approx(90).epsilon(1e-3));
    });
    CHECK(types == 19);
}

TEST_CASE("a view matrix is the same in any type") {
    const glm::mat4 matrix = glm::lookAt(glm::vec3(1, 2, 3), glm::vec3(-4, 0, 1), glm::vec3(0, 1, 0));
    const glm::vec3 lamp = {-2, 0.5f, 2};
    const glm::vec4 moved = matrix * glm::vec4(lamp, 1);
    const std::vector<Sphere> lights = {{lamp.x, lamp.y, lamp.z, 1}};
    each_type(matrix, [&](const auto& as_it_is) {
        const auto world = world_space(lights, as_it_is);
        const Sphere sphere = (*world.to_view)(lights[0]);
        CHECK(sphere.x == doctest::Approx(moved.x));
        CHECK(sphere.y == doctest::Approx(moved.y));
        CHECK(sphere.z == doctest::Approx(moved.z));
    });
    Eigen::Affine3d affine = Eigen::Affine3d::Identity();
    affine.translation() = Eigen::Vector3d(5, 6, 7);
    CHECK((*world_space(lights, affine).to_view)(lights[0]).y == doctest::Approx(6.5));
}

TEST_CASE("a view matrix that is transposed, multiplied with a projection or not affine is refused as that") {
    const glm::mat4 matrix = glm::translate(glm::mat4(1.0f), {1.0f, 2.0f, 3.0f}),
                    projection = glm::perspective(1.0f, 1.5f, 0.1f, 100.0f);
    const auto view = View::from_projection(projection, {64, 48});
    const std::vector<Sphere> lights = {{0, 0, -5, 1}};
    Binner<> binner;
    const auto refusal = [&](const glm::mat4& m) {
        const auto grid = binner.bin(*view, world_space(lights, m));
        REQUIRE(!grid);
        return grid.error().code;
    };
    CHECK(refusal(glm::transpose(matrix)) == ErrorCode::view_matrix_transposed);
    CHECK(refusal(projection * matrix) == ErrorCode::view_matrix_not_affine);
    glm::mat4 bad[3] = {matrix, matrix, matrix};
    bad[0][1][3] = bad[0][3][1] = 0.5f;
    bad[1][3][3] = 2.0f;
    bad[2][3][0] = std::nanf("");
    for (const glm::mat4& m : bad)
        CHECK(refusal(m) == ErrorCode::view_matrix_not_affine);
}

TEST_CASE("a Binner names the form of its lists") {
    static_assert(Binner<>::list_format.ids == IdWidth::u32);
    static_assert(Binner<Options{.ids = IdWidth::u16}>::list_format.ids == IdWidth::u16);
    static_assert(Binner<>::list_format.encoding == ListEncoding::offset_count);
}
