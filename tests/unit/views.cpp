// Several views in one pair of buffers. tests/shader has shaders that read such encoded grids.
#include "scene.hpp"

#include <iterator>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

using namespace lightbin;

namespace {

/// Returns the lights in the view space of an eye that is `aside` farther to the right.
std::vector<glm::vec4> seen_from(float aside, std::vector<glm::vec4> lights) {
    for (glm::vec4& light : lights)
        light.x -= aside;
    return lights;
}

/// Returns the lists of one view from a grid of several.
template <class Id> test::Lists lists_of_view(const LightGrid<Id>& grid, int view) {
    test::Lists lists;
    for (int slice = 0; slice < grid.slices(); ++slice)
        for (int y = 0; y < grid.tiles_y(); ++y)
            for (int x = 0; x < grid.tiles_x(); ++x) {
                const auto ids = grid.lights_in(x, y, slice, view);
                lists.emplace_back(ids.begin(), ids.end());
            }
    return lists;
}

/// Two buffers that hold several views, and show which part of them was written.
template <class Id> struct Buffers {
    static constexpr ListRange unset_range = {0xabcdef01, 0x23456789};
    static constexpr Id unset_id = 0xbeef;
    std::vector<ListRange> ranges = std::vector<ListRange>(20000, unset_range);
    std::vector<Id> ids = std::vector<Id>(400000, unset_id);

    bool unset_from(std::size_t range, std::size_t id) const {
        return std::all_of(ranges.begin() + static_cast<std::ptrdiff_t>(range), ranges.end(),
                           [](const ListRange r) {
                               return r.offset == unset_range.offset && r.count == unset_range.count;
                           }) &&
               std::all_of(ids.begin() + static_cast<std::ptrdiff_t>(id), ids.end(),
                           [](Id i) { return i == unset_id; });
    }
};

/// Makes the grids of three views by one Binner and copies each behind the last. The lists must be those that a
/// separate Binner makes for each view.
template <Options options> void check_shared(const View& view, const Slices& slices) {
    using Id = typename Binner<options>::Id;
    Buffers<Id> buffers;
    Binner<options> binner;
    const auto inputs = inputs_for<options>({}, slices);
    std::vector<test::Lists> expected;
    std::size_t ranges = 0, ids = 0;
    std::optional<LightGrid<Id>> all;
    for (const float aside : {-0.5f, 0.0f, 0.5f}) {
        const auto lights = seen_from(aside, test::random_lights(700, 5));
        Binner<options> own;
        expected.push_back(test::to_lists(*own.bin(view, lights, inputs)));
        const auto grid = binner.bin(view, lights, inputs);
        const auto copy = all ? grid->copy_to(buffers.ranges, buffers.ids, *all)
                              : grid->copy_to(buffers.ranges, buffers.ids);
        REQUIRE(copy);
        all = *copy;
        ranges += grid->ranges().size();
        ids += grid->ids().size();
        CHECK(copy->light_counts().culled == grid->light_counts().culled);
        CHECK(copy->ranks().order.data() == grid->ranks().order.data());
        CHECK(copy->ranges().data() == buffers.ranges.data());
        CHECK(copy->ranges().size() == ranges);
        CHECK(copy->ids().data() == buffers.ids.data());
        CHECK(copy->ids().size() == ids);
        CHECK(buffers.unset_from(ranges, ids));
        for (std::size_t i = 0; i < expected.size(); ++i)
            CHECK(lists_of_view(*all, static_cast<int>(i)) == expected[i]);
    }
    if (view.tile_count() > 1) CHECK(expected[0] != expected[2]);
    // Each range begins where the one before it ends, also from one view to the next.
    std::uint32_t offset = 0;
    for (const ListRange range : all->ranges()) {
        CHECK(range.offset == offset);
        offset += range.count;
    }
    CHECK(offset == ids);
}

template <class Result> ErrorCode code_of(const Result& result) {
    REQUIRE(!result);
    return result.error().code;
}

}  // namespace

