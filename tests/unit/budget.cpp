// Budgets against sorting all entries.
#include "scene.hpp"

#include <lightbin/budget.hpp>

#include <limits>

using namespace lightbin;

namespace {

/// Returns whether light a is kept if only one of a and b can be.
bool goes_before(const std::vector<float>& weights, std::uint32_t a, std::uint32_t b) {
    const bool a_is_none = std::isnan(weights[a]), b_is_none = std::isnan(weights[b]);
    if (a_is_none != b_is_none) return b_is_none;
    if (!a_is_none && weights[a] != weights[b]) return weights[a] > weights[b];
    return a < b;
}

/// Returns the lists that a budget should leave, by sorting all entries. With z-bins, where lists have ranks in place
/// of ids, order[rank] is the id; else `order` is empty.
test::Lists expected(const test::Lists& lists, const std::vector<std::uint32_t>& order,
                     const std::vector<float>& weights, const BudgetLimits& limits) {
    struct Entry {
        std::size_t cell;
        std::uint32_t id, light;
    };
    std::vector<Entry> entries;
    for (std::size_t cell = 0; cell < lists.size(); ++cell) {
        std::vector<Entry> list;
        for (const std::uint32_t id : lists[cell])
            list.push_back({cell, id, order.empty() ? id : order[id]});
        std::sort(list.begin(), list.end(),
                  [&](const Entry& a, const Entry& b) { return goes_before(weights, a.light, b.light); });
        list.resize(std::min<std::size_t>(list.size(), limits.per_cell));
        entries.insert(entries.end(), list.begin(), list.end());
    }
    std::sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
        return a.light != b.light ? goes_before(weights, a.light, b.light) : a.cell < b.cell;
    });
    entries.resize(std::min<std::size_t>(entries.size(), limits.per_frame));
    test::Lists kept(lists.size());
    for (const Entry& entry : entries)
        kept[entry.cell].push_back(entry.id);
    for (auto& list : kept)
        std::sort(list.begin(), list.end());
    return kept;
}

/// Checks one call: the ranges follow one another, and every entry is kept or counted as dropped.
template <class Id>
void check_limit(Budget<Id>& budget, const LightGrid<Id>& grid, const std::vector<float>& weights,
                 const BudgetLimits& limits) {
    const auto limited = budget.limit(grid, weights, limits);
    REQUIRE(limited);
    const LightGrid<Id>& kept = limited->grid;
    REQUIRE(kept.ranges().size() == grid.ranges().size());
    REQUIRE(limited->cut_in_cell.size() == grid.ranges().size());
    std::size_t offset = 0, wrong = 0, cut = 0;
    for (std::size_t cell = 0; cell < grid.ranges().size(); ++cell) {
        wrong += kept.ranges()[cell].offset != offset;
        wrong += limited->cut_in_cell[cell] != grid.ranges()[cell].count - kept.ranges()[cell].count;
        offset += kept.ranges()[cell].count;
        cut += limited->cut_in_cell[cell];
    }
    CHECK(wrong == 0);
    CHECK(kept.ids().size() == offset);
    CHECK(limited->entries_cut == cut);
    CHECK(limited->entries_cut == grid.ids().size() - offset);
    CHECK(kept.light_counts().lights == grid.light_counts().lights);
    CHECK(kept.ranks().order.data() == grid.ranks().order.data());
    CHECK(kept.ranks().bins.data() == grid.ranks().bins.data());
    const std::vector<std::uint32_t> order(grid.ranks().order.begin(), grid.ranks().order.end());
    CHECK((test::to_lists(kept) == expected(test::to_lists(grid), order, weights, limits)));
    if (limited->entries_cut == 0) CHECK(kept.ids().data() == grid.ids().data());
}

/// Checks all limits that matter: none, and those near the longest list and near the number of entries.
template <class Id> void check_limits(const LightGrid<Id>& grid, const std::vector<float>& weights) {
    Budget<Id> budget;
    const std::uint32_t longest = longest_list(grid),
                        all = static_cast<std::uint32_t>(grid.ids().size());
    const BudgetLimits unlimited;
    for (const std::uint32_t per_cell : {0u, 1u, 3u, longest / 2, longest, longest + 1, unlimited.per_cell})
        for (const std::uint32_t per_frame : {0u, 1u, all / 3, all - (all > 0), all, unlimited.per_frame})
            check_limit(budget, grid, weights, {per_cell, per_frame});
}

