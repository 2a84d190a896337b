// Every instruction set that this machine has gives the same bytes as the scalar kernels.
#include "scene.hpp"

#include <cstring>

using namespace lightbin;

namespace {

struct Input {
    View view;
    std::vector<glm::vec4> lights;
    std::vector<float> min, max, gap_min, gap_max;
};

/// Cameras, screens, tile sizes and lights of every order of magnitude, with some bad ones among them.
Input random_input(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto between = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    const auto small_more_often = [&](float high) {
        return static_cast<int>(between(0, 1) * between(0, high));
    };
    const glm::mat4 projections[] = {
        glm::perspective(between(0.01f, 3.0f), between(0.3f, 3.0f), 0.1f, 1000.0f),
        glm::ortho(-between(1, 50), between(1, 50), -between(1, 50), between(1, 50), -between(0, 20),
                   between(1, 200)),
        glm::frustum(-between(0, 1), between(0.01f, 3), -between(-0.5f, 1), between(1, 3), 1.0f, 100.0f),
        glm::infinitePerspective(1.0f, 1.5f, 1e-3f),
    };
    const View view = *View::from_projection(projections[seed % 4],
                                             {1 + small_more_often(2000), 1 + small_more_often(2000)},
                                             {.tile_size = 2 + small_more_often(100)});
    const auto most = static_cast<std::size_t>(2e7) / view.tile_count();
    std::vector<glm::vec4> lights((std::min)(most, static_cast<std::size_t>(small_more_often(3000))));
    const float scale = std::exp(between(-3, 4));
    for (glm::vec4& light : lights) {
        const float z = between(-60, 100), side = std::exp(between(-2, 1)) * (std::fabs(z) + 2);
        light = {between(-1, 1) * side, between(-1, 1) * side, -z, scale * std::exp(between(-1.5f, 1.5f))};
        switch (static_cast<int>(between(0, 200))) {
        case 0:
            light.w = std::nanf("");
            break;
        case 1:
            light.w = 0;
            break;
        case 2:
            light.w = -1;
            break;
        case 3:
            light.w = HUGE_VALF;
            break;
        case 4:
            light *= 1e20f;
            break;
        case 5:
            light *= 1e-20f;
            break;
        case 6:
            light.x = std::nanf("");
            break;
        default:
            break;
        }
    }
    std::vector<float> min(view.tile_count()), max(view.tile_count());
    for (float& bound : min)
        bound = between(0, 1) < 0.01f ? std::nanf("") : between(-10, 60);
    for (float& bound : max)
        bound = between(0, 1) < 0.01f ? HUGE_VALF : between(0, 100);
    std::vector<float> gap_min(view.tile_count()), gap_max(view.tile_count());
    for (float& bound : gap_min)
        bound = between(0, 1) < 0.01f ? std::nanf("") : between(-10, 80);
    for (float& bound : gap_max)
        bound = between(0, 1) < 0.01f ? HUGE_VALF : between(0, 100);
    return {view, lights, min, max, gap_min, gap_max};
}

template <Isa isa, Index index, DepthTest depth_test> class Tier {
public:
    std::vector<std::uint32_t> bytes(const Input& input) {
        const auto grid = [&] {
            if constexpr (depth_test == DepthTest::none)
                return binner_.bin(input.view, input.lights);
            else
                return binner_.bin(input.view, input.lights,
                                   {input.min, input.max, input.gap_min, input.gap_max});
        }();
        REQUIRE(grid);
        std::vector<std::uint32_t> all = {grid->rejected()};
        for (const Tile& tile : grid->tiles())
            all.insert(all.end(), {tile.offset, tile.count});
        all.insert(all.end(), grid->indices().begin(), grid->indices().end());
        return all;
    }

private:
    Binner<Options{.index = index, .depth_test = depth_test, .isa = isa}> binner_;
};

template <Index index, DepthTest depth_test> void compare(std::uint32_t seeds, std::uint32_t first_seed) {
    Tier<Isa::scalar, index, depth_test> scalar;
    Tier<Isa::sse2, index, depth_test> sse2;
    Tier<Isa::avx2, index, depth_test> avx2;
    Tier<Isa::avx512, index, depth_test> avx512;
    for (std::uint32_t seed = first_seed; seed < first_seed + seeds; ++seed) {
        const Input input = random_input(seed);
        const auto expected = scalar.bytes(input);
        CHECK((sse2.bytes(input) == expected));
        CHECK((avx2.bytes(input) == expected));
        CHECK((avx512.bytes(input) == expected));
    }
}

}  // namespace

TEST_CASE("all tiers give the same bytes") {
    MESSAGE("widest tier on this machine: " << static_cast<int>(detail::machine_isa(Isa::avx512)));
    compare<Index::u32, DepthTest::none>(200, 0);
    compare<Index::u16, DepthTest::none>(100, 1000);
    compare<Index::u32, DepthTest::interval>(200, 2000);
    compare<Index::u16, DepthTest::interval>(100, 3000);
    compare<Index::u32, DepthTest::box>(200, 4000);
    compare<Index::u32, DepthTest::split_box>(200, 5000);
}

TEST_CASE("more lights than 16 bits count, and more tiles than 8 bits count") {
    Input input = random_input(5);
    input.lights = test::random_lights(150000, 50);
    input.view = test::view({1280, 720}, 40);
    input.min.assign(input.view.tile_count(), 5.0f);
    input.max.assign(input.view.tile_count(), 9.0f);
    input.gap_min.clear();
    input.gap_max.clear();
    for (glm::vec4& light : input.lights)
        light.w *= 0.1f;
    const auto check = [&] {
        CHECK((Tier<Isa::avx512, Index::u32, DepthTest::none>().bytes(input) ==
               Tier<Isa::scalar, Index::u32, DepthTest::none>().bytes(input)));
        CHECK((Tier<Isa::avx2, Index::u32, DepthTest::interval>().bytes(input) ==
               Tier<Isa::scalar, Index::u32, DepthTest::interval>().bytes(input)));
        CHECK((Tier<Isa::avx512, Index::u32, DepthTest::interval>().bytes(input) ==
               Tier<Isa::scalar, Index::u32, DepthTest::interval>().bytes(input)));
        CHECK((Tier<Isa::avx512, Index::u32, DepthTest::box>().bytes(input) ==
               Tier<Isa::scalar, Index::u32, DepthTest::box>().bytes(input)));
    };
    check();
    input.lights.resize(2000);
    for (const auto& [viewport, tile] : {std::pair(Extent{3000, 300}, 4), std::pair(Extent{300, 3000}, 4)}) {
        input.view = test::view(viewport, tile);
        input.min.assign(input.view.tile_count(), 5.0f);
        input.max.assign(input.view.tile_count(), 9.0f);
        check();
    }
}
