// SPDX-License-Identifier: MIT
// The C side and the C++ side on the same random inputs give the same bytes. The C side's functions are in a library of
// their own; this file includes both headers, as a program may that moves from one side to the other.
#include <lightbin/coverage.hpp>
#include <lightbin/lightbin.h>

#include <lightbin/box.hpp>
#include <lightbin/budget.hpp>
#include <lightbin/encode.hpp>
#include <lightbin/grid_union.hpp>
#include <lightbin/lightbin.hpp>
#include <lightbin/shader.hpp>
#include <lightbin/shader_reduce.hpp>
#include <lightbin/shader_cull.hpp>
#include <lightbin/spot.hpp>

#include "../split_mix.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace lightbin;

class Random {
public:
    explicit Random(std::uint64_t seed) : mix_(seed) {}
    int integer(int low, int high) { return mix_.integer(low, high); }
    float real(float low, float high) {
        return low +
               (high - low) * static_cast<float>(mix_.integer(0, 1 << 20)) / static_cast<float>(1 << 20);
    }

private:
    SplitMix mix_;
};

/// A struct of the caller's, whose members lie in another order than lightbin's, behind a byte so that none is aligned.
#pragma pack(push, 1)
struct Lamp {
    char kind;
    float cosine, range, colour[3], position[3], axis[3], half_axes[9], taper;
};
#pragma pack(pop)

float number(const float& from) {  // an unaligned float
    float value = 0;
    std::memcpy(&value, &from, sizeof value);
    return value;
}

/// A camera, the lights, and the other inputs of a build, for both sides.
struct Scene {
    float projection[16] = {}, view_matrix[16] = {};
    int width, height, tile_size;
    std::vector<Lamp> lamps;
    std::vector<float> min, max, boundaries;

    explicit Scene(Random& random) {
        width = random.integer(1, 700), height = random.integer(1, 500), tile_size = random.integer(4, 40);
        const float near_plane = 0.1f, far_plane = 200;
        projection[0] = random.real(0.5f, 2), projection[5] = random.real(0.5f, 2);
        projection[8] = random.real(-0.2f, 0.2f), projection[9] = random.real(-0.2f, 0.2f);
        projection[10] = -(far_plane + near_plane) / (far_plane - near_plane), projection[11] = -1;
        projection[14] = -2 * far_plane * near_plane / (far_plane - near_plane);
        const float angle = random.real(-3, 3), c = std::cos(angle), s = std::sin(angle);
        const float turn[16] = {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, random.real(-9, 9), random.real(-9, 9),
                                3, 1};
        std::memcpy(view_matrix, turn, sizeof turn);
        lamps.resize(static_cast<std::size_t>(random.integer(0, 3) == 0 ? random.integer(0, 3)
                                                                        : random.integer(4, 700)));
        for (Lamp& lamp : lamps) {
            const float z = random.real(-60, 4);
            const float position[3] = {random.real(-1, 1) * (4 - z), random.real(-1, 1) * (4 - z), z},
                        axis[3] = {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
            float half_axes[9], taper = random.real(0, 1);
            for (float& number : half_axes)
                number = random.real(-4, 4);
            std::memcpy(&lamp.half_axes, half_axes, sizeof half_axes);
            std::memcpy(&lamp.taper, &taper, sizeof taper);
            const float range = random.integer(0, 50) == 0 ? -1 : random.real(0, 6),
                        cosine = random.real(-0.2f, 1);
            std::memcpy(&lamp.position, position, sizeof position);
            std::memcpy(&lamp.axis, axis, sizeof axis);
            std::memcpy(&lamp.range, &range, sizeof range);
            std::memcpy(&lamp.cosine, &cosine, sizeof cosine);
        }
        const auto tiles = static_cast<std::size_t>((width + tile_size - 1) / tile_size) *
                           static_cast<std::size_t>((height + tile_size - 1) / tile_size);
        for (std::size_t i = 0; i < tiles; ++i) {
            min.push_back(random.real(0.1f, 40));
            max.push_back(min.back() + random.real(-0.5f, 30));
        }
        for (float depth = random.real(1, 5); boundaries.size() < 12; depth += random.real(0.5f, 9))
            boundaries.push_back(depth);
    }

    Sphere sphere(const Lamp& lamp) const {
        return {number(lamp.position[0]), number(lamp.position[1]), number(lamp.position[2]),
                number(lamp.range)};
    }
    Spot spot(const Lamp& lamp) const {
        const Sphere ball = sphere(lamp);
        return {ball.x,
                ball.y,
                ball.z,
                ball.radius,
                number(lamp.axis[0]),
                number(lamp.axis[1]),
                number(lamp.axis[2]),
                number(lamp.cosine)};
    }
};

/// Returns the Box of a lamp: centred at its position, and cut by its sphere if `cut`, else with a taper of 1.
Box box(const Scene& scene, const Lamp& lamp, bool cut) {
    const Sphere ball = scene.sphere(lamp);
    Box made = {ball.x, ball.y, ball.z, cut ? ball.radius : INFINITY, ball.x,
                ball.y, ball.z, {},     cut ? number(lamp.taper) : 1};
    std::memcpy(made.half_axes, lamp.half_axes, sizeof made.half_axes);
    return made;
}

/// The caller's threads for both sides: one for each task.
void on_threads(std::size_t count, const auto& body) {
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < count; ++i)
        threads.emplace_back([&, i] { body(i); });
    for (std::thread& thread : threads)
        thread.join();
}

void run_tasks(void* calls, std::size_t count, lightbin_task task, void* context) {
    ++*static_cast<int*>(calls);
    on_threads(count, [=](std::size_t i) { task(context, i); });
}

