// SPDX-License-Identifier: MIT
// World to view space: the moved sphere holds the exact image of the given one. Its radius takes in the matrix's
// largest stretch and the rounding of the moved centre.
//
// In floats a vector of lights at a time (move.inl), by way of an origin o near the eye, which keeps the rounding as
// small far from the world's origin as near it:  A p + t = A (p - o) + (A o + t).  With u = 2^-24 the unit roundoff,
// A's entries, p - o and the products are within u each and three sums follow, so a centre is within 6u of the sum of
// |A_j| |p_j - o_j|, A_j being the columns of A. In doubles one by one where floats can't hold or would blur it.
//
// A cone becomes one only by a rotation Q and a scale. Let s be the largest stretch and A = Q P with P's stretches from
// (1 - d) s to s: A p is no farther than d s |p| from s Q p, and so the images of a cone's axis under A and Q are at an
// angle whose sine is d at most. A point of the image is no farther than 3 d s |p| from the cone around the image of the
// axis, with the same angle (d up to 1/16).
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/float_environment.hpp>
#include <lightbin/detail/base/math.hpp>
#include <lightbin/detail/base/maybe.hpp>
#include <lightbin/detail/base/platform.hpp>
#include <lightbin/detail/base/rounding.hpp>
#include <lightbin/matrix.hpp>
#include <lightbin/result.hpp>
#include <lightbin/sphere.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// An affine map in floats.
struct FloatMove {
    float origin[3];
    float columns[3][3];  ///< A
    float at_origin[3];   ///< A origin + t
    float stretch;        ///< the most that it makes a length longer, rounded up
    float error;          ///< of the moved centre, by |x| + |y| + |z| from the origin
    float least_error;    ///< and of at_origin
    float
        bend;  ///< how far a point of a cone may move beside its image, by its distance from the apex; inf: any
    /// As far from the origin it serves, for plain radii; less than 0 where doubles must.
    float most = -1;
};

class WorldToView {
public:
    /// Not inline, so that no operation of it moves out of the environment.
    LIGHTBIN_NOINLINE explicit WorldToView(const Matrix& matrix)
        : m_(matrix), affine_(finite(m_) && last_row_is_plain(m_)) {
        const DefaultFloatEnvironment environment;
        // The largest singular value is at most the root of the largest row sum of M^T M. Where a product overflows, sums
        // are infinite or NaN, which no comparison takes for the largest: then there is no bound.
        // In the same way the square of the smallest is at least the least diagonal element less what stands beside it.
        double square = 0, all = 0, least = static_cast<double>(infinity);
        for (int i = 0; i < 3; ++i) {
            double row_sum = 0, diagonal = 0;
            for (int j = 0; j < 3; ++j) {
                const double product = m_[i][0] * m_[j][0] + m_[i][1] * m_[j][1] + m_[i][2] * m_[j][2];
                row_sum += abs_of(product);
                if (j == i) diagonal = product;
            }
            square = max_of(square, row_sum);
            least = min_of(least, 2 * diagonal - row_sum);
            all += row_sum;
        }
        stretch_ = is_finite(all) ? root_of(square) * (1 + 0x1p-48) : static_cast<double>(infinity);
        uneven_ = least > 0 && is_finite(all) ? 1 - root_of(least / square) : 1;
        if (affine_) find_floats();
    }

    /// Why no light can be moved by it.
    Maybe<ErrorCode> refusal() const {
        if (affine_) return {};
        return finite(m_) && last_row_is_plain(transposed(m_)) ? ErrorCode::view_matrix_transposed
                                                               : ErrorCode::view_matrix_not_affine;
    }
    const FloatMove& floats() const { return floats_; }

