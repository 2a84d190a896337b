// Compares what advise() counts with lists searched pixel by pixel, and its times with clocks that this file controls;
// checked() sees that the cheapest plan comes first. Nothing here depends on real time.
#include "scene.hpp"

#include <lightbin/advise.hpp>

#include <algorithm>
#include <chrono>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace lightbin;

namespace {

constexpr float unbounded = std::numeric_limits<float>::infinity();

/// Returns the window depths of a picture: ground below the eye up to the horizon, blocks on it, and sky.
std::vector<float> ground_depth(ImageSize size) {
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
        : min(view.tile_count()), max(min),
          reduced(*reduce_depth(view, {.depth = depth, .skip_background = true}, {min, max})) {}
    std::vector<float> min, max;
    ZBounds reduced;
};

/// The scene of most cases here: a view of ground, and lights on it.
struct Street {
    ImageSize size = {640, 360};
    View view = test::view(size, 8);
    std::vector<float> depth = ground_depth(size);
    Bounds bounds = Bounds(view, depth);
    std::vector<glm::vec4> lights = test::random_lights(200, 5);
};

/// A clock that moves only during builds: the n-th build takes build_ns(n).
struct WoundClock {
    using duration = std::chrono::nanoseconds;
    using time_point = std::chrono::time_point<WoundClock>;
    static inline std::int64_t (*build_ns)(std::size_t build);
    static inline std::size_t calls;
    static inline time_point time;

    static time_point now() {
        if (calls++ % 2 == 1) time += duration(build_ns(calls / 2 - 1));
        return time;
    }
};

constexpr std::int64_t none_takes_time(std::size_t) {
    return 0;
}
constexpr std::int64_t each_100(std::size_t) {
    return 100;
}

Advice checked(const Result<Advice>& advice, const AdviceCosts& costs) {
    REQUIRE(advice);
    double before = 0;
    for (const AdvicePlan& plan : advice->plans()) {
        const bool bounded = plan.depth_test && plan.slicing == Slicing::none;
        CHECK(plan.build_ns >= (bounded ? costs.z_bounds_ns : 0));
        CHECK(plan.build_ns < 1e12);
        CHECK(plan.total_ns ==
              plan.build_ns + plan.upload_ns +
                  (plan.evaluations + plan.words * costs.word_evaluations) * costs.evaluation_ns);
        if (!plan.masks) CHECK(plan.words == 0);
        CHECK(plan.total_ns >= before);
        before = plan.total_ns;
        if (!plan.tiled) CHECK(plan.build_ns == 0);
    }
    CHECK(&advice->best() == &advice->plans()[0]);
    return *advice;
}

Advice advised(const View& view, const auto& lights, const AdviceCosts& costs = {}, const ZBounds& bounds = {}) {
    return checked(advise(view, lights, costs, bounds), costs);
}

Advice advised_on(std::int64_t (*build_ns)(std::size_t build), const View& view, const auto& lights,
                  const AdviceCosts& costs = {}, const ZBounds& bounds = {}) {
    WoundClock::build_ns = build_ns;
    WoundClock::calls = 0;
    const Advice advice = checked(advise<WoundClock>(view, lights, costs, bounds), costs);
    CHECK(WoundClock::calls % 2 == 0);
    const std::size_t builds = WoundClock::calls / 2, grids = advice.plans().size() - 1;
    CHECK(builds >= 3 * grids);  // the first finds no memory, the second may be disturbed
    CHECK(builds <= 9 * grids);
    return advice;
}

Advice advised_on(std::int64_t (*build_ns)(std::size_t build), const Street& street, const AdviceCosts& costs) {
    return advised_on(build_ns, street.view, street.lights, costs, street.bounds.reduced);
}

/// Returns the sum of lights_at(x, y) of each pixel.
double evaluations(ImageSize size, const auto& lights_at) {
    std::size_t sum = 0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            sum += lights_at(x, y);
    return static_cast<double>(sum);
}

/// Returns the view depths of ground_depth(); infinity where nothing is drawn.
std::vector<float> view_depths(const View& view, ImageSize size) {
    std::vector<float> depths;
    for (const float depth : ground_depth(size))
        depths.push_back(depth < 1 ? view.view_depths(double{depth}, double{depth}).min : unbounded);
    return depths;
}

const Slices a_dozen = *Slices::exponential(12, 2, 60), hundred = *Slices::linear(100, 0, 60);

Advice advised_in_slices(const View& view, const auto& lights, const DepthSamples& samples,
                         const AdviceCosts& costs = {}) {
    return checked(advise_slices(view, lights, {.clusters = a_dozen, .z_bins = hundred}, samples, costs),
                   costs);
}

/// Returns the advice for the street in slices, by a clock on which each build takes 100 ns.
Advice advised_in_slices_of(const Street& street, const AdviceCosts& costs) {
    const std::vector<float> depths = view_depths(street.view, street.size);
    WoundClock::build_ns = each_100;
    WoundClock::calls = 0;
    return checked(advise_slices<WoundClock>(street.view, street.lights,
                                             {.clusters = a_dozen, .z_bins = hundred},
                                             {.depths = depths, .size = street.size}, costs),
                   costs);
}

/// Calls visit.operator()<options>() with the options of a plan of advise_slices().
void with_options_of(const AdvicePlan& plan, const auto& visit) {
    if (plan.slicing == Slicing::none) return visit.template operator()<Options{}>();
    if (plan.slicing == Slicing::z_bins) return visit.template operator()<Options{.slicing = Slicing::z_bins}>();
    if (!plan.depth_test) return visit.template operator()<Options{.slicing = Slicing::clusters}>();
    visit.template operator()<Options{.depth_test = true, .slicing = Slicing::clusters}>();
}

/// A pixel's depth, and the lights that it evaluates with a plan's grid, found by testing each light.
template <Options options>
std::size_t lights_at(const LightGrid<std::uint32_t>& grid, const Slices& slices, int tile_x, int tile_y,
                      float depth) {
    int slice = 0;
    while (slice + 1 < slices.count() && depth >= slices.boundaries()[static_cast<std::size_t>(slice)])
        ++slice;
    std::size_t count = 0;
    for (const std::uint32_t id :
         grid.lights_in(tile_x, tile_y, options.slicing == Slicing::clusters ? slice : 0)) {
        if constexpr (options.slicing == Slicing::z_bins) {
            const BinRange bin = grid.ranks().bins[static_cast<std::size_t>(slice)];
            if (id < bin.least || id > bin.greatest) continue;
        }
        ++count;
    }
    return count;
}

}  // namespace