struct Deleter {
    void operator()(lightbin_view* view) const { lightbin_view_destroy(view); }
    void operator()(lightbin_slices* slices) const { lightbin_slices_destroy(slices); }
    void operator()(lightbin_binner* binner) const { lightbin_binner_destroy(binner); }
    void operator()(lightbin_budget* budget) const { lightbin_budget_destroy(budget); }
    void operator()(lightbin_grid_union* grid_union) const { lightbin_grid_union_destroy(grid_union); }
    void operator()(lightbin_shader* shader) const { lightbin_shader_destroy(shader); }
};
template <class Handle> using Owned = std::unique_ptr<Handle, Deleter>;

/// Returns one of lightbin.h's structs with the defaults.
template <class Struct> Struct sized() {
    Struct made = {};
    made.size = sizeof made;
    return made;
}

std::string text(const lightbin_result& result) {
    std::string text(lightbin_error_text(result, nullptr, 0), ' ');
    lightbin_error_text(result, text.data(), text.size() + 1);
    return text;
}

template <class Items, class OtherItems>
bool equal(const Items& a, const OtherItems* b, std::uint64_t count) {
    return a.size() == count && (count == 0 || std::memcmp(a.data(), b, a.size_bytes()) == 0);
}

template <class Id> void compare(const LightGrid<Id>& expected, const lightbin_grid& grid) {
    CHECK(grid.id_bytes == sizeof(Id));
    CHECK(grid.tiles_x == expected.tiles_x());
    CHECK(grid.tiles_y == expected.tiles_y());
    CHECK(grid.slices == expected.slices());
    CHECK(equal(expected.ranges(), grid.ranges, grid.range_count));
    CHECK(equal(expected.ids(), grid.ids, grid.id_count));
    CHECK(equal(expected.ranks().order, grid.order, grid.order_count));
    CHECK(equal(expected.ranks().bins, grid.bins, grid.bin_count));
    CHECK(grid.lights == expected.light_counts().lights);
    CHECK(grid.rejected == expected.light_counts().rejected);
    CHECK(grid.culled == expected.light_counts().culled);
    CHECK(grid.first_spot == expected.light_counts().first_spot);
    CHECK(grid.first_box == expected.light_counts().first_box);
}

/// What is made of a finished grid, on both sides.
template <class Id>
void compare_uses(const LightGrid<Id>& expected, const lightbin_grid& grid, Random& random) {
    const std::size_t lights = expected.light_counts().lights, cells = expected.ranges().size();
    std::vector<std::uint32_t> entries(lights, 7), cpp_entries(lights);
    std::uint32_t listed = 0;
    REQUIRE(lightbin_count_entries(&grid, entries.data(), entries.size(), &listed).error == LIGHTBIN_OK);
    CHECK(listed == *count_entries(expected, std::span<std::uint32_t>(cpp_entries)));
    CHECK(entries == cpp_entries);

    std::vector<float> weights;
    for (std::size_t i = 0; i < lights; ++i)
        weights.push_back(static_cast<float>(random.integer(0, 9)));
    Budget<Id> cpp_budget;
    lightbin_budget* budget = nullptr;
    REQUIRE(lightbin_budget_create(&budget).error == LIGHTBIN_OK);
    const Owned<lightbin_budget> budget_owner(budget);
    const std::uint32_t per_cell = static_cast<std::uint32_t>(random.integer(1, 20)),
                        per_frame = static_cast<std::uint32_t>(random.integer(1, 3000));
    const BudgetedGrid<Id> cpp_limited = *cpp_budget.limit(expected, weights, {per_cell, per_frame});
    auto limited = sized<lightbin_grid>();
    auto cut = sized<lightbin_cut>();
    REQUIRE(lightbin_limit_grid(budget, &grid, weights.data(), weights.size(), per_cell, per_frame, &limited,
                                &cut)
                .error == LIGHTBIN_OK);
    compare(cpp_limited.grid, limited);
    CHECK(cut.entries_cut == cpp_limited.entries_cut);
    CHECK(equal(cpp_limited.cut_in_cell, cut.cut_in_cell, cut.cell_count));

    GridUnion<Id> cpp_union;
    lightbin_grid_union* grid_union = nullptr;
    REQUIRE(lightbin_grid_union_create(&grid_union).error == LIGHTBIN_OK);
    const Owned<lightbin_grid_union> union_owner(grid_union);
    auto united = sized<lightbin_grid>();
    const auto cpp_united = cpp_union.unite(cpp_limited.grid, expected);
    const lightbin_result unites = lightbin_unite_grids(grid_union, &limited, &grid, &united);
    REQUIRE((unites.error == LIGHTBIN_OK) == cpp_united.has_value());
    if (cpp_united)
        compare(*cpp_united, united);
    else
        CHECK(unites.error == LIGHTBIN_IDS_ARE_RANKS);

    std::vector<ListRange> cpp_ranges(2 * cells);
    std::vector<lightbin_range> ranges(2 * cells);
    std::vector<Id> ids(2 * expected.ids().size()), cpp_ids(2 * expected.ids().size());
    lightbin_grid first = grid, both = limited;
    REQUIRE(lightbin_copy_grid(&first, ranges.data(), ranges.size(), ids.data(), ids.size()).error ==
            LIGHTBIN_OK);
    REQUIRE(lightbin_append_grid(&both, &first, ranges.data(), ranges.size(), ids.data(), ids.size()).error ==
            LIGHTBIN_OK);
    CHECK((cells == 0 || first.ranges == ranges.data()));
    const auto cpp_first = *expected.copy_to(cpp_ranges, cpp_ids);
    compare(cpp_first, first);
    compare(*cpp_limited.grid.copy_to(cpp_ranges, cpp_ids, cpp_first), both);
}