    /// The image of any sphere, in doubles. Bad input stays bad. Not inline: within a tier's kernel, compilers fuse its
    /// products and sums by that tier's instructions.
    LIGHTBIN_NOINLINE Sphere operator()(const Sphere& light) const {
        if (!is_finite(light.x) || !is_finite(light.y) || !is_finite(light.z) || !(light.radius >= 0))
            return light;
        const double x = static_cast<double>(light.x), y = static_cast<double>(light.y),
                     z = static_cast<double>(light.z);
        double centre[3], error = 0;
        for (int row = 0; row < 3; ++row) {
            const double a = m_[0][row] * x, b = m_[1][row] * y, c = m_[2][row] * z, d = m_[3][row];
            centre[row] = a + b + c + d;
            if (!(abs_of(centre[row]) <= static_cast<double>(FLT_MAX))) return {0, 0, 0, infinity};
            // 2^-24 to round the centre to float, 2^-50 for the sum in double
            error +=
                0x1p-24 * abs_of(centre[row]) + 0x1p-50 * (abs_of(a) + abs_of(b) + abs_of(c) + abs_of(d));
        }
        const double radius = (static_cast<double>(light.radius) * stretch_ + error) * (1 + 0x1p-23) +
                              static_cast<double>(FLT_MIN);
        return {static_cast<float>(centre[0]), static_cast<float>(centre[1]), static_cast<float>(centre[2]),
                radius <= static_cast<double>(FLT_MAX) ? static_cast<float>(radius) : infinity};
    }

    /// The image of a vector, rounded to nearest, with radius 0.
    Sphere direction(float x, float y, float z) const {
        float image[3];
        for (int row = 0; row < 3; ++row)
            image[row] =
                static_cast<float>(m_[0][row] * static_cast<double>(x) + m_[1][row] * static_cast<double>(y) +
                                   m_[2][row] * static_cast<double>(z));
        return {image[0], image[1], image[2], 0};
    }

private:
    static bool last_row_is_plain(const Matrix& m) {
        return m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
    }

    /// Only for maps near to a rotation and a scale: others can take p - o far beyond the image, and its rounding too. So
    /// a column is no shorter than 2^-26, and an entry of it that is flushed to zero is no more than 2^-100 of that.
    void find_floats() {
        double inverse[3][3], det = 0, norm2 = 0, inverse_norm2 = 0, longest2 = 0;
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) {
                const int c1 = (c + 1) % 3, c2 = (c + 2) % 3, r1 = (r + 1) % 3, r2 = (r + 2) % 3;
                inverse[r][c] = m_[c1][r1] * m_[c2][r2] - m_[c1][r2] * m_[c2][r1];
            }
        for (int r = 0; r < 3; ++r)
            det += m_[0][r] * inverse[r][0];
        for (int c = 0; c < 3; ++c) {
            double length2 = 0;
            for (int r = 0; r < 3; ++r) {
                inverse[r][c] /= det;
                inverse_norm2 += inverse[r][c] * inverse[r][c];
                length2 += m_[c][r] * m_[c][r];
            }
            norm2 += length2;
            longest2 = max_of(longest2, length2);
        }
        if (!(norm2 * inverse_norm2 <= 1024) || !(norm2 >= 0x1p-40) || !(norm2 <= 0x1p40)) return;
        double origin[3], before = 0, offset = 0;
        for (int c = 0; c < 3; ++c) {
            origin[c] = 0;
            for (int r = 0; r < 3; ++r)
                origin[c] -= inverse[r][c] * m_[3][r];
            if (!(abs_of(origin[c]) <= 0x1p60)) return;
            floats_.origin[c] = static_cast<float>(origin[c]);
            origin[c] = static_cast<double>(floats_.origin[c]);
        }
        for (int r = 0; r < 3; ++r) {
            double at = m_[3][r];
            before += abs_of(at);
            for (int c = 0; c < 3; ++c) {
                at += m_[c][r] * origin[c];
                before += abs_of(m_[c][r] * origin[c]);
                floats_.columns[c][r] = static_cast<float>(m_[c][r]);
            }
            offset += abs_of(at);
            floats_.at_origin[r] = static_cast<float>(at);
        }
        // Each a little more than it must be, for the rounding of the moved radius; 2^-100 for what is flushed to zero.
        floats_.stretch = float_above(stretch_ * (1 + 0x1p-22));
        floats_.error = float_above(root_of(longest2) * (6 * 0x1p-24) * (1 + 0x1p-18));
        floats_.least_error = float_above((offset * 0x1p-23 + before * 0x1p-50) * (1 + 0x1p-18) + 0x1p-100);
        floats_.bend = uneven_ < 0x1p-4 ? float_above(3 * uneven_ + 0x1p-40) : infinity;
        floats_.most = float_safe_max;
    }

    Matrix m_;
    bool affine_;
    double stretch_;  ///< the most that it makes a length longer
    double uneven_;   ///< how much shorter, relative to that, it makes one at most
    FloatMove floats_ = {};
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
