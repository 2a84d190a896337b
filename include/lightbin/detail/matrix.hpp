// SPDX-License-Identifier: MIT
// The caller's matrix type ends here.
#pragma once

#include <lightbin/detail/flavour.hpp>

#include <cmath>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// Copies any matrix[column][row]. Indices are constants, which no type of index warns of.
template <class Matrix> void copy_matrix(const Matrix& matrix, double (&m)[4][4]) {
    const auto copy_column = [](const auto& column, double(&to)[4]) {
        to[0] = static_cast<double>(column[0]);
        to[1] = static_cast<double>(column[1]);
        to[2] = static_cast<double>(column[2]);
        to[3] = static_cast<double>(column[3]);
    };
    copy_column(matrix[0], m[0]);
    copy_column(matrix[1], m[1]);
    copy_column(matrix[2], m[2]);
    copy_column(matrix[3], m[3]);
}

inline bool finite(const double (&m)[4][4]) {
    for (const auto& column : m)
        for (const double entry : column)
            if (!std::isfinite(entry)) return false;
    return true;
}

}  // namespace lightbin::detail
