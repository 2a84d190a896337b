// SPDX-License-Identifier: MIT
// How much more than the exact set the lists hold, on the synthetic field: no more and no less than
// rectangles and depth intervals explain.
#include "harness.hpp"

using namespace oracle;

namespace {

/// The field that benchmarks use as well: 80 % of centres uniform in the frustum's volume from z = 1 to 200,
/// the others in a box around it; radius lognormal, median 6.1154, sigma 0.5.
std::vector<Light> field(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    std::vector<Light> lights;
    const double half_height = std::tan(std::acos(-1.0) / 6), half_width = half_height * 1920 / 1080;
    for (std::size_t i = 0; i < count; ++i) {
        double x, y, z;
        if (random.chance(0.8)) {
            z = std::cbrt(random.uniform(1, 200.0 * 200 * 200));
            x = z * half_width * random.uniform(-1, 1);
            y = z * half_height * random.uniform(-1, 1);
        } else {
            x = random.uniform(-260, 260), y = random.uniform(-160, 160), z = random.uniform(-50, 250);
        }
        lights.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(-z),
                          static_cast<float>(6.1154 * std::exp(0.5 * random.normal()))});
    }
    return lights;
}

Camera field_camera(int tile) {
    return {"field", projection(symmetric_lens(1920.0 / 1080, 60)), false, 1920, 1080, tile, false, false,
            false};
}

/// The tiles along one axis whose wedges the ball meets.
template <class Meets> std::pair<int, int> met_range(int count, Meets meets) {
    int first = 0, last = count;  // the wedges met are neighbours, as the ball is convex
    while (first < count && !meets(first))
        ++first;
    for (last = first; last < count && meets(last); ++last) {
    }
    return {first, last};
}

struct Pairs {
    double emitted = 0, rectangle = 0, exact = 0;
};

Pairs count_pairs(const std::vector<Light>& lights, int tile, bool interval) {
    const Camera camera = field_camera(tile);
    Tally tally;
    Examiner examiner(camera, tally);
    const Oracle& oracle = examiner.oracle;
    const lightbin::View view = view_of(camera);
    const int nx = oracle.tiles_x(), ny = oracle.tiles_y();

    // A ground plane seen from 10 above it, tiles above the horizon full of sky from 150 to 400.
    std::vector<float> min, max;
    for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
            const double t = std::tan(std::acos(-1.0) / 6), low = (1 - 2.0 * y * tile / 1080) * t,
                         high = (1 - 2.0 * (y + 1) * tile / 1080) * t;
            const bool ground = high > 10.0 / 150;
            min.push_back(ground ? static_cast<float>(10 / low) : 150.0f);
            max.push_back(ground ? static_cast<float>(10 / high) : 400.0f);
        }

    Pairs pairs;
    if (interval) {
        lightbin::Binner<lightbin::Options{.depth_test = lightbin::DepthTest::interval}> binner;
        pairs.emitted =
            static_cast<double>(binner.bin(view, lights, {.bounds = {.min = min, .max = max}})->ids().size());
    } else {
        lightbin::Binner<> binner;
        pairs.emitted = static_cast<double>(binner.bin(view, lights)->ids().size());
    }
    const Examiner::Cell range(examiner);
    for (const Light& light : lights) {
        const auto s = examiner.subject(light);
        const Rational lowest = s.seen.depth - s.seen.radius, highest = s.seen.depth + s.seen.radius;
        const auto [x0, x1] =
            met_range(nx, [&](int x) { return examiner.meets_columns(s, x, x + 1); });
        const auto [y0, y1] =
            met_range(ny, [&](int y) { return examiner.meets_rows(s, y, y + 1); });
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                const std::size_t at = static_cast<std::size_t>(y * nx + x);
                const Examiner::Cell cell = interval ? Examiner::Cell(examiner, min[at], max[at]) : range;
                const Depths& depths = cell.depths();
                if (highest < *depths.min || (depths.max && lowest > *depths.max)) continue;
                ++pairs.rectangle;
                pairs.exact += examiner.meets_tile(s, x, y, cell);
            }
    }
    return pairs;
}

}  // namespace

TEST_CASE("excess on the field") {
    const std::vector<Light> lights = field(3000, 42);
    for (const int tile : {32, 16})
        for (const bool interval : {false, true}) {
            const Pairs pairs = count_pairs(lights, tile, interval);
            MESSAGE(tile << " px, " << std::string(interval ? "interval" : "none") << ": emitted "
                         << pairs.emitted << ", exact rectangles " << pairs.rectangle << ", exact set "
                         << pairs.exact << ": excess " << pairs.emitted / pairs.exact - 1
                         << ", of it rounding " << pairs.emitted / pairs.rectangle - 1);
            CHECK(pairs.exact > 10000);
            // All that the method's geometry demands, and a thousandth for the margin that rounding takes.
            CHECK(pairs.emitted >= pairs.rectangle);
            CHECK(pairs.emitted <= pairs.rectangle * 1.001);
            // The rectangle's corners: a disc leaves 1 - pi/4 of its square empty, a large light at most 4/pi
            // - 1 = 27 %.
            if (!interval) {
                CHECK(pairs.rectangle / pairs.exact > 1.05);
                CHECK(pairs.rectangle / pairs.exact < 1.35);
            } else {  // and the sphere's depth interval is as long at its rim as in its middle
                CHECK(pairs.rectangle / pairs.exact > 1.1);
                CHECK(pairs.rectangle / pairs.exact < 1.6);
            }
        }
}