/// Compares a shader's text and bindings, or the sentence of the error.
void compare_shaders(const Result<ShaderText>& expected, const lightbin_result& result,
                     const lightbin_shader* made) {
    REQUIRE((result.error == LIGHTBIN_OK) == expected.has_value());
    if (!expected) {
        CHECK(text(result) == expected.error().message().c_str());
        return;
    }
    CHECK(lightbin_shader_text(made) == expected->text);
    REQUIRE(lightbin_shader_binding_count(made) == expected->bindings.size());
    for (std::size_t i = 0; i < expected->bindings.size(); ++i) {
        auto binding = sized<lightbin_binding>();
        REQUIRE(lightbin_shader_binding(made, i, &binding).error == LIGHTBIN_OK);
        CHECK(binding.name == expected->bindings[i].name);
        CHECK(binding.slot.binding == expected->bindings[i].slot.binding);
        CHECK(binding.slot.set == expected->bindings[i].slot.set);
        CHECK(binding.resource == static_cast<std::int32_t>(expected->bindings[i].resource));
        CHECK(binding.bytes == expected->bindings[i].bytes);
        CHECK(binding.gl_internal_format == gl_format(expected->bindings[i].format).internal);
        CHECK(binding.webgpu_format == std::string(webgpu_format(expected->bindings[i].format)));
    }
}

Owned<lightbin_view> view_of(const Scene& scene) {
    auto options = sized<lightbin_view_options>();
    options.width = scene.width, options.height = scene.height, options.tile_size = scene.tile_size;
    options.projection.floats = scene.projection;
    lightbin_view* view = nullptr;
    REQUIRE(lightbin_view_create(&options, &view).error == LIGHTBIN_OK);
    return Owned<lightbin_view>(view);
}

View cpp_view_of(const Scene& scene) {
    return *View::from_projection(matrix(scene.projection, MatrixLayout::column_major),
                                  {scene.width, scene.height}, {.tile_size = scene.tile_size});
}

/// The lamps from `first_spot` on are spots, those from `first_box` on boxes, and those before both spheres.
lightbin_lights lights_of(const Scene& scene, std::size_t first_spot, bool in_world, std::size_t first_box,
                          bool cut) {
    const auto floats = [](const auto& member) { return lightbin_floats{&member, sizeof(Lamp)}; };
    auto lights = sized<lightbin_lights>();
    if (in_world) lights.view_matrix.floats = scene.view_matrix;
    if (first_spot > 0) {
        const Lamp& first = scene.lamps[0];
        lights.spheres = {first_spot, floats(first.position), floats(first.range)};
    }
    if (first_spot < first_box) {
        const Lamp& first = scene.lamps[first_spot];
        lights.spots = {first_box - first_spot, floats(first.position), floats(first.range),
                        floats(first.axis), floats(first.cosine)};
    }
    if (first_box < scene.lamps.size()) {
        const Lamp& first = scene.lamps[first_box];
        lights.boxes = {scene.lamps.size() - first_box, {}, {}, floats(first.position),
                        floats(first.half_axes),        {}};
        if (cut) {
            lights.boxes.centre = floats(first.position), lights.boxes.radius = floats(first.range);
            lights.boxes.taper = floats(first.taper);
        }
    }
    return lights;
}
lightbin_lights lights_of(const Scene& scene, std::size_t first_spot, bool in_world) {
    return lights_of(scene, first_spot, in_world, scene.lamps.size(), false);
}

/// Returns a binner with options; null: the defaults.
Owned<lightbin_binner> binner_of(const lightbin_binner_options* options) {
    lightbin_binner* made = nullptr;
    const lightbin_result created = lightbin_binner_create(options, &made);
    REQUIRE_MESSAGE(created.error == LIGHTBIN_OK, text(created));
    return Owned<lightbin_binner>(made);
}

