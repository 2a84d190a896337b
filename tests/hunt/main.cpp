// SPDX-License-Identifier: MIT
// Hunts for a light that the library misses, as somebody would who does not believe it: with the public headers
// alone, points inside spheres, the caller's own matrices in long double and the caller's own pixels.
//
//     hunt [--rounds N | --seconds N] [--seed N | --seed random] [--first ROUND]
//
// A round makes a camera, lights, points in the lights, Z bounds and slices, and looks for the light of each point in the
// grids of every kind. A fault is printed with its seed and round: `hunt --seed S --first R --rounds 1` goes there again.
#include "scene.hpp"

#include <lightbin/shader_build.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <numeric>
#include <random>
#include <string_view>

namespace hunt {
namespace {

using lightbin::DepthTest;
using lightbin::Isa;
using lightbin::Slicing;
using Long = long double;

constexpr const char* bounds_kinds[] = {"absent", "minimum", "maximum", "both", "tight", "gaps", "nasty bounds"};

/// A point of a light that is surely seen, and surely in one tile.
struct Placed {
    Inside inside;
    Seen seen;
    std::size_t tile;
};

struct Bounds {
    lightbin::ZBounds spans() const { return {sides[0], sides[1], sides[2], sides[3]}; }

    std::vector<float> sides[4];  ///< minimum, maximum, and those of the gap
};

/// Returns whether the bounds of a tile, beyond doubt, include a depth.
bool surely_within(const Bounds& bounds, bool with_gaps, std::size_t tile, Real depth) {
    const auto& [min, max, gap_min, gap_max] = bounds.sides;
    if (!min.empty() && !max.empty() && min[tile] > max[tile]) return false;
    const auto tests = [&](const std::vector<float>& side) { return !side.empty() && !std::isnan(side[tile]); };
    if (tests(min) && !surely_at_most(static_cast<Long>(min[tile]), depth)) return false;
    if (tests(max) && !surely_at_most(depth, static_cast<Long>(max[tile]))) return false;
    if (!with_gaps || !tests(gap_min) || !tests(gap_max) || gap_min[tile] >= gap_max[tile]) return true;
    return surely_at_most(depth, static_cast<Long>(gap_min[tile])) ||
           surely_at_most(static_cast<Long>(gap_max[tile]), depth);
}

/// Makes Z bounds as a caller may have them: those of a tile hold some of the points in the tile, and hardly more.
Bounds make_bounds(std::string_view name, const lightbin::View& view, const std::vector<Placed>& points, Random& random) {
    Bounds bounds;
    if (name == "absent") return bounds;
    const std::size_t tiles = view.tile_count(), size = tiles + (random.coin() ? 0 : random.below(std::size_t{70}));
    const bool gaps = name == "gaps" || random.one_in(4), nasty = name == "nasty bounds";
    if (name != "maximum") bounds.sides[0].resize(size, -7.0f);
    if (name != "minimum") bounds.sides[1].resize(size, 7.0f);
    if (gaps)
        for (int i = 2; i < 4; ++i)
            bounds.sides[i].resize(size, 0.0f);
    const auto side = [&](int i, std::size_t tile) -> float& {
        static float none;
        return bounds.sides[i].empty() ? none : bounds.sides[i][tile];
    };
    for (std::size_t tile = 0; tile < tiles; ++tile) {
        if (nasty && random.coin())
            for (int i = 0; i < 4; ++i)
                side(i, tile) = nasty_float(random);
        else if (random.one_in(3))
            side(0, tile) = infinite, side(1, tile) = -infinite;  // nothing is drawn
        else
            side(0, tile) = view.near_depth(), side(1, tile) = view.far_depth();
    }
    // Between two points of a tile's, with the gap between them.
    std::vector<std::pair<std::size_t, std::size_t>> by_tile;
    for (std::size_t i = 0; i < points.size(); ++i)
        by_tile.emplace_back(points[i].tile, i);
    std::ranges::sort(by_tile);
    for (std::size_t begin = 0, end; begin < by_tile.size(); begin = end) {
        const std::size_t tile = by_tile[begin].first;
        for (end = begin; end < by_tile.size() && by_tile[end].first == tile;)
            ++end;
        if (nasty && random.coin()) continue;
        const auto depth = [&] { return points[by_tile[begin + random.below(end - begin)].second].seen.depth; };
        Real least = depth(), most = depth();
        if (most.value < least.value) std::swap(least, most);
        if (name == "tight") most = least;
        side(0, tile) = float_down(least.low());
        side(1, tile) = float_up(most.high());
        side(2, tile) = float_up(least.high());
        side(3, tile) = float_down(most.low());
        if (name == "gaps" && random.one_in(4)) side(0, tile) = -infinite, side(1, tile) = infinite;
    }
    return bounds;
}

/// Makes slices by a law, or with boundaries anywhere, often at the points' depths or a float beside.
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
    const lightbin::View* view;
    const Scene* scene;
    lightbin::ZBounds bounds;
    const lightbin::Slices* slices;
    std::uint64_t seed;  ///< of how the work is shared
};

/// A copy of a LightGrid, which lives on when its Binner makes another.
struct Grid {
    std::vector<lightbin::ListRange> ranges;
    std::vector<std::uint32_t> ids, order;
    std::vector<lightbin::BinRange> bins;
    lightbin::LightCounts counts;

