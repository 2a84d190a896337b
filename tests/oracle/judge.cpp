// SPDX-License-Identifier: MIT
#include "judge.hpp"

#include "../../bench/exact/truth.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <numeric>
#include <span>

namespace oracle {

namespace {

std::string text(double number) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%a", number);
    return buffer;
}
std::string text(float number) {
    return text(static_cast<double>(number));
}

std::string text(const Light& light) {
    return "{" + text(light.x) + ", " + text(light.y) + ", " + text(light.z) + ", " + text(light.w) + "}";
}

std::string text(const Camera& camera) {
    std::string all = std::to_string(camera.width) + "x" + std::to_string(camera.height) + "/" +
                      std::to_string(camera.tile) + (camera.zero_to_one ? " [0,1]" : "") +
                      (camera.upper_left ? " upper left" : "") + (camera.reversed ? " reversed" : "") + " m";
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (camera.m[column][row] != 0)
                all += " [" + std::to_string(column) + "][" + std::to_string(row) + "] " +
                       text(camera.m[column][row]);
    return all;
}

/// The tiles a light, ascending: of light i, tiles[starts[i]] up to tiles[starts[i + 1]].
struct TilesOfLights {
    std::vector<std::size_t> starts;
    std::vector<std::uint32_t> tiles;

    TilesOfLights(const Lists& lists, std::size_t lights) : starts(lights + 2), tiles(lists.ids.size()) {
        for (const std::uint32_t id : lists.ids)
            ++starts.at(id + 2);
        std::partial_sum(starts.begin(), starts.end(), starts.begin());
        for (std::size_t tile = 0; tile + 1 < lists.offsets.size(); ++tile)
            for (std::size_t i = lists.offsets[tile]; i < lists.offsets[tile + 1]; ++i)
                tiles[starts[lists.ids[i] + 1]++] = static_cast<std::uint32_t>(tile);
    }
    std::span<const std::uint32_t> of(std::size_t light) const {
        return std::span(tiles).subspan(starts[light], starts[light + 1] - starts[light]);
    }
};

/// Depths at which a tile has something to light: in double for the filter, and where they come from.
struct Range {
    FlatDepths flat;
    float min, max;      ///< NaN: no bound
    double window = -1;  ///< a sample of the depth buffer; negative: none
};

}  // namespace

class Judge::Impl {
public:
    explicit Impl(const Scene& scene) : scene_(scene), truth_(scene.camera) {
        const CameraBall signs = truth_.oracle.in_camera({{1, 1, 1}, 0});
        sign_[0] = signs.x.convert_to<double>(), sign_[1] = signs.y.convert_to<double>();
        sign_[2] = signs.depth.convert_to<double>();
    }

    void examine(Rung rung, const Lists& lists, Verdicts& verdicts) {
        rung_ = rung;
        const std::uint32_t bad = rejected_of(scene_.lights);
        if (lists.rejected != bad)
            complain(verdicts,
                     "rejected " + std::to_string(lists.rejected) + " of " + std::to_string(bad) + " bad");
        if (lists.offsets.size() != tile_count() + 1 || !ascending(lists)) {
            complain(verdicts, "the lists are out of order");
            return;
        }
        TilesOfLights tiles(lists, scene_.lights.size());
        const bool first = rung == Rung::rectangles;
        if (!first) gather_ranges();
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
            ++verdicts.cases;
            if (is_bad(scene_.lights[i])) {
                if (!tiles.of(i).empty()) complain(verdicts, "a bad light is listed");
            } else if (first) {
                outside(i, tiles.of(i), verdicts);
            } else {
                lacking(i, rectangles_->of(i), tiles.of(i), verdicts);
            }
        }
        if (first) rectangles_ = std::make_unique<TilesOfLights>(std::move(tiles));
    }

    std::uint64_t test_filter(Random& random, std::size_t questions, std::uint64_t& wrong) {
        std::uint64_t answered = 0;
        gather_ranges();
        for (std::size_t i = 0; i < questions; ++i) {
            const Light& light = scene_.lights[random.bits() % scene_.lights.size()];
            if (is_bad(light)) continue;
            const std::size_t tile = random.bits() % tile_count();
            Block block = one_tile(tile);
            if (random.chance(0.3)) block.x1 = random.integer(block.x1, truth_.oracle.tiles_x());
            if (random.chance(0.3)) block.y0 = random.integer(0, block.y0);
            const std::span<const Range> ranges = ranges_of(tile);
            const Range range =
                ranges.empty() ? Range{truth_.range, NAN, NAN} : ranges[random.bits() % ranges.size()];
            const FlatBall ball = flat(light);
            const bool apart = truth_.filter.apart(block.x0, block.x1, block.y0, block.y1, range.flat, ball);
            const auto met = truth_.filter.meets(block.x0, block.x1, block.y0, block.y1, range.flat, ball);
            if (!apart && !met) continue;
            ++answered;
            const bool truth = meets({truth_.columns(block.x0, block.x1), truth_.rows(block.y0, block.y1)},
                                     exact_depths(range), seen(light));
            wrong += (apart && truth) || (met && *met != truth);
        }
        return answered;
    }

