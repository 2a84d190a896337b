// SPDX-License-Identifier: MIT
// The rungs of the ladder.
#pragma once

#include "built.hpp"

#include <lightbin/lightbin.hpp>

#include <cstddef>
#include <utility>
#include <vector>

using lightbin::DepthTest;
using lightbin::Footprint;

/// A footprint and a depth test.
struct Method {
    Footprint footprint;
    DepthTest depth_test;
};

inline constexpr Method ladder[] = {
    {Footprint::rectangle, DepthTest::none},  {Footprint::rectangle, DepthTest::interval},
    {Footprint::rectangle, DepthTest::box},   {Footprint::rectangle, DepthTest::split_box},
    {Footprint::silhouette, DepthTest::none}, {Footprint::silhouette, DepthTest::interval},
    {Footprint::silhouette, DepthTest::box},  {Footprint::silhouette, DepthTest::split_box},
};

/// A build for each of the ladder's methods.
inline std::vector<BuildLists> ladder_builders() {
    return []<std::size_t... i>(std::index_sequence<i...>)->std::vector<BuildLists> {
        return {builder<lightbin::Options{.footprint = ladder[i].footprint,
                                          .depth_test = ladder[i].depth_test}>()...};
    }
    (std::make_index_sequence<std::size(ladder)>{});
}
