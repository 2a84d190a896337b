// SPDX-License-Identifier: MIT
// A camera as a user gives it: a projection matrix, viewport, tile size and the settings of the graphics API.
#pragma once

#include <string>

namespace oracle {

/// m[column][row]
template <class Real> struct Matrix4 {
    Real entry[4][4] = {};
    Real* operator[](int column) { return entry[column]; }
    const Real* operator[](int column) const { return entry[column]; }
};
using Matrix = Matrix4<double>;

struct Camera {
    std::string name;
    Matrix m{};            ///< every entry is a float, unless `doubles`
    bool doubles = false;  ///< the matrix was given in double precision
    int width = 0, height = 0, tile = 0;
    bool zero_to_one = false;  ///< range of clip depth
    bool upper_left = false;   ///< window origin
    bool reversed = false;     ///< set by the user for orthographic matrices only
};

}  // namespace oracle