private:
    std::size_t tile_count() const {
        return static_cast<std::size_t>(truth_.oracle.tiles_x()) * static_cast<std::size_t>(truth_.oracle.tiles_y());
    }

    bool ascending(const Lists& lists) const {
        if (!std::is_sorted(lists.offsets.begin(), lists.offsets.end()) || lists.offsets.front() != 0 ||
            lists.offsets.back() != lists.ids.size())
            return false;
        for (std::size_t tile = 0; tile + 1 < lists.offsets.size(); ++tile) {
            std::int64_t last = -1;
            for (std::size_t i = lists.offsets[tile]; i < lists.offsets[tile + 1]; ++i) {
                if (std::int64_t{lists.ids[i]} <= last || lists.ids[i] >= scene_.lights.size()) return false;
                last = lists.ids[i];
            }
        }
        return true;
    }

    /// Rung rectangles: all tiles but the light's own, in as few blocks as they come.
    void outside(std::size_t i, std::span<const std::uint32_t> tiles, Verdicts& verdicts) {
        const int nx = truth_.oracle.tiles_x(), ny = truth_.oracle.tiles_y();
        if (tiles.empty()) return prove(i, {0, nx, 0, ny}, {truth_.range, NAN, NAN}, verdicts);
        const int top = static_cast<int>(tiles.front()) / nx, bottom = static_cast<int>(tiles.back()) / nx;
        prove(i, {0, nx, 0, top}, {truth_.range, NAN, NAN}, verdicts);
        prove(i, {0, nx, bottom + 1, ny}, {truth_.range, NAN, NAN}, verdicts);
        const int x0 = static_cast<int>(tiles.front()) % nx, x1 = static_cast<int>(tiles.back()) % nx + 1;
        const auto area = static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(bottom + 1 - top);
        bool rectangle = x0 < x1 && tiles.size() == area;
        for (const std::uint32_t tile : tiles) {
            const int x = static_cast<int>(tile) % nx;
            rectangle = rectangle && x >= x0 && x < x1;
        }
        if (!rectangle) return complain(verdicts, "not a rectangle: light " + std::to_string(i));
        prove(i, {0, x0, top, bottom + 1}, {truth_.range, NAN, NAN}, verdicts);
        prove(i, {x1, nx, top, bottom + 1}, {truth_.range, NAN, NAN}, verdicts);
    }

    /// Other rungs: the tiles of the light's rectangle that its list lacks.
    void lacking(std::size_t i, std::span<const std::uint32_t> rectangle,
                 std::span<const std::uint32_t> tiles, Verdicts& verdicts) {
        std::size_t at = 0;
        for (const std::uint32_t tile : rectangle) {
            if (at < tiles.size() && tiles[at] == tile) {
                ++at;
                continue;
            }
            for (const Range& range : ranges_of(tile))
                prove(i, one_tile(tile), range, verdicts);
        }
        if (at != tiles.size() && ++verdicts.strays <= 3)
            complain(verdicts, "beyond its rectangle: light " + std::to_string(i));
    }

    Block one_tile(std::size_t tile) const {
        const int x = static_cast<int>(tile) % truth_.oracle.tiles_x(),
                  y = static_cast<int>(tile) / truth_.oracle.tiles_x();
        return {x, x + 1, y, y + 1};
    }

    void prove(std::size_t i, const Block& block, const Range& range, Verdicts& verdicts) {
        if (block.empty()) return;
        const Light& light = scene_.lights[i];
        const std::uint64_t before = truth_.by_rationals();
        const bool met = truth_.meets(
            block, range.flat, flat(light), [&] { return exact_depths(range); }, [&] { return seen(light); });
        ++verdicts.proven;
        verdicts.exact += truth_.by_rationals() - before;
        if (!met) return;
        if (++verdicts.misses <= 5)
            complain(verdicts, "MISS: light " + std::to_string(i) + " " + text(light) + " tiles " +
                                   std::to_string(block.x0) + ".." + std::to_string(block.x1 - 1) + " x " +
                                   std::to_string(block.y0) + ".." + std::to_string(block.y1 - 1) +
                                   (range.window < 0 ? " bounds " + text(range.min) + ".." + text(range.max)
                                                     : " window depth " + text(range.window)));
    }

    FlatBall flat(const Light& light) const {
        return {sign_[0] * static_cast<double>(light.x), sign_[1] * static_cast<double>(light.y),
                sign_[2] * static_cast<double>(light.z), static_cast<double>(light.w)};
    }

    CameraBall seen(const Light& light) const {
        return truth_.oracle.in_camera(exact_ball(light.x, light.y, light.z, light.w));
    }

    Depths exact_depths(const Range& range) const {
        Depths depths;
        if (range.window >= 0) {
            depths.min = depths.max = truth_.oracle.view_depth(exact(range.window));
        } else {
            const auto given = [](float v) { return std::isnan(v) ? std::nullopt : std::optional(v); };
            depths = truth_.oracle.depths(given(range.min), given(range.max));
        }
        return depths;
    }

    void complain(Verdicts& verdicts, const std::string& what) const {
        verdicts.reports.push_back(what + " (" + info(rung_).name + "; " + text(scene_.camera) + ")");
    }

    /// What each tile has to light, for ranges_of(): every sample by itself; bounds as they are asked for, as there
    /// may be very many.
    void gather_ranges() {
        ranges_.clear();
        if (!scene_.depth.empty()) gather_samples();
    }

    /// NaN is no bound.
    void add_range(float min, float max) {
        constexpr float inf = std::numeric_limits<float>::infinity();
        if (min > max || min == inf || max == -inf) return;
        const double low = static_cast<double>(min), high = static_cast<double>(max);
        const FlatDepths flat = {low > truth_.range.min ? low : truth_.range.min,
                                 high < truth_.range.max ? high : truth_.range.max};
        if (!flat.surely_empty()) ranges_.push_back({flat, min, max});
    }

    void gather_samples() {
        range_starts_.assign(1, 0);
        std::map<float, std::optional<double>> view_depths;  // by window depth
        std::vector<std::vector<float>> seen(tile_count());
        const Camera& camera = scene_.camera;
        const float background = far_window_depth();
        for (std::size_t pixel = 0; pixel < scene_.depth.size(); ++pixel) {
            const float sample = scene_.depth[pixel];
            if (scene_.skip_background && sample == background) continue;
            const int x = static_cast<int>(pixel) % camera.width / camera.tile,
                      y = static_cast<int>(pixel) / camera.width / camera.tile;
            auto& tile = seen[static_cast<std::size_t>(y * truth_.oracle.tiles_x() + x)];
            const auto same = [&](float v) { return v == sample || (std::isnan(v) && std::isnan(sample)); };
            if (std::none_of(tile.begin(), tile.end(), same)) tile.push_back(sample);
        }
        for (const std::vector<float>& samples : seen) {
            for (const float sample : samples) {
                if (std::isnan(sample)) {  // anything
                    ranges_.push_back({truth_.range, NAN, NAN});
                    continue;
                }
                const float window = std::clamp(sample, 0.0f, 1.0f);
                const auto [at, is_new] = view_depths.try_emplace(window);
                if (is_new)
                    if (const auto depth = truth_.oracle.view_depth(exact(static_cast<double>(window))))
                        at->second = depth->convert_to<double>();
                if (!at->second) continue;  // at infinity
                ranges_.push_back({{*at->second, *at->second}, NAN, NAN, static_cast<double>(window)});
            }
            range_starts_.push_back(ranges_.size());
        }
    }

    float far_window_depth() const {
        const auto at_0 = truth_.oracle.view_depth(0), at_1 = truth_.oracle.view_depth(1);
        return !at_0 || (at_1 && *at_0 > *at_1) ? 0.0f : 1.0f;
    }

    /// Valid until the next call.
    std::span<const Range> ranges_of(std::size_t tile) {
        if (!scene_.depth.empty())
            return std::span(ranges_).subspan(range_starts_[tile],
                                              range_starts_[tile + 1] - range_starts_[tile]);
        ranges_.clear();
        add_range(scene_.min[tile], scene_.max[tile]);
        return ranges_;
    }

    const Scene& scene_;
    Truth truth_;
    double sign_[3];  ///< view space to the camera's axes
    Rung rung_ = Rung::rectangles;
    std::unique_ptr<TilesOfLights> rectangles_;
    std::vector<std::size_t> range_starts_;
    std::vector<Range> ranges_;
};