/// Returns weights: 0 random, 1 few values, 2 all equal, 3 with special floats, 4 ascending, 5 only NaN.
std::vector<float> weights_of(std::size_t count, int kind, std::uint32_t seed) {
    std::mt19937 random(seed);
    constexpr float endless_weight = std::numeric_limits<float>::infinity(),
                    no_number = std::numeric_limits<float>::quiet_NaN();
    const float special[] = {no_number, -no_number, endless_weight, -endless_weight, 0.0f,     -0.0f, 1e-42f,
                             -1e-42f,   FLT_MAX,    -FLT_MAX,       FLT_MIN,         -FLT_MIN, 1,     -1};
    std::lognormal_distribution<float> any(0, 2);
    std::vector<float> weights;
    for (std::size_t i = 0; i < count; ++i)
        weights.push_back(kind == 0   ? any(random)
                          : kind == 1 ? static_cast<float>(random() % 4)
                          : kind == 2 ? 0.25f
                          : kind == 3 ? special[random() % std::size(special)]
                          : kind == 4 ? static_cast<float>(i)
                                      : no_number);
    return weights;
}

}  // namespace

TEST_CASE("a budget keeps the heaviest lights of each cell, and then the heaviest entries of the frame") {
    const View view = test::view({320, 180}, 32);
    const Slices slices = *Slices::exponential(5, 2, 60);
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        const auto lights = test::random_lights(seed == 0 ? 0 : 1 + seed * 17, seed);
        for (int kind = 0; kind < 6; ++kind) {
            const auto weights = weights_of(lights.size(), kind, seed);
            Binner<Options{.ids = IdWidth::u16}> tiles;
            check_limits(*tiles.bin(view, lights), weights);
            if (kind == 1 || kind == 3) continue;
            Binner<Options{.depth_test = true, .slicing = Slicing::clusters}> clusters;
            check_limits(*clusters.bin(view, lights, {.slices = slices}), weights);
            Binner<Options{.slicing = Slicing::z_bins}> z_bins;
            check_limits(*z_bins.bin(view, lights, {.slices = slices}), weights);
        }
    }
}

TEST_CASE("a budget of many lights, whose weights lie close together or far apart") {
    const View view = test::view({640, 360}, 64);
    const auto lights = test::random_lights(3000, 7);
    Binner<> binner;
    const auto grid = *binner.bin(view, lights);
    Budget<> budget;
    for (const int kind : {0, 2, 3}) {
        auto weights = weights_of(lights.size(), kind, 3);
        for (std::size_t i = 0; kind == 2 && i < weights.size(); ++i)  // one float apart
            weights[i] = std::nextafter(1.0f, i % 3 == 0 ? 2.0f : 0.0f);
        check_limit(budget, grid, weights, {.per_cell = 40});
        check_limit(budget, grid, weights, {.per_frame = 5000});
        check_limit(budget, grid, weights, {.per_cell = 64, .per_frame = 2000});
    }
}

TEST_CASE("a budget refuses too few weights, and takes more") {
    const View view = test::view({64, 64}, 32);
    const auto lights = test::random_lights(9, 1);
    Binner<> binner;
    const auto grid = *binner.bin(view, lights);
    Budget<> budget;
    const auto refused = budget.limit(grid, std::vector<float>(8), {.per_cell = 1});
    REQUIRE(!refused);
    CHECK(refused.error().code == ErrorCode::too_few_weights);
    CHECK(std::string(refused.error().message()).find("9 lights that were binned, and was given 8") !=
          std::string::npos);
    CHECK(!budget.limit(grid, {}, {}));
    CHECK(budget.limit(grid, std::vector<float>(10), {.per_cell = 1}));
    const View empty = test::view({0, 64}, 32);
    const auto nothing =
        budget.limit(*binner.bin(empty, lights), std::vector<float>(9), {.per_cell = 0, .per_frame = 0});
    REQUIRE(nothing);
    CHECK(nothing->grid.ids().empty());
    CHECK(nothing->cut_in_cell.empty());
}