TEST_CASE("in slices, entries and evaluations are those of the plans' grids at the samples' depths") {
    const View view = test::view({311, 197}, 16);
    const auto lights = test::random_lights(150, 7);
    const std::vector<float> depths = view_depths(view, {311, 197});
    // Counts all pixels, and every third row and column: the samples are in the middle of these blocks.
    for (const int step : {1, 3}) {
        const ImageSize size = {311 / step, 197 / step};
        const View of_samples = test::view({size.width * step, size.height * step}, 16);
        std::vector<float> samples;
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                samples.push_back(
                    depths[static_cast<std::size_t>((y * step + step / 2) * 311 + x * step + step / 2)]);
        const Advice advice =
            advised_in_slices(of_samples, lights, {.depths = samples, .size = size}, {.z_bounds_ns = 0});
        CHECK(advice.plans().size() == 5 * 6 + 1);
        for (const AdvicePlan& plan : advice.plans()) {
            CAPTURE(plan.tile_size);
            CAPTURE(static_cast<int>(plan.slicing));
            const auto sampled = [&](auto lights_of) {
                return step * step * evaluations(size, [&](int x, int y) {
                           const float depth = samples[static_cast<std::size_t>(y * size.width + x)];
                           return depth < unbounded
                                      ? lights_of(x * step + step / 2, y * step + step / 2, depth)
                                      : 0;
                       });
            };
            if (!plan.tiled) {
                CHECK(plan.evaluations == sampled([](int, int, float) { return std::size_t{150}; }));
                continue;
            }
            with_options_of(plan, [&]<Options options> {
                const Slices& slices = options.slicing == Slicing::clusters ? a_dozen : hundred;
                Binner<options> binner;
                const auto grid = binner.bin(*of_samples.with_tile_size(plan.tile_size), lights,
                                             inputs_for<options>({}, slices));
                REQUIRE(grid);
                if (plan.masks) {
                    MaskBinner mask_binner;
                    const View tiled = *of_samples.with_tile_size(plan.tile_size);
                    const bool binned = plan.slicing == Slicing::z_bins;
                    const LightMasks masks =
                        *(binned ? mask_binner.bin(tiled, lights, hundred) : mask_binner.bin(tiled, lights));
                    CHECK(plan.entries == masks.words().size());
                    CHECK(plan.words == sampled([&](int, int, float depth) {
                              if (!binned) return std::size_t{masks.mask_words()};
                              const BinRange bin =
                                  masks.bins()[static_cast<std::size_t>(hundred.slice_at(depth))];
                              std::set<std::size_t> words = {bin.least / 32};
                              for (std::size_t rank = bin.least; rank <= bin.greatest; ++rank)
                                  words.insert(rank / 32);
                              return words.size();
                          }));
                } else {
                    CHECK(plan.entries == grid->ids().size());
                }
                CHECK(plan.evaluations == sampled([&](int x, int y, float depth) {
                          return lights_at<options>(*grid, slices, x / plan.tile_size, y / plan.tile_size,
                                                    depth);
                      }));
            });
        }
    }
}

