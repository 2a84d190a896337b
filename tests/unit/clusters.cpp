// Slices, and clusters (tiles cut into slices) as shaders look them up. tests/oracle/spheres.cpp tests that they miss
// no light.
#include "scene.hpp"

#include <limits>

using namespace lightbin;

namespace {
constexpr float endless = std::numeric_limits<float>::infinity();
}  // namespace

TEST_CASE("slices of exponential and linear depth end where they should") {
    const Slices law = *Slices::exponential(16, 5, 100);
    CHECK(law.count() == 16);
    CHECK(law.boundaries()[0] == 5);
    for (std::size_t i = 1; i < 15; ++i)
        CHECK(law.boundaries()[i] / law.boundaries()[i - 1] == doctest::Approx(std::pow(20.0, 1 / 15.0)));
    CHECK(100 / law.boundaries()[14] == doctest::Approx(std::pow(20.0, 1 / 15.0)));
    const Slices even = *Slices::linear(4, 2, 10);
    CHECK(std::vector<float>(even.boundaries().begin(), even.boundaries().end()) ==
          std::vector<float>{4, 6, 8});
    CHECK(Slices::linear(1, 5, 5)->boundaries().empty());
}

TEST_CASE("a depth is in the slice between its boundaries") {
    for (const Slices& slices : {*Slices::exponential(24, 0.5f, 2500), *Slices::linear(100, -20, 1000)}) {
        CHECK(slices.slice_at(-endless) == 0);
        CHECK(slices.slice_at(endless) == slices.count() - 1);
        for (int i = 1; i < slices.count(); ++i) {
            const float boundary = slices.boundaries()[static_cast<std::size_t>(i - 1)];
            CHECK(slices.slice_at(boundary) == i);
            CHECK(slices.slice_at(std::nextafter(boundary, -endless)) == i - 1);
        }
    }
}

namespace {

/// log2 in a shader at its worst, by the precision that Vulkan asks for: 2^-21 from 0.5 to 2, else 3 units in the last
/// place.
float rough_log2(float x, float sign) {
    const double exact = std::log2(static_cast<double>(x));
    const float nearest = static_cast<float>(exact);
    const double unit = static_cast<double>(std::nextafter(std::fabs(nearest), endless) - std::fabs(nearest));
    return static_cast<float>(exact + static_cast<double>(sign) * (0.5f <= x && x <= 2 ? 0x1p-21 : 3 * unit));
}

/// A shader's own formula for slices: floor(place * scale + bias), with the depth or its logarithm as place. SimGear's
/// is tested in tests/renderers/simgear.cpp.
struct OwnFormula {
    bool by_log2;
    float scale, bias;

