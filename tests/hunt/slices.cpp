// SPDX-License-Identifier: MIT
#include "slices.hpp"

#include <algorithm>
#include <memory>
#include <numeric>

namespace hunt {
namespace {

using lightbin::Slices;
using lightbin::Slicing;

/// By a law, or anywhere, with boundaries at and beside the points' depths.
Slices make_slices(const std::vector<Placed>& points, int count, Random& random) {
    const float least = static_cast<float>(random.log_between(0x1p-10, 0x1p6)),
                most = least * static_cast<float>(random.log_between(1.5, 0x1p12));
    if (random.one_in(3)) return *Slices::exponential(count, least, most);
    if (random.one_in(2)) return *Slices::linear(count, random.coin() ? 0 : -least, most);
    std::vector<float> boundaries;
    for (int i = 1; i < count; ++i) {
        float boundary = random.one_in(4) || points.empty()
                             ? nasty_float(random)
                             : static_cast<float>(points[random.below(points.size())].seen.depth.value);
        for (int step = random.below(3); step > 0; --step)
            boundary = std::nextafter(boundary, random.coin() ? 1e38f : -1e38f);
        if (std::isfinite(boundary)) boundaries.push_back(boundary);
    }
    std::ranges::sort(boundaries);
    boundaries.erase(std::unique(boundaries.begin(), boundaries.end()), boundaries.end());
    return *Slices::from_boundaries(boundaries);
}

std::string check_lists(const lightbin::LightGrid<std::uint32_t>& grid, std::uint64_t ids) {
    std::uint64_t at = 0;
    for (const lightbin::ListRange range : grid.ranges()) {
        if (range.offset != at) return "offsets leave a gap or overlap";
        at += range.count;
        for (std::uint64_t i = at - range.count; i < at; ++i)
            if (grid.ids()[i] >= ids || (i > at - range.count && grid.ids()[i - 1] >= grid.ids()[i]))
                return "ids do not ascend, or are none";
    }
    return at == grid.ids().size() ? "" : "counts do not add up to the index list";
}

/// What is wrong with a grid; empty: nothing.
std::string look(const lightbin::LightGrid<std::uint32_t>& grid, const Slices& slices,
                 const std::vector<Placed>& points, bool ranked, Report& report) {
    const auto& counts = grid.light_counts();
    const std::uint32_t visible = counts.lights - counts.culled - counts.rejected;
    if (const std::string wrong = check_lists(grid, ranked ? visible : counts.lights); !wrong.empty())
        return wrong;
    std::vector<std::uint32_t> rank_of(counts.lights, 0xffffffff);
    const auto [order, bins] = grid.ranks();
    if (order.size() != (ranked ? visible : 0)) return "ranks are not as many as lights in view";
    for (std::uint32_t rank = 0; rank < order.size(); ++rank) {
        if (order[rank] >= rank_of.size() || rank_of[order[rank]] != 0xffffffff)
            return "the order has a light twice, or none";
        rank_of[order[rank]] = rank;
    }
    if (bins.size() != static_cast<std::size_t>(ranked ? slices.count() : 0))
        return "bins are not as many as slices";
    for (const Placed& point : points) {
        const auto slice_of = [&](long double depth) {
            return std::ranges::upper_bound(slices.boundaries(), depth) - slices.boundaries().begin();
        };
        const auto slice = slice_of(point.seen.depth.low());
        if (slice != slice_of(point.seen.depth.high())) continue;  // not known
        ++report.points;
        const std::uint32_t light = point.inside.light, id = ranked ? rank_of[light] : light;
        const auto columns = static_cast<std::size_t>(grid.tiles_x());
        const auto list =
            grid.lights_in(static_cast<int>(point.tile % columns), static_cast<int>(point.tile / columns),
                           ranked ? 0 : static_cast<int>(slice));
        const auto at = " light " + std::to_string(light) + " in slice " + std::to_string(slice) + " of " +
                        std::to_string(slices.count());
        if (!std::ranges::binary_search(list, id)) return "MISS: the list lacks" + at;
        if (ranked && (bins[static_cast<std::size_t>(slice)].least > id ||
                       bins[static_cast<std::size_t>(slice)].greatest < id))
            return "MISS: the bin's range lacks" + at;
    }
    return "";
}

template <lightbin::Options options>
std::string hunt_with(const lightbin::View& view, const Scene& scene, const std::vector<Placed>& points,
                      const Slices& slices, Random& random, Report& report) {
    static auto binner = std::make_unique<lightbin::Binner<options>>();
    if (random.one_in(8)) binner = std::make_unique<lightbin::Binner<options>>();
    // On this thread, in another order.
    const auto run = [&](std::size_t n, auto body) {
        for (std::size_t i = n; i-- > 0;)
            body(i);
    };
    const lightbin::Parallel threads(static_cast<std::size_t>(random.from_to(1, 9)), run, 0);
    const std::span<const Sphere> lights = scene.lights;
    const auto inputs = lightbin::inputs_for<options>({}, slices);
    const auto grid = scene.in_world
                          ? binner->bin(view, lightbin::world_space(lights, scene.to_view), inputs, threads)
                          : binner->bin(view, lights, inputs, threads);
    ++report.grids;
    if (!grid) return "refused: " + grid.error().message();
    report.entries += grid->ids().size();
    return look(*grid, slices, points, options.slicing == Slicing::z_bins, report);
}

}  // namespace

std::string hunt_slices(const lightbin::View& view, const Scene& scene, const std::vector<Placed>& points,
                        Random& random, Report& report) {
    using enum lightbin::DepthTest;
    using enum lightbin::Footprint;
    const int kind = random.below(static_cast<int>(std::size(slicing_names)));
    const bool few = kind < 3 && view.tile_count() * scene.lights.size() > 20'000;
    const Slices slices =
        make_slices(points, few ? random.from_to(1, 5) : random.pick({1, 2, 7, 24, 65, 1024}), random);
    if (view.tile_count() * static_cast<std::size_t>(slices.count()) > 1'000'000) return "";
    ++report.tally[slicing_names[kind]];
    const auto hunted = [&]<lightbin::Options options>() {
        return hunt_with<options>(view, scene, points, slices, random, report);
    };
    std::string wrong;
    if (kind == 0) wrong = hunted.operator()<lightbin::Options{.slicing = Slicing::clusters}>();
    if (kind == 1)
        wrong = hunted.operator()<lightbin::Options{.depth_test = box, .slicing = Slicing::clusters}>();
    if (kind == 2)
        wrong = hunted.operator()<lightbin::Options{
            .footprint = silhouette, .depth_test = box, .slicing = Slicing::clusters}>();
    if (kind == 3) wrong = hunted.operator()<lightbin::Options{.slicing = Slicing::z_bins}>();
    if (kind == 4)
        wrong = hunted.operator()<lightbin::Options{.footprint = silhouette, .slicing = Slicing::z_bins}>();
    return wrong.empty() ? "" : wrong + "; " + slicing_names[kind];
}

}  // namespace hunt
