// What advise() predicts against grids that are built, and what it chooses where the choice is plain. Nothing
// here depends on how fast the machine is.
#include "scene.hpp"

#include <lightbin/advise.hpp>

#include <bit>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>

using namespace lightbin;

namespace {

constexpr float unbounded = std::numeric_limits<float>::infinity();

/// Ground below the eye up to the horizon, blocks on it, sky above: window depth a pixel.
std::vector<float> ground_depth(Extent size) {
    std::vector<float> depth;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const float slope =
                (0.5f - (static_cast<float>(y) + 0.5f) / static_cast<float>(size.height)) * 1.1547f;
            float z = slope > 0 ? 6 / slope : unbounded;
            if (x / 37 % 5 == 2 && slope > -0.2f) z = std::min(z, 10.0f + static_cast<float>(x / 37));
            depth.push_back(z > 999 ? 1.0f : (1000 * (z - 0.1f)) / (999.9f * z));
        }
    return depth;
}

struct Bounds {
    explicit Bounds(const View& view, const std::vector<float>& depth)
        : min(view.tile_count()), max(min), gap_min(min), gap_max(min) {
        reduced = *reduce_depth(view, {.depth = depth, .skip_background = true}, min, max, gap_min, gap_max);
    }
    std::vector<float> min, max, gap_min, gap_max;
    ZBounds reduced;
};

/// A picture's Z bounds at each tile size that is asked for, reduced once.
class Picture {
public:
    explicit Picture(std::vector<float> depth) : depth_(std::move(depth)) {}
    const Bounds& bounds(const View& view) {
        const auto [at, is_new] = bounds_.try_emplace(view.tile_size());
        if (is_new) at->second = std::make_unique<Bounds>(view, depth_);
        return *at->second;
    }

private:
    std::vector<float> depth_;
    std::map<int, std::unique_ptr<Bounds>> bounds_;
};

double tile_pixels(const View& view, std::size_t tile) {
    const int x = static_cast<int>(tile) % view.tiles_x(), y = static_cast<int>(tile) / view.tiles_x();
    const int t = view.tile_size();
    return static_cast<double>(std::min((x + 1) * t, view.viewport().width) - x * t) *
           (std::min((y + 1) * t, view.viewport().height) - y * t);
}

/// Evaluations of a grid that is built, in the view's own tiles that have something to light.
template <Footprint footprint, DepthTest depth_test>
double built(const View& fine, int tile_size, const std::vector<glm::vec4>& lights, Picture& picture) {
    const View view = *fine.with_tile_size(tile_size);
    Binner<Options{.footprint = footprint, .depth_test = depth_test}> binner;
    const Bounds &bounds = picture.bounds(view), &fine_bounds = picture.bounds(fine);
    const auto grid = [&] {
        if constexpr (depth_test == DepthTest::none)
            return binner.bin(view, lights);
        else
            return binner.bin(view, lights, bounds.reduced);
    }();
    REQUIRE(grid);
    double sum = 0;
    const int scale = tile_size / fine.tile_size();
    for (std::size_t tile = 0; tile < fine.tile_count(); ++tile) {
        if (fine_bounds.min[tile] > fine_bounds.max[tile]) continue;
        const int x = static_cast<int>(tile) % fine.tiles_x() / scale;
        const int y = static_cast<int>(tile) / fine.tiles_x() / scale;
        sum += tile_pixels(fine, tile) * static_cast<double>(grid->lights_in(x, y).size());
    }
    return sum;
}

double built(const View& fine, const Plan& plan, const std::vector<glm::vec4>& lights, Picture& picture) {
    const auto of = [&]<Footprint footprint>() {
        switch (plan.depth_test) {
        case DepthTest::interval:
            return built<footprint, DepthTest::interval>(fine, plan.tile_size, lights, picture);
        case DepthTest::box:
            return built<footprint, DepthTest::box>(fine, plan.tile_size, lights, picture);
        case DepthTest::split_box:
            return built<footprint, DepthTest::split_box>(fine, plan.tile_size, lights, picture);
        default:
            return built<footprint, DepthTest::none>(fine, plan.tile_size, lights, picture);
        }
    };
    return plan.footprint == Footprint::rectangle ? of.operator()<Footprint::rectangle>()
                                                  : of.operator()<Footprint::silhouette>();
}

