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

/// Whether lights are tested by depth. tests/same_bytes.sh compiles this file with earlier versions, too, in which the
/// option was one of several tests: the third was this one.
using DepthTest = decltype(lightbin::Options::depth_test);
constexpr DepthTest no_test = static_cast<DepthTest>(0), tested = static_cast<DepthTest>(2);

template <lightbin::Options options>
Lists built(const lightbin::View& view, const Scene& scene, bool flush, std::size_t workers = 1) {
    thread_local lightbin::Binner<options> binner;
    thread_local std::vector<float> sides[2];
    const auto grid = [&] {
        const Flush flushing(flush);
        // The caller's threads at their least helpful: one of them, which takes the work from the end.
        auto run = [](std::size_t n, auto body) {
            while (n > 0)
                body(--n);
        };
        const auto parallel = workers > 1 ? lightbin::Parallel(workers, run) : lightbin::Parallel();
        lightbin::ZBounds bounds{.min = scene.min, .max = scene.max};
        if (options.depth_test != no_test && !scene.depth.empty()) {
            for (std::vector<float>& side : sides)
                side.resize(view.tile_count());
            bounds = *lightbin::reduce_depth(
                view, {.depth = scene.depth, .skip_background = scene.skip_background}, {sides[0], sides[1]},
                options.isa);
        }
        static const lightbin::Slices slices = *lightbin::Slices::exponential(20, 0.5f, 300.0f);
        return binner.bin(view, scene.lights, lightbin::inputs_for<options>(bounds, slices), parallel);
    }();
    Lists lists;
    if (!grid) return lists;
    lists.rejected = grid->light_counts().rejected;
    lists.offsets.reserve(grid->ranges().size() + 1);
    for (const lightbin::ListRange range : grid->ranges())
        lists.offsets.push_back(range.offset);
    lists.offsets.push_back(static_cast<std::uint32_t>(grid->ids().size()));
    lists.ids.assign(grid->ids().begin(), grid->ids().end());
    lists.ids.insert(lists.ids.end(), grid->ranks().order.begin(), grid->ranks().order.end());
    for (const lightbin::BinRange bin : grid->ranks().bins)
        lists.ids.insert(lists.ids.end(), {bin.least, bin.greatest});
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
    using lightbin::Slicing;
    const auto lists_of = [&]<DepthTest depth_test, Slicing slicing = Slicing::none>() {
        return on_all_tiers<lightbin::Options{.depth_test = depth_test, .slicing = slicing}>(
            *view, scene, flush_, complaints);
    };
    switch (rung) {
    case Rung::rectangles:
        return lists_of.operator()<no_test>();
    case Rung::depth_test:
        return lists_of.operator()<tested>();
#if defined(ORACLE_EVERY_WAY)
    case Rung::clusters:
        return lists_of.operator()<no_test, Slicing::clusters>();
    case Rung::tested_clusters:
        return lists_of.operator()<tested, Slicing::clusters>();
    case Rung::z_bins:
        return lists_of.operator()<no_test, Slicing::z_bins>();
    case Rung::tested_z_bins:
        return lists_of.operator()<tested, Slicing::z_bins>();
#endif
    }
    return {};
}

}  // namespace oracle
