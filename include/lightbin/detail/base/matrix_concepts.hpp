// SPDX-License-Identifier: MIT
// Recognizes the matrix types of other libraries by their members, without including those libraries.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#include <concepts>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// M is read as m[column][row].
template <class M>
concept SubscriptMatrix = requires(const M& m) {
    { m[0][0] } -> std::convertible_to<double>;
};
/// M is a matrix or transform of Eigen.
template <class M>
concept EigenLikeMatrix = requires(const M& m) {
    { m.matrix()(0, 0) } -> std::convertible_to<double>;
    m.matrix().rows() + m.matrix().cols();
};
/// M is a 4x4 matrix struct of DirectXMath or Direct3D 9.
template <class M>
concept DirectXLikeMatrix = requires(const M& m) {
    m._11 + m._44;
    { m.m[0][0] } -> std::convertible_to<double>;
};
/// M is a matrix of OpenSceneGraph.
template <class M>
concept OpenSceneGraphLikeMatrix = requires(const M& m) {
    { m(0, 0) } -> std::convertible_to<double>;
    m.getTrans();
    m.ptr();
};
/// M is an array of numbers, or a pointer to numbers, without a matrix type.
template <class M>
concept SixteenNumbers = requires(const M& m) {
    { m[0] } -> std::convertible_to<double>;
};

}}}  // namespace lightbin::detail
