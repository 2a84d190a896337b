// SPDX-License-Identifier: MIT
// Compares a scene's lists, without and with depth test, and its masks, without and with z-bins, with exact arithmetic.
// Also compares every instruction set, and work divided among threads, with the scalar code.
#pragma once

#include "families.hpp"
#include "library_view.hpp"

#include "../../bench/exact/truth.hpp"

#include <lightbin/binner.hpp>
#include <lightbin/masks.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace oracle {

struct Verdicts {
    std::uint64_t proven = 0;  ///< proofs that a sphere does not meet a tile (or several) between its depth bounds
    std::uint64_t exact = 0;   ///< of these, decided by rational numbers
    std::uint64_t misses = 0;
    std::vector<std::string> reports;  ///< the first misses, and other complaints
};

class Judge {
public:
    Judge(const Scene& scene, const lightbin::View& view, Verdicts& verdicts)
        : scene_(scene), view_(view), truth_(scene.camera), verdicts_(verdicts) {
        for (const Light& light : scene.lights) {
            if (is_bad(light)) {
                balls_.emplace_back(), flat_.emplace_back();
                continue;
            }
            balls_.push_back(truth_.oracle.in_camera(exact_ball(light.x, light.y, light.z, light.w)));
            const CameraBall& b = balls_.back();
            flat_.push_back({nearly(b.x), nearly(b.y), nearly(b.depth), b.all ? HUGE_VAL : nearly(b.radius)});
        }
    }

    template <bool depth_test> void judge() {
        using lightbin::Isa;
        const Lists lists = built<depth_test>(Isa::scalar);
        // An Isa sets an upper limit: one that the machine lacks would run a narrower one again.
        for (const Isa isa : {Isa::simd128, Isa::avx2, Isa::avx512})
            if (lightbin::machine_isa(isa) == isa && built<depth_test>(isa) != lists)
                complain(to_string(isa) + std::string(" differs"));
        if (built<depth_test>(lightbin::compiled_isa, 3) != lists) complain("with 3 workers it differs");

        if (lists.rejected != rejected_of(scene_.lights)) complain("bad lights are miscounted");
        std::vector<bool> in(lists.ranges.size() * scene_.lights.size());
        std::size_t end = 0;
        for (std::size_t tile = 0; tile < lists.ranges.size(); ++tile) {
            const auto [offset, count] = lists.ranges[tile];
            if (offset != end || (end += count) > lists.ids.size()) return complain("the lists are out of order");
            std::int64_t last = -1;
            for (std::size_t i = offset; i < end; last = lists.ids[i++]) {
                const std::uint32_t id = lists.ids[i];
                if (id <= last || id >= scene_.lights.size()) return complain("ids are out of order");
                const std::size_t pair = tile * scene_.lights.size() + id;
                if (is_bad(scene_.lights[id])) complain("a bad light is listed");
                if (depth_test && !in_rectangle_[pair]) complain("a light is listed beyond its rectangle");
                in[pair] = true;
            }
        }
        const int nx = view_.tiles_x();
        for (int y = 0; y < view_.tiles_y(); ++y)
            for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
                const auto tile = [&](int x) { return static_cast<std::size_t>(y * nx + x); };
                const auto pair = [&](int x) { return tile(x) * scene_.lights.size() + i; };
                for (int x = 0, x1 = 0; x < nx && !is_bad(scene_.lights[i]); x = x1) {
                    x1 = x + 1;
                    if (in[pair(x)] || (depth_test && !in_rectangle_[pair(x)])) continue;
                    float min = -INFINITY, max = INFINITY;
                    if (depth_test)
                        min = scene_.min[tile(x)], max = scene_.max[tile(x)];
                    else
                        while (x1 < nx && !in[pair(x1)])
                            ++x1;
                    prove(i, {x, x1, y, y + 1}, min, max);
                }
            }
        in_rectangle_ = std::move(in);
    }

    /// Proves that lights do not meet columns and rows whose masks lack them, nor tiles in z-bins that lack them.
    void judge_masks(bool with_bins) {
        using lightbin::Isa, lightbin::MaskBinner;
        Random random(scene_.lights.size());
        const lightbin::Slices slices = slices_at_ends(Aim(scene_.camera), scene_.lights, random);
        const auto bin = [&](MaskBinner& binner) {
            return with_bins ? binner.bin(view_, scene_.lights, slices) : binner.bin(view_, scene_.lights);
        };
        MaskBinner scalar(Isa::scalar);
        const auto masks = bin(scalar);
        if (!masks) return complain("the lights were refused");
        for (const Isa isa : {Isa::simd128, Isa::avx2, Isa::avx512}) {
            MaskBinner binner(isa);
            const auto other = bin(binner);
            if (!other || !std::ranges::equal(other->words(), masks->words()))
                complain("masks: " + (to_string(isa) + std::string(" differs")));
        }
        if (masks->light_counts().rejected != rejected_of(scene_.lights)) complain("masks: bad lights are miscounted");
        const std::size_t count = scene_.lights.size(), out_of_view = masks->ids().size();
        std::vector<std::size_t> place_of(count, out_of_view);
        for (std::size_t place = 0; place < out_of_view; ++place) {
            const std::uint32_t id = masks->ids()[place];
            if (id >= count || place_of[id] != out_of_view) return complain("masks: no ids, or one twice");
            if (is_bad(scene_.lights[id])) complain("masks: a bad light has a bit");
            place_of[id] = place;
        }
        const int nx = view_.tiles_x(), ny = view_.tiles_y();
        for (std::size_t i = 0; i < count; ++i) {
            if (is_bad(scene_.lights[i])) continue;
            const std::size_t place = place_of[i];
            const auto each_run = [&](int end, const auto& mask_at, const auto& prove_run) {
                const auto lacks = [&](int at) {
                    return place == out_of_view || !(mask_at(at)[place / 32] >> place % 32 & 1);
                };
                for (int at = 0, begin = 0; at < end; begin = ++at) {
                    while (at < end && lacks(at))
                        ++at;
                    if (begin < at) prove_run(begin, at);
                }
            };
            each_run(
                nx, [&](int x) { return masks->column(x); },
                [&](int x0, int x1) { prove(i, {x0, x1, 0, ny}, -INFINITY, INFINITY); });
            each_run(
                ny, [&](int y) { return masks->row(y); },
                [&](int y0, int y1) { prove(i, {0, nx, y0, y1}, -INFINITY, INFINITY); });
            const auto boundaries = slices.boundaries();
            for (std::size_t s = 0; s < masks->bins().size(); ++s)
                if (place < masks->bins()[s].least || place > masks->bins()[s].greatest)
                    prove(i, {0, nx, 0, ny}, s == 0 ? -INFINITY : boundaries[s - 1],
                          s == boundaries.size() ? INFINITY : boundaries[s]);
        }
    }