/// One set of options on both sides, for several scenes.
template <Options options> void compare_sides() {
    using Read = typename Binner<options>::Inputs;
    Random random(1000 * static_cast<unsigned>(options.ids) + 10 * static_cast<unsigned>(options.depth_test) +
                  static_cast<unsigned>(options.slicing));
    Binner<options> expected;
    lightbin_binner_options asked = {sizeof asked,
                                     options.ids == IdWidth::u16 ? LIGHTBIN_U16 : LIGHTBIN_U32,
                                     options.depth_test,
                                     static_cast<std::int32_t>(options.slicing),
                                     LIGHTBIN_WIDEST};
    for (int round = 0; round < 8; ++round) {
        CAPTURE(round);
        asked.isa = round % (lightbin_machine_isa() + 1);  // each instruction set in turn
        const auto binner = binner_of(&asked);
        const Scene scene(random);
        const auto view = view_of(scene);
        const View cpp_view = cpp_view_of(scene);
        lightbin_slices* slices_made = nullptr;
        const float margin = round % 3 == 0 ? 0.01f : 0.0f;
        REQUIRE(lightbin_slices_from_boundaries(scene.boundaries.data(), scene.boundaries.size(), margin, &slices_made)
                    .error == LIGHTBIN_OK);
        const Owned<lightbin_slices> slices(slices_made);
        const Slices cpp_slices = Slices::from_boundaries(scene.boundaries)->with_margin(margin);
        auto bounds = sized<lightbin_z_bounds>();
        bounds.min = scene.min.data(), bounds.max = scene.max.data();
        bounds.tiles = scene.min.size();
        const ZBounds cpp_bounds = {scene.min, scene.max};
        int calls = 0;
        lightbin_threads threads = {sizeof threads, 3, run_tasks, &calls};
        auto inputs = sized<lightbin_inputs>();
        if (Read::reads_slices) inputs.slices = slices.get();
        if (Read::reads_bounds) inputs.bounds = &bounds;
        if (round % 2 == 1) inputs.threads = &threads;

        const bool in_world = round % 4 >= 2;
        const std::size_t count = scene.lamps.size();
        const std::size_t firsts[][2] = {
            {count, count},         {0, count},    {0, 0}, {count / 2, count}, {count / 3, count / 3 * 2},
            {count / 2, count / 2}, {0, count / 2}};  // the first spot and the first box
        for (const auto& [first_spot, first_box] : firsts) {
            const bool cut = round % 3 != 1;
            const lightbin_lights lights = lights_of(scene, first_spot, in_world, first_box, cut);
            const auto check = [&](const auto& cpp_lights) {
                auto grid = sized<lightbin_grid>();
                const lightbin_result result =
                    lightbin_bin(binner.get(), view.get(), &lights, &inputs, &grid);
                REQUIRE_MESSAGE(result.error == LIGHTBIN_OK, text(result));
                const Read cpp_inputs = inputs_for<options>(cpp_bounds, cpp_slices);
                const auto cpp_grid = *expected.bin(cpp_view, cpp_lights, cpp_inputs);
                compare(cpp_grid, grid);
                if (round < 2) compare_uses(cpp_grid, grid, random);
                if constexpr (options.ids == IdWidth::u16) {
                    std::vector<lightbin_light_coverage> covered(count);
                    std::size_t covered_count = 0;
                    REQUIRE(lightbin_coverage(view.get(), &lights, inputs.threads, covered.data(), count, &covered_count)
                                .error == LIGHTBIN_OK);
                    CHECK(equal(std::span<const LightCoverage>(*coverage(cpp_view, cpp_lights)), covered.data(),
                                covered_count));
                }
            };
            const auto world = matrix(scene.view_matrix, MatrixLayout::column_major);
            const auto part = [&](std::size_t begin, std::size_t end, const auto& to_light) {
                auto array =
                    view_space(std::span<const Lamp>(scene.lamps).subspan(begin, end - begin), to_light);
                if (in_world) array.to_view = world_space(scene.lamps, world, to_light).to_view;
                return array;
            };
            const auto spheres = part(0, first_spot, [&](const Lamp& lamp) { return scene.sphere(lamp); });
            const auto spots =
                part(first_spot, first_box, [&](const Lamp& lamp) { return scene.spot(lamp); });
            const auto boxes =
                part(first_box, count, [&](const Lamp& lamp) { return box(scene, lamp, cut); });
            if (first_spot == count)
                check(spheres);
            else if (first_spot == 0 && first_box == count)
                check(spots);
            else if (first_box == 0)
                check(boxes);
            else
                check(lightbin::lights(spheres, spots, boxes));
        }
    }
}

/// Compares both widths of ids, and with 16 bits what lights cover.
template <Options options> void compare_ids() {
    constexpr Options narrow = {
        .ids = IdWidth::u16, .depth_test = options.depth_test, .slicing = options.slicing};
    compare_sides<options>();
    compare_sides<narrow>();
}

}  // namespace

TEST_CASE("C: lights are binned as in C++, with all options") {
    compare_ids<Options{}>();
    compare_ids<Options{.depth_test = true}>();
    compare_ids<Options{.slicing = Slicing::clusters}>();
    compare_ids<Options{.depth_test = true, .slicing = Slicing::clusters}>();
    compare_ids<Options{.slicing = Slicing::z_bins}>();
    compare_ids<Options{.depth_test = true, .slicing = Slicing::z_bins}>();
}

TEST_CASE("C: arrays of vec4s and separate arrays give the same lists") {
    Random random(5);
    const Scene scene(random);
    const auto view = view_of(scene);
    std::vector<float> packed, spaced, centres, radii, axes, cosines;
    for (const Lamp& lamp : scene.lamps) {
        const Spot spot = scene.spot(lamp);
        packed.insert(packed.end(), {spot.x, spot.y, spot.z, spot.radius});
        spaced.insert(spaced.end(), {spot.x, spot.y, spot.z, spot.radius, 9, spot.axis_x, spot.axis_y,
                                     spot.axis_z, spot.cos_half_angle});
        centres.insert(centres.end(), {spot.x, spot.y, spot.z});
        radii.push_back(spot.radius);
        axes.insert(axes.end(), {spot.axis_x, spot.axis_y, spot.axis_z});
        cosines.push_back(spot.cos_half_angle);
    }
    const auto binner = binner_of(nullptr);
    const auto lists_are = [&](const LightGrid<std::uint32_t>& expected, const lightbin_lights& lights) {
        auto grid = sized<lightbin_grid>();
        REQUIRE(lightbin_bin(binner.get(), view.get(), &lights, nullptr, &grid).error == LIGHTBIN_OK);
        compare(expected, grid);
    };
    Binner<> expected;
    const auto of_spheres = *expected.bin(
        cpp_view_of(scene), view_space(scene.lamps, [&](const Lamp& lamp) { return scene.sphere(lamp); }));
    const std::size_t count = scene.lamps.size(), stride = 9 * sizeof(float);
    const lightbin_floats far_centres = {spaced.data(), stride}, far_radii = {spaced.data() + 3, stride},
                          far_axes = {spaced.data() + 5, stride}, far_cosines = {spaced.data() + 8, stride};
    const lightbin_spheres ways[] = {{count, {packed.data(), 16}, {packed.data() + 3, 16}},
                                     {count, far_centres, far_radii},
                                     {count, {centres.data(), 12}, {radii.data(), 4}}};
    for (const lightbin_spheres& way : ways) {
        auto lights = sized<lightbin_lights>();
        lights.spheres = way;
        lists_are(of_spheres, lights);
    }
    const auto of_spots = *expected.bin(
        cpp_view_of(scene), view_space(scene.lamps, [&](const Lamp& lamp) { return scene.spot(lamp); }));
    const lightbin_spots spot_ways[] = {
        {count, far_centres, far_radii, far_axes, far_cosines},
        {count, far_centres, far_radii, far_axes, {cosines.data(), 4}},
        {count, {centres.data(), 12}, {radii.data(), 4}, {axes.data(), 12}, {cosines.data(), 4}}};
    for (const lightbin_spots& way : spot_ways) {
        auto lights = sized<lightbin_lights>();
        lights.spots = way;
        lists_are(of_spots, lights);
    }
}

