// SPDX-License-Identifier: MIT
// What a user hands over: a matrix and the API's settings, no more.
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
    bool doubles = false;  ///< handed over in double precision
    int width = 0, height = 0, tile = 0;
    bool zero_to_one = false;  ///< range of clip depth
    bool upper_left = false;   ///< window origin
    bool reversed = false;     ///< declared for orthographic matrices only
};

}  // namespace oracle
