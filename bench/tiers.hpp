// SPDX-License-Identifier: MIT
// The same options on every instruction set that this machine has.
#pragma once

#include <lightbin/options.hpp>

constexpr lightbin::Options with(lightbin::Options options, lightbin::Isa isa) {
    options.isa = isa;
    return options;
}

/// Calls `visit` for the options' tier, if this machine has it.
template <lightbin::Options options, class Visit> void visit_tier(Visit visit) {
    if (lightbin::machine_isa(options.isa) == options.isa) visit.template operator()<options>();
}

/// Calls `visit` for each tier up to the widest that was compiled in.
template <lightbin::Options options, class Visit> void each_tier(Visit visit) {
    visit_tier<with(options, lightbin::Isa::scalar)>(visit);
#if defined(LIGHTBIN_X86)
    visit_tier<with(options, lightbin::Isa::simd128)>(visit);
    visit_tier<with(options, lightbin::Isa::avx2)>(visit);
#endif
    visit_tier<options>(visit);
}