TEST_CASE("C: encodings and list lengths are those of C++") {
    Random random(6);
    for (int round = 0; round < 6; ++round) {
        const Scene scene(random);
        const auto view = view_of(scene);
        const lightbin_lights lights = lights_of(scene, scene.lamps.size(), false);
        const auto binner = binner_of(nullptr);
        auto grid = sized<lightbin_grid>();
        REQUIRE(lightbin_bin(binner.get(), view.get(), &lights, nullptr, &grid).error == LIGHTBIN_OK);
        Binner<> cpp_binner;
        const auto cpp_grid =
            *cpp_binner.bin(cpp_view_of(scene),
                            view_space(scene.lamps, [&](const Lamp& lamp) { return scene.sphere(lamp); }));
        for (const ListFormat& cpp_format :
             {ListFormat{.ids = IdWidth::u16},
              ListFormat{.encoding = ListEncoding::sentinel, .ids = IdWidth::u16, .capacity = 5}}) {
            const lightbin_format format = {
                sizeof format, static_cast<std::int32_t>(cpp_format.encoding),
                cpp_format.ids == IdWidth::u32 ? LIGHTBIN_U32 : static_cast<std::int32_t>(cpp_format.ids),
                cpp_format.capacity};
            std::uint64_t bytes = 0;
            REQUIRE(lightbin_encoded_bytes(&format, grid.range_count, grid.id_count, &bytes).error ==
                    LIGHTBIN_OK);
            CHECK(bytes == encoded_bytes(cpp_format, cpp_grid.ranges().size(), cpp_grid.ids().size()));
            std::vector<std::byte> out(bytes), cpp_out(bytes);
            auto encoded = sized<lightbin_encoded>();
            REQUIRE(lightbin_encode(&grid, &format, out.data(), out.size(), &encoded).error == LIGHTBIN_OK);
            const Encoded cpp_encoded = *encode(cpp_grid, cpp_format, cpp_out);
            CHECK(out == cpp_out);
            CHECK(encoded.entries_cut == cpp_encoded.entries_cut);
            CHECK(encoded.tiles_cut == cpp_encoded.tiles_cut);
            CHECK(encoded.capacity_needed == cpp_encoded.capacity_needed);
        }
        const ListLengths cpp_lengths = list_lengths(cpp_grid);
        std::uint32_t longest = 0;
        std::uint64_t histogram[33] = {};
        REQUIRE(lightbin_list_lengths(&grid, &longest, histogram).error == LIGHTBIN_OK);
        CHECK(longest == cpp_lengths.longest);
        CHECK(std::memcmp(histogram, cpp_lengths.histogram.data(), sizeof histogram) == 0);
    }
}

TEST_CASE("C: depth buffers are reduced as in C++") {
    Random random(7);
    for (int round = 0; round < 12; ++round) {
        const Scene scene(random);
        const auto view = view_of(scene);
        const int samples = round % 3 + 1;
        std::vector<float> depth(static_cast<std::size_t>(scene.width * scene.height * samples));
        for (float& sample : depth)
            sample = random.integer(0, 3) == 0 ? 1 : random.real(0.5f, 1);
        const std::size_t tiles = scene.min.size();
        std::vector<float> made(2 * tiles), expected(2 * tiles);
        const lightbin_depth_buffer buffer = {sizeof buffer, samples,  depth.data(), depth.size(), 0,
                                              round % 3,     round % 2};
        const lightbin_z_bounds_buffers out = {sizeof out, round % (lightbin_machine_isa() + 1), made.data(),
                                               made.data() + tiles, tiles};
        auto bounds = sized<lightbin_z_bounds>();
        const lightbin_result result = lightbin_reduce_depth(view.get(), &buffer, &out, &bounds);
        REQUIRE_MESSAGE(result.error == LIGHTBIN_OK, text(result));
        const auto part = [&](std::size_t i) { return std::span<float>(expected.data() + i * tiles, tiles); };
        const auto reduced = reduce_depth(cpp_view_of(scene),
                                          {.depth = depth,
                                           .samples = samples,
                                           .format = static_cast<DepthFormat>(round % 3),
                                           .skip_background = round % 2 != 0},
                                          {part(0), part(1)});
        REQUIRE(reduced);
        CHECK(std::memcmp(made.data(), expected.data(), made.size() * sizeof(float)) == 0);
        CHECK((bounds.min == made.data() && bounds.max == made.data() + tiles));
    }
}

TEST_CASE("C: instruction sets are those of C++, and one that is not there is refused") {
    CHECK(lightbin_machine_isa() == static_cast<int>(machine_isa()));
    auto options = sized<lightbin_binner_options>();
    lightbin_binner* binner = nullptr;
    for (options.isa = -1; options.isa <= LIGHTBIN_AVX512 + 1; ++options.isa) {
        const lightbin_result made = lightbin_binner_create(&options, &binner);
        const bool is_value = 0 <= options.isa && options.isa <= LIGHTBIN_AVX512;
        CHECK(made.error == (!is_value                                 ? LIGHTBIN_NOT_A_VALUE
                             : options.isa > lightbin_machine_isa() ? LIGHTBIN_NO_SUCH_ISA
                                                                    : LIGHTBIN_OK));
        if (made.error == LIGHTBIN_OK)
            lightbin_binner_destroy(binner);
        else
            CHECK(text(made).starts_with("options.isa: "));
    }
}