    std::span<const std::uint32_t> of(std::size_t cell) const {
        return std::span(ids).subspan(ranges[cell].offset, ranges[cell].count);
    }
};

/// A loop for lightbin::Parallel that runs the bodies on the calling thread, forward, backward or shuffled.
struct Runner {
    template <class Body> void operator()(std::size_t n, const Body& body) const {
        std::vector<std::size_t> order(n);
        std::iota(order.begin(), order.end(), std::size_t{0});
        Random random(seed);
        if (random.coin()) std::reverse(order.begin(), order.end());
        if (random.coin())
            for (std::size_t i = n; i > 1; --i)
                std::swap(order[i - 1], order[random.below(i)]);
        for (const std::size_t i : order)
            body(i);
    }
    std::uint64_t seed;
};

/// Bins with a Binner that lives on from call to call, unless its grid is large.
template <lightbin::Options options> lightbin::Result<Grid> bin(const Input& input) {
    static std::unique_ptr<lightbin::Binner<options>> binner;
    Random random(input.seed);
    if (!binner || random.one_in(8)) binner = std::make_unique<lightbin::Binner<options>>();
    const Runner runner = {input.seed};
    const lightbin::Parallel threads(random.pick<std::size_t>({1, 1, 2, 3, 4, 7, 8, 16, 33, 64}), runner, 0);
    const auto inputs = lightbin::inputs_for<options>(input.bounds, *input.slices);
    const auto run = [&](const auto& lights) { return binner->bin(*input.view, lights, inputs, threads); };
    const Scene& scene = *input.scene;
    const auto grid = !scene.in_world  ? run(scene.lights)
                      : scene.in_float ? run(lightbin::world_space(scene.lights, glm::mat4(scene.to_view)))
                                       : run(lightbin::world_space(scene.lights, scene.to_view));
    if (!grid) return grid.error();
    const auto copy = [](auto from, auto& to) { to.assign(from.begin(), from.end()); };
    Grid out;
    copy(grid->ranges(), out.ranges), copy(grid->ids(), out.ids);
    copy(grid->ranks().order, out.order), copy(grid->ranks().bins, out.bins);
    out.counts = grid->light_counts();
    if (out.ids.size() > 2'000'000 || out.ranges.size() > 1'000'000) binner.reset();
    return out;
}

/// A Binner's options, compiled for each instruction set.
struct BinnerKind {
    std::string name;
    DepthTest depth_test;
    Slicing slicing;
    lightbin::Result<Grid> (*bins[4])(const Input&);