    static OwnFormula exponential(int count, float first, float last) {
        const double begin = std::log2(static_cast<double>(first)),
                     scale = (count - 1) / (std::log2(static_cast<double>(last)) - begin);
        return {true, static_cast<float>(scale), static_cast<float>(1 - scale * begin)};
    }
    static OwnFormula linear(int count, float begin, float end) {
        return {false, static_cast<float>(count) / (end - begin), -begin * static_cast<float>(count) / (end - begin)};
    }
    int slice_at(float depth, int count, float sign) const {
        volatile float product = (by_log2 ? rough_log2(depth, sign) : depth) * scale;  // not fused
        return static_cast<int>(std::min(std::max(std::floor(product + bias), 0.0f), static_cast<float>(count - 1)));
    }
};

/// Counts spheres that end at a depth near a boundary and are not in the slice that such a shader finds there.
template <Options options> int missed(const Slices& slices, const OwnFormula& formula) {
    std::vector<Sphere> lights;
    std::vector<float> depths;
    for (const float boundary : slices.boundaries())
        for (std::int32_t step = -40; step <= 40; ++step) {
            float depth = boundary;
            for (std::int32_t i = 0; i < std::abs(step); ++i)
                depth = std::nextafter(depth, step < 0 ? 0.0f : endless);
            lights.push_back({0, 0, -2 * depth, depth});  // begins there
            lights.push_back({0, 0, -depth / 2, depth / 2});
            depths.insert(depths.end(), 2, depth);
        }
    Binner<options> binner;
    const glm::mat4 projection = glm::perspectiveRH_NO(1.0f, 1.0f, 0.05f, 1e6f);
    const View view = *View::from_projection(projection, {640, 640}, {.tile_size = 128});
    const auto grid = binner.bin(view, lights, {.slices = slices});
    REQUIRE(grid);
    const LightRanks ranks = grid->ranks();
    std::vector<std::uint32_t> rank_of(lights.size());
    for (std::uint32_t rank = 0; rank < ranks.order.size(); ++rank)
        rank_of[ranks.order[rank]] = rank;
    int count = 0;
    for (std::uint32_t i = 0; i < lights.size(); ++i)
        for (const float sign : {-1.0f, 1.0f}) {
            const int slice = formula.slice_at(depths[i], slices.count(), sign);
            if constexpr (options.slicing == Slicing::z_bins) {
                const BinRange range = ranks.bins[static_cast<std::size_t>(slice)];
                count += !(range.least <= rank_of[i] && rank_of[i] <= range.greatest);
            } else {
                const auto ids = grid->lights_in(2, 2, slice);
                count += !std::binary_search(ids.begin(), ids.end(), i);
            }
        }
    return count;
}

template <Options options> void check_margin() {
    const auto check = [](const Slices& slices, const OwnFormula& formula) {
        CHECK(missed<options>(slices.with_margin(0x1p-14f), formula) == 0);
        // Z-bins often list lights that end close by anyway, so only clusters must lose some without a margin.
        if (options.slicing == Slicing::clusters) CHECK(missed<options>(slices, formula) > 0);
    };
    check(*Slices::exponential(24, 5, 200), OwnFormula::exponential(24, 5, 200));
    check(*Slices::exponential(24, 0.1f, 1000), OwnFormula::exponential(24, 0.1f, 1000));
    check(*Slices::exponential(200, 0.5f, 90000), OwnFormula::exponential(200, 0.5f, 90000));
    check(*Slices::linear(100, 0.7f, 60), OwnFormula::linear(100, 0.7f, 60));
}

}  // namespace

TEST_CASE("with a margin, a light is where shaders look it up whose own formula rounds otherwise") {
    check_margin<Options{.slicing = Slicing::clusters}>();
    check_margin<Options{.depth_test = true, .slicing = Slicing::clusters}>();
    check_margin<Options{.slicing = Slicing::z_bins}>();
}

TEST_CASE("a margin takes a light to no slice that is further off") {
    const Slices slices = *Slices::from_boundaries(std::vector<float>{-8, 0, 8, 32}), wide = slices.with_margin(0.25f);
    CHECK(std::equal(slices.boundaries().begin(), slices.boundaries().end(), wide.boundaries().begin()));
    CHECK(wide.slice_at(7.9f) == 2);
    const Slices copy = wide;
    const auto slices_of = [&](float depth, float radius) {
        const std::vector<Sphere> light = {{0, 0, -depth, radius}};
        Binner<Options{.slicing = Slicing::clusters}> binner;
        const auto grid = binner.bin(test::view({64, 64}, 64), light, {.slices = copy});
        std::vector<int> met;
        for (int slice = 0; slice < wide.count(); ++slice)
            if (!grid->lights_in(0, 0, slice).empty()) met.push_back(slice);
        return met;
    };
    // With a margin of 1/4, depth 8 may be looked up as 6 to 10, and a depth looked up as 8 may be 8 / 1.25 to 8 /
    // 0.75.
    CHECK(slices_of(3, 2) == std::vector<int>{2});
    CHECK(slices_of(4, 2.5f) == std::vector<int>{2, 3});
    CHECK(slices_of(14, 1) == std::vector<int>{3});
    CHECK(slices_of(14, 3.5f) == std::vector<int>{2, 3});
    CHECK(slices_of(22, 4) == std::vector<int>{3, 4});
    CHECK(slices_of(-2, 3) == std::vector<int>{1, 2});
    CHECK(slices_of(-3, 4) == std::vector<int>{0, 1, 2});
    CHECK(slices_of(5, endless).size() == 5);
    // Z-bins, where shaders look lights up in the table.
    const Slices even = *Slices::linear(100, 0, 100);
    const std::vector<Sphere> light = {{0, 0, -42, 2}};
    Binner<Options{.slicing = Slicing::z_bins}> binner;
    const auto grid = binner.bin(test::view({64, 64}, 64), light, {.slices = even.with_margin(0.25f)});
    for (std::size_t bin = 0; bin < 100; ++bin) {
        const BinRange range = grid->ranks().bins[bin];
        if (bin >= 30 && bin <= 55) CHECK(range.least <= range.greatest);
        if (bin < 25 || bin > 60) CHECK(range.least > range.greatest);
    }
}

