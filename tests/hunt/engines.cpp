// SPDX-License-Identifier: MIT
// The engines of one depth test, HUNT_DEPTH_TEST.
#include "engines.hpp"
#include "guarded.hpp"

#include <lightbin/encode.hpp>

#include <algorithm>
#include <atomic>
#include <memory>
#include <numeric>
#include <thread>
#include <vector>

namespace hunt {
namespace {

/// A light as a caller may have it, with what the library need not know.
struct Lamp {
    double power;
    float range;
    float place[3];
    char name[7];
};

/// The caller's way to run a loop.
struct Runner {
    template <class Body> void operator()(std::size_t n, const Body& body) const {
        std::vector<std::size_t> order(n);
        std::iota(order.begin(), order.end(), std::size_t{0});
        Random random(seed);
        if (how == Order::backward) std::reverse(order.begin(), order.end());
        if (how == Order::shuffled)
            for (std::size_t i = n; i > 1; --i)
                std::swap(order[i - 1], order[random.below(i)]);
        if (how != Order::threads) {
            for (const std::size_t i : order)
                body(i);
            return;
        }
        std::atomic<std::size_t> next = 0;
        const auto work = [&] {
            for (std::size_t i; (i = next++) < n;)
                body(i);
        };
        std::thread others[] = {std::thread(work), std::thread(work)};
        work();
        for (std::thread& other : others)
            other.join();
    }