Advice advised(const View& view, const auto& lights, const Costs& costs = {}, const ZBounds& bounds = {}) {
    const Result<Advice> advice = advise(view, lights, costs, bounds);
    REQUIRE(advice);
    for (const Plan& plan : advice->plans()) {
        CHECK(plan.build_ns >= 0);
        CHECK(plan.evaluations >= 0);
        CHECK(plan.total_ns == doctest::Approx(plan.build_ns + plan.evaluations * costs.evaluation_ns));
        CHECK(plan.total_ns >= advice->best().total_ns);
    }
    return *advice;
}

}  // namespace

TEST_CASE("the evaluations of rectangles without Z are those of the built grids, as far as 512 lights are in "
          "view") {
    const View view = test::view({1000, 700}, 8);
    // A constant depth: every tile has something to light.
    Picture flat(std::vector<float>(1000 * 700, 0.5f));
    for (const std::size_t count : {1u, 40u, 512u, 40000u}) {
        std::vector<glm::vec4> lights = test::random_lights(count, static_cast<std::uint32_t>(count));
        if (count > 512)  // all but one in a hundred behind the eye
            for (std::size_t i = 0; i < count; ++i)
                if (i % 100 != 17) lights[i] = {0, 0, 50, 1};
        int rectangles = 0, silhouettes = 0;
        const Advice advice = advised(view, lights);
        for (const Plan& plan : advice.plans()) {
            if (!plan.tiled) continue;
            const double truth = built(view, plan, lights, flat);
            if (plan.footprint == Footprint::rectangle) {
                CHECK(plan.evaluations == doctest::Approx(truth).epsilon(0.005));
                ++rectangles;
            } else if (count >= 40) {  // the mean over many outlines
                CHECK(plan.evaluations == doctest::Approx(truth).epsilon(0.12));
                ++silhouettes;
            }
        }
        CHECK(rectangles == 5);  // 8, 16, 32, 64 and 1000 pixels
        CHECK(silhouettes == (count >= 40 ? 4 : 0));
    }
}

TEST_CASE("the evaluations of lists with Z are near those of the built grids") {
    const View view = test::view({1280, 720}, 8);
    Picture ground(ground_depth({1280, 720})), flat(std::vector<float>(1280 * 720, 0.5f));
    const Bounds& bounds = ground.bounds(view);
    double squares = 0, surveyed_squares = 0;
    int plans = 0;
    std::vector<std::size_t> counts = {20, 300, 1000, 5000};
    if (test::share_of_cases(1) > 1) counts.resize(2);
    for (const std::size_t count : counts) {
        const auto lights = test::random_lights(count, 7);
        // As advise() does, with more lights and blocks than it takes time for.
        const auto source = detail::as_lights(lights);
        detail::Survey survey =
            detail::survey_rectangles(test::widest_tier(), view, source, bounds.reduced, count);
        detail::survey_blocks(test::widest_tier(), view, source, bounds.reduced, 4096, survey);
        // The standard error of a share is 0.44 over the root of the blocks: 0.007 for the 4096 above, 0.07 for the 40
        // that there is time for at least with more lights, and with 20 lights it may be 8 of them. Each tier asks other
        // numbers of blocks.
        const bool few = count < 40;
        const double allowed = 3.4 * 0.44 / std::sqrt(few ? 8 : 40);
        std::vector<Advice> advices;
        for (const Isa isa : test::machine_tiers())
            advices.push_back(advised(view, lights, {.isa = isa}, bounds.reduced));
        for (const Plan& plan : advices.front().plans()) {
            if (!plan.tiled || plan.tile_size > 64 || plan.footprint == Footprint::silhouette) continue;
            CAPTURE(count);
            CAPTURE(plan.tile_size);
            CAPTURE(static_cast<int>(plan.depth_test));
            const double truth = built(view, plan, lights, ground);
            const double untested =
                built<Footprint::rectangle, DepthTest::none>(view, plan.tile_size, lights, flat);
            const std::size_t grid = static_cast<std::size_t>(std::countr_zero(unsigned(plan.tile_size / 8)));
            const std::size_t rung = plan.depth_test == DepthTest::none  ? 0
                                     : plan.depth_test == DepthTest::box ? 1
                                                                         : 2;
            const double surveyed = survey.grids[grid].evaluations[rung];
            for (const Advice& advice : advices) {
                const auto same = [&](const Plan& other) {
                    return other.tile_size == plan.tile_size && other.footprint == plan.footprint &&
                           other.depth_test == plan.depth_test;
                };
                const auto advised_plan = std::find_if(advice.plans().begin(), advice.plans().end(), same);
                REQUIRE(advised_plan != advice.plans().end());
                const double error = (advised_plan->evaluations - truth) / untested;
                CHECK(std::fabs(error) <= allowed);
                if (!few) squares += error * error;
                ++plans;
            }
            CHECK(std::fabs(surveyed - truth) <= 0.024 * untested);
            surveyed_squares += std::pow((surveyed - truth) / untested, 2);
        }
    }
    const int of_a_count = 4 * 3, kinds = static_cast<int>(counts.size()) * of_a_count;
    const int tiers = static_cast<int>(test::machine_tiers().size());
    CHECK(plans == kinds * tiers);
    CHECK(std::sqrt(squares / ((kinds - of_a_count) * tiers)) < 0.1);
    CHECK(std::sqrt(surveyed_squares / kinds) < 0.01);
}

