// SPDX-License-Identifier: MIT
// What tables call the options.
#pragma once

#include <lightbin/options.hpp>

constexpr const char* name_of(lightbin::Footprint footprint) {
    return footprint == lightbin::Footprint::rectangle ? "rectangle" : "silhouette";
}
constexpr const char* name_of(lightbin::DepthTest test) {
    constexpr const char* names[] = {"none", "interval", "box", "split_box"};
    return names[static_cast<int>(test)];
}
constexpr const char* name_of(lightbin::Isa isa) {
    constexpr const char* names[] = {"scalar", "sse2", "avx2", "avx512", "neon"};
    return names[static_cast<int>(isa)];
}