    Order how;
    std::uint64_t seed;
};

template <class Id> Lists copy_of(const lightbin::LightGrid<Id>& grid) {
    return {{grid.ranges().begin(), grid.ranges().end()}, {grid.ids().begin(), grid.ids().end()}};
}

template <lightbin::Options options> struct Kept {
    using Binner = lightbin::Binner<options>;
    using Id = typename Binner::Id;
    static constexpr bool with_depth = options.depth_test != DepthTest::none;

    static inline std::unique_ptr<Binner> binner;

    static void forget() { binner.reset(); }

    /// The grid in the caller's memory, which is too small at first. Writes what is wrong.
    static lightbin::LightGrid<Id> copy(const lightbin::LightGrid<Id>& grid,
                                        Guarded<lightbin::ListRange>& ranges, Guarded<Id>& ids, Output& out) {
        using lightbin::ErrorCode;
        const std::size_t tiles = grid.ranges().size(), entries = grid.ids().size();
        if (tiles > 0) {
            const auto few = grid.copy_to(ranges.span(tiles - 1), ids.span());
            if (few || few.error().code != ErrorCode::range_buffer_too_small)
                out.wrong = "copy_to takes too few ranges";
        }
        if (entries > 0) {
            const auto few = grid.copy_to(ranges.span(), ids.span(entries - 1));
            if (few || few.error().code != ErrorCode::id_buffer_too_small)
                out.wrong = "copy_to takes too few ids";
        }
        if (!ranges.intact(0) || !ids.intact(0)) out.wrong = "copy_to writes to a buffer that is too small";
        const auto copied = grid.copy_to(ranges.span(), ids.span());
        if (!copied) {
            out.wrong = "copy_to refuses buffers that are large enough";
            return grid;
        }
        if (!ranges.intact(tiles) || !ids.intact(entries)) out.wrong = "copy_to writes beyond the lists";
        if (copied->ranges().data() != ranges.span().data() || copied->ranges().size() != tiles ||
            copied->ids().size() != entries)
            out.wrong = "copy_to returns a grid that is not where it wrote";
        return *copied;
    }

    static void take(const lightbin::LightGrid<Id>& grid, Output& out) {
        out.tiles_x = grid.tiles_x();
        out.tiles_y = grid.tiles_y();
        out.counts = grid.light_counts();
        out.lengths = list_lengths(grid);
        out.lists = copy_of(grid);
    }

    template <class Lights, class Threads>
    static void build(const Input& input, const Lights& lights, const Threads& threads, Output& out) {
        const auto inputs = lightbin::inputs_for<options>(input.bounds);
        if constexpr (with_depth)
            if (input.calls == Calls::transparency) {
                const auto grids = binner->bin_transparency(*input.view, lights, inputs, threads);
                if (!grids) return static_cast<void>(out.error = grids.error());
                take(grids->opaque, out);
                out.transparent = copy_of(grids->transparent);
                return;
            }
        const auto grid = binner->bin(*input.view, lights, inputs, threads);
        if (!grid) return static_cast<void>(out.error = grid.error());
        if (input.calls != Calls::copy) return take(*grid, out);
        Random random(input.seed);
        const std::size_t more = random.one_in(3) ? 0 : random.below(std::size_t{20});
        Guarded<lightbin::ListRange> ranges(grid->ranges().size() + more);
        Guarded<Id> ids(grid->ids().size() + more);
        take(copy(*grid, ranges, ids, out), out);
    }

    template <class Lights>
    static void build_with_threads(const Input& input, const Lights& lights, Output& out) {
        const Runner runner = {input.order, input.seed};
        // Serial with one form of lights alone, as each takes time to compile.
        if constexpr (std::is_same_v<Lights, std::vector<glm::vec4>>)
            if (input.order == Order::serial) return build(input, lights, lightbin::Serial{}, out);
        build(input, lights,
              input.order == Order::serial ? lightbin::Parallel()
                                           : lightbin::Parallel(input.workers, runner, 0),
              out);
    }

    static Output run(const Input& input) {
        if (!binner) binner = std::make_unique<Binner>();
        Output out;
        const Scene& scene = *input.scene;
        if (input.form == Form::own) {
            std::vector<Lamp> lamps;
            lamps.reserve(scene.lights.size());
            for (const Sphere& light : scene.lights)
                lamps.push_back({0, light.radius, {light.x, light.y, light.z}, {}});
            const auto to_light = [&scene](const Lamp& lamp) {
                static_cast<void>(scene);
                return Sphere{lamp.place[0], lamp.place[1], lamp.place[2], lamp.range};
            };
            if (!scene.in_world)
                build_with_threads(input, lightbin::view_space(lamps, to_light), out);
            else
                build_with_threads(input, lightbin::world_space(lamps, scene.to_view, to_light), out);
        } else if (scene.in_world) {
            if (scene.in_float)
                build_with_threads(input, lightbin::world_space(scene.lights, glm::mat4(scene.to_view)), out);
            else
                build_with_threads(input, lightbin::world_space(scene.lights, scene.to_view), out);
        } else if (input.form == Form::spheres) {
            build_with_threads(input, std::span<const Sphere>(scene.lights), out);
        } else {
            std::vector<glm::vec4> vectors;
            vectors.reserve(scene.lights.size());
            for (const Sphere& light : scene.lights)
                vectors.emplace_back(light.x, light.y, light.z, light.radius);
            build_with_threads(input, vectors, out);
        }
        return out;
    }
};

template <Footprint footprint, DepthTest depth_test, IdWidth ids> Engine of_tier(unsigned tier) {
    constexpr auto of = []<lightbin::Isa isa>() {
        constexpr lightbin::Options options = {
            .ids = ids, .footprint = footprint, .depth_test = depth_test, .isa = isa};
        return Engine{Kept<options>::run, Kept<options>::forget};
    };
    switch (tier) {
    case 0:
        return of.template operator()<lightbin::Isa::scalar>();
    case 1:
        return of.template operator()<lightbin::Isa::sse2>();
    case 2:
        return of.template operator()<lightbin::Isa::avx2>();
    default:
        return of.template operator()<lightbin::compiled_isa>();
    }
}

}  // namespace

template <DepthTest depth_test> Engine engine(Footprint footprint, unsigned tier, IdWidth ids) {
    if constexpr (has_narrow_ids(depth_test))
        if (ids == IdWidth::u16)
            return footprint == Footprint::rectangle
                       ? of_tier<Footprint::rectangle, depth_test, IdWidth::u16>(tier)
                       : of_tier<Footprint::silhouette, depth_test, IdWidth::u16>(tier);
    return footprint == Footprint::rectangle ? of_tier<Footprint::rectangle, depth_test, IdWidth::u32>(tier)
                                             : of_tier<Footprint::silhouette, depth_test, IdWidth::u32>(tier);
}

template Engine engine<DepthTest::HUNT_DEPTH_TEST>(Footprint footprint, unsigned tier, IdWidth ids);

}  // namespace hunt