TEST_CASE("all tiers survey alike; bounds that leave out nothing are as none") {
    const View view = test::view({1000, 700}, 8);  // its last blocks are not whole
    const std::vector<float> depth = ground_depth({1000, 700});
    const Bounds bounds(view, depth);
    const auto lights = test::random_lights(300, 9);
    const auto surveyed = [&](Isa isa, const ZBounds& given) {
        const auto source = detail::as_lights(lights);
        detail::Survey survey = detail::survey_rectangles(isa, view, source, given);
        detail::survey_blocks(isa, view, source, given, 100, survey);
        return survey;
    };
    const detail::Survey scalar = surveyed(Isa::scalar, bounds.reduced);
    for (const Isa isa : test::machine_tiers()) {
        const detail::Survey other = surveyed(isa, bounds.reduced);
        for (std::size_t grid = 0; grid < 4; ++grid)
            for (std::size_t rung = 0; rung < std::size(detail::rungs); ++rung) {
                CHECK(other.grids[grid].entries[rung] == scalar.grids[grid].entries[rung]);
                CHECK(other.grids[grid].evaluations[rung] == scalar.grids[grid].evaluations[rung]);
            }
    }
    const std::vector<float> from_eye(view.tile_count(), 0.0f), to_sky(view.tile_count(), unbounded);
    const detail::Survey open = surveyed(test::widest_tier(), {.min = from_eye, .max = to_sky}),
                         blind = surveyed(test::widest_tier(), {});
    for (std::size_t grid = 0; grid < 4; ++grid)
        CHECK(open.grids[grid].evaluations[0] == doctest::Approx(blind.grids[grid].evaluations[0]));
}