TEST_CASE("entries and evaluations are those of the plans' grids, of as many sides of Z bounds as there are") {
    const View view = test::view({611, 397}, 8);
    const std::vector<float> depth = ground_depth({611, 397});
    const Bounds bounds(view, depth);
    const auto lights = test::random_lights(150, 7);
    const auto tile_of = [](const View& of, int x, int y) {
        return static_cast<std::size_t>(y / of.tile_size() * of.tiles_x() + x / of.tile_size());
    };
    for (const int sides : {0, 1, 2, 3}) {
        const auto sides_of = [&](const Bounds& all) {
            ZBounds given;
            if ((sides & 1) != 0) given.min = all.min;
            if ((sides & 2) != 0) given.max = all.max;
            return given;
        };
        const Advice advice = advised(view, lights, {}, sides_of(bounds));
        // Expects plans for tiles of 8, 16, 32, 64 and 611 pixels: masks, lists, lists with a depth test.
        CHECK(std::ranges::count(advice.plans(), true, &AdvicePlan::depth_test) == (sides > 0 ? 5 : 0));
        CHECK(std::ranges::count(advice.plans(), false, &AdvicePlan::depth_test) == 5 + 5 + 1);
        for (const AdvicePlan& plan : advice.plans()) {
            CAPTURE(plan.tile_size);
            CAPTURE(plan.depth_test);
            const View own = *view.with_tile_size(plan.tiled ? plan.tile_size : 611);
            const Bounds of_own_tiles(own, depth);
            test::Lists lists = {std::vector<std::uint32_t>(150)};
            if (plan.tiled)
                lists = plan.depth_test ? test::lists<Options{.depth_test = true}>(own, lights, sides_of(of_own_tiles))
                                        : test::lists(own, lights);
            if (!plan.masks) CHECK(plan.entries == (plan.tiled ? test::entries(lists) : 0));
            CHECK(plan.evaluations == evaluations({611, 397}, [&](int x, int y) {
                      const std::size_t fine = tile_of(view, x, y);
                      const bool nothing = sides == 3 && bounds.min[fine] > bounds.max[fine];
                      return nothing ? 0 : lists[tile_of(own, x, y)].size();
                  }));
        }
    }
}

