// SPDX-License-Identifier: MIT
// The rungs of the ladder.
#pragma once

#include "tiled_view.hpp"

#include <lightbin/lightbin.hpp>

#include <tuple>
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

/// Bins spheres or spots by one rung; the grid is valid until the next call.
template <Method method> class Bin {
public:
    template <class Any> auto operator()(const TiledView& view, const std::vector<Any>& lights) {
        return *binner_.bin(view.view, lights, lightbin::inputs_for<options>(view.bounds()));
    }

private:
    static constexpr lightbin::Options options = {.footprint = method.footprint,
                                                  .depth_test = method.depth_test};

    lightbin::Binner<options> binner_;
};

/// One binner for each rung. Calls visit(i, bin) for ladder[i] and its own Bin.
class Ladder {
public:
    template <class Visit> void for_each(Visit visit) { visit_all(visit, std::make_index_sequence<rungs>{}); }

private:
    static constexpr std::size_t rungs = std::size(ladder);

    template <std::size_t... i>
    static auto bins_of(std::index_sequence<i...>) -> std::tuple<Bin<ladder[i]>...>;
    template <class Visit, std::size_t... i> void visit_all(Visit& visit, std::index_sequence<i...>) {
        (visit(i, std::get<i>(bins_)), ...);
    }

    decltype(bins_of(std::make_index_sequence<rungs>{})) bins_;
};