TEST_CASE("slices that are none, or do not ascend, are refused by name") {
    const auto code = [](const Result<Slices>& slices) { return slices.error().code; };
    CHECK(code(Slices::linear(0, 1, 2)) == ErrorCode::no_slices);
    CHECK(std::string(Slices::exponential(-3, 1, 2).error().message()) == "there must be at least 1 slice, not -3");
    const float nan = std::nanf("");
    for (const int count : {2, 3, 24}) {
        for (const float bad : {1.0f, 2.0f, nan, endless}) {
            CHECK(code(Slices::linear(count, 2, bad)) == ErrorCode::slice_range_empty);
            CHECK(code(Slices::exponential(count, 2, bad)) == ErrorCode::slice_range_empty);
        }
        for (const float bad : {7.0f, nan, -endless}) {
            CHECK(code(Slices::linear(count, bad, 7)) == ErrorCode::slice_range_empty);
            CHECK(code(Slices::exponential(count, bad, 7)) == ErrorCode::slice_range_empty);
        }
        for (const float bad : {0.0f, -1.0f})
            CHECK(code(Slices::exponential(count, bad, 7)) == ErrorCode::slice_range_empty);
    }
    CHECK(code(Slices::linear(1000, 1, 1.00001f)) ==
          ErrorCode::slices_do_not_ascend);  // more than there are floats
    CHECK(code(Slices::exponential(9, 1, 1.0000003f)) == ErrorCode::slices_do_not_ascend);
    CHECK(Slices::exponential(1, 5, 5)->boundaries().empty());
    CHECK(code(Slices::from_boundaries(std::vector<float>{1, nan})) == ErrorCode::slices_do_not_ascend);
    const auto twice = Slices::from_boundaries(std::vector<float>{1, 3, 3});
    CHECK(std::string(twice.error().message()).find("boundary 2, counted from 0,") != std::string::npos);
}

TEST_CASE("temporary slices live as long as the inputs that were given them") {
    constexpr Options options = {.slicing = Slicing::clusters};
    const View view = test::view({640, 480}, 64);
    const auto lights = test::random_lights(200, 32);
    const Slices slices = *Slices::linear(9, -3, 40);
    Binner<options> binner;
    const auto expected = test::to_lists(*binner.bin(view, lights, {.slices = slices}));
    const auto make = [] { return Slices::linear(9, -3, 40); };
    const Binner<options>::Inputs made = {.slices = *make()};
    const auto returned = inputs_for<options>({}, *make());
    const auto copied = returned;
    const Slices& referred = *make();
    const std::vector<Slices> others(20, *Slices::linear(9, 100, 200));  // in the memory of what is gone
    CHECK(test::to_lists(*binner.bin(view, lights, made)) == expected);
    CHECK(test::to_lists(*binner.bin(view, lights, returned)) == expected);
    CHECK(test::to_lists(*binner.bin(view, lights, copied)) == expected);
    CHECK(test::to_lists(*binner.bin(view, lights, {.slices = referred})) == expected);
    CHECK(test::to_lists(*binner.bin(view, lights, {.slices = *make()})) == expected);
    // Others are referred to.
    Slices named = slices;
    const auto given = inputs_for<options>({}, named);
    named = others[0];
    CHECK(test::to_lists(*binner.bin(view, lights, given)) ==
          test::to_lists(*binner.bin(view, lights, {.slices = others[0]})));
}

TEST_CASE("more cells than 32 bits number are refused") {
    const View view = test::view({16384, 16384}, 1);
    Binner<Options{.slicing = Slicing::clusters}> binner;
    const auto grid = binner.bin(view, std::vector<Sphere>(), {.slices = *Slices::linear(16, 0, 1)});
    REQUIRE_FALSE(grid);
    CHECK(grid.error().code == ErrorCode::too_many_cells);
    CHECK(grid.error().needed == std::uint64_t{1} << 32);
}

TEST_CASE("more pairs of a light and a slice than 32 bits number are refused") {
    constexpr float endless = std::numeric_limits<float>::infinity();
    const std::vector<Sphere> lights(50000, Sphere{0, 0, -5, endless});
    Binner<Options{.slicing = Slicing::clusters}> binner;
    const auto grid = binner.bin(test::view({64, 64}, 64), lights, {.slices = *Slices::linear(100000, 0, 200)});
    REQUIRE_FALSE(grid);
    CHECK(grid.error().code == ErrorCode::too_many_pairs);
    CHECK(std::string(grid.error().message()).find("fewer slices") != std::string::npos);
}