TEST_CASE("C: a view knows what it knows in C++") {
    Random random(8);
    const Scene scene(random);
    const auto view = view_of(scene);
    const View cpp_view = cpp_view_of(scene);
    auto info = sized<lightbin_view_info>();
    REQUIRE(lightbin_view_describe(view.get(), &info).error == LIGHTBIN_OK);
    CHECK(info.tiles_x == cpp_view.tiles_x());
    CHECK(info.near_depth == cpp_view.near_depth());
    CHECK(info.far_depth == cpp_view.far_depth());
    CHECK(info.pixels_not_square == cpp_view.summary().pixels_not_square);
    char line[600];
    lightbin_view_text(view.get(), line, sizeof line);
    CHECK(std::string(line) == to_string(cpp_view.summary()).c_str());
    const double point[3] = {1, 2, -9};
    double image[3] = {}, back[3] = {};
    REQUIRE(lightbin_view_project(view.get(), point, image).error == LIGHTBIN_OK);
    CHECK(image[0] == cpp_view.image_point({1, 2, -9}).x);
    CHECK(image[2] == 9);
    REQUIRE(lightbin_view_unproject(view.get(), image, back).error == LIGHTBIN_OK);
    CHECK(back[1] == doctest::Approx(2));
    float depths[2] = {};
    REQUIRE(lightbin_view_depths(view.get(), 0.25, 0.5, depths).error == LIGHTBIN_OK);
    CHECK(depths[1] == cpp_view.view_depths(0.25, 0.5).max);
}

TEST_CASE("C: shader texts and their data are those of C++") {
    for (int language = LIGHTBIN_GLSL_430; language <= LIGHTBIN_WGSL; ++language)
        for (int storage = LIGHTBIN_STORAGE_BUFFER; storage <= LIGHTBIN_BYTE_ADDRESS; ++storage)
            for (int slicing = LIGHTBIN_NO_SLICING; slicing <= LIGHTBIN_Z_BINS; ++slicing) {
                CAPTURE(language);
                CAPTURE(storage);
                auto options = sized<lightbin_snippet_options>();
                options.language = language, options.storage = storage, options.slicing = slicing;
                options.heat_map = 1, options.max_tiles = 64, options.max_entries = 512,
                options.max_slices = 8;
                options.views = language % 2 == 0 ? 0 : 3;
                options.prefix = "mine_", options.slots_given = slicing == 0;
                const lightbin_slot slots[] = {{6, 0}, {5, 0}, {4, 0}, {3, 0}, {2, 0}, {1, 0}};
                options.tiles = slots[0], options.lists = slots[1], options.grid = slots[2],
                options.slices = slots[3], options.bins = slots[4], options.view = slots[5];
                ShaderOptions cpp_options = {.language = static_cast<ShaderLanguage>(language),
                                             .storage = static_cast<ListStorage>(storage),
                                             .slicing = static_cast<Slicing>(slicing),
                                             .views = language % 2 == 0 ? 1u : 3u,
                                             .heat_map = true,
                                             .max_tiles = 64,
                                             .max_entries = 512,
                                             .max_slices = 8,
                                             .prefix = "mine_"};
                if (slicing == 0) {
                    cpp_options.tiles = {6}, cpp_options.lists = {5}, cpp_options.grid = {4};
                    cpp_options.slices = {3}, cpp_options.bins = {2}, cpp_options.view = {1};
                }
                lightbin_shader* made = nullptr;
                const lightbin_result result = lightbin_shader_snippet(&options, &made);
                const Owned<lightbin_shader> shader(made);
                const auto expected = shader_snippet(cpp_options);
                compare_shaders(expected, result, made);
            }
    Random random(9);
    const Scene scene(random);
    const auto view = view_of(scene);
    const View cpp_view = cpp_view_of(scene);
    const auto same = [](const auto& a, const auto& b) {
        return sizeof a == sizeof b && std::memcmp(&a, &b, sizeof a) == 0;
    };
    lightbin_grid_constants grid;
    REQUIRE(lightbin_shader_grid(view.get(), 3, 4, &grid).error == LIGHTBIN_OK);
    CHECK(same(grid, shader_grid(cpp_view, 3, 4)));
    lightbin_view_constants check;
    REQUIRE(lightbin_shader_view(view.get(), 2, &check).error == LIGHTBIN_OK);
    CHECK(same(check, shader_view(cpp_view, 2)));
    lightbin_reduce_constants reduce;
    REQUIRE(lightbin_shader_reduce(view.get(), 3, 4, &reduce).error == LIGHTBIN_OK);
    CHECK(same(reduce, shader_reduce(cpp_view, 3, 4)));
    auto reduce_options = sized<lightbin_reduce_options>();
    reduce_options.language = LIGHTBIN_GLSL_430;
    lightbin_shader* made = nullptr;
    REQUIRE(lightbin_reduce_shader(&reduce_options, &made).error == LIGHTBIN_OK);
    CHECK(lightbin_shader_text(made) == reduce_shader()->text);
    lightbin_shader_destroy(made);
    lightbin_slices* slices = nullptr;
    REQUIRE(lightbin_slices_exponential(24, 5, 200, 0, &slices).error == LIGHTBIN_OK);
    const Owned<lightbin_slices> owned(slices);
    const Slices cpp_slices = *Slices::exponential(24, 5, 200);
    CHECK(lightbin_slices_count(slices) == 24);
    CHECK(lightbin_slices_at(slices, 30) == cpp_slices.slice_at(30));
    CHECK(std::memcmp(lightbin_slices_boundaries(slices), cpp_slices.boundaries().data(),
                      23 * sizeof(float)) == 0);
    std::vector<std::uint32_t> words(27);
    REQUIRE(lightbin_shader_slices(slices, words.data(), words.size()).error == LIGHTBIN_OK);
    CHECK(words == shader_slices(cpp_slices));
    std::size_t count = 0;
    std::vector<lightbin_edges> edges(static_cast<std::size_t>(cpp_view.tiles_x() + cpp_view.tiles_y()));
    REQUIRE(lightbin_shader_edges(view.get(), edges.data(), edges.size(), &count).error == LIGHTBIN_OK);
    CHECK(std::memcmp(edges.data(), shader_edges(cpp_view).data(), count * sizeof edges[0]) == 0);
    edges.resize(24);
    REQUIRE(lightbin_shader_slabs(slices, edges.data(), edges.size(), &count).error == LIGHTBIN_OK);
    CHECK(std::memcmp(edges.data(), shader_slabs(cpp_slices).data(), count * sizeof edges[0]) == 0);
}

