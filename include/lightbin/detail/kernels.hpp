// SPDX-License-Identifier: MIT
// The table of kernels, one row an instruction set. The scalar row is the reference and, so far, the only
// one.
#pragma once

#include <lightbin/detail/scalar.hpp>

namespace lightbin::detail {

template <bool with_depth> using ProjectKernel = decltype(&project_scalar<with_depth>);

template <class Id, bool with_depth> struct Kernels {
    ProjectKernel<with_depth> project;
    decltype(&count_scalar<with_depth>) count;
    decltype(&emit_scalar<Id, with_depth>) emit;
};

template <class Id, bool with_depth>
inline constexpr Kernels<Id, with_depth> scalar_kernels = {
    project_scalar<with_depth>, count_scalar<with_depth>, emit_scalar<Id, with_depth>};

/// The kernels to use on this machine.
template <class Id, bool with_depth> constexpr const Kernels<Id, with_depth>& kernels() {
    return scalar_kernels<Id, with_depth>;
}

}  // namespace lightbin::detail