TEST_CASE("small tiles' endless sides and NaNs merge to what hides nothing that is drawn") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const View view = test::view({316, 236}, 8);
    std::mt19937 random(3);
    const float values[] = {nan, -unbounded, unbounded, 0, 1, 2, 3, 4, 5, 6, 7, 8};
    for (int round = 0; round < 64; ++round) {
        std::vector<float> sides[2];
        for (std::vector<float>& side : sides)
            for (std::size_t tile = 0; tile < view.tile_count(); ++tile)
                side.push_back(values[random() % std::size(values)]);
        const auto given = [&](int side) {
            return round >> side & 1 ? std::span<const float>(sides[side]) : std::span<const float>();
        };
        const ZBounds bounds = {.min = given(0), .max = given(1)};
        const auto drawn = [](const ZBounds& of, std::size_t tile, float z) {
            return !(!of.min.empty() && z < of.min[tile]) && !(!of.max.empty() && z > of.max[tile]);
        };
        const detail::WeighedGrid grid(view, bounds, 24);
        CHECK(grid.bounds.min.empty() == bounds.min.empty());
        CHECK(grid.bounds.max.empty() == bounds.max.empty());
        for (std::size_t tile = 0; tile < view.tile_count(); ++tile) {
            const std::size_t width = static_cast<std::size_t>(view.tiles_x()),
                              at = tile / width / 3 * static_cast<std::size_t>(grid.view.tiles_x()) +
                                   tile % width / 3;
            const bool empty =
                !bounds.min.empty() && !bounds.max.empty() && bounds.min[tile] > bounds.max[tile];
            for (float z = -1; z <= 9; z += 0.25f)
                if (!empty && drawn(bounds, tile, z)) REQUIRE(drawn(grid.bounds, at, z));
        }
    }
}

TEST_CASE("builds that are disturbed change nothing") {
    const Street street;
    // The first builds allocate memory; later, one in eight takes a hundred times as long.
    const auto disturbed = [](std::size_t build) {
        std::mt19937 random(static_cast<std::uint32_t>(build));
        return std::int64_t{build < 5 || random() % 8 == 0 ? 100'000'000 : 1'000'000};
    };
    const auto steady = [](std::size_t) { return std::int64_t{1'000'000}; };
    for (const double cost : {0.001, 0.01, 0.1, 1.0, 10.0}) {
        const AdvicePlan quiet = advised_on(steady, street.view, street.lights, {.evaluation_ns = cost}).best(),
                   noisy = advised_on(disturbed, street.view, street.lights, {.evaluation_ns = cost}).best();
        CHECK(noisy.tiled == quiet.tiled);
        CHECK(noisy.tile_size == quiet.tile_size);
        CHECK(noisy.total_ns == quiet.total_ns);
    }
}

TEST_CASE("without Z bounds the fragments of all layers count, and a byte of the lists costs what is said") {
    const Street street;
    const AdviceCosts plain = {.evaluation_ns = 1, .z_bounds_ns = 3},
                dear = {.evaluation_ns = 1, .z_bounds_ns = 3, .upload_byte_ns = 16, .overdraw = 2.5};
    const auto compare = [&](const Advice& without, const Advice& with, auto bytes_of) {
        REQUIRE(with.plans().size() == without.plans().size());
        for (const AdvicePlan& plan : without.plans()) {
            const auto same = std::ranges::find_if(
                with.plans(), [&](const AdvicePlan& other) { return to_string(other) == to_string(plan); });
            REQUIRE(same != with.plans().end());
            const bool bounded = plan.depth_test && plan.slicing == Slicing::none;
            CHECK(plan.has_z_bounds() == bounded);
            CHECK(same->evaluations == plan.evaluations * (bounded ? 1 : 2.5));
            CHECK(same->words == plan.words * 2.5);
            CHECK(plan.build_ns == (plan.tiled ? 100 : 0) + (bounded ? 3 : 0));
            CHECK(same->build_ns == plan.build_ns);
            CHECK(plan.upload_ns == 0);
            CHECK(same->upload_ns == 16 * static_cast<double>(bytes_of(plan)));
        }
    };
    const auto tiles = [&](const AdvicePlan& plan) {
        return street.view.with_tile_size(plan.tile_size)->tile_count();
    };
    compare(advised_on(each_100, street, plain), advised_on(each_100, street, dear), [&](const AdvicePlan& plan) {
        if (plan.masks) return 4 * std::size_t{plan.entries};
        return plan.tiled ? 8 * tiles(plan) + 4 * std::size_t{plan.entries} : 0;
    });
    const std::size_t in_view = [&] {
        Binner<Options{.slicing = Slicing::z_bins}> binner;
        return binner.bin(street.view, street.lights, {.slices = hundred})->ranks().order.size();
    }();
    const Advice without = advised_in_slices_of(street, plain), with = advised_in_slices_of(street, dear);
    compare(without, with, [&](const AdvicePlan& plan) -> std::size_t {
        if (!plan.tiled) return 0;
        if (plan.masks) return 4 * std::size_t{plan.entries};
        const std::size_t slices = plan.slicing == Slicing::clusters ? 12 : 1,
                          ranks = plan.slicing == Slicing::z_bins ? 8 * 100 + 4 * in_view : 0;
        return 8 * tiles(plan) * slices + 4 * std::size_t{plan.entries} + ranks;
    });
}