TEST_CASE("a block's coarser tiles are those of the coarser grids; gaps are no wider, and as wide between "
          "two depths") {
    const Extent size = {200, 150};  // its last blocks are not whole
    const View view = test::view(size, 4);
    for (const unsigned depths : {2u, 1000u}) {
        // The finest tiles have one depth each, or nothing to light.
        std::mt19937 random(depths);
        std::vector<float> of_tile(view.tile_count()), depth;
        for (float& value : of_tile)
            value = random() % 8 == 0
                        ? 1.0f
                        : 0.99f + 0.009f * static_cast<float>(random() % depths) / static_cast<float>(depths);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                depth.push_back(of_tile[static_cast<std::size_t>(y / 4 * view.tiles_x() + x / 4)]);
        const Bounds finest(view, depth);
        int gaps = 0;
        for (int shift = 1; shift <= 3; ++shift) {
            const View coarse = *view.with_tile_size(4 << shift);
            const Bounds wanted(coarse, depth);
            for (std::size_t tile = 0; tile < coarse.tile_count(); ++tile) {
                const int x = static_cast<int>(tile) % coarse.tiles_x(),
                          y = static_cast<int>(tile) / coarse.tiles_x();
                const int blocks = 3 - shift;
                detail::SurveyBlock block = {};
                detail::read_block(view, finest.reduced, x >> blocks, y >> blocks, block);
                detail::scalar::merge_tiles(block);
                const unsigned in_block = (1u << blocks) - 1;
                const unsigned place = (shift == 1   ? 64
                                        : shift == 2 ? 80
                                                     : 84) +
                                       detail::block_place((static_cast<unsigned>(x) & in_block) << shift,
                                                           (static_cast<unsigned>(y) & in_block) << shift);
                float low, high;
                detail::tile_edges(coarse.camera().x, x, low, high);
                CHECK(block.low[0][place] == doctest::Approx(low));
                CHECK(block.high[0][place] == doctest::Approx(high));
                detail::tile_edges(coarse.camera().y, y, low, high);
                CHECK(block.low[1][place] == doctest::Approx(low));
                CHECK(block.high[1][place] == doctest::Approx(high));
                CHECK(block.low[2][place] == wanted.min[tile]);
                CHECK(block.high[2][place] == wanted.max[tile]);
                if (wanted.min[tile] > wanted.max[tile]) continue;
                const bool gap = block.gap_min[place] < block.gap_max[place];
                if (depths == 2) CHECK(gap == (wanted.gap_min[tile] < wanted.gap_max[tile]));
                if (!gap) continue;
                ++gaps;
                CHECK(block.gap_min[place] >= wanted.gap_min[tile]);
                CHECK(block.gap_max[place] <= wanted.gap_max[tile]);
                if (depths > 2) continue;
                CHECK(block.gap_min[place] == wanted.gap_min[tile]);
                CHECK(block.gap_max[place] == wanted.gap_max[tile]);
            }
        }
        CHECK(gaps > 100);
    }
}

TEST_CASE("kinds of light in turn are all seen by the sample") {
    // One in four, or in seven, is large; the others are dots.
    const View view = test::view({800, 600}, 8);
    for (const std::size_t period : {4u, 7u, 8u, 64u}) {
        std::vector<glm::vec4> lights;
        for (std::size_t i = 0; i < 16384; ++i)
            lights.emplace_back(0, 0, -20, i % period == 0 ? 4.0f : 0.001f);
        Picture flat(std::vector<float>(800 * 600, 0.5f));
        const auto wanted = built<Footprint::rectangle, DepthTest::none>(view, 16, lights, flat);
        const Advice advice = advised(view, lights);
        for (const Plan& plan : advice.plans())
            if (plan.tiled && plan.tile_size == 16 && plan.footprint == Footprint::rectangle)
                CHECK(plan.evaluations == doctest::Approx(wanted).epsilon(0.1));
    }
}

TEST_CASE("without Z bounds no depth test is weighed, and none is chosen that costs more than it saves") {
    const View view = test::view({1280, 720}, 8);
    const auto lights = test::random_lights(500, 3);
    const Advice blind = advised(view, lights);
    for (const Plan& plan : blind.plans())
        CHECK(plan.depth_test == DepthTest::none);

    const std::vector<float> depth = ground_depth({1280, 720});
    const Bounds bounds(view, depth);
    const auto best = [&](const Costs& costs) { return advised(view, lights, costs, bounds.reduced).best(); };
    CHECK(best({.evaluation_ns = 1}).depth_test != DepthTest::none);
    CHECK(best({.evaluation_ns = 1, .z_bounds_ns = 1e9}).depth_test == DepthTest::none);

    // Lights that reach everything: depth tells nothing apart.
    const std::vector<Sphere> everywhere(500, Sphere{0, 0, -20, 5000});
    const Advice advice = advised(view, everywhere, {}, bounds.reduced);
    CHECK(advice.best().depth_test == DepthTest::none);
    for (const Plan& plan : advice.plans())
        CHECK(plan.evaluations == doctest::Approx(advice.best().evaluations).epsilon(0.1));
}

