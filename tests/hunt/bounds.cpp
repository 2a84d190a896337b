// SPDX-License-Identifier: MIT
#include "bounds.hpp"

#include "guarded.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string_view>

namespace hunt {
namespace {

using Long = long double;
constexpr lightbin::Isa tiers[] = {lightbin::Isa::scalar, lightbin::Isa::sse2, lightbin::Isa::avx2,
                                   lightbin::Options{}.isa};

/// What may lie in a depth buffer after a fragment of that window depth was written, by the words of DepthFormat: any
/// value that is near enough, more often one as far off as they allow.
float stored(Real depth, lightbin::DepthFormat format, Random& random) {
    const Long exact = std::clamp(depth.value, 0.0L, 1.0L);
    const int way = random.below(3);
    if (format == lightbin::DepthFormat::float32) {
        const float nearest = static_cast<float>(exact);
        const float value = way == 0 ? float_down(exact) : way == 1 ? float_up(exact) : nearest;
        const Long place = static_cast<Long>(value) - std::nextafter(value, -1.0f);
        return std::fabs(value - exact) + depth.error <= place && value >= 0 && value <= 1 ? value : nearest;
    }
    const Long steps = format == lightbin::DepthFormat::unorm24 ? 0xffffff : 0xffff;
    const auto value_of = [&](Long step) { return static_cast<float>(step / steps); };
    const float value = value_of(way == 0   ? std::floor(exact * steps)
                                 : way == 1 ? std::ceil(exact * steps)
                                            : std::round(exact * steps));
    const Long reach = 1 / steps + 0x1p-24L;
    return std::fabs(value - exact) + depth.error <= reach ? value : value_of(std::round(exact * steps));
}

std::string text(const char* what, std::size_t tile, Long is, Long least, Long most) {
    char line[200];
    std::snprintf(line, sizeof line, "%s: tile %zu, %.20Lg not in %.20Lg .. %.20Lg", what, tile, is, least,
                  most);
    return line;
}

/// Draws points to a depth buffer and reduces it.
std::string reduce(const Camera& camera, const lightbin::View& view, const std::vector<Placed>& points,
                   Random& random, Tally& tally, Bounds& bounds) {
    lightbin::DepthBuffer buffer;
    buffer.format = static_cast<lightbin::DepthFormat>(random.below(3));
    buffer.samples = random.pick({1, 1, 2, 3, 4, 8});
    buffer.skip_background = random.coin();
    const std::size_t width = static_cast<std::size_t>(view.viewport().width),
                      height = static_cast<std::size_t>(view.viewport().height),
                      samples = static_cast<std::size_t>(buffer.samples), row = width * samples;
    if (random.coin()) buffer.row_pitch = row + random.below(std::size_t{9});
    const std::size_t pitch = buffer.row_pitch == 0 ? row : buffer.row_pitch;
    const std::size_t size = height == 0 || width == 0 ? 0 : pitch * (height - 1) + row;
    ++tally[to_string(buffer.format)];
    ++tally[buffer.skip_background ? "background skipped" : "background counts"];
    ++tally[samples == 1 ? "one sample" : "many samples"];
    ++tally[pitch == row ? "no pitch" : "pitch"];

    const float background = view.reversed_z() ? 0.0f : 1.0f;
    constexpr float other = 0.3f;
    const int fill = random.below(4);
    std::vector<float> depth(size, fill == 0 ? other : background);
    if (fill == 1)
        for (float& sample : depth)
            sample = random.one_in(50) ? nasty_float(random) : static_cast<float>(random.unit());
    // Beside the rows lies what must not be read.
    for (std::size_t y = 0; y + 1 < height && size > 0; ++y)
        for (std::size_t x = row; x < pitch; ++x)
            depth[y * pitch + x] = random.coin() ? std::nanf("") : random.coin() ? -5.0f : 5.0f;
    std::vector<std::size_t> drawn(points.size(), size);
    std::vector<std::pair<std::size_t, std::size_t>> places;  // of a sample, and of the point there
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].pixel_x < 0 || random.one_in(5)) continue;
        const std::size_t place = static_cast<std::size_t>(points[i].pixel_y) * pitch +
                                  static_cast<std::size_t>(points[i].pixel_x) * samples +
                                  random.below(samples);
        depth[place] = stored(points[i].seen.window_depth, buffer.format, random);
        drawn[i] = place;
        places.emplace_back(place, i);
    }
    std::ranges::sort(places);
    for (std::size_t i = 0; i + 1 < places.size(); ++i)
        if (places[i].first == places[i + 1].first) drawn[places[i].second] = size;  // drawn over
    buffer.depth = depth;

    const std::size_t tiles = view.tile_count();
    bool wanted[4];
    for (bool& side : wanted)
        side = !random.one_in(5);
    if (!wanted[2]) wanted[3] = false;
    for (unsigned tier = 0; tier < std::size(tiers); ++tier) {
        std::vector<Guarded<float>> sides;
        for (int i = 0; i < 4; ++i)
            sides.emplace_back(tiles + random.below(std::size_t{3}));
        const auto span = [&](std::size_t i) { return wanted[i] ? sides[i].span() : std::span<float>{}; };
        const auto made =
            lightbin::reduce_depth(view, buffer, {span(0), span(1), span(2), span(3)}, tiers[tier]);
        if (!made) return "reduce_depth refuses: " + made.error().message();
        const bool gaps = wanted[2] && wanted[3];
        const std::span<const float> given[] = {made->min, made->max, made->gap_min, made->gap_max};
        for (std::size_t i = 0; i < 4; ++i) {
            const bool has = (i < 2 ? wanted[i] : gaps) && tiles > 0;
            if (!sides[i].intact(has ? tiles : 0)) return "reduce_depth writes beyond its bounds";
            if (has && (given[i].data() != sides[i].span().data() || given[i].size() != tiles))
                return "reduce_depth returns other bounds than it wrote";
            if (!has && !given[i].empty()) return "reduce_depth returns bounds that are not wanted";
            std::vector<float>& kept = bounds.sides[i];
            if (tier > 0 && has && std::memcmp(kept.data(), given[i].data(), tiles * sizeof(float)) != 0)
                return std::string("reduce_depth differs on tier ") + std::to_string(tier);
            kept.assign(given[i].begin(), given[i].end());
        }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (drawn[i] == size || (buffer.skip_background && depth[drawn[i]] == background)) continue;
        const std::size_t tile = points[i].tile;
        ++tally["points drawn"];
        if (!surely_within(bounds, true, tile, points[i].seen.depth)) {
            // By how much? Next to a bound is in doubt only if long double can't tell.
            const Real at = points[i].seen.depth;
            const auto side = [&](int k, float none) {
                return bounds.sides[k].empty() ? none : bounds.sides[k][tile];
            };
            if (surely_less(at, side(0, -infinite)) || surely_less(side(1, infinite), at))
                return text("MISS: a drawn point is out of its tile's reduced bounds", tile, at.value,
                            side(0, -infinite), side(1, infinite)) +
                       " (" + to_string(buffer.format) + ", stored " + std::to_string(depth[drawn[i]]) + ")";
            if (surely_less(side(2, infinite), at) && surely_less(at, side(3, -infinite)))
                return text("MISS: a drawn point is in its tile's reduced gap", tile, at.value, side(2, 0),
                            side(3, 0));
        }
    }
    // What the words say of tiles without a sample that counts, and of NaN.
    const std::size_t tile_size = static_cast<std::size_t>(view.tile_size());
    for (std::size_t tile = 0; tile < tiles; tile += 1 + random.below(tiles / 64 + 1)) {
        const std::size_t tx = tile % static_cast<std::size_t>(view.tiles_x()),
                          ty = tile / static_cast<std::size_t>(view.tiles_x());
        bool any = false, nan = false;
        for (std::size_t y = ty * tile_size; y < std::min((ty + 1) * tile_size, height); ++y)
            for (std::size_t x = tx * tile_size * samples;
                 x < std::min((tx + 1) * tile_size, width) * samples; ++x) {
                const float sample = depth[y * pitch + x];
                if (std::isnan(sample)) nan = true;
                if (!(buffer.skip_background && sample == background)) any = true;
            }
        const auto is = [&](int side, auto test) {
            return bounds.sides[side].empty() || test(bounds.sides[side][tile]);
        };
        if (!any &&
            !(is(0, [](float z) { return z == infinite; }) && is(1, [](float z) { return z == -infinite; })))
            return "a tile where nothing is drawn has bounds";
        if (any && !bounds.sides[0].empty() && !bounds.sides[1].empty() &&
            bounds.sides[0][tile] > bounds.sides[1][tile])
            return "a tile where something is drawn has no bounds";
        if (nan && !(is(0, [&](float z) { return z <= view.near_depth(); }) &&
                     is(1, [&](float z) { return z >= view.far_depth(); })))
            return "a tile with a NaN sample does not reach from near to far";
    }
    static_cast<void>(camera);
    return {};
}

}  // namespace

