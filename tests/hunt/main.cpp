// SPDX-License-Identifier: MIT
// Hunts for a light that the library misses, as somebody would who does not believe it: with the public headers
// alone, points inside spheres, the caller's own matrices in long double and the caller's own pixels.
//
//     hunt [--rounds N | --seconds N] [--seed N | --seed random] [--first ROUND]
//
// A round makes a camera, lights, points in the lights, Z bounds and slices, and looks for the light of each point in
// the grids of every kind, and in masks. A fault is printed with its seed and round: `hunt --seed S --first R --rounds
// 1` goes there again.
#include "scene.hpp"

#include <lightbin/masks.hpp>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <string_view>

namespace hunt {
namespace {

using lightbin::Isa;
using lightbin::Slicing;

/// A point of a light that is certainly seen, and certainly in one tile.
struct Placed {
    Inside inside;
    Seen seen;
    std::size_t tile;
};

struct Bounds {
    lightbin::ZBounds spans() const { return {sides[0], sides[1]}; }

    std::vector<float> sides[2];  ///< minimum and maximum depth of each tile
};

/// Returns true only if a depth is certainly within the bounds of a tile.
bool surely_within(const Bounds& bounds, std::size_t tile, Real depth) {
    const auto& [min, max] = bounds.sides;
    if (!min.empty() && !max.empty() && min[tile] > max[tile]) return false;
    const auto tests = [&](const std::vector<float>& side) { return !side.empty() && !std::isnan(side[tile]); };
    if (tests(min) && !surely_at_most(static_cast<Long>(min[tile]), depth)) return false;
    return !tests(max) || surely_at_most(depth, static_cast<Long>(max[tile]));
}

/// Makes Z bounds as a caller may have them: both, one or none. Those of a tile hold two of the
/// points in the tile, or one, and hardly more; where there is no point they are as for nothing drawn, or for anything.
/// Now and then they are floats that nobody would pass.
Bounds make_bounds(const lightbin::View& view, const std::vector<Placed>& points, Random& random) {
    Bounds bounds;
    const std::size_t tiles = view.tile_count(), size = tiles + (random.coin() ? 0 : random.below(std::size_t{70}));
    const bool nasty = random.one_in(6);
    const int absent = random.below(6);  // a side, or none
    for (int i = 0; i < 2; ++i)
        if (absent != 5 && absent != i) bounds.sides[i].resize(size, 7.0f);
    const auto set = [&](std::size_t tile, float min, float max) {
        for (int i = 0; i < 2; ++i)
            if (!bounds.sides[i].empty())
                bounds.sides[i][tile] = nasty && random.one_in(3) ? nasty_float(random) : i == 0 ? min : max;
    };
    for (std::size_t tile = 0; tile < tiles; ++tile)
        if (random.one_in(3))
            set(tile, infinite, -infinite);
        else
            set(tile, view.near_depth(), view.far_depth());
    std::vector<std::pair<std::size_t, std::size_t>> by_tile;
    for (std::size_t i = 0; i < points.size(); ++i)
        by_tile.emplace_back(points[i].tile, i);
    std::ranges::sort(by_tile);
    for (std::size_t begin = 0, end; begin < by_tile.size(); begin = end) {
        const std::size_t tile = by_tile[begin].first;
        for (end = begin; end < by_tile.size() && by_tile[end].first == tile;)
            ++end;
        const auto depth = [&] { return points[by_tile[begin + random.below(end - begin)].second].seen.depth; };
        Real least = depth(), most = random.one_in(4) ? least : depth();
        if (most.value < least.value) std::swap(least, most);
        set(tile, float_down(least.low()), float_up(most.high()));
    }
    return bounds;
}

/// Makes depth slices by a formula or with random boundaries, often at the points' depths or a float beside.
lightbin::Slices make_slices(const std::vector<Placed>& points, int count, Random& random) {
    using lightbin::Slices;
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

struct Input {
    const lightbin::View& view;
    const Scene& scene;
    const Bounds& bounds;
    const lightbin::Slices& slices;
    std::uint64_t seed;  ///< for how work is divided among threads
};

/// A copy of a LightGrid, which lives on when its Binner makes another.
struct Grid {
    std::vector<lightbin::ListRange> ranges;
    std::vector<std::uint32_t> ids, order;
    std::vector<lightbin::BinRange> bins;
    lightbin::LightCounts counts;
};

bool same(const Grid& a, const Grid& b) {
    const auto bytes = [](const auto& one, const auto& other) {
        return one.size() == other.size() &&
               (one.empty() || std::memcmp(one.data(), other.data(), one.size() * sizeof one[0]) == 0);
    };
    return bytes(a.ranges, b.ranges) && bytes(a.ids, b.ids) && bytes(a.order, b.order) && bytes(a.bins, b.bins);
}

/// Calls a function with the lights in view space or, with a matrix of floats or doubles, in world space.
template <class Call> auto with_lights(const Scene& scene, Call call) {
    if (!scene.in_world) return call(lightbin::view_space(scene.lights));
    if (scene.in_float) return call(lightbin::world_space(scene.lights, glm::mat4(scene.to_view)));
    return call(lightbin::world_space(scene.lights, scene.to_view));
}

/// Makes lists with a Binner that is kept from call to call, unless the lists are large.
template <lightbin::Options options> lightbin::Result<Grid> bin(const Input& input, Isa isa) {
    static std::map<Isa, std::unique_ptr<lightbin::Binner<options>>> binners;
    std::unique_ptr<lightbin::Binner<options>>& binner = binners[isa];
    Random random(input.seed);
    if (!binner || random.one_in(8)) binner = std::make_unique<lightbin::Binner<options>>(isa);
    const bool backward = random.coin();
    const auto runner = [&](std::size_t n, const auto& body) {  // on this thread, from either end
        for (std::size_t i = 0; i < n; ++i)
            body(backward ? n - 1 - i : i);
    };
    const lightbin::Parallel threads(random.pick<std::size_t>({1, 1, 2, 3, 4, 7, 8, 16, 33, 64}), runner);
    const auto inputs = lightbin::inputs_for<options>(input.bounds.spans(), input.slices);
    const auto grid =
        with_lights(input.scene, [&](const auto& lights) { return binner->bin(input.view, lights, inputs, threads); });
    if (!grid) return grid.error();
    const auto copy = [](auto from, auto& to) { to.assign(from.begin(), from.end()); };
    Grid out;
    copy(grid->ranges(), out.ranges), copy(grid->ids(), out.ids);
    copy(grid->ranks().order, out.order), copy(grid->ranks().bins, out.bins);
    out.counts = grid->light_counts();
    if (out.ids.size() > 2'000'000 || out.ranges.size() > 1'000'000) binner.reset();
    return out;
}

/// Makes lists from the masks of a MaskBinner: a tile's list has the lights that both its column and its row have.
template <Slicing slicing> lightbin::Result<Grid> bin_masks(const Input& input, Isa isa) {
    constexpr bool ranked = slicing == Slicing::z_bins;
    static std::map<Isa, lightbin::MaskBinner> binners;
    lightbin::MaskBinner& binner = binners.try_emplace(isa, isa).first->second;
    const auto masks = with_lights(input.scene, [&](const auto& lights) {
        return ranked ? binner.bin(input.view, lights, input.slices) : binner.bin(input.view, lights);
    });
    if (!masks) return masks.error();
    const auto ids = masks->ids();
    Grid out;
    if (ranked) out.order.assign(ids.begin(), ids.end());
    out.bins.assign(masks->bins().begin(), masks->bins().end());
    out.counts = masks->light_counts();
    for (int y = 0; y < masks->tiles_y(); ++y)
        for (int x = 0; x < masks->tiles_x(); ++x) {
            const auto column = masks->column(x), row = masks->row(y);
            const auto begin = static_cast<std::uint32_t>(out.ids.size());
            for (std::uint32_t word = 0; word < masks->mask_words(); ++word)
                for (std::uint32_t bits = column[word] & row[word]; bits != 0; bits &= bits - 1) {
                    const std::uint32_t place = 32 * word + static_cast<std::uint32_t>(std::countr_zero(bits));
                    out.ids.push_back(ranked ? place : ids[place]);
                }
            out.ranges.push_back({begin, static_cast<std::uint32_t>(out.ids.size()) - begin});
        }
    if (masks->words().size() > 2'000'000) binner = lightbin::MaskBinner(isa);
    return out;
}

/// One set of a Binner's options, or masks; and what was found with it.
struct BinnerKind {
    std::string name;
    bool depth_test;
    Slicing slicing;
    lightbin::Result<Grid> (*bin_on)(const Input&, Isa);
    std::uint64_t points = 0;  ///< number of points that were looked for

    template <bool depth_test, Slicing slicing> static BinnerKind of() {
        return {std::string(depth_test ? "depth test, " : "") + to_string(slicing),
                depth_test,
                slicing,
                bin<lightbin::Options{.depth_test = depth_test, .slicing = slicing}>};
    }
    template <Slicing slicing> static BinnerKind of_masks() {
        return {std::string("masks, ") + to_string(slicing), false, slicing, bin_masks<slicing>};
    }
};

std::vector<BinnerKind> binner_kinds() {
    return {BinnerKind::of<false, Slicing::none>(),     BinnerKind::of<true, Slicing::none>(),
            BinnerKind::of<false, Slicing::clusters>(), BinnerKind::of<true, Slicing::clusters>(),
            BinnerKind::of<false, Slicing::z_bins>(),   BinnerKind::of<true, Slicing::z_bins>(),
            BinnerKind::of_masks<Slicing::none>(),      BinnerKind::of_masks<Slicing::z_bins>()};
}

class Round {
public:
    Round(std::uint64_t seed, std::uint64_t round, std::vector<BinnerKind>& kinds, std::vector<std::string>& faults)
        : name_("seed " + std::to_string(seed) + ", round " + std::to_string(round)),
          random_(seed ^ round * 0xd1342543de82ef95), kinds_(kinds), faults_(faults) {}

    void run() {
        const bool ordinary = random_.coin();
        std::optional<lightbin::View> view;
        for (int tries = 0; tries < 20 && !view; ++tries) {
            camera_ = make_camera(ordinary, random_);
            set_grid(camera_, random_);
            const auto made =
                camera_.in_float
                    ? lightbin::View::from_projection(glm::mat4(camera_.matrix), camera_.viewport, camera_.options)
                    : lightbin::View::from_projection(camera_.matrix, camera_.viewport, camera_.options);
            if (made)
                view = *made;
            else if (ordinary)
                return fault("an ordinary camera is refused: " + std::string(made.error().message()));
        }
        if (!view) return;
        view_ = &*view;
        // Numbers of lights about as large as a kernel works on at once; few large ones if there are many tiles.
        const std::uint32_t lights = random_.pick(
            {0u,   1u,   2u,   3u,   7u,   8u,   9u,   16u,   31u,   33u,   63u,    64u,    65u,    100u,
             127u, 129u, 255u, 256u, 257u, 300u, 513u, 1000u, 4097u, 8193u, 65535u, 65536u, 65537u, 131073u});
        const std::uint64_t tiles = view->tile_count(), most = 250'000;
        const auto large = static_cast<std::uint32_t>(
            lights * tiles <= most ? lights : std::min<std::uint64_t>(lights, most / (2 * tiles) + 1));
        scene_ = make_scene(camera_, lights, large, random_);
        keep_small(large);
        Maker(camera_, scene_, random_).find_points();
        place_points();
        bounds_ = make_bounds(*view_, placed_, random_);
        const bool costly = tiles > 20'000 || scene_.lights.size() > 2000;
        for (BinnerKind& kind : kinds_)
            if (!costly || random_.one_in(3)) hunt(kind, costly);
    }

private:
    /// Shrinks lights, and finally drops some, as long as they cover more tiles than a round has time for.
    void keep_small(std::uint32_t large) {
        for (int tries = 0; large < scene_.lights.size(); ++tries) {
            const std::uint64_t entries = with_lights(scene_, [&](const auto& lights) {
                lightbin::detail::Footprints rectangles;
                rectangles.project(lightbin::machine_isa(), *view_, lightbin::detail::as_lights(lights), {});
                return rectangles.area();
            });
            if (entries < 2'000'000) return;
            for (Sphere& light : scene_.lights)
                if (random_.coin() && light.radius > 0) light.radius *= 0.01f;
            if (tries > 3) scene_.lights.resize(std::max<std::size_t>(large, scene_.lights.size() / 8));
        }
    }

    void fault(const std::string& what) { faults_.push_back(what + ", in " + name_); }

    /// Keeps the points that are certainly in their light, in view and in one tile.
    void place_points() {
        for (const Inside& point : scene_.inside) {
            if (point.light >= scene_.lights.size() || !surely_inside(scene_.lights[point.light], point.point))
                continue;
            const auto seen = see(camera_, in_view_space(scene_, point.point));
            if (!seen) continue;
            const int size = camera_.options.tile_size;
            const auto tile_of = [&](Real at, int side, int count) {  // -1 where not known
                const Long low = std::floor(at.low()), high = std::floor(at.high());
                const auto tile = [&](Long pixel) {
                    return static_cast<std::ptrdiff_t>(
                        std::floor(count > 0 ? (2 * pixel + 1) * count / (2 * static_cast<Long>(side)) : pixel / size));
                };
                return low >= 0 && high < side && tile(low) == tile(high) ? tile(low) : -1;
            };
            auto x = tile_of(seen->x, camera_.viewport.width, camera_.options.columns),
                 y = tile_of(seen->y, camera_.viewport.height, camera_.options.rows);
            if (x < 0 || y < 0) continue;
            if (camera_.turned) std::swap(x, y);
            placed_.push_back({point, *seen, static_cast<std::size_t>(y * view_->tiles_x() + x)});
            if (surely_less(seen->depth, static_cast<Long>(view_->near_depth())) ||
                surely_less(static_cast<Long>(view_->far_depth()), seen->depth))
                fault("MISS: a point in view is not between View's near and far depth");
        }
    }

    /// Looks for all points in one grid. Other instruction sets and numbers of threads must make the same bytes.
    void hunt(BinnerKind& kind, bool costly) {
        const bool clusters = kind.slicing == Slicing::clusters;
        const bool few = clusters && view_->tile_count() * scene_.lights.size() > 20'000;
        const lightbin::Slices slices =
            make_slices(placed_, few ? random_.from_to(1, 5) : random_.pick({1, 2, 7, 24, 65, 1024}), random_);
        if (clusters && view_->tile_count() * static_cast<std::size_t>(slices.count()) > 1'000'000) return;
        const auto binned = [&](int tier) {
            constexpr Isa tiers[] = {Isa::scalar, Isa::simd128, Isa::avx2, lightbin::compiled_isa};
            return kind.bin_on({*view_, scene_, bounds_, slices, random_.bits()}, tiers[tier]);
        };
        const int first = random_.below(4);
        const auto grid = binned(first);
        if (!grid) {
            using lightbin::ErrorCode;
            if (grid.error().code != ErrorCode::too_many_entries &&
                grid.error().code != ErrorCode::too_many_pairs)
                fault("refused: " + std::string(grid.error().message()) + "; " + kind.name);
            return;
        }
        if (const std::string wrong = look(*grid, slices, kind); !wrong.empty()) fault(wrong + "; " + kind.name);
        for (int tier = 0; tier < 4; ++tier) {
            if (costly ? !random_.one_in(3) : tier == first && random_.coin()) continue;
            const auto other = binned(tier);
            if (!other || !same(*other, *grid))
                fault("another grid on instruction set " + std::to_string(tier) + "; " + kind.name);
        }
    }

    /// Returns what is wrong with a grid, or an empty string.
    std::string look(const Grid& grid, const lightbin::Slices& slices, BinnerKind& kind) {
        const bool clusters = kind.slicing == Slicing::clusters, ranked = kind.slicing == Slicing::z_bins;
        const std::size_t tiles = view_->tile_count(), count = static_cast<std::size_t>(slices.count());
        const auto bad = static_cast<std::uint32_t>(std::ranges::count_if(scene_.lights, is_bad));
        const std::uint32_t visible = grid.counts.lights - grid.counts.culled - grid.counts.rejected;
        if (grid.counts.lights != scene_.lights.size() || grid.counts.rejected != bad || visible > grid.counts.lights)
            return "the counts are not those of the lights";
        if (grid.ranges.size() != tiles * (clusters ? count : 1)) return "lists are not as many as cells";
        std::uint64_t at = 0;
        for (const lightbin::ListRange range : grid.ranges) {
            if (range.offset != at) return "offsets leave a gap or overlap";
            at += range.count;
            for (std::uint64_t i = at - range.count; i < at; ++i)
                if (grid.ids[i] >= (ranked ? visible : grid.counts.lights) ||
                    (i > at - range.count && grid.ids[i - 1] >= grid.ids[i]))
                    return "ids do not ascend, or are none";
        }
        if (at != grid.ids.size()) return "counts do not add up to the index list";
        if (grid.order.size() != (ranked ? visible : 0)) return "ranks are not as many as lights in view";
        if (grid.bins.size() != (ranked ? count : 0)) return "bins are not as many as slices";
        std::vector<std::uint32_t> rank_of(scene_.lights.size(), 0xffffffff);
        for (std::uint32_t rank = 0; rank < grid.order.size(); ++rank) {
            if (grid.order[rank] >= rank_of.size() || rank_of[grid.order[rank]] != 0xffffffff)
                return "the order has a light twice, or none";
            rank_of[grid.order[rank]] = rank;
        }
        for (const Placed& point : placed_) {
            const Real depth = point.seen.depth;
            const auto slice_of = [&](Long at_depth) {
                return static_cast<std::size_t>(std::ranges::upper_bound(slices.boundaries(), at_depth) -
                                                slices.boundaries().begin());
            };
            const std::size_t slice = slice_of(depth.low());
            if (kind.slicing != Slicing::none) {
                if (slice != slice_of(depth.high())) continue;
            }
            const bool bounded = kind.depth_test && !clusters;
            if (bounded && !surely_within(bounds_, point.tile, depth)) continue;
            ++kind.points;
            const std::uint32_t light = point.inside.light, id = ranked ? rank_of[light] : light;
            const lightbin::ListRange range = grid.ranges[point.tile + (clusters ? slice * tiles : 0)];
            if (std::ranges::binary_search(std::span(grid.ids).subspan(range.offset, range.count), id) &&
                (!ranked || (grid.bins[slice].least <= id && id <= grid.bins[slice].greatest)))
                continue;
            const Sphere& s = scene_.lights[light];
            const Point& p = point.inside.point;
            char line[400];
            std::snprintf(line, sizeof line,
                          "MISS: light %u (%.9g, %.9g, %.9g, %.9g) holds (%.21Lg, %.21Lg, %.21Lg), seen in tile %zu at "
                          "depth %.12Lg, slice %zu of %zu, but the list or the bin lacks it",
                          light, s.x, s.y, s.z, s.radius, p[0], p[1], p[2], point.tile, depth.value, slice, count);
            return line;
        }
        return "";
    }

    std::string name_;
    Random random_;
    std::vector<BinnerKind>& kinds_;
    std::vector<std::string>& faults_;
    Camera camera_;
    const lightbin::View* view_ = nullptr;
    Scene scene_;
    std::vector<Placed> placed_;
    Bounds bounds_;
};

}  // namespace
}  // namespace hunt

int main(int count, char** words) {
    std::uint64_t rounds = ~std::uint64_t{0}, seconds = ~std::uint64_t{0}, seed = 1, first = 0;
    for (int i = 1; i < count; i += 2) {
        const std::string_view word = words[i];
        std::uint64_t* const number = word == "--rounds"    ? &rounds
                                      : word == "--seconds" ? &seconds
                                      : word == "--first"   ? &first
                                      : word == "--seed"    ? &seed
                                                            : nullptr;
        if (number == nullptr || i + 1 == count)
            return std::fputs("hunt [--rounds N | --seconds N] [--seed N | --seed random] [--first ROUND]\n", stderr), 2;
        const std::string_view value = words[i + 1];
        *number = value == "random" ? std::random_device{}() : std::strtoull(words[i + 1], nullptr, 10);
    }
    std::vector<hunt::BinnerKind> kinds = hunt::binner_kinds();
    std::vector<std::string> faults;
    const auto start = std::chrono::steady_clock::now();
    std::uint64_t done = 0;
    while (done < rounds && faults.size() < 10 &&
           std::chrono::steady_clock::now() - start < std::chrono::duration<double>(static_cast<double>(seconds))) {
        hunt::Round(seed, first + done++, kinds, faults).run();
        if (done % 100 == 0)
            std::printf("hunt: %llu rounds\n", static_cast<unsigned long long>(done)), std::fflush(stdout);
    }
    for (const std::string& fault : faults)
        std::printf("FAULT: %s\n", fault.c_str());
    bool all_had_points = true;
    for (const hunt::BinnerKind& kind : kinds) {
        std::printf("%10llu points: %s\n", static_cast<unsigned long long>(kind.points), kind.name.c_str());
        all_had_points = all_had_points && kind.points > 0;
    }
    // In a few rounds some kind of grid may get no point at all; in 200 rounds each must get one.
    return !faults.empty() || (done >= 200 && !all_had_points);
}