    template <lightbin::Footprint footprint, DepthTest depth_test, Slicing slicing = Slicing::none>
    static BinnerKind of() {
        constexpr auto on = [](Isa isa) {
            return lightbin::Options{.footprint = footprint, .depth_test = depth_test, .slicing = slicing, .isa = isa};
        };
        return {std::string(to_string(footprint)) + ", " + to_string(depth_test) + ", " + to_string(slicing),
                depth_test,
                slicing,
                {bin<on(Isa::scalar)>, bin<on(Isa::simd128)>, bin<on(Isa::avx2)>, bin<on(lightbin::compiled_isa)>}};
    }
};

const std::vector<BinnerKind>& binner_kinds() {
    using enum lightbin::Footprint;
    using enum DepthTest;
    static const std::vector<BinnerKind> all = {
        BinnerKind::of<rectangle, none>(),
        BinnerKind::of<rectangle, interval>(),
        BinnerKind::of<rectangle, box>(),
        BinnerKind::of<rectangle, split_box>(),
        BinnerKind::of<silhouette, none>(),
        BinnerKind::of<silhouette, interval>(),
        BinnerKind::of<silhouette, box>(),
        BinnerKind::of<silhouette, split_box>(),
        BinnerKind::of<rectangle, none, Slicing::clusters>(),
        BinnerKind::of<rectangle, box, Slicing::clusters>(),
        BinnerKind::of<silhouette, box, Slicing::clusters>(),
        BinnerKind::of<rectangle, none, Slicing::z_bins>(),
        BinnerKind::of<silhouette, none, Slicing::z_bins>(),
    };
    return all;
}

/// What a hunt has come to so far.
struct Report {
    Tally tally;               ///< views of each kind, and points looked for
    std::uint64_t points = 0;  ///< looked for in lists, all kinds of Binners together
    std::uint64_t grids = 0;
    std::vector<std::string> faults;
};

class Round {
public:
    Round(std::uint64_t seed, std::uint64_t round, Report& report)
        : seed_(seed), round_(round), random_(seed ^ round * 0xd1342543de82ef95), report_(report) {}

    void run() {
        // Each kind comes up once in as many rounds as there are kinds.
        const auto deal = [&](int salt, auto& kinds) {
            return dealt(seed_ * 31 + static_cast<std::uint64_t>(salt), round_, static_cast<int>(std::size(kinds)));
        };
        const int camera_kind = deal(1, camera_kinds), grid_kind = deal(2, grid_kinds), space = deal(3, space_kinds);
        const char* const bounds_kind = bounds_kinds[deal(4, bounds_kinds)];
        const std::uint32_t lights = light_counts[deal(5, light_counts)];
        what_ = std::string(camera_kinds[camera_kind]) + ", " + grid_kinds[grid_kind] + ", " + space_kinds[space] +
                ", bounds " + bounds_kind + ", " + std::to_string(lights) + " lights";

        std::optional<lightbin::View> view;
        for (int tries = 0; tries < 20 && !view; ++tries) {
            camera_ = make_camera(camera_kind, random_);
            set_grid(camera_, grid_kind, random_);
            const auto made = camera_.in_float ? lightbin::View::from_projection(glm::mat4(camera_.matrix),
                                                                                 camera_.viewport, camera_.options)
                                               : lightbin::View::from_projection(camera_.matrix, camera_.viewport,
                                                                                 camera_.options);
            if (made)
                view = *made;
            else if (ordinary(camera_kind))
                fault("an ordinary camera is refused: " + std::string(made.error().message()));
        }
        if (!view) return;
        view_ = &*view;
        for (const char* kind : {camera_kinds[camera_kind], grid_kinds[grid_kind], space_kinds[space], bounds_kind})
            ++report_.tally[kind];

        const std::uint64_t tiles = view->tile_count(), most = 250'000;
        const auto large = static_cast<std::uint32_t>(
            lights * tiles <= most ? lights : std::min<std::uint64_t>(lights, most / (2 * tiles) + 1));
        scene_ = make_scene(camera_, space, lights, large, random_);
        keep_small(large);
        place_points();
        bounds_ = make_bounds(bounds_kind, *view_, placed_, random_);
        const bool costly = tiles > 20'000 || scene_.lights.size() > 2000;
        for (const BinnerKind& kind : binner_kinds())
            if (!costly || random_.one_in(3)) hunt(kind, costly);
    }

private:
    /// Shrinks lights, and in the end drops some, while their rectangles cover more tiles than a round has time for.
    void keep_small(std::uint32_t large) {
        for (int tries = 0; large < scene_.lights.size(); ++tries) {
            const auto rectangles =
                scene_.in_world
                    ? lightbin::shader_footprints(*view_, lightbin::world_space(scene_.lights, scene_.to_view))
                    : lightbin::shader_footprints(*view_, scene_.lights);
            double entries = 0;
            for (const lightbin::ShaderFootprint& f : *rectangles)
                entries += (f.x1 - f.x0 + 1.0) * (f.y1 - f.y0 + 1.0);
            if (entries < 2e6) return;
            if (tries < 4) {
                for (Sphere& light : scene_.lights)
                    if (random_.coin() && light.radius > 0) light.radius *= 0.01f;
            } else {
                scene_.lights.resize(std::max<std::size_t>(large, scene_.lights.size() / 8));
                std::erase_if(scene_.inside, [&](const Inside& i) { return i.light >= scene_.lights.size(); });
            }
        }
    }