private:
    struct Lists {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges;  ///< offset and count
        std::vector<std::uint32_t> ids;
        std::uint32_t rejected = 0;
        bool operator==(const Lists&) const = default;
    };

    template <bool depth_test> Lists built(lightbin::Isa isa, std::size_t workers = 1) {
        constexpr lightbin::Options options = {.depth_test = depth_test};
        thread_local std::map<lightbin::Isa, lightbin::Binner<options>> binners;
        lightbin::Binner<options>& binner = binners.try_emplace(isa, isa).first->second;
        // The worst order in which threads may work: one thread does everything, from the end.
        auto run = [](std::size_t n, auto body) {
            while (n > 0)
                body(--n);
        };
        const auto inputs = lightbin::inputs_for<options>(lightbin::ZBounds{scene_.min, scene_.max});
        const auto grid = binner.bin(view_, scene_.lights, inputs,
                                     workers > 1 ? lightbin::Parallel(workers, run) : lightbin::Parallel());
        if (!grid) {
            complain("the lights were refused");
            return {};
        }
        Lists lists = {{}, {grid->ids().begin(), grid->ids().end()}, grid->light_counts().rejected};
        for (const lightbin::ListRange range : grid->ranges())
            lists.ranges.emplace_back(range.offset, range.count);
        return lists;
    }

    /// Proves that a light does not meet tiles whose lists lack it, between depth bounds; NaN is no bound.
    void prove(std::size_t i, const Block& tiles, float min, float max) {
        const double low = static_cast<double>(min), high = static_cast<double>(max);
        const FlatDepths depths = {low > truth_.range.min ? low : truth_.range.min,
                                   high < truth_.range.max ? high : truth_.range.max};
        if (min > max || min == INFINITY || max == -INFINITY || depths.surely_empty()) return;
        const auto exact_depths = [&] {
            const auto given = [](float v) { return std::isnan(v) ? std::nullopt : std::optional(v); };
            return truth_.oracle.depths(given(min), given(max));
        };
        const std::uint64_t before = truth_.by_rationals();
        const bool met = truth_.meets(tiles, depths, flat_[i], exact_depths, [&] { return balls_[i]; });
        ++verdicts_.proven, verdicts_.exact += truth_.by_rationals() - before;
        if (!met || ++verdicts_.misses > 5) return;
        char where[120];
        std::snprintf(where, sizeof where, " tiles %d..%d, %d, bounds %a..%a", tiles.x0, tiles.x1, tiles.y0, low, high);
        complain("MISS: light " + text(scene_.lights[i]) + where);
    }

    void complain(const std::string& what) {
        if (verdicts_.reports.size() < 20) verdicts_.reports.push_back(what);
    }

    const Scene& scene_;
    const lightbin::View& view_;
    Truth truth_;
    Verdicts& verdicts_;
    std::vector<CameraBall> balls_;
    std::vector<FlatBall> flat_;
    std::vector<bool> in_rectangle_;  ///< tile by tile
};

inline void judge_scene(const Scene& scene, const lightbin::View& view, Verdicts& verdicts) {
    Judge judge(scene, view, verdicts);
    if (!scene.min.empty()) {
        judge.judge<false>();
        judge.judge<true>();
    }
    judge.judge_masks(false);
    judge.judge_masks(true);
}

}  // namespace oracle