TEST_CASE("views in one pair of buffers have the lists that each has alone") {
    const Slices slices = *Slices::exponential(7, 2, 90);
    for (const ImageSize size : {ImageSize{320, 200}, ImageSize{1, 1}, ImageSize{0, 40}}) {
        const View view = test::view(size, 16);
        check_shared<Options{}>(view, slices);
        check_shared<Options{.ids = IdWidth::u16}>(view, slices);
        check_shared<Options{.slicing = Slicing::clusters}>(view, slices);
        check_shared<Options{.ids = IdWidth::u16, .slicing = Slicing::z_bins}>(view, slices);
    }
}

TEST_CASE("views that do not fit into buffers, or not together, are an error and nothing is written") {
    const auto lights = test::random_lights(300, 9);
    const View view = test::view({320, 200}, 16);  // 20 x 13 tiles
    Binner<> binner;
    const auto grid = binner.bin(view, lights);
    const std::size_t ranges = grid->ranges().size(), ids = grid->ids().size();
    REQUIRE(ids > 100);
    Buffers<std::uint32_t> buffers;
    const auto check_too_small = [&](std::size_t views, const auto&... before) {
        const auto few_ranges =
            grid->copy_to(std::span(buffers.ranges).first(views * ranges - 1), buffers.ids, before...);
        CHECK(code_of(few_ranges) == ErrorCode::range_buffer_too_small);
        CHECK(few_ranges.error().needed == views * ranges);
        CHECK(few_ranges.error().available == views * ranges - 1);
        const auto few_ids =
            grid->copy_to(buffers.ranges, std::span(buffers.ids).first(views * ids - 1), before...);
        CHECK(code_of(few_ids) == ErrorCode::id_buffer_too_small);
        CHECK(few_ids.error().needed == views * ids);
        CHECK(few_ids.error().available == views * ids - 1);
    };
    check_too_small(1);
    CHECK(buffers.unset_from(0, 0));
    const auto first =
        grid->copy_to(std::span(buffers.ranges).first(ranges), std::span(buffers.ids).first(ids));
    REQUIRE(first);
    CHECK(buffers.unset_from(ranges, ids));
    check_too_small(2, *first);

    // A view with as many tiles, but other numbers of columns and rows; and one with as many cells in slices.
    Binner<> other;
    for (const View& unlike :
         {test::view({200, 320}, 16), test::view({320, 208}, 8), test::view({330, 200}, 16)})
        CHECK(code_of(other.bin(unlike, lights)->copy_to(buffers.ranges, buffers.ids, *first)) ==
              ErrorCode::grids_differ);
    Binner<Options{.slicing = Slicing::clusters}> clusters;
    CHECK(code_of(clusters.bin(view, lights, {.slices = *Slices::linear(2, 0, 9)})
                      ->copy_to(buffers.ranges, buffers.ids, *first)) == ErrorCode::grids_differ);

    // Earlier views with so many entries that this view's would be number 2^32. Only the numbers are read.
    if constexpr (sizeof(std::size_t) > 4) {
        const LightGrid<std::uint32_t> full(20, 13, first->ranges(),
                                            {buffers.ids.data(), 0xffffffff - ids + 1});
        const auto too_many =
            grid->copy_to(buffers.ranges, {buffers.ids.data(), std::size_t{0xffffffff} * 2}, full);
        CHECK(code_of(too_many) == ErrorCode::too_many_entries);
        CHECK(too_many.error().needed == std::uint64_t{1} << 32);
        const LightGrid<std::uint32_t> wide(20, 13, {buffers.ranges.data(), 0xffffffff - ranges + 1},
                                            first->ids());
        const auto too_wide =
            grid->copy_to({buffers.ranges.data(), std::size_t{0xffffffff} * 2}, buffers.ids, wide);
        CHECK(code_of(too_wide) == ErrorCode::too_many_cells);
    }
    CHECK(buffers.unset_from(ranges, ids));
    CHECK(grid->copy_to(std::span(buffers.ranges).first(2 * ranges), std::span(buffers.ids).first(2 * ids),
                        *first));
    CHECK(buffers.unset_from(2 * ranges, 2 * ids));
}
