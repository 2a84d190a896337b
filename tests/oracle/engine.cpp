// SPDX-License-Identifier: MIT
#include "engine.hpp"
#include "flush.hpp"
#include "library_view.hpp"

#include <lightbin/binner.hpp>
#include <lightbin/z_bounds.hpp>

#include <span>
#include <string>
#include <vector>

namespace oracle {

namespace {

template <lightbin::Options options>
Lists built(const lightbin::View& view, const Scene& scene, bool flush, std::size_t workers = 1) {
    thread_local lightbin::Binner<options> binner;
    thread_local std::vector<float> sides[4];
    const auto grid = [&] {
        const Flush flushing(flush);
        // The caller's threads at their least helpful: one of them, which takes the work from the end.
        auto run = [](std::size_t n, auto body) {
            while (n > 0)
                body(--n);
        };
        const auto parallel = workers > 1 ? lightbin::Parallel(workers, run) : lightbin::Parallel();
        if constexpr (options.depth_test == lightbin::DepthTest::none) {
            return binner.bin(view, scene.lights, {}, parallel);
        } else {
            constexpr bool split = options.depth_test == lightbin::DepthTest::split_box;
            lightbin::ZBounds bounds{.min = scene.min, .max = scene.max};
            if (split) bounds.gap_min = scene.gap_min, bounds.gap_max = scene.gap_max;
            if (!scene.depth.empty()) {
                for (std::vector<float>& side : sides)
                    side.resize(view.tile_count());
                const auto gap = [&](std::size_t side) {
                    return split ? std::span<float>(sides[side]) : std::span<float>{};
                };
                bounds = *lightbin::reduce_depth(
                    view, {.depth = scene.depth, .skip_background = scene.skip_background},
                    {sides[0], sides[1], gap(2), gap(3)}, options.isa);
            }
            return binner.bin(view, scene.lights, {.bounds = bounds}, parallel);
        }
    }();
    Lists lists;
    if (!grid) return lists;
    lists.rejected = grid->light_counts().rejected;
    lists.offsets.reserve(grid->ranges().size() + 1);
    for (const lightbin::ListRange range : grid->ranges())
        lists.offsets.push_back(range.offset);
    lists.offsets.push_back(static_cast<std::uint32_t>(grid->ids().size()));
    lists.ids.assign(grid->ids().begin(), grid->ids().end());
    if (view.tile_count() > (1 << 24)) binner = lightbin::Binner<options>();  // gigabytes
    return lists;
}

/// More ways to the same lists, for tests/same_bytes.sh: they take long to compile and to run.
#if defined(ORACLE_EVERY_WAY)
constexpr bool every_way = true;
#else
constexpr bool every_way = false;
#endif

template <lightbin::Options options>
Lists on_all_tiers(const lightbin::View& view, const Scene& scene, bool flush,
                   std::vector<std::string>& complaints) {
    using lightbin::Isa;
    constexpr auto capped = [](Isa isa, lightbin::IdWidth ids = lightbin::IdWidth::u32) {
        lightbin::Options with_isa = options;
        with_isa.isa = isa;
        with_isa.ids = ids;
        return with_isa;
    };
    Lists lists = built<capped(Isa::scalar)>(view, scene, flush);
    if (lists.offsets.empty()) complaints.push_back("the lights were refused");
    // An Isa in the options is a cap: one that the machine lacks would be a narrower one again.
    const auto compare = [&]<Isa isa>() {
        if (lightbin::machine_isa(isa) != isa) return;
        if (built<capped(isa)>(view, scene, flush) != lists)
            complaints.push_back(to_string(isa) + std::string(" differs"));
        if constexpr (every_way)
            if (scene.lights.size() <= 0x10000 &&
                built<capped(isa, lightbin::IdWidth::u16)>(view, scene, flush) != lists)
                complaints.push_back(to_string(isa) + std::string(" differs with ids of 16 bits"));
    };
    if constexpr (every_way) compare.template operator()<Isa::scalar>();
    compare.template operator()<Isa::simd128>();
    compare.template operator()<Isa::avx2>();
    compare.template operator()<Isa::avx512>();
    for (const std::size_t workers : {3, 2, 16}) {
        if (workers != 3 && !every_way) break;
        if (built<options>(view, scene, flush, workers) != lists)
            complaints.push_back("with " + std::to_string(workers) + " workers it differs");
    }
    return lists;
}

}  // namespace

bool Engine::accepts(const Camera& camera) const {
    return library_view(camera).has_value();
}

Lists Engine::lists(const Scene& scene, Rung rung, std::vector<std::string>& complaints) const {
    const auto view = library_view(scene.camera);
    if (!view) {
        complaints.push_back("the camera was refused: " + std::string(view.error().message()));
        return {};
    }
    using lightbin::DepthTest, lightbin::Footprint;
    const auto lists_of = [&]<Footprint footprint, DepthTest depth_test>() {
        return on_all_tiers<lightbin::Options{.footprint = footprint, .depth_test = depth_test}>(
            *view, scene, flush_, complaints);
    };
    switch (rung) {
#define RUNG(name, footprint, depth_test)                                                                    \
    case Rung::name:                                                                                         \
        return lists_of.operator()<Footprint::footprint, DepthTest::depth_test>();
        RUNG(rectangle, rectangle, none)
        RUNG(rectangle_interval, rectangle, interval)
        RUNG(rectangle_box, rectangle, box)
        RUNG(rectangle_split_box, rectangle, split_box)
        RUNG(silhouette, silhouette, none)
        RUNG(silhouette_interval, silhouette, interval)
        RUNG(silhouette_box, silhouette, box)
        RUNG(silhouette_split_box, silhouette, split_box)
#undef RUNG
    }
    return {};
}

}  // namespace oracle
