// Every instruction set that this machine has gives the same bytes as the scalar kernels, on threads, and in sizes that
// tests/platforms/lists.cpp has not. That one asks the same of random scenes with every option.
#include "scene.hpp"

#include <cstdlib>
#include <string>

using namespace lightbin;

namespace {

template <Options options>
std::vector<std::uint32_t> bytes(const View& view, const std::vector<glm::vec4>& lights, const Parallel& parallel) {
    static const Slices slices = *Slices::exponential(11, 2, 80);
    const auto all_tiles = [&](float depth) { return std::vector<float>(view.tile_count(), depth); };
    const auto min = all_tiles(5), max = all_tiles(40), gap_min = all_tiles(10), gap_max = all_tiles(20);
    static Binner<options> binner;
    const auto grid = binner.bin(view, lights, inputs_for<options>({min, max, gap_min, gap_max}, slices), parallel);
    REQUIRE(grid);
    std::vector<std::uint32_t> all = {grid->light_counts().rejected};
    for (const ListRange range : grid->ranges())
        all.insert(all.end(), {range.offset, range.count});
    all.insert(all.end(), grid->ids().begin(), grid->ids().end());
    all.insert(all.end(), grid->ranks().order.begin(), grid->ranks().order.end());
    for (const BinRange range : grid->ranks().bins)
        all.insert(all.end(), {range.least, range.greatest});
    return all;
}

constexpr Options with(Options options, Isa isa) {
    options.isa = isa;
    return options;
}

/// Each instruction set, serial and shared among threads, against the serial scalar kernels.
template <Options options> void compare(const View& view, const std::vector<glm::vec4>& lights) {
    const auto expected = bytes<with(options, Isa::scalar)>(view, lights, {});
    test::on_machine_tiers([&]<Isa isa>() {
        for (const std::size_t workers : {1u, 2u, 3u, 7u})
            CHECK((bytes<with(options, isa)>(view, lights, {workers, test::on_threads, 0}) == expected));
        CHECK((bytes<with(options, isa)>(view, lights, {}) == expected));
    });
}

constexpr Options plain = {}, box = {.depth_test = DepthTest::box}, split_box = {.depth_test = DepthTest::split_box},
                  clusters = {.slicing = Slicing::clusters},
                  box_clusters = {.depth_test = DepthTest::box, .slicing = Slicing::clusters},
                  z_bins = {.footprint = Footprint::silhouette,
                            .depth_test = DepthTest::box,
                            .slicing = Slicing::z_bins};

}  // namespace

// Who runs this in an emulator says in LIGHTBIN_TIERS what the emulated machine has, so that it cannot be less in silence.
TEST_CASE("this machine has the tiers that it is said to have") {
    const char* const wanted = std::getenv("LIGHTBIN_TIERS");
    MESSAGE("tiers: " << test::tier_names());
    if (wanted) CHECK(test::tier_names() == std::string(wanted));
}

TEST_CASE("threads write their own parts only") {
    const View view = test::view({1280, 720}, 16);
    const auto lights = test::random_lights(3000, 51);
    compare<plain>(view, lights);
    compare<split_box>(view, lights);
    compare<clusters>(view, lights);
    compare<box_clusters>(view, lights);
    compare<z_bins>(view, lights);
}

TEST_CASE("lights that all but touch the sides of the view are in it on all tiers or on none") {
    std::mt19937 random(5);
    const auto between = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    for (int camera = 0; camera < 40; ++camera) {
        const float slope = std::exp(between(-2, 1)), slant = std::hypot(slope, 1.0f);
        const auto projection = glm::perspective(2 * std::atan(slope), 1.0f, 0.1f, 1000.0f);
        const View view = *View::from_projection(projection, {1000, 1000}, {.tile_size = 20});
        std::vector<glm::vec4> lights(2000);
        for (glm::vec4& light : lights) {
            const float depth = std::exp(between(0, 6)), radius = depth * std::exp(between(-6, 0)),
                        aside = depth * slope + radius * slant + depth * between(0, 0x1p-19f);
            light = {camera % 2 == 0 ? aside : 0, camera % 2 == 0 ? 0 : -aside, -depth, radius};
        }
        compare<z_bins>(view, lights);  // which numbers the lights that are in view
    }
}

TEST_CASE("more lights than 16 bits count, and more tiles than 8 bits count") {
    const auto check = [&](Extent viewport, int tile_size, std::size_t count, float scale) {
        auto lights = test::random_lights(count, 50);
        for (glm::vec4& light : lights)
            light.w *= scale;
        const View view = test::view(viewport, tile_size);
        compare<plain>(view, lights);
        compare<box>(view, lights);
        compare<box_clusters>(view, lights);
    };
    check({992, 300}, 4, 1500, 0.2f);  // the widest grid of one panel of lists, and one tile more
    check({996, 300}, 4, 1500, 0.2f);
    check({3000, 300}, 4, 1500, 0.2f);
    check({300, 3000}, 4, 1500, 0.2f);
    if (test::share_of_cases(1) > 1) return;  // an emulator takes seconds for as many lights
    check({1280, 720}, 40, 70000, 0.05f);
    check({40000 / 2, 8}, 8, 70000, 0.01f);
}