TEST_CASE("what the evaluations cost decides between tiles") {
    const View view = test::view({1280, 720}, 8);
    const auto lights = test::random_lights(500, 5);
    CHECK(!advised(view, lights, {.evaluation_ns = 0}).best().tiled);  // nothing to save
    const Advice dear = advised(view, lights, {.evaluation_ns = 1e6});
    for (const Plan& plan : dear.plans())
        CHECK(plan.evaluations >= dear.best().evaluations);
    CHECK(dear.best().tile_size == 8);
    CHECK(advised(view, lights, {.evaluation_ns = 0.002}).best().tile_size > 8);
    const Advice slow = advised(view, lights, {.machine = 1000});
    CHECK(slow.best().build_ns <= 1000 * advised(view, lights).best().build_ns);
}

TEST_CASE("scenes that need no grid get none") {
    const View view = test::view({1280, 720}, 8);
    const auto is_cheap = [&](const auto& lights, const Costs& costs = {}) {
        const Plan best = advised(view, lights, costs).best();
        return !best.tiled || best.tile_size >= 1280;
    };
    CHECK(is_cheap(std::vector<Sphere>{}));
    CHECK(advised(view, std::vector<Sphere>{}).best().total_ns == 0);
    CHECK(is_cheap(std::vector<Sphere>{{0, 0, -20, 500}}));
    CHECK(is_cheap(std::vector<Sphere>(2000, Sphere{0, 0, 500, 20})));  // behind the eye
    CHECK(advised(view, std::vector<Sphere>(2000, Sphere{0, 0, 500, 20})).best().evaluations == 0);
    CHECK(!is_cheap(test::random_lights(1000, 6)));
}

TEST_CASE("any input") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Sphere> bad = {{nan, 0, 0, 1},          {0, 0, -9, -1},   {0, 0, -9, unbounded},
                                     {0, 0, -9, 0},           {0, 0, 0, 1e30f}, {1e30f, 0, -1e38f, 1},
                                     {0, nan, unbounded, nan}};
    const std::vector<float> nothing(100000, nan), crossed(100000, 0.0f);
    for (const Extent size : {Extent{0, 0}, {0, 50}, {1, 1}, {640, 1}, {1000, 700}, {32768, 32768}})
        for (const int tile : {1, 8, 100, 40000, std::numeric_limits<int>::max()}) {
            const View view = test::view(size, tile);
            advised(view, bad);
            advised(view, std::vector<Sphere>{});
            if (view.tile_count() > nothing.size()) continue;
            advised(view, bad, {}, {.min = nothing, .max = nothing, .gap_min = nothing, .gap_max = nothing});
            advised(view, bad, {}, {.min = nothing});
            const Advice empty =
                advised(view, bad, {}, {.min = std::vector<float>(100000, 1.0f), .max = crossed});
            for (const Plan& plan : empty.plans())
                CHECK(plan.evaluations == 0);
        }

    const View view = test::view({1000, 700}, 32);
    const std::vector<float> few(view.tile_count() - 1);
    CHECK(advise(view, bad, {}, {.max = few}).error().code == ErrorCode::z_bounds_too_small);
    CHECK(advise(view, bad, {}, {.min = crossed, .gap_min = few}).error().code ==
          ErrorCode::z_bounds_too_small);
    const float projective[4][4] = {{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    CHECK(advise(view, world_space(bad, projective)).error().code == ErrorCode::view_matrix_not_affine);
}

TEST_CASE("lights in any form and any number get the same advice each time, in words too") {
    const View view = test::view({1000, 700}, 16);
    const auto lights = test::random_lights(3000, 8);
    const Advice first = advised(view, lights);
    const float identity[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    const Advice again = advised(view, view_space(lights)),
                 moved = advised(view, world_space(lights, identity));
    REQUIRE(again.plans().size() == first.plans().size());
    for (std::size_t i = 0; i < first.plans().size(); ++i)
        CHECK(again.plans()[i].total_ns == first.plans()[i].total_ns);
    CHECK(moved.best().evaluations == doctest::Approx(first.best().evaluations).epsilon(0.02));
    CHECK(first.best().index == Index::u16);
    CHECK(advised(view, std::vector<Sphere>(65537, Sphere{0, 0, -9, 1})).best().index == Index::u32);

    const std::string text = first.text();
    CHECK(std::count(text.begin(), text.end(), '\n') ==
          static_cast<std::ptrdiff_t>(first.plans().size()) + 1);
    CHECK(text.find("no tiling") != std::string::npos);
}
