// Masks of columns and rows: in every tile they must give the lights of a Binner's list; with z-bins also its order and
// ranges.
#include "scene.hpp"

#include <lightbin/masks.hpp>
#include <lightbin/shader.hpp>

#include <glm/ext/matrix_transform.hpp>

#include <cmath>
#include <limits>

using namespace lightbin;

namespace {

/// Returns the positions in ids() of the lights in a tile.
std::vector<std::uint32_t> lights_in(const LightMasks& masks, int x, int y) {
    const auto column = masks.column(x), row = masks.row(y);
    std::vector<std::uint32_t> found;
    for (std::uint32_t place = 0; place < masks.ids().size(); ++place)
        if ((column[place / 32] & row[place / 32]) >> place % 32 & 1) found.push_back(place);
    return found;
}

/// Returns whether a mask has no bits beyond those of the lights in view.
bool ends(const LightMasks& masks, std::span<const std::uint32_t> mask) {
    for (std::size_t place = masks.ids().size(); place < 32 * mask.size(); ++place)
        if (mask[place / 32] >> place % 32 & 1) return false;
    return true;
}

/// Checks words() against the other members.
void check_words(const LightMasks& masks) {
    const std::span<const std::uint32_t> words = masks.words();
    const auto same = [&](std::size_t at, std::span<const std::uint32_t> part) {
        return at + part.size() <= words.size() &&
               std::equal(part.begin(), part.end(), words.begin() + std::ptrdiff_t(at));
    };
    const std::size_t each = masks.mask_words(), x_end = static_cast<std::size_t>(masks.tiles_x()),
                      y_end = static_cast<std::size_t>(masks.tiles_y()), ids_at = 1 + (x_end + 1 + y_end) * each;
    CHECK(words[0] == each);
    CHECK(32 * each >= masks.ids().size());
    CHECK(32 * each < masks.ids().size() + 64);
    REQUIRE(words.size() == ids_at + 32 * each + 2 * masks.bins().size());
    std::size_t wrong = 0;
    for (std::size_t x = 0; x < x_end; ++x)
        wrong += !same(1 + x * each, masks.column(int(x))) || !ends(masks, masks.column(int(x)));
    for (std::size_t y = 0; y < y_end; ++y)
        wrong += !same(1 + (x_end + 1 + y) * each, masks.row(int(y))) || !ends(masks, masks.row(int(y)));
    CHECK(wrong == 0);
    CHECK(same(1 + x_end * each, std::vector<std::uint32_t>(each)));
    CHECK(same(ids_at, masks.ids()));
    CHECK(same(ids_at + masks.ids().size(), std::vector<std::uint32_t>(32 * each - masks.ids().size())));
    std::vector<std::uint32_t> bins;
    for (const BinRange bin : masks.bins())
        bins.insert(bins.end(), {bin.least, bin.greatest});
    CHECK(same(ids_at + 32 * each, bins));
}

bool same(const LightCounts& a, const LightCounts& b) {
    return a.lights == b.lights && a.rejected == b.rejected && a.culled == b.culled && a.first_spot == b.first_spot &&
           a.first_box == b.first_box;
}

/// Returns whether each tile has the lights of its list. Masks with z-bins number lights as lists do.
bool same_tiles(const LightMasks& masks, const LightGrid<std::uint32_t>& grid) {
    const bool ranked = !masks.bins().empty();
    for (int y = 0; y < masks.tiles_y(); ++y)
        for (int x = 0; x < masks.tiles_x(); ++x) {
            std::vector<std::uint32_t> found = lights_in(masks, x, y);
            if (!ranked)
                for (std::uint32_t& light : found)
                    light = masks.ids()[light];
            const auto list = grid.lights_in(x, y);
            if (!std::equal(found.begin(), found.end(), list.begin(), list.end())) return false;
        }
    return true;
}

/// Compares masks with and without z-bins with the grids of Binners, on every instruction set.
template <class LightRange> void check(const View& view, const LightRange& lights, const Slices& slices) {
    Binner<> binner;
    Binner<Options{.slicing = Slicing::z_bins}> ranking;
    const auto grid = binner.bin(view, lights);
    const auto ranked = ranking.bin(view, lights, {.slices = slices});
    REQUIRE((grid && ranked));
    std::vector<std::uint32_t> words, ranked_words;
    for (const Isa isa : test::machine_tiers()) {
        MaskBinner plain(isa), with_bins(isa);
        const auto masks = plain.bin(view, lights), bins = with_bins.bin(view, lights, slices);
        REQUIRE((masks && bins));
        for (const LightMasks& of : {*masks, *bins}) {
            REQUIRE((of.tiles_x() == view.tiles_x() && of.tiles_y() == view.tiles_y()));
            CHECK(same(of.light_counts(), grid->light_counts()));
        }
        if (words.empty()) {  // the scalar tier
            check_words(*masks);
            check_words(*bins);
            CHECK(masks->bins().empty());
            CHECK((std::is_sorted(masks->ids().begin(), masks->ids().end())));
            CHECK(same_tiles(*masks, *grid));
            CHECK(same_tiles(*bins, *ranked));
            const auto order = ranked->ranks().order;
            CHECK((std::equal(order.begin(), order.end(), bins->ids().begin(), bins->ids().end())));
            CHECK((std::equal(bins->bins().begin(), bins->bins().end(), ranked->ranks().bins.begin(),
                              ranked->ranks().bins.end(), [](BinRange a, BinRange b) {
                                  return a.least == b.least && a.greatest == b.greatest;
                              })));
            words.assign(masks->words().begin(), masks->words().end());
            ranked_words.assign(bins->words().begin(), bins->words().end());
        }
        CHECK((std::equal(words.begin(), words.end(), masks->words().begin(), masks->words().end())));
        CHECK((std::equal(ranked_words.begin(), ranked_words.end(), bins->words().begin(), bins->words().end())));
    }
}

}  // namespace

