// Bitmasks without lists, against the lists.
#include "scene.hpp"

using namespace lightbin;

namespace {

template <class Id> std::vector<std::uint32_t> bits_of(const LightGrid<Id>& grid, std::uint32_t max_lights) {
    const std::size_t each = (max_lights + 31) / 32;
    std::vector<std::uint32_t> bits(grid.ranges().size() * each);
    for (std::size_t tile = 0; tile < grid.ranges().size(); ++tile)
        for (std::uint32_t i = 0; i < grid.ranges()[tile].count; ++i) {
            const std::uint32_t id = grid.ids()[grid.ranges()[tile].offset + i];
            bits[tile * each + id / 32] |= std::uint32_t{1} << id % 32;
        }
    return bits;
}

template <Options options, class Light> void compare(std::vector<Light> test::Kinds::*kind) {
    const Slices slices = *Slices::linear(100, 0, 60);
    Binner<options> binner, other;
    for (const std::size_t count : {0u, 1u, 40u, 700u})
        for (const Extent size : {Extent{640, 480}, Extent{333, 217}, Extent{16, 900}, Extent{0, 0}}) {
            const View view = test::view(size, 16);
            const std::vector<float> min(view.tile_count(), 5), max(view.tile_count(), 30);
            const auto lights = test::random_kinds(count, count, count, 61).*kind;
            const auto inputs = inputs_for<options>({.min = min, .max = max}, slices);
            const auto grid = binner.bin(view, lights, inputs);
            REQUIRE(grid);
            const std::uint32_t max_lights = static_cast<std::uint32_t>(count) + 5;
            const auto expected = bits_of(*grid, max_lights);
            for (const std::size_t workers : {1u, 2u, 7u}) {
                // What is there before is no part of it, nor is what lies behind written.
                std::vector<std::uint32_t> bits(expected.size() + 9, 0xabababab);
                const auto made =
                    other.bin_bits(view, lights, max_lights, bits, inputs, Parallel(workers, test::on_threads));
                REQUIRE(made);
                CHECK((std::equal(expected.begin(), expected.end(), bits.begin())));
                CHECK((std::count(bits.begin() + static_cast<std::ptrdiff_t>(expected.size()), bits.end(),
                                  0xabababab) == 9));
                CHECK(made->counts.culled == grid->light_counts().culled);
                CHECK((std::equal(made->ranks.order.begin(), made->ranks.order.end(),
                                  grid->ranks().order.begin(), grid->ranks().order.end())));
                CHECK(made->ranks.bins.size() == grid->ranks().bins.size());
            }
        }
}

}  // namespace

TEST_CASE("bitmasks without lists have the lists' lights, in every tier, on any number of threads") {
    test::on_machine_tiers([]<Isa isa>() {
        compare<Options{.isa = isa}>(&test::Kinds::spheres);
        compare<Options{.depth_test = DepthTest::box, .isa = isa}>(&test::Kinds::spots);
        compare<Options{.depth_test = DepthTest::box, .isa = isa}>(&test::Kinds::boxes);
        compare<Options{.ids = IdWidth::u16, .slicing = Slicing::z_bins, .isa = isa}>(&test::Kinds::spheres);
        compare<Options{.footprint = Footprint::silhouette,
                        .depth_test = DepthTest::box,
                        .slicing = Slicing::z_bins,
                        .isa = isa}>(&test::Kinds::spheres);
    });
}

TEST_CASE("bitmasks that don't fit are refused, and not a bit is written") {
    const View view = test::view({64, 64}, 16);
    const auto lights = test::random_lights(70, 3);
    std::vector<std::uint32_t> bits(16 * 3, 7);
    Binner<> binner;
    const auto short_of = binner.bin_bits(view, lights, 97, bits);
    REQUIRE(!short_of);
    CHECK(short_of.error().code == ErrorCode::bit_buffer_too_small);
    CHECK(std::string(short_of.error().message()).find("holds 48 words of 32 bits and 64 ") != std::string::npos);
    CHECK(binner.bin_bits(view, lights, 69, bits).error().code == ErrorCode::ids_too_narrow);
    CHECK(binner.bin_bits(view, lights, 0, bits).error().code == ErrorCode::ids_too_narrow);
    CHECK(std::count(bits.begin(), bits.end(), 7u) == 48);
    CHECK(binner.bin_bits(view, lights, 70, bits));
    CHECK(binner.bin_bits(view, std::vector<glm::vec4>(), 0, {}));
}