namespace {

/// Returns which techniques a plan uses, in the order of the verdicts, read from the plan's text.
std::vector<bool> techniques_of(const AdvicePlan& plan) {
    const std::string words = "," + to_string(plan) + ",";
    const auto says = [&](const char* word) { return words.find(word) != words.npos; };
    const bool tested = says(" depth test,"), sliced = says(" clusters,");
    return {says(" px,"), says(" masks,"), tested && !sliced, tested, sliced, says(" z_bins,")};
}

/// Checks that each verdict on a technique follows from the plans' costs, and that the text has a line for each.
/// tests/gl/advise.sh tests the text itself.
void check_verdicts(const Advice& advice) {
    for (const AdvicePlan& plan : advice.plans()) {
        std::string lines;
        const std::vector<AdviceVerdict> verdicts = advice.verdicts(plan);
        REQUIRE(verdicts.size() == 6);
        for (std::size_t i = 0; i < verdicts.size(); ++i) {
            const auto& [part, keep, other, instead, saved_ns] = verdicts[i];
            double least = HUGE_VAL;
            for (const AdvicePlan& another : advice.plans())
                if (techniques_of(another)[i] != keep) least = std::min(least, another.total_ns);
            const bool weighed = least < HUGE_VAL;
            CAPTURE(to_string(plan));
            CHECK(keep == techniques_of(plan)[i]);
            CHECK(instead == (weighed ? to_string(other) : ""));
            if (weighed) CHECK(techniques_of(other)[i] != keep);
            if (weighed) CHECK(other.total_ns == least);
            if (weighed) CHECK(saved_ns == least - plan.total_ns);
            const std::string line = to_string(verdicts[i]);
            CHECK(line.find(keep ? "keep: " : "leave out: ") == 13);
            CHECK(line.ends_with(weighed ? " instead: " + instead + "\n" : "weighed\n"));
            CHECK((line.find(" only ") != line.npos) == (weighed && saved_ns < 0));
            lines += line;
        }
        if (&plan != &advice.best()) continue;
        const std::string text = to_string(advice);
        CHECK(text.substr(0, text.find('\n')).find(to_string(plan)) != text.npos);
        CHECK(text.substr(text.find('\n') + 1) == lines);
    }
}

}  // namespace

TEST_CASE("a verdict on each technique tells the cheapest plan that differs in it, and the difference") {
    const Street street;
    check_verdicts(advised(street.view, street.lights));
    check_verdicts(advised_on(each_100, street, {.evaluation_ns = 1}));
    check_verdicts(advised_in_slices_of(street, {.evaluation_ns = 1}));
    check_verdicts(advised(street.view, std::vector<Sphere>{}));
    std::mt19937 random(4);
    for (int round = 0; round < 100; ++round) {
        std::vector<AdvicePlan> plans;
        for (int i = 1 + round % 8; i > 0; --i) {
            AdvicePlan plan = {.tiled = random() % 8 != 0, .depth_test = random() % 2 != 0, .tile_size = 8};
            plan.slicing = static_cast<Slicing>(random() % 3);
            plan.masks = random() % 2 != 0;
            plan.total_ns = static_cast<double>(random() % 3'000'000);
            plans.push_back(plan);
        }
        check_verdicts(Advice(plans));
    }
}