namespace {

/// Random options of cull_shader() for both sides, among them those that are refused.
struct CullOptions {
    lightbin_cull_options c = sized<lightbin_cull_options>();
    CullShaderOptions cpp;

    explicit CullOptions(Random& random) {
        const auto both = [&](std::int32_t& to, auto& cpp_to, int least, int greatest) {
            to = random.integer(least, greatest);
            cpp_to = static_cast<std::remove_reference_t<decltype(cpp_to)>>(to);
        };
        // In a quarter of the cases any value, so that most are not refused.
        const bool any = random.integer(0, 3) == 0;
        both(c.language, cpp.language, LIGHTBIN_GLSL_430, LIGHTBIN_WGSL);
        if (!any && !detail::Dialect{cpp.language}.storage_buffers)
            c.language = LIGHTBIN_WGSL, cpp.language = ShaderLanguage::wgsl;
        both(c.kind, cpp.kind, LIGHTBIN_CULL_SPHERE, any ? LIGHTBIN_CULL_BOX : LIGHTBIN_CULL_SPOT);
        both(c.world_space, cpp.world_space, 0, 1);
        both(c.count_in_buffer, cpp.count_in_buffer, 0, 1);
        both(c.depth_test, cpp.depth_test, 0, 1);
        both(c.slicing, cpp.slicing, LIGHTBIN_NO_SLICING, any ? LIGHTBIN_Z_BINS : LIGHTBIN_CLUSTERS);
        both(c.max_only, cpp.max_only, 0, 1);
        both(c.orthographic, cpp.orthographic, 0, 1);
        c.ids = any ? 1 << random.integer(0, 2) : 2 * random.integer(0, 1);
        if (c.ids != 0) cpp.ids = static_cast<IdWidth>(c.ids);
        c.count_at = cpp.count_at = static_cast<std::uint32_t>(random.integer(0, 9));
        if (random.integer(0, 1) == 1) {
            cpp.lights_at = {20, 3, 9, 11, 17};
            c.stride = 20, c.centre = 3, c.radius = 9, c.axis = 11, c.cosine = 17;
        } else {
            c.centre = 7;  // which is not read without a stride
            if (cpp.kind == CullKind::spot) cpp.lights_at.stride = 8;
        }
        if (random.integer(0, 1) == 1) {
            c.prefix = "mine_", cpp.prefix = "mine_";
            const bool sets = detail::Dialect{cpp.language}.spaces;
            auto move = [&, next = 20](lightbin_slot& slot, ShaderSlot& cpp_slot) mutable {
                slot = {--next, sets ? next % 3 : 0};
                cpp_slot = {slot.binding, slot.set};
            };
            c.slots_given = 1;
            move(c.lights, cpp.lights), move(c.z_bounds, cpp.z_bounds), move(c.scratch, cpp.scratch);
            move(c.slices, cpp.slices), move(c.tiles, cpp.tiles), move(c.light_count, cpp.light_count);
            move(c.lists, cpp.lists), move(c.grid, cpp.grid);
        }
    }
};

}  // namespace