bool surely_within(const Bounds& bounds, bool with_gaps, std::size_t tile, Real depth) {
    const auto& [min, max, gap_min, gap_max] = bounds.sides;
    if (!min.empty() && !max.empty() && min[tile] > max[tile]) return false;
    const auto tests = [&](const std::vector<float>& side) {
        return !side.empty() && !std::isnan(side[tile]);
    };
    if (tests(min) && !surely_at_most(static_cast<Long>(min[tile]), depth)) return false;
    if (tests(max) && !surely_at_most(depth, static_cast<Long>(max[tile]))) return false;
    if (!with_gaps || !tests(gap_min) || !tests(gap_max) || gap_min[tile] >= gap_max[tile]) return true;
    return surely_at_most(depth, static_cast<Long>(gap_min[tile])) ||
           surely_at_most(static_cast<Long>(gap_max[tile]), depth);
}

std::string make_bounds(int kind, const Camera& camera, const lightbin::View& view,
                        const std::vector<Placed>& points, Random& random, Tally& tally, Bounds& bounds) {
    const std::string_view name = bounds_kinds[kind];
    const std::size_t tiles = view.tile_count(), pixels = static_cast<std::size_t>(view.viewport().width) *
                                                          static_cast<std::size_t>(view.viewport().height);
    if (name == "depth buffer" && pixels <= 200000)
        return reduce(camera, view, points, random, tally, bounds);
    if (name == "absent") return {};
    const bool gaps = name == "gaps" || random.one_in(4), nasty = name == "nasty bounds";
    const std::size_t room = tiles + (random.coin() ? 0 : random.below(std::size_t{70}));
    if (name != "maximum") bounds.sides[0].resize(room, -7.0f);
    if (name != "minimum") bounds.sides[1].resize(room, 7.0f);
    if (gaps)
        for (int i = 2; i < 4; ++i)
            bounds.sides[i].resize(room, 0.0f);
    std::vector<std::vector<Real>> in_tile;
    std::vector<std::pair<std::size_t, std::size_t>> by_tile;
    for (std::size_t i = 0; i < points.size(); ++i)
        by_tile.emplace_back(points[i].tile, i);
    std::ranges::sort(by_tile);
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
    for (std::size_t begin = 0, end; begin < by_tile.size(); begin = end) {
        const std::size_t tile = by_tile[begin].first;
        for (end = begin; end < by_tile.size() && by_tile[end].first == tile;)
            ++end;
        if (nasty && random.coin()) continue;
        const auto depth = [&](std::size_t i) { return points[by_tile[i].second].seen.depth; };
        const Real one = depth(begin + random.below(end - begin)),
                   two = depth(begin + random.below(end - begin));
        const bool swapped = two.value < one.value;
        const Real least = swapped ? two : one, most = name == "tight" ? least : swapped ? one : two;
        side(0, tile) = float_down(least.low());
        side(1, tile) = float_up(most.high());
        side(2, tile) = float_up(least.high());
        side(3, tile) = float_down(most.low());
        if (name == "gaps" && random.one_in(4)) side(0, tile) = -infinite, side(1, tile) = infinite;
    }
    return {};
}

}  // namespace hunt