TEST_CASE("any input") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Sphere> bad = {{nan, 0, 0, 1},          {0, 0, -9, -1},   {0, 0, -9, unbounded},
                                     {0, 0, -9, 0},           {0, 0, 0, 1e30f}, {1e30f, 0, -1e38f, 1},
                                     {0, nan, unbounded, nan}};
    const std::vector<float> nothing(100000, nan), ones(100000, 1.0f), zeros(100000, 0.0f),
        depths = {nan, unbounded, -unbounded, -5, 0, 3e38f};
    for (const ImageSize size : {ImageSize{0, 0}, {0, 50}, {1, 1}, {640, 1}, {300, 200}, {32768, 2}})
        for (const int tile : {1, 8, 100, 40000, std::numeric_limits<int>::max()}) {
            const View view = test::view(size, tile);
            advised(view, bad);
            advised(view, std::vector<Sphere>{});
            for (const ImageSize samples : {ImageSize{0, 0}, {-1, -1}, {3, 2}, {1, 1}})
                advised_in_slices(view, bad, {.depths = depths, .size = samples});
            advised(view, bad, {}, {.min = nothing, .max = nothing});
            advised(view, bad, {}, {.min = nothing});
            const Advice empty = advised(view, bad, {}, {.min = ones, .max = zeros});
            for (const AdvicePlan& plan : empty.plans())
                CHECK(plan.evaluations == 0);
        }

    const View view = test::view({1000, 700}, 32);
    const std::vector<float> few(view.tile_count() - 1);
    CHECK(advise(view, bad, {}, {.max = few}).error().code == ErrorCode::z_bounds_too_small);
    glm::mat4 matrix = glm::perspectiveRH_NO(1.0471976f, 1.5f, 0.1f, 1000.0f);
    CHECK(advise(*View::from_projection(matrix, {300, 200}, {.columns = 3, .rows = 2}), bad).error().code ==
          ErrorCode::tile_size_out_of_range);
    // Turned, the image has the same tiles.
    const View upright = *View::from_projection(matrix, {300, 200}, {.tile_size = 9});
    for (int column = 0; column < 4; ++column)
        std::swap(matrix[column].x, matrix[column].y);
    const View turned = *View::from_projection(matrix, {200, 300}, {.tile_size = 9});
    const auto lights = test::random_lights(100, 5);
    std::vector<float> max;
    for (std::size_t tile = 0; tile < upright.tile_count(); ++tile)
        max.push_back(static_cast<float>(tile % 50));
    const auto evaluations = [](const Advice& advice) {
        std::multiset<double> found;
        for (const AdvicePlan& plan : advice.plans())
            found.insert(plan.evaluations);
        return found;
    };
    CHECK(evaluations(advised(turned, lights, {}, {.max = max})) ==
          evaluations(advised(upright, lights, {}, {.max = max})));
    std::vector<float> of_upright(6 * 4), of_turned(4 * 6);
    for (std::size_t y = 0; y < 4; ++y)
        for (std::size_t x = 0; x < 6; ++x)
            of_upright[y * 6 + x] = of_turned[x * 4 + y] = static_cast<float>(3 + 5 * x + 7 * y);
    CHECK(evaluations(advised_in_slices(turned, lights, {.depths = of_turned, .size = {4, 6}})) ==
          evaluations(advised_in_slices(upright, lights, {.depths = of_upright, .size = {6, 4}})));
    const auto too_few = advise_slices(view, bad, {.clusters = a_dozen, .z_bins = hundred},
                                       {.depths = depths, .size = {3, 3}});
    CHECK(too_few.error().code == ErrorCode::depth_buffer_too_small);
    const float projective[4][4] = {{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 0}, {5, 0, 0, 1}};
    CHECK(advise(view, world_space(bad, projective)).error().code == ErrorCode::view_matrix_not_affine);
}

TEST_CASE("the image that plans are timed with is moved sideways") {
    for (const View& view : {test::view({1000, 700}, 16), test::view({640, 48}, 8)}) {
        const ViewPoint point = view.view_point({100, 20, 5});
        const ImagePoint moved = detail::moved_aside(view, 1.0 / 32).image_point(point);
        CHECK(moved.x == doctest::Approx(100 + view.viewport().width / 32.0));
        CHECK(moved.y == doctest::Approx(20));
        CHECK(moved.depth == doctest::Approx(5));
    }
}

TEST_CASE("lights in any form, on any instruction set, count alike") {
    const View view = test::view({1000, 700}, 16);
    const auto lights = test::random_lights(1000, 8);
    const float identity[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    // On a clock that does not move, plans are sorted by light evaluations.
    const Advice first = advised_on(none_takes_time, view, lights),
                 moved = advised_on(none_takes_time, view, world_space(lights, identity));
    CHECK(moved.best().evaluations == doctest::Approx(first.best().evaluations).epsilon(0.02));
}