    void fault(const std::string& what) {
        if (++faults_ > 3) return;  // the rest says no more
        report_.faults.push_back(what + "\n    in seed " + std::to_string(seed_) + ", round " + std::to_string(round_) +
                                 ": " + what_);
    }

    /// Keeps the points that are surely in their light, surely in view and surely in one tile.
    void place_points() {
        std::vector<Inside> points = scene_.inside;
        find_points(camera_, scene_, random_, points);
        if (view_->tile_count() == 0) return;
        for (const Inside& point : points) {
            if (!surely_inside(scene_.lights[point.light], point.point)) continue;
            const auto seen = see(camera_, in_view_space(scene_, point.point));
            if (!seen) continue;
            const int size = view_->tile_size();
            const auto tile_of = [&](Real at, int side) {  // -1 where not known
                const Long low = std::floor(at.low()), high = std::floor(at.high());
                const bool known = low >= 0 && high < side && std::floor(low / size) == std::floor(high / size);
                return known ? static_cast<std::ptrdiff_t>(std::floor(low / size)) : -1;
            };
            const auto x = tile_of(seen->x, camera_.viewport.width), y = tile_of(seen->y, camera_.viewport.height);
            if (x < 0 || y < 0) continue;
            placed_.push_back({point, *seen, static_cast<std::size_t>(y * view_->tiles_x() + x)});
            if (surely_less(seen->depth, static_cast<Long>(view_->near_depth())) ||
                surely_less(static_cast<Long>(view_->far_depth()), seen->depth))
                fault("MISS: a point in view is not between View's near and far depth");
        }
    }

    /// Looks into one grid of the kind. Grids of other instruction sets and numbers of threads must be the same bytes.
    void hunt(const BinnerKind& kind, bool costly) {
        const bool clusters = kind.slicing == Slicing::clusters;
        const bool few = clusters && view_->tile_count() * scene_.lights.size() > 20'000;
        const lightbin::Slices slices =
            make_slices(placed_, few ? random_.from_to(1, 5) : random_.pick({1, 2, 7, 24, 65, 1024}), random_);
        if (clusters && view_->tile_count() * static_cast<std::size_t>(slices.count()) > 1'000'000) return;
        const Input input = {view_, &scene_, bounds_.spans(), &slices, random_.bits()};
        const int first = random_.below(4);
        const auto grid = kind.bins[first](input);
        ++report_.grids;
        if (!grid) {
            using lightbin::ErrorCode;
            if (grid.error().code != ErrorCode::too_many_entries && grid.error().code != ErrorCode::too_many_list_places)
                fault("refused: " + std::string(grid.error().message()) + "; " + kind.name);
            return;
        }
        if (const std::string wrong = look(*grid, slices, kind); !wrong.empty()) fault(wrong + "; " + kind.name);
        for (int tier = 0; tier < 4; ++tier) {
            if (costly ? !random_.one_in(3) : tier == first && random_.coin()) continue;
            const auto other = kind.bins[tier]({view_, &scene_, bounds_.spans(), &slices, random_.bits()});
            ++report_.grids;
            const auto same = [](const auto& a, const auto& b) {
                return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
            };
            if (!other || !same(other->ranges, grid->ranges) || !same(other->ids, grid->ids) ||
                !same(other->order, grid->order) || !same(other->bins, grid->bins))
                fault("another grid on instruction set " + std::to_string(tier) + "; " + kind.name);
        }
    }