Judge::Judge(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Judge::~Judge() = default;
Judge::Judge(Judge&&) noexcept = default;

void Judge::examine(Rung rung, const Lists& lists, Verdicts& verdicts) {
    impl_->examine(rung, lists, verdicts);
}

std::uint64_t Judge::test_filter(Random& random, std::size_t questions, std::uint64_t& wrong) {
    return impl_->test_filter(random, questions, wrong);
}

namespace {
Random random_of(const Family& family, std::uint64_t seed) {
    Random random(seed_of(family.name) + seed * 0x9e3779b97f4a7c15u);
    random.bits();
    return random;
}
}  // namespace

namespace {
/// What a processor that takes denormal numbers for 0 sees of a scene.
void flush(Scene& scene) {
    const auto flush_number = [](float& v) {
        if (std::abs(v) < FLT_MIN) v = 0;
    };
    for (Light& light : scene.lights)
        for (float* v : {&light.x, &light.y, &light.z, &light.w})
            flush_number(*v);
    for (auto* depths : {&scene.min, &scene.max, &scene.depth})
        std::for_each(depths->begin(), depths->end(), flush_number);
}
}  // namespace

void judge_scene(Scene scene, const Engine& engine, Verdicts& verdicts) {
    if (engine.flushes_denormals()) flush(scene);
    Judge judge(scene);
    for (const RungInfo& info : all_rungs()) {
        const Lists lists = engine.lists(scene, info.rung, verdicts.reports);
        if (lists.offsets.empty()) return;
        judge.examine(info.rung, lists, verdicts);
    }
}

void run_scene(const Family& family, std::uint64_t seed, std::size_t lights, const Engine& engine,
               Verdicts& verdicts) {
    Random random = random_of(family, seed);
    const std::size_t before = verdicts.reports.size();
    judge_scene(family.make(random, lights), engine, verdicts);
    for (std::size_t i = before; i < verdicts.reports.size(); ++i)
        verdicts.reports[i] = family.name + " " + std::to_string(seed) + ": " + verdicts.reports[i];
}

std::uint64_t test_filter(const Family& family, std::uint64_t seed, std::size_t questions,
                          std::uint64_t& wrong) {
    Random random = random_of(family, seed);
    const Scene scene = family.make(random, 100);
    return Judge(scene).test_filter(random, questions, wrong);
}

}  // namespace oracle
