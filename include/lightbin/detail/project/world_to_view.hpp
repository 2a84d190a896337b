// SPDX-License-Identifier: MIT
// The transform of lights from world space to view space. A transformed sphere contains the exact image of the given
// one: its radius is multiplied by the largest factor by which the matrix can stretch a length, and enlarged by a
// bound on the rounding error of the transformed centre.
//
// world_to_view.inl transforms a vector of lights at a time in float. So that the rounding error far from the world's
// origin is as small as near it, positions p are taken relative to an origin o near the eye:  A p + t = A (p - o) + (A
// o + t),  where A is the matrix's linear part with the columns A_j, and t its translation. Let u = 2^-24, the unit
// roundoff of float. The entries of A, the differences p_j - o_j and the products each have a relative error of at
// most u, and three sums follow. So a centre is within 6u of the sum over j of |A_j| |p_j - o_j| of the exact one.
// Lights that are too large, small or far away for the float path are transformed in double, one by one.
//
// With an eye, o and A o + t are 0 and positions relative to the eye were rounded to float. The error of that, at most
// (1 + 2^-20) u, takes the place of the differences' one. In double it is added: WorldToView::position_error().
//
// Only a rotation with a uniform scale maps every cone to a cone. Let the factors by which A stretches lengths lie
// between (1 - d) s and s. By the polar decomposition A = Q P, with Q orthogonal and P stretching by the same factors,
// and so A p is at most d s |p| away from s Q p. The images of a cone's axis under A and under Q then differ by an
// angle whose sine is at most d. So for d up to 1/16 a point of the cone's image is at most 3 d s |p| away from the
// cone with the given half angle around the image of the axis under A.
#pragma once

#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/float_environment.hpp>
#include <lightbin/matrix.hpp>
#include <lightbin/sphere.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// An affine transform of world space to view space, in float.
struct FloatTransform {
    float origin[3];        ///< a world-space point near the eye: positions are taken relative to it, to round less
    float columns[3][3];    ///< the columns of the transform's linear part, a 3x3 matrix
    float origin_image[3];  ///< `origin` in view space
    float stretch;          ///< an upper bound on the factor by which the transform stretches a length
    /// A transformed centre has an error of at most  error_rate * (|x| + |y| + |z|) + error_at_origin,  where x, y and
    /// z are its world-space coordinates relative to the member `origin`.
    float error_rate, error_at_origin;
    /// How far a point of a transformed spot can lie outside the cone around the transformed axis, divided by the
    /// spot's transformed radius; +inf where no bound is known.
    float cone_error;
    float max_distance = -1;  ///< float is precise enough where |x| + |y| + |z|, relative to `origin`, is at most this
};

/// A matrix that transforms lights from world space to view space.
class WorldToView {
public:
    /// Not inlined, so that no operation moves out of the lifetime of the local `environment`, which rounds to nearest.
    LIGHTBIN_NOINLINE explicit WorldToView(const Matrix& matrix)
        : m_(matrix), affine_(finite(m_) && last_row_is_affine(m_)) {
        const DefaultFloatEnvironment environment;
        // By Gershgorin's circle theorem the square of the largest singular value, which is the largest eigenvalue of
        // M^T M, is at most the largest sum of absolute values in a row of M^T M. Likewise, the square of the smallest
        // one is at least the smallest difference of a diagonal element and the absolute values beside it. `all` is the
        // sum of all absolute values: if a product overflows, it is infinite or NaN, and there is no bound.
        double largest2 = 0, all = 0, smallest2 = static_cast<double>(infinity);
        for (int i = 0; i < 3; ++i) {
            double row_sum = 0, diagonal = 0;
            for (int j = 0; j < 3; ++j) {
                const double product = m_[i][0] * m_[j][0] + m_[i][1] * m_[j][1] + m_[i][2] * m_[j][2];
                row_sum += abs_of(product);
                if (j == i) diagonal = product;
            }
            largest2 = max_of(largest2, row_sum);
            smallest2 = min_of(smallest2, 2 * diagonal - row_sum);
            all += row_sum;
        }
        stretch_ = is_finite(all) ? root_of(largest2) * (1 + 0x1p-48) : static_cast<double>(infinity);
        anisotropy_ = smallest2 > 0 && is_finite(all) ? 1 - root_of(smallest2 / largest2) : 1;
        if (affine_) find_float_transform();
    }

    /// The matrix without its translation, for positions relative to the eye that were rounded to float.
    WorldToView(const Matrix& matrix, const WorldPoint& eye) : WorldToView(without_translation(matrix)) {
        position_error_ = 0x1p-24 * (1 + 0x1p-20);
        eye_finite_ = is_finite(eye.x) && is_finite(eye.y) && is_finite(eye.z);
    }

    /// Returns why the matrix can transform no light, or nothing if it can.
    std::optional<ErrorCode> refusal() const {
        if (!eye_finite_) return ErrorCode::eye_not_finite;
        if (affine_) return {};
        return finite(m_) && last_row_is_affine(transposed(m_)) ? ErrorCode::view_matrix_transposed
                                                                : ErrorCode::view_matrix_not_affine;
    }
    const FloatTransform& in_float() const { return in_float_; }
    const Matrix& matrix() const { return m_; }
    /// A bound on the relative error of each coordinate of a given position.
    double position_error() const { return position_error_; }

