// SPDX-License-Identifier: MIT
// Stability: settled.
// The matrix types that callers have, converted to one: a Matrix for column vectors (M v), stored by columns.
//
//   type                                      first four numbers    what to pass
//   GLM, cglm, float[4][4] of columns         column of M v         the matrix itself
//   Eigen                                     either                the matrix or transform itself
//   DirectXMath's XMFLOAT4X4, D3DMATRIX       row of v M            the matrix (of an XMMATRIX: XMStoreFloat4x4 first)
//   OpenSceneGraph's Matrixf, Matrixd         row of v M            the matrix itself
//   Irrlicht                                  row of v M            matrix(m.pointer(), MatrixLayout::row_vectors)
//   Panda3D, with CS_yup_right                row of v M            matrix(m.get_data(), MatrixLayout::row_vectors)
//   Qt's QMatrix4x4                           column of M v         matrix(m.constData(), MatrixLayout::column_major)
//   OGRE, rows of one's own                   row of M v            matrix(&m[0][0], MatrixLayout::row_major)
//
// The rows of a matrix for row vectors (v M) are the columns of the same transform for column vectors (M v), so
// column_major and row_vectors are the same numbers in memory: a view matrix has its translation in numbers 13 to 15,
// counted from 1, and with row_major in numbers 4, 8 and 12. A float[4][4] of rows is read as its transpose.
#pragma once

#include <lightbin/detail/base/math.hpp>
#include <lightbin/result.hpp>

#include <concepts>
#include <type_traits>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// How sixteen numbers in memory make a matrix.
enum class MatrixLayout : std::uint8_t {
    column_major,  ///< the columns of a matrix for M v, one after another: OpenGL's
    row_major,     ///< the rows of a matrix for M v, one after another: as it is written on paper
    row_vectors,   ///< row after row of a matrix that is multiplied by a row vector from the left: Direct3D
};

/// A 4x4 matrix for column vectors (M v). Its entries are matrix[column][row].
struct Matrix {
    double columns[4][4];

    const double* operator[](int column) const { return columns[column]; }
};

namespace detail {

/// An array of numbers, or a pointer to numbers.
template <class M>
concept SixteenNumbers = requires(const M& m) {
    { m[0] } -> std::convertible_to<double>;
};

/// Returns the matrix whose entries are at<column, row>(). The indices are compile-time constants because a constant
/// converts to any index type without a warning.
template <class At> Matrix from_entries(const At& at) {
    Matrix result;
    [&]<int... i>(std::integer_sequence<int, i...>) {
        ((result.columns[i / 4][i % 4] = static_cast<double>(at.template operator()<i / 4, i % 4>())), ...);
    }
    (std::make_integer_sequence<int, 16>());
    return result;
}

/// Converts a matrix of any type in the table at the top of matrix.hpp. The types of other libraries are recognized by
/// their members, without including those libraries.
template <class M> Matrix to_matrix(const M& m) {
    if constexpr (requires { { m[0][0] } -> std::convertible_to<double>; }) {
        if constexpr (std::is_array_v<M>)
            static_assert(std::extent_v<M, 0> == 4 && std::extent_v<M, 1> == 4,
                          "lightbin: this matrix is not 4x4");
        else if constexpr (requires { M::length(); })  // GLM's
            static_assert(M::length() == 4, "lightbin: this matrix is not 4x4");
        return from_entries([&]<int column, int row>() { return m[column][row]; });
    } else if constexpr (requires { { m.matrix()(0, 0) } -> std::convertible_to<double>; m.matrix().cols(); }) {  // Eigen's
        LIGHTBIN_ASSERT(m.matrix().rows() == 4 && m.matrix().cols() == 4);
        return from_entries([&]<int column, int row>() { return m.matrix()(row, column); });
    } else if constexpr (requires { m._11 + m._44; { m.m[0][0] } -> std::convertible_to<double>; }) {  // DirectXMath's
        return from_entries([&]<int column, int row>() { return m.m[column][row]; });
    } else if constexpr (requires { { m(0, 0) } -> std::convertible_to<double>; m.getTrans(); }) {  // OpenSceneGraph's
        return from_entries([&]<int column, int row>() { return m(column, row); });
    } else {
        static_assert(
            !SixteenNumbers<M>,
            "lightbin: sixteen numbers do not say which matrix they are: pass lightbin::matrix(numbers, "
            "lightbin::MatrixLayout::column_major), or row_major or row_vectors, see MatrixLayout");
        static_assert(
            SixteenNumbers<M>,
            "lightbin: this is no matrix[column][row] and none of Eigen's, DirectXMath's or "
            "OpenSceneGraph's types: pass lightbin::matrix(numbers, layout) with its sixteen numbers");
        return {};
    }
}

inline bool finite(const Matrix& m) {
    for (const auto& column : m.columns)
        for (const double entry : column)
            if (!is_finite(entry)) return false;
    return true;
}

inline Matrix transposed(const Matrix& m) {
    return from_entries([&]<int column, int row>() { return m[row][column]; });
}

}  // namespace detail

/// Returns the matrix that sixteen numbers make in the given layout.
///
/// numbers  float[16], double[16], a pointer to 16 numbers, or a std::array, std::vector or std::span of sixteen
template <class Numbers> Matrix matrix(const Numbers& numbers, MatrixLayout layout) {
    static_assert(
        detail::SixteenNumbers<Numbers>,
        "lightbin: matrix() takes sixteen numbers, one after another: float[16], a pointer, std::array");
    if constexpr (std::is_array_v<Numbers>)
        static_assert(std::extent_v<Numbers> == 16,
                      "lightbin: a matrix has sixteen numbers, this array has not");
    else if constexpr (requires { numbers.size(); })
        LIGHTBIN_ASSERT(numbers.size() == 16);
    Matrix columns = {};
    if constexpr (detail::SixteenNumbers<Numbers>)
        columns = detail::from_entries([&]<int column, int row>() { return numbers[4 * column + row]; });
    return layout == MatrixLayout::row_major ? detail::transposed(columns) : columns;
}

}}  // namespace lightbin
