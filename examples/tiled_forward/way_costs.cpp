// SPDX-License-Identifier: MIT
#include "way_costs.hpp"

#include "../../bench/pool.hpp"
#include "value_of.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <limits>
#include <thread>
#include <utility>

using lightbin::IdWidth;
using lightbin::Options;
using lightbin::Slicing;

namespace {

constexpr std::size_t turns = 12;

double now_ns() {
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

template <class Work> double ns_of(Work work) {
    const double start = now_ns();
    work();
    return now_ns() - start;
}

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Branch predictors learn a scene that is built again and again, so each turn has the lights elsewhere, up to a 32nd of
// the picture to the side, as lightbin::advise() has them.
std::vector<ViewLights> sets_of(const BinnedLights& lights, const lightbin::View& view,
                                const glm::mat4& projection) {
    std::vector<ViewLights> sets(1);
    for (const GpuBox& box : lights.boxes())
        sets[0].boxes.push_back(box_of(box));
    for (const GpuLight& light : lights.lights()) {
        const lightbin::Spot spot = spot_of(light);
        if (lights.has_spots())
            sets[0].spots.push_back(spot);
        else
            sets[0].spheres.push_back({spot.x, spot.y, spot.z, spot.radius});
    }
    for (std::size_t turn = 0; turn < turns; ++turn) {
        const float aside =
            (2 * static_cast<float>(turn) / static_cast<float>(turns - 1) - 1) / 32 * 2 / projection[0][0];
        ViewLights set = sets[0];
        const auto way_of = [&](const auto& light) { return aside * (view.orthographic() ? 1 : light.z); };
        for (lightbin::Spot& spot : set.spots)
            spot.x += way_of(spot);
        for (lightbin::Sphere& sphere : set.spheres)
            sphere.x += way_of(sphere);
        for (lightbin::Box& box : set.boxes) {
            box.x += way_of(box);
            box.box_x += way_of(box);
        }
        sets.push_back(std::move(set));
    }
    return sets;
}

lightbin::Slices slices_of(DepthMethod method, const lightbin::View& view, const BinnedLights& lights) {
    return slices_for({.method = method}, view.orthographic(), lights.listed());
}

// The options of ways, but for the width of ids.
constexpr Options ways[] = {
    {},
    {.depth_test = true},
    {.slicing = Slicing::z_bins},
    {.slicing = Slicing::clusters},
    {.depth_test = true, .slicing = Slicing::clusters}};

bool is(const lightbin::AdvicePlan& plan, const Options& way) {
    return plan.tiled && plan.depth_test == way.depth_test && plan.slicing == way.slicing;
}

constexpr Options with_ids(Options way, IdWidth ids) {
    way.ids = ids;
    return way;
}

}  // namespace

WayCosts::WayCosts(const lightbin::View& view, const glm::mat4& projection, const BinnedLights& lights,
                   CpuDepth depth)
    : view_(view), depth_(std::move(depth)), sets_(sets_of(lights, view, projection)),
      clusters_(slices_of(DepthMethod::clusters, view, lights)),
      z_bins_(slices_of(DepthMethod::z_bins, view, lights)),
      workers_(std::max(std::thread::hardware_concurrency(), 1u)), pool_(std::make_unique<Pool>(workers_)) {
    clusters_ns_ = ns_of([&] { clusters_ = slices_of(DepthMethod::clusters, view, lights); });
    z_bins_ns_ = ns_of([&] { z_bins_ = slices_of(DepthMethod::z_bins, view, lights); });
    for (const float window : depth_.depth) {
        const double z = static_cast<double>(window);
        view_depth_.push_back(window < 1 ? view.view_depths(z, z).min
                                         : std::numeric_limits<float>::infinity());
    }
}

WayCosts::~WayCosts() = default;

// From their boundaries, as slices_for() lays them.
std::string WayCosts::slices_in_words(Slicing slicing) const {
    const lightbin::Slices& slices = slicing == Slicing::z_bins ? z_bins_ : clusters_;
    const auto boundary = [&](std::size_t i) { return static_cast<double>(slices.boundaries()[i]); };
    const int count = slices.count();
    char words[80];
    if (slicing == Slicing::z_bins || view_.orthographic())
        std::snprintf(words, sizeof words, "linear(%d, 0, %#.4gf)", count, boundary(0) * count);
    else
        std::snprintf(words, sizeof words, "exponential(%d, %#.4gf, %#.4gf)", count, boundary(0),
                      boundary(0) * std::pow(boundary(1) / boundary(0), count - 1));
    return words;
}

const WayCosts::Reduced& WayCosts::reduced(int tile_size, bool minimum, bool maximum) {
    const auto [place, is_new] = reduced_.try_emplace({tile_size, minimum, maximum});
    Reduced& reduced = place->second;
    if (!is_new) return reduced;
    const lightbin::View view = value_of(view_.with_tile_size(tile_size));
    reduced.min.resize(minimum ? view.tile_count() : 0);
    reduced.max.resize(maximum ? view.tile_count() : 0);
    std::vector<double> times;
    for (int turn = 0; turn < 5; ++turn)
        times.push_back(ns_of([&] {
            reduced.bounds =
                value_of(lightbin::reduce_depth(view, {.depth = depth_.depth, .skip_background = true},
                                                {reduced.min, reduced.max}));
        }));
    reduced.ns = median(times);
    return reduced;
}

double WayCosts::z_bounds_ns(const Way& way) {
    const double here = prices_.read_back_ns + reduced(way.plan.tile_size, way.minimum, way.maximum).ns;
    return prices_.depth_pass_ns + std::min(here, prices_.gpu_reduction_ns);
}

bool WayCosts::reduces_on_gpu(const Way& way) {
    return z_bounds_ns(way) == prices_.depth_pass_ns + prices_.gpu_reduction_ns;
}

template <Options options> WayCosts::Build WayCosts::build_with(const Way& way) {
    const lightbin::View view = value_of(view_.with_tile_size(way.plan.tile_size));
    const lightbin::Slices& slices = options.slicing == Slicing::z_bins ? z_bins_ : clusters_;
    const auto binner = std::make_shared<lightbin::Binner<options>>();
    const auto least = std::make_shared<std::vector<lightbin::Sphere>>();
    lightbin::ZBounds bounds;
    if (way.plan.has_z_bounds())
        bounds = reduced(way.plan.tile_size, way.minimum, way.maximum).bounds;
    return [=, this, &slices](const ViewLights& lights, Counts* counts) {
        const auto parallel = way.threads ? lightbin::Parallel(workers_, *pool_) : lightbin::Parallel();
        const auto bin = [&](const auto& taken) {
            return value_of(binner->bin(view, lightbin::lights(taken, lights.boxes),
                                        lightbin::inputs_for<options>(bounds, slices), parallel));
        };
        const double start = now_ns();
        const bool cones = way.cones && !lights.spots.empty();
        if (!cones) {
            least->clear();
            for (const lightbin::Spot& spot : lights.spots)
                least->push_back(lightbin::bounding_sphere(spot));
        }
        const auto grid = cones ? bin(lights.spots) : bin(lights.spots.empty() ? lights.spheres : *least);
        const double ns = now_ns() - start;
        if (counts == nullptr) return ns;

        counts->bytes = static_cast<double>(grid.ranges().size_bytes() + grid.ids().size_bytes() +
                                            grid.ranks().order.size_bytes() + grid.ranks().bins.size_bytes());
        const float* depth = view_depth_.data();
        for (int y = 0; y < view.viewport().height; ++y)
            for (int x = 0; x < view.viewport().width; ++x, ++depth) {
                if (std::isinf(*depth)) continue;
                const int slice = options.slicing == Slicing::none ? 0 : slices.slice_at(*depth);
                auto met = grid.lights_in(x / view.tile_size(), y / view.tile_size(),
                                          options.slicing == Slicing::clusters ? slice : 0);
                if constexpr (options.slicing == Slicing::z_bins)
                    met = lightbin::lights_of_bin(met, grid.ranks().bins[static_cast<std::size_t>(slice)]);
                counts->evaluations += static_cast<double>(met.size());
            }
        return ns;
    };
}

WayCosts::Build WayCosts::build_of(const Way& way) {
    if (!way.plan.tiled)
        return [this](const ViewLights& lights, Counts* counts) {
            const auto drawn = std::count_if(view_depth_.begin(), view_depth_.end(),
                                             [](float depth) { return std::isfinite(depth); });
            if (counts != nullptr)
                counts->evaluations = static_cast<double>(drawn) * static_cast<double>(lights.size());
            return 0.0;
        };
    Build build;
    [&]<std::size_t... i>(std::index_sequence<i...>) {
        const auto take = [&]<std::size_t at> {
            if (!is(way.plan, ways[at])) return;
            build = way.narrow_ids ? build_with<with_ids(ways[at], IdWidth::u16)>(way)
                                   : build_with<with_ids(ways[at], IdWidth::u32)>(way);
        };
        (take.template operator()<i>(), ...);
    }
    (std::make_index_sequence<std::size(ways)>{});
    return build;
}

std::vector<WayCost> WayCosts::measure(std::span<const Way> all) {
    std::vector<Build> builds;
    std::vector<WayCost> costs;
    for (const Way& way : all) {
        builds.push_back(build_of(way));
        WayCost& cost = costs.emplace_back();
        if (!builds.back()) {
            cost.shade = HUGE_VAL;
            continue;
        }
        Counts counts;
        builds.back()(sets_[0], &counts);
        const bool bounded = way.plan.has_z_bounds();
        if (bounded)
            cost.depth = z_bounds_ns(way);
        else if (way.plan.tiled && way.plan.slicing != Slicing::none)
            cost.depth = way.plan.slicing == Slicing::clusters ? clusters_ns_ : z_bins_ns_;
        cost.upload = counts.bytes * prices_.upload_byte_ns;
        cost.shade = counts.evaluations * prices_.evaluation_ns * (bounded ? 1 : depth_.overdraw);
    }
    std::vector<std::vector<double>> times(all.size());
    for (std::size_t turn = 0; turn < turns; ++turn)
        for (std::size_t i = 0; i < all.size(); ++i)
            if (builds[i]) times[i].push_back(builds[i](sets_[1 + turn], nullptr));
    for (std::size_t i = 0; i < all.size(); ++i)
        if (builds[i]) costs[i].build = median(times[i]);
    return costs;
}
