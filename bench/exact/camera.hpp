// SPDX-License-Identifier: MIT
// A camera as a user gives it: a projection matrix, viewport, tile size and the settings of the graphics API.
#pragma once

#include <algorithm>
#include <cstdint>
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
    int columns = 0, rows = 0;  ///< in place of `tile`, unless they are 0
    bool turned = false;        ///< handed over with x and y of clip space exchanged

    int side(int axis) const { return axis == 0 ? width : height; }
    int tiles(int axis) const {
        const int count = axis == 0 ? columns : rows;
        return count > 0 ? count : (side(axis) + tile - 1) / tile;
    }
    /// The first pixel of a column or row of tiles: the first whose centre is not before it.
    int first_pixel(int axis, int at) const {
        const int count = axis == 0 ? columns : rows;
        if (count == 0) return std::min(at * tile, side(axis));
        int pixel = static_cast<int>(std::int64_t{at} * side(axis) / count);
        while ((2 * std::int64_t{pixel} + 1) * count < 2 * std::int64_t{at} * side(axis))
            ++pixel;
        return pixel;
    }
    /// The column or row of tiles of a pixel.
    int tile_of(int axis, int pixel) const {
        const int count = axis == 0 ? columns : rows;
        return count == 0 ? pixel / tile
                          : static_cast<int>((2 * std::int64_t{pixel} + 1) * count / (2 * side(axis)));
    }
};

}  // namespace oracle
