// Lights of several kinds in one call: each list must have the entries of the kinds' own grids, one kind after another.
#include "scene.hpp"

#include <glm/ext/matrix_transform.hpp>

using namespace lightbin;

namespace {

const Parallel in_three_parts(3, test::backwards);

template <Options options, class LightRange>
test::Lists joined_lists(Isa isa, const View& view, const LightRange& all, LightCounts* counts = nullptr) {
    return test::id_lists<options>(view, all, in_three_parts, counts, isa);
}

/// Appends lists of another kind; its ids continue from `first`.
void append(test::Lists& to, const test::Lists& from, std::size_t first) {
    REQUIRE(to.size() == from.size());
    for (std::size_t cell = 0; cell < to.size(); ++cell)
        for (const auto id : from[cell])
            to[cell].push_back(id + static_cast<std::uint32_t>(first));
}

template <Options options> void check_joined(Isa isa, const View& view, const test::Kinds& kinds) {
    LightCounts counts, of_spheres, of_spots, of_boxes;
    test::Lists expected = joined_lists<options>(isa, view, kinds.spheres, &of_spheres);
    append(expected, joined_lists<options>(isa, view, kinds.spots, &of_spots), kinds.spheres.size());
    append(expected, joined_lists<options>(isa, view, kinds.boxes, &of_boxes), kinds.spheres.size() + kinds.spots.size());
    CHECK(joined_lists<options>(isa, view, lights(kinds.spheres, kinds.spots, kinds.boxes), &counts) == expected);
    CHECK(counts.rejected == of_spheres.rejected + of_spots.rejected + of_boxes.rejected);
    CHECK(counts.culled == of_spheres.culled + of_spots.culled + of_boxes.culled);
    CHECK(counts.first_spot == kinds.spheres.size());
    CHECK(counts.first_box == kinds.spheres.size() + kinds.spots.size());

    expected = joined_lists<options>(isa, view, kinds.spheres);
    append(expected, joined_lists<options>(isa, view, kinds.boxes), kinds.spheres.size());
    CHECK(joined_lists<options>(isa, view, lights(kinds.spheres, kinds.boxes)) == expected);
    expected = joined_lists<options>(isa, view, kinds.spots);
    append(expected, joined_lists<options>(isa, view, kinds.boxes), kinds.spots.size());
    CHECK(joined_lists<options>(isa, view, lights(kinds.spots, kinds.boxes)) == expected);
}

TEST_CASE("joined arrays give the lists of each alone, one after another") {
    const View view = test::view({900, 500}, 16);
    for (const test::Kinds& kinds :
         {test::random_kinds(500, 300, 200, 1), test::random_kinds(1, 0, 70, 2), test::random_kinds(0, 65, 0, 3)})
        for (const Isa isa : test::machine_tiers()) {
            check_joined<Options{}>(isa, view, kinds);
            check_joined<Options{.ids = IdWidth::u16, .depth_test = true}>(isa, view, kinds);
            check_joined<Options{.slicing = Slicing::clusters}>(isa, view, kinds);
            check_joined<Options{.depth_test = true, .slicing = Slicing::clusters}>(isa, view, kinds);
            check_joined<Options{.depth_test = true, .slicing = Slicing::z_bins}>(isa, view, kinds);
        }
}

TEST_CASE("joined arrays may be in spaces of their own, and of the caller's types") {
    const View view = test::view({640, 360}, 32);
    const test::Kinds kinds = test::random_kinds(200, 150, 100, 7);
    const glm::mat4 matrix = glm::rotate(glm::translate(glm::mat4(1.0f), {3.0f, -2.0f, 4.0f}), 0.5f, {1.0f, 2.0f, 3.0f});
    constexpr Options tested = {.depth_test = true};
    const auto spots = world_space(kinds.spots, matrix);
    test::Lists expected = joined_lists<tested>(compiled_isa, view, kinds.spheres);
    append(expected, joined_lists<tested>(compiled_isa, view, spots), kinds.spheres.size());
    append(expected, joined_lists<tested>(compiled_isa, view, kinds.boxes), kinds.spheres.size() + kinds.spots.size());
    CHECK(joined_lists<tested>(compiled_isa, view, lights(std::span(kinds.spheres), spots, view_space(kinds.boxes))) == expected);
    // The array that a temporary span in view_space() refers to outlives the span.
    CHECK(joined_lists<tested>(compiled_isa, view, lights(view_space(std::span(kinds.spheres)), spots, kinds.boxes)) == expected);
}

TEST_CASE("too many lights in all arrays together are refused") {
    const View view = test::view({64, 64}, 16);
    const std::vector<Sphere> spheres(0x9000, {0, 0, -5, 1});
    const std::vector<Spot> spots(0x9000, Spot::whole({0, 0, -5, 1}));
    Binner<Options{.ids = IdWidth::u16}> binner;
    const auto grid = binner.bin(view, lights(spheres, spots));
    REQUIRE(!grid);
    CHECK(grid.error().code == ErrorCode::too_many_lights);
    CHECK(grid.error().needed == 0x12000);
}

}  // namespace