    /// Returns the image of a sphere, computed in double, or the sphere itself if a coordinate is NaN or infinite or
    /// its radius NaN or negative. Not inlined, as instruction sets with fused multiply-adds would then use them here.
    LIGHTBIN_NOINLINE Sphere operator()(const Sphere& light) const {
        if (!is_finite(light.x) || !is_finite(light.y) || !is_finite(light.z) || !(light.radius >= 0)) return light;
        const double x = static_cast<double>(light.x), y = static_cast<double>(light.y),
                     z = static_cast<double>(light.z);
        double centre[3], error = 0;
        for (int row = 0; row < 3; ++row) {
            const double a = m_[0][row] * x, b = m_[1][row] * y, c = m_[2][row] * z, d = m_[3][row];
            centre[row] = a + b + c + d;
            if (!(abs_of(centre[row]) <= static_cast<double>(FLT_MAX))) return {0, 0, 0, infinity};
            // Rounding the centre to float has a relative error of 2^-24; 2^-50 covers the sum in double.
            error += 0x1p-24 * abs_of(centre[row]) +
                     (0x1p-50 + position_error_) * (abs_of(a) + abs_of(b) + abs_of(c) + abs_of(d));
        }
        // The sphere may be the least one around a spot, whose apex, at most a radius off the centre, is what was
        // rounded. By the Cauchy-Schwarz inequality that adds up to 3 position_error_ of the radius.
        const double radius =
            (static_cast<double>(light.radius) * stretch_ + error) * (1 + 0x1p-23 + 4 * position_error_) +
            static_cast<double>(FLT_MIN);
        return {static_cast<float>(centre[0]), static_cast<float>(centre[1]), static_cast<float>(centre[2]),
                radius <= static_cast<double>(FLT_MAX) ? static_cast<float>(radius) : infinity};
    }

private:
    static Matrix without_translation(Matrix matrix) {
        for (int row = 0; row < 3; ++row)
            matrix.columns[3][row] = 0;
        return matrix;
    }
    static bool last_row_is_affine(const Matrix& m) {
        return m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
    }

    /// Finds the transform in float if A, the linear part, is close to a rotation with a uniform scale: if the product
    /// of its Frobenius norm and its inverse's is at most 32. Otherwise a position relative to the origin, p - o, and
    /// so its rounding error, could be much larger than its image. A's norm must be 2^-20 to 2^20, so each column of A
    /// is at least 2^-26 long, and a denormal entry that is flushed to zero is at most 2^-100 times as long.
    void find_float_transform() {
        double inverse[3][3], det = 0, norm2 = 0, inverse_norm2 = 0, longest_column2 = 0;
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
            longest_column2 = max_of(longest_column2, length2);
        }
        if (!(norm2 * inverse_norm2 <= 1024) || !(norm2 >= 0x1p-40) || !(norm2 <= 0x1p40)) return;
        double origin[3], terms = 0, offset = 0;  // sums of the absolute values in A o + t, and of the results
        for (int c = 0; c < 3; ++c) {
            origin[c] = 0;
            for (int r = 0; r < 3; ++r)
                origin[c] -= inverse[r][c] * m_[3][r];
            if (!(abs_of(origin[c]) <= 0x1p60)) return;
            in_float_.origin[c] = static_cast<float>(origin[c]);
            origin[c] = static_cast<double>(in_float_.origin[c]);
        }
        for (int r = 0; r < 3; ++r) {
            double at = m_[3][r];
            terms += abs_of(at);
            for (int c = 0; c < 3; ++c) {
                at += m_[c][r] * origin[c];
                terms += abs_of(m_[c][r] * origin[c]);
                in_float_.columns[c][r] = static_cast<float>(m_[c][r]);
            }
            offset += abs_of(at);
            in_float_.origin_image[r] = static_cast<float>(at);
        }
        // Kernels compute a transformed radius: stretch * radius + (error_rate * distance + error_at_origin). The
        // factors (1 + 2^-22) and (1 + 2^-18) cover rounding in this, and 2^-100 covers denormal numbers flushed to
        // zero.
        in_float_.stretch = float_above(stretch_ * (1 + 0x1p-22));
        in_float_.error_rate = float_above(root_of(longest_column2) * (6 * 0x1p-24) * (1 + 0x1p-18));
        in_float_.error_at_origin = float_above((offset * 0x1p-23 + terms * 0x1p-50) * (1 + 0x1p-18) + 0x1p-100);
        in_float_.cone_error = anisotropy_ < 0x1p-4 ? float_above(3 * anisotropy_ + 0x1p-40) : infinity;
        in_float_.max_distance = float_safe_max;
    }

    Matrix m_;
    bool affine_;
    double stretch_;     ///< the linear part's largest singular value, rounded up: no length is stretched more
    double anisotropy_;  ///< the linear part's smallest singular value is at least (1 - anisotropy_) * the largest
    FloatTransform in_float_ = {};
    double position_error_ = 0;
    bool eye_finite_ = true;
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