    /// Returns what is wrong with a grid, or an empty string.
    std::string look(const Grid& grid, const lightbin::Slices& slices, const BinnerKind& kind) {
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
            if (kind.slicing != Slicing::none ? slice != slice_of(depth.high())
                                              : kind.depth_test != DepthTest::none &&
                                                    !surely_within(bounds_, kind.depth_test == DepthTest::split_box,
                                                                   point.tile, depth))
                continue;
            ++report_.points;
            ++report_.tally["points, " + kind.name];
            const std::uint32_t light = point.inside.light, id = ranked ? rank_of[light] : light;
            const auto list = grid.of(point.tile + (clusters ? slice * tiles : 0));
            if (std::ranges::binary_search(list, id) &&
                (!ranked || (grid.bins[slice].least <= id && id <= grid.bins[slice].greatest)))
                continue;
            const Sphere& s = scene_.lights[light];
            const Point& p = point.inside.point;
            char line[400];
            std::snprintf(line, sizeof line,
                          "MISS: light %u (%.9g, %.9g, %.9g, %.9g) holds (%.21Lg, %.21Lg, %.21Lg), seen at pixel %.12Lg, "
                          "%.12Lg in tile %zu at depth %.12Lg, slice %zu of %zu, but the list of %zu or the bin lacks it",
                          light, s.x, s.y, s.z, s.radius, p[0], p[1], p[2], point.seen.x.value, point.seen.y.value,
                          point.tile, depth.value, slice, count, list.size());
            return line;
        }
        return "";
    }

    std::uint64_t seed_, round_;
    int faults_ = 0;
    Random random_;
    Report& report_;
    std::string what_;
    Camera camera_;
    const lightbin::View* view_ = nullptr;
    Scene scene_;
    std::vector<Placed> placed_;
    Bounds bounds_;
};

/// Counts the kinds of cameras, grids, spaces, bounds and Binners that no round has had.
std::size_t left_out(Tally& tally) {
    const auto name = [&](const auto& kinds) {
        for (const char* kind : kinds)
            tally[kind];
    };
    name(camera_kinds), name(grid_kinds), name(space_kinds), name(bounds_kinds);
    for (const BinnerKind& kind : binner_kinds())
        tally["points, " + kind.name];
    return static_cast<std::size_t>(std::ranges::count(tally, 0, [](const auto& times) { return times.second; }));
}

}  // namespace
}  // namespace hunt

int main(int count, char** words) {
    std::uint64_t rounds = 0, seed = 1, first = 0;
    double seconds = 0;
    for (int i = 1; i < count; i += 2) {
        const std::string_view word = words[i], value = i + 1 < count ? words[i + 1] : "";
        const std::uint64_t number = std::strtoull(value.data(), nullptr, 10);
        if (word == "--rounds")
            rounds = number;
        else if (word == "--seconds")
            seconds = static_cast<double>(number);
        else if (word == "--first")
            first = number;
        else if (word == "--seed")
            seed = value == "random" ? std::random_device{}() : number;
        else
            return std::fprintf(stderr, "hunt [--rounds N | --seconds N] [--seed N | --seed random] [--first ROUND]\n"), 2;
    }
    if (rounds == 0 && seconds == 0) rounds = 200;
    std::setvbuf(stdout, nullptr, _IOLBF, 1 << 12);
    std::printf("hunt: seed %llu\n", static_cast<unsigned long long>(seed));

    hunt::Report report;
    const auto start = std::chrono::steady_clock::now();
    const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
    double next_line = 10;
    std::size_t printed = 0;
    std::uint64_t round = first;
    const auto progress = [&] {
        std::printf("hunt: %.0f s, %llu rounds, %llu grids, %.4g points looked for, %zu faults\n", elapsed(),
                    static_cast<unsigned long long>(round - first), static_cast<unsigned long long>(report.grids),
                    static_cast<double>(report.points), report.faults.size());
    };
    while ((rounds == 0 || round - first < rounds) && (seconds == 0 || elapsed() < seconds) &&
           report.faults.size() < 10) {
        try {
            hunt::Round(seed, round, report).run();
        } catch (const std::bad_alloc&) {
            report.faults.push_back("out of memory in round " + std::to_string(round));
        }
        ++round;
        for (; printed < report.faults.size(); ++printed)
            std::printf("FAULT after %.1f s: %s\n", elapsed(), report.faults[printed].c_str());
        if (elapsed() < next_line) continue;
        progress();
        next_line = elapsed() * 1.2 + 5;
    }
    progress();

    // A few rounds can't have had everything: 200 must.
    const std::size_t kinds_left_out = hunt::left_out(report.tally);
    for (const auto& [name, times] : report.tally)
        std::printf("  %10llu  %s\n", static_cast<unsigned long long>(times), name.c_str());
    if (kinds_left_out > 0) std::printf("hunt: %zu kinds had no turn\n", kinds_left_out);
    return !report.faults.empty() || (round - first >= 200 && kinds_left_out > 0);
}
