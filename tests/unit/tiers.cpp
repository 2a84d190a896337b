// Every instruction set that this machine has sees the same lights. That it gives the same bytes as the scalar kernels, on
// threads as well, is proven of random scenes with every option by tests/platforms/lists.cpp, of grids with the most tiles
// and lights by straight_on.cpp and tests/oracle.
#include "scene.hpp"

#include <cstdlib>
#include <string>

using namespace lightbin;

namespace {

/// The lights that are in view.
template <Isa isa>
std::vector<std::uint32_t> in_view(const View& view, const std::vector<glm::vec4>& lights) {
    static Binner<Options{.slicing = Slicing::z_bins, .isa = isa}> binner;
    const auto grid = binner.bin(view, lights, {.slices = *Slices::linear(1, 0, 1)});
    REQUIRE(grid);
    return {grid->ranks().order.begin(), grid->ranks().order.end()};
}

}  // namespace

// Who runs this in an emulator says in LIGHTBIN_TIERS what the emulated machine has, so that it cannot be less in silence.
TEST_CASE("this machine has the tiers that it is said to have") {
    const char* const wanted = std::getenv("LIGHTBIN_TIERS");
    MESSAGE("tiers: " << test::tier_names());
    if (wanted) CHECK(test::tier_names() == std::string(wanted));
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
        const auto expected = in_view<Isa::scalar>(view, lights);
        test::on_machine_tiers([&]<Isa isa>() { CHECK(in_view<isa>(view, lights) == expected); });
    }
}