TEST_CASE("masks have the lights of the lists in every tile, of every kind, camera and tile size") {
    const Slices slices = *Slices::exponential(50, 1, 90);
    const glm::mat4 turned = glm::rotate(glm::translate(glm::mat4(1), {3, -2, 4}), 0.5f, {1.0f, 2.0f, 3.0f});
    for (const int tile_size : {8, 16, 31, 64})
        for (const View& view : test::cameras(tile_size)) {
            const std::uint32_t seed = static_cast<std::uint32_t>(tile_size);
            auto spheres = test::random_lights(400, seed);
            spheres[7].w = std::numeric_limits<float>::quiet_NaN();
            spheres[8].w = -1;
            spheres[9].w = std::numeric_limits<float>::infinity();
            const test::Kinds kinds = test::random_kinds(150, 90, 70, seed);
            check(view, spheres, slices);
            check(view, world_space(spheres, turned), slices);
            check(view, kinds.spots, slices);
            check(view, kinds.boxes, slices);
            check(view, lights(kinds.spheres, world_space(kinds.spots, turned), kinds.boxes), slices);
            check(view, lights(kinds.spheres, kinds.boxes), slices);
        }
}

TEST_CASE("masks have the lights of the lists where words, and the sums of several words, end") {
    const View view = test::view({200, 120}, 16);
    const Slices slices = *Slices::linear(9, 5, 30);
    for (const std::size_t count : {0u, 1u, 31u, 32u, 33u, 64u, 100u, 160u, 224u, 255u, 256u, 257u, 500u, 2016u, 2048u,
                                    2049u}) {
        std::mt19937 random(static_cast<std::uint32_t>(count));
        std::uniform_real_distribution<float> side(-3, 3), depth(8, 40), radius(0.1f, 6);
        std::vector<Sphere> in_view(count);
        for (Sphere& light : in_view)
            light = {side(random), side(random), -depth(random), radius(random)};
        MaskBinner binner;
        REQUIRE(binner.bin(view, in_view)->ids().size() == count);
        check(view, in_view, slices);
    }
}