TEST_CASE("C: the shaders that make light grids on the GPU, and their plans, are those of C++") {
    Random random(11);
    int texts = 0, plans = 0, refused = 0;
    for (int round = 0; round < 200; ++round) {
        CAPTURE(round);
        CullOptions options(random);
        for (int pass = LIGHTBIN_CULL_PROJECT; pass <= LIGHTBIN_CULL_FILL; ++pass) {
            lightbin_shader* made = nullptr;
            options.c.pass = pass;
            const lightbin_result result = lightbin_cull_shader(&options.c, &made);
            const Owned<lightbin_shader> shader(made);
            const auto expected = cull_shader(static_cast<CullPass>(pass), options.cpp);
            compare_shaders(expected, result, made);
            texts += expected.has_value();
        }

        const Scene scene(random);
        const auto view = view_of(scene);
        lightbin_slices* slices_made = nullptr;
        const int slice_count = random.integer(1, 1100);
        const float margin = round % 3 == 0 ? 0.01f : 0;
        REQUIRE(lightbin_slices_linear(slice_count, 1, 900, margin, &slices_made).error ==
                LIGHTBIN_OK);
        const Owned<lightbin_slices> slices(slices_made);
        const Slices cpp_slices = Slices::linear(slice_count, 1, 900)->with_margin(margin);
        auto matrix_given = lightbin_matrix{scene.view_matrix, nullptr, LIGHTBIN_COLUMN_MAJOR, 0};
        const Matrix cpp_matrix = matrix(scene.view_matrix, MatrixLayout::column_major);
        const CullRoom room = {static_cast<std::uint32_t>(random.integer(0, 90'000)),
                               static_cast<std::uint32_t>(random.integer(0, 1 << 20))};
        const bool sliced = options.cpp.slicing != Slicing::none, in_world = options.cpp.world_space;
        auto plan = sized<lightbin_cull_plan>();
        const lightbin_result result =
            lightbin_plan_cull(view.get(), &options.c, room.lights, room.entries,
                               sliced ? slices.get() : nullptr, in_world ? &matrix_given : nullptr, &plan);
        const auto expected = plan_cull(cpp_view_of(scene), options.cpp, room, sliced ? &cpp_slices : nullptr,
                                        in_world ? &cpp_matrix : nullptr);
        REQUIRE((result.error == LIGHTBIN_OK) == expected.has_value());
        if (!expected) {
            CHECK(text(result) == expected.error().message().c_str());
            CHECK(plan.scratch_bytes == 0);
            ++refused;
            continue;
        }
        ++plans;
        CHECK(plan.scratch_bytes == expected->bytes.scratch);
        CHECK(plan.tile_bytes == expected->bytes.tiles);
        CHECK(plan.list_bytes == expected->bytes.lists);
        for (int pass = LIGHTBIN_CULL_PROJECT; pass <= LIGHTBIN_CULL_FILL; ++pass) {
            CHECK(plan.groups[pass].x == expected->groups_of(static_cast<CullPass>(pass)).x);
            CHECK(plan.groups[pass].y == expected->groups_of(static_cast<CullPass>(pass)).y);
        }
        std::uint32_t words[64] = {};
        std::memcpy(words, &expected->constants, sizeof expected->constants);
        CHECK(std::memcmp(words, plan.constants, sizeof words) == 0);
    }
    CHECK(texts > 500);
    CHECK(plans > 50);
    CHECK(refused > 20);
    static_assert(sizeof(lightbin_cull_totals) == sizeof(CullTotals));
    static_assert(offsetof(lightbin_cull_totals, visible) == offsetof(CullTotals, visible));
}

TEST_CASE("C: shapes are the lights of C++") {
    struct Point {
        float x, y, z;
    };
    Random random(11);
    const auto same = [](lightbin_result result, const auto& made, const auto& expected) {
        static_assert(sizeof made == sizeof expected);
        CHECK_MESSAGE(result.error == LIGHTBIN_OK, text(result));
        CHECK(std::memcmp(&made, &expected, sizeof made) == 0);
    };
    for (int i = 0; i < 300; ++i) {
        float v[4][3], transform[16];
        Point p[4];
        for (int k = 0; k < 4; ++k) {
            for (float& number : v[k])
                number = i % 50 == 0 && random.integer(0, 9) == 0 ? std::nanf("") : random.real(-5, 5);
            p[k] = {v[k][0], v[k][1], v[k][2]};
        }
        for (float& number : transform)
            number = random.real(-2, 2);
        const float size = random.real(-0.1f, 4), cosine = random.real(-1, 1), begin = random.real(0, 0.9f);
        const lightbin_sphere ball = {{p[0].x, p[0].y, p[0].z}, size};
        const Sphere cpp_ball = {p[0].x, p[0].y, p[0].z, size};
        const lightbin_spot spot = {{p[0].x, p[0].y, p[0].z}, size, {p[1].x, p[1].y, p[1].z}, cosine};
        lightbin_sphere sphere;
        lightbin_box box;
        same(lightbin_spot_sphere(&spot, &sphere), sphere,
             least_sphere(Spot{p[0].x, p[0].y, p[0].z, size, p[1].x, p[1].y, p[1].z, cosine}));
        same(lightbin_tube_sphere(v[0], v[1], size, &sphere), sphere, tube_sphere(p[0], p[1], size));
        same(lightbin_rectangle_sphere(v[0], v[1], v[2], size, &sphere), sphere,
             rectangle_sphere(p[0], p[1], p[2], size));
        same(lightbin_tube_box(v[0], v[1], size, &box), box, tube_box(p[0], p[1], size));
        same(lightbin_half_sphere(&ball, v[1], &box), box, half_sphere(cpp_ball, p[1]));
        const double fraction = static_cast<double>(begin);
        same(lightbin_projector_box(v[0], v[1], v[2], v[3], fraction, &box), box,
             projector_box(p[0], p[1], p[2], p[3], fraction));
        lightbin_matrix numbers = {transform, nullptr, i % 3, 0};
        same(lightbin_cube_box(&numbers, 0.5, &box), box,
             whole_box(matrix(transform, static_cast<MatrixLayout>(i % 3)), 0.5));
        const Box whole = whole_box(p[0], p[1], p[2], p[3]);
        same(lightbin_whole_box(v[0], v[1], &box), box, whole);
        std::memcpy(box.centre, v[2], sizeof box.centre);
        box.radius = size;
        same(lightbin_box_sphere(&box, &sphere), sphere,
             bounding_sphere(clipped_sphere({p[2].x, p[2].y, p[2].z, size}, whole)));
    }
}

TEST_CASE("C: each error of the C++ side has its number and its sentence") {
    CHECK(lightbin_light_range(100, 0.01f) == light_range(100, 0.01f));
    CHECK(lightbin_light_window(1, 3) == light_window(1, 3));
    std::vector<std::string> seen;
    for (std::size_t code = 0; code < std::size(detail::error_sentences); ++code) {
        const Error error = {static_cast<ErrorCode>(100 + code), 123, 456};
        int found = 0;
        for (std::int32_t number = 1; number < 300; ++number)
            found += text({number, 0, "", 123, 456}) == error.message().c_str();
        CHECK_MESSAGE(found == 1, error.message().c_str());
    }
}