namespace {

/// Lists in the cells whose slice does not meet its tile's Z bounds are empty, and the others as without bounds. Counts
/// the cells with lights that are kept, and that are emptied.
template <Options options, class Lights>
void check_bounded(const View& view, const Lights& lights, const Slices& slices, const ZBounds& bounds,
                   std::size_t& kept, std::size_t& emptied) {
    Binner<options> whole, bounded;
    const auto expected = test::to_lists(*whole.bin(view, lights, {.slices = slices}));
    const std::size_t tiles = view.tile_count();
    for (const Isa isa : test::machine_tiers()) {
        Binner<options> binner(isa);
        const auto run = [](std::size_t count, const auto& body) {
            for (std::size_t i = count; i-- > 0;)
                body(i);
        };
        const auto lists = test::to_lists(*binner.bin(view, lights, {.slices = slices, .bounds = bounds}));
        CHECK(lists == test::to_lists(*bounded.bin(view, lights, {.slices = slices, .bounds = bounds}, Parallel(3, run))));
        REQUIRE(lists.size() == expected.size());
        for (std::size_t cell = 0; cell < lists.size(); ++cell) {
            const std::size_t tile = cell % tiles, slice = cell / tiles;
            const float min = bounds.min.empty() ? -endless : bounds.min[tile],
                        max = bounds.max.empty() ? endless : bounds.max[tile],
                        from = slice == 0 ? -endless : slices.boundaries()[slice - 1],
                        to = slice == slices.boundaries().size() ? endless : slices.boundaries()[slice];
            const bool drawn = !(min > max) && !(min > to) && !(max < from);
            const bool as_it_should = drawn ? lists[cell] == expected[cell] : lists[cell].empty();
            if (!as_it_should) CHECK(as_it_should);
            (drawn ? kept : emptied) += !expected[cell].empty();
        }
    }
}

}  // namespace

TEST_CASE("with Z bounds, the cells of clusters that nothing is drawn in list no light") {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> depth(1, 90);
    std::size_t kept = 0, emptied = 0;
    for (const View& view : {test::view({500, 330}, 16), test::view({1000, 700}, 64), test::cameras(24)[3]}) {
        std::vector<float> min, max;
        for (std::size_t tile = 0; tile < view.tile_count(); ++tile) {
            min.push_back(tile % 97 == 0 ? -endless : depth(random));
            max.push_back(tile % 89 == 0 ? endless : tile % 3 == 0 ? depth(random) : min.back() * 1.2f);
            if (tile % 101 == 0) (tile % 2 == 0 ? min : max).back() = std::numeric_limits<float>::quiet_NaN();
        }
        const Slices slices = *Slices::exponential(20, 2, 80);
        for (const ZBounds& bounds : {ZBounds{min, max}, ZBounds{min, {}}, ZBounds{{}, max}})
            for (const std::size_t count : {std::size_t{1}, std::size_t{40}, std::size_t{900}}) {
                const auto spheres = test::random_lights(count, 7);
                check_bounded<Options{.slicing = Slicing::clusters}>(view, spheres, slices, bounds, kept, emptied);
                check_bounded<Options{.ids = IdWidth::u16, .depth_test = true, .slicing = Slicing::clusters}>(
                    view, spheres, slices, bounds, kept, emptied);
            }
        const auto spheres = test::random_lights(300, 9);
        std::vector<Spot> spots;
        for (const glm::vec4& sphere : spheres)
            spots.push_back({sphere.x, sphere.y, sphere.z, sphere.w, 0.3f, -1, 0.2f, 0.7f});
        check_bounded<Options{.depth_test = true, .slicing = Slicing::clusters}>(view, lights(spheres, spots), slices,
                                                                                 {min, max}, kept, emptied);
    }
    CHECK(kept > 0);
    CHECK(emptied > 0);
    Binner<Options{.slicing = Slicing::clusters}> binner;
    const std::vector<float> few(3);
    const auto grid = binner.bin(test::view({100, 100}, 10), test::random_lights(9, 1),
                                 {.slices = *Slices::linear(4, 0, 9), .bounds = {few, few}});
    REQUIRE(!grid);
    CHECK(grid.error().code == ErrorCode::z_bounds_too_small);
}