// tests/oracle/families.cpp tests the greatest numbers of columns and rows.
TEST_CASE("masks have the lights of the lists where there are many columns or rows") {
    const auto spheres = test::random_lights(70, 5);
    const test::Kinds kinds = test::random_kinds(20, 20, 20, 6);
    const Slices slices = *Slices::linear(20, 0, 80);
    for (const ImageSize size :
         {ImageSize{255, 254}, {256, 255}, {257, 300}, {1000, 40}, {40, 1000}, {32768, 3}, {3, 32768}}) {
        check(test::view(size, 1), std::vector<Sphere>{{0, 0, -5, HUGE_VALF}}, slices);
        check(test::view(size, 1), spheres, slices);
        check(test::view(size, 1), lights(kinds.spheres, kinds.spots, kinds.boxes), slices);
    }
}

TEST_CASE("a MaskBinner that was moved from is as new, and what it had goes on elsewhere") {
    const View view = test::view({320, 200}, 16);
    const auto lights = test::random_lights(900, 1);
    MaskBinner from;
    const auto words = [&](MaskBinner& binner) {
        const auto masks = *binner.bin(view, lights);
        return std::vector<std::uint32_t>(masks.words().begin(), masks.words().end());
    };
    const auto expected = words(from);
    MaskBinner to = std::move(from);
    CHECK(words(from) == expected);
    CHECK(words(to) == expected);
    from = std::move(to);
    CHECK(words(from) == expected);
    CHECK(words(to) == expected);
}

TEST_CASE("masks of an empty viewport are empty") {
    MaskBinner binner;
    for (const ImageSize size : {ImageSize{0, 0}, {0, 40}, {40, 0}}) {
        const auto masks = binner.bin(test::view(size, 16), test::random_lights(50, 3), *Slices::linear(4, 0, 9));
        REQUIRE(masks);
        check_words(*masks);
        CHECK(masks->ids().empty());
    }
}

TEST_CASE("what masks refuse") {
    const auto clusters = shader_snippet({.slicing = Slicing::clusters, .masks = true});
    REQUIRE(!clusters);
    CHECK(clusters.error().code == ErrorCode::no_such_slicing_shader);
    const auto views = shader_snippet({.masks = true, .views = 2});
    REQUIRE(!views);
    CHECK(views.error().code == ErrorCode::views_out_of_range);
    CHECK(views.error().available == 1);
    MaskBinner binner;
    const View view = test::view({64, 64}, 16);
    const auto few = test::random_lights(3, 1);
    const Slices slices = *Slices::linear(4, 0, 9);
    for (const auto& refused : {binner.bin(view, world_space(few, glm::mat4(NAN))),
                                binner.bin(view, world_space(few, glm::mat4(NAN)), slices)}) {
        REQUIRE(!refused);
        CHECK(refused.error().code == ErrorCode::view_matrix_not_affine);
    }
    if constexpr (sizeof(std::size_t) > 4) {
        const char byte = 0;  // a span of more lights than are there: they are refused before they are read
        const std::span<const char> array(&byte, static_cast<std::size_t>(std::uint64_t{1} << 32));
        const auto refused = binner.bin(view, view_space(array, [](char) { return Sphere{0, 0, -5, 1}; }));
        REQUIRE(!refused);
        CHECK(refused.error().code == ErrorCode::too_many_lights);
        // (32,768 columns + 1 + 32,768 rows + 32) masks of 65,537 words are more than 2^32.
        const std::vector<Sphere> many(32 * 65537, {0, 0, -5, 1});
        const auto large = binner.bin(test::view({32768, 32768}, 1), many);
        REQUIRE(!large);
        CHECK(large.error().code == ErrorCode::too_many_entries);
        CHECK(large.error().needed == 1 + std::uint64_t{32768 + 1 + 32768 + 32} * 65537);
        CHECK(large.error().available == 0xffffffff);
    }
}
