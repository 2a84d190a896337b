// Z-bins (depth intervals with a range of lights): lists against those without, every light tried in every bin.
#include "scene.hpp"

#include <limits>

using namespace lightbin;

namespace {

/// Returns whether a light's closed depth interval meets a slice's, computed exactly in doubles.
bool meets(const glm::vec4& light, const Slices& slices, int slice) {
    const auto at = [&](int i) { return double{slices.boundaries()[static_cast<std::size_t>(i)]}; };
    const double z = -double{light.z}, r = double{light.w};
    return (slice == 0 || z + r >= at(slice - 1)) && (slice + 1 == slices.count() || z - r <= at(slice));
}

template <class Id>
void check_bins(const LightGrid<Id>& grid, const std::vector<glm::vec4>& lights, const Slices& slices) {
    const auto order = grid.ranks().order;
    const auto bins = grid.ranks().bins;
    REQUIRE(bins.size() == static_cast<std::size_t>(slices.count()));
    const LightCounts& counts = grid.light_counts();
    REQUIRE(order.size() == counts.lights - counts.rejected - counts.culled);

    // A bin's range has the lights that meet it. It may begin or end with lights of a neighbouring bin, but no others.
    const auto range = [&](int first, int last) {
        BinRange met = {1, 0};
        for (std::uint32_t rank = 0; rank < order.size(); ++rank)
            for (int slice = std::max(first, 0); slice <= std::min(last, slices.count() - 1); ++slice)
                if (meets(lights[order[rank]], slices, slice))
                    met = met.least > met.greatest ? BinRange{rank, rank} : BinRange{met.least, rank};
        return met;
    };
    const auto within = [](BinRange a, BinRange b) {
        return a.least > a.greatest || (b.least <= a.least && a.greatest <= b.greatest);
    };
    int wrong = 0, wide = 0;
    for (int slice = 0; slice < slices.count(); ++slice) {
        const BinRange bin = bins[static_cast<std::size_t>(slice)], truth = range(slice, slice);
        wrong += !within(truth, bin) || !within(bin, range(slice - 1, slice + 1));
        wide += bin.least != truth.least || bin.greatest != truth.greatest;
    }
    CHECK(wrong == 0);
    CHECK(wide <= (slices.count() + 1) / 2);
    int before = 0;
    for (const std::uint32_t light : order) {
        int begin = 0;
        while (!meets(lights[light], slices, begin))
            ++begin;
        CHECK(begin >= before - 1);
        before = begin;
    }
}

/// Returns lights whose depths and radii have few bits, so that their ends are exact and often at boundaries.
std::vector<glm::vec4> exact_lights() {
    auto lights = test::random_lights(700, 41);
    for (glm::vec4& light : lights)
        light = glm::vec4(light.x, light.y, std::round(8 * light.z) / 8, std::round(8 * light.w) / 8);
    lights[3].w = std::numeric_limits<float>::quiet_NaN();
    lights[5].w = 1000;
    return lights;
}

template <Options options> void check_law(const Slices& slices) {
    const auto lights = exact_lights();
    std::vector<float> min, max;
    const View view = test::view({640, 480}, 32);
    Binner<options> binner;
    const auto grid = binner.bin(view, lights, inputs_for<options>(test::some_bounds(view, min, max), slices));
    REQUIRE(grid);
    check_bins(*grid, lights, slices);
}

template <Options options> void check_lists() {
    constexpr Options unranked = {.ids = options.ids, .depth_test = options.depth_test};
    const View view = test::view({640, 480}, 32);
    CHECK((test::id_lists<options>(view, exact_lights()) == test::id_lists<unranked>(view, exact_lights())));
    check_law<options>(*Slices::linear(200, 0, 50));
    check_law<options>(*Slices::exponential(64, 0.5f, 40));
    check_law<options>(*Slices::linear(1, 0, 1));
    check_law<options>(*Slices::from_boundaries(std::vector<float>{-1, 0, 12, 12.125f, 1e30f}));
}

}  // namespace

TEST_CASE("z-bins have the least and greatest rank of the lights in them, and the lists are the same lights") {
    check_lists<Options{.slicing = Slicing::z_bins}>();
    check_lists<Options{.ids = IdWidth::u16, .slicing = Slicing::z_bins}>();
    check_lists<Options{.depth_test = true, .slicing = Slicing::z_bins}>();
}

TEST_CASE("the part of a list that lies in a bin") {
    const std::vector<std::uint16_t> list = {0, 3, 4, 9};
    const auto part = [&](std::uint32_t least, std::uint32_t greatest) {
        const auto ids = lights_of_bin(std::span<const std::uint16_t>(list), {least, greatest});
        return std::vector<std::uint16_t>(ids.begin(), ids.end());
    };
    CHECK(part(0, 9) == list);
    CHECK(part(1, 4) == std::vector<std::uint16_t>{3, 4});
    CHECK(part(4, 70000) == std::vector<std::uint16_t>{4, 9});
    CHECK(part(5, 8).empty());
    CHECK(part(1, 0).empty());
    CHECK(lights_of_bin(std::span<const std::uint16_t>(), {0, 9}).empty());
}

TEST_CASE("z-bins of no light are empty, and so they are after a scene of many") {
    const View view = test::view({64, 64}, 16);
    const Slices slices = *Slices::linear(16, 0, 100);
    Binner<Options{.slicing = Slicing::z_bins}> binner;
    for (const std::size_t count : {0u, 300u, 0u}) {
        const auto lights = test::random_lights(count, 7);
        const auto grid = binner.bin(view, lights, {.slices = slices});
        REQUIRE(grid);
        check_bins(*grid, lights, slices);
    }
}
