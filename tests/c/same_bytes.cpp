// SPDX-License-Identifier: MIT
// The functions of the C API give what C++ gives, in one case or a few each: both run the same code, so that only what
// the C API reads and chooses can differ. The C functions are in a library; this file includes both headers, as a
// program may that moves from one API to the other.
#include <lightbin/lightbin.h>

#include <lightbin/box.hpp>
#include <lightbin/coverage.hpp>
#include <lightbin/dump.hpp>
#include <lightbin/encode.hpp>
#include <lightbin/lightbin.hpp>
#include <lightbin/masks.hpp>
#include <lightbin/shader.hpp>
#include <lightbin/shader_cull.hpp>
#include <lightbin/shader_reduce.hpp>
#include <lightbin/spot.hpp>

#include "../split_mix.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace lightbin;

/// A user's struct: members in another order than lightbin's, behind a byte, so that none is aligned.
#pragma pack(push, 1)
struct Lamp {
    char kind;
    float cosine, range, colour[3], position[3], axis[3], half_axes[9], taper;
};
#pragma pack(pop)

constexpr std::size_t count = 300;
constexpr float projection[16] = {1, 0, 0, 0, 0, 1.5f, 0, 0, 0.1f, 0, -1.001f, -1, 0, 0, -0.2f, 0},
                view_matrix[16] = {0.6f, 0, -0.8f, 0, 0, 1, 0, 0, 0.8f, 0, 0.6f, 0, 3, -2, 1, 1};
const View cpp_view = *View::from_projection(matrix(projection, MatrixLayout::column_major), {640, 360},
                                             {.tile_size = 24});
const std::size_t tiles = cpp_view.tile_count();
const Slices cpp_slices = Slices::exponential(9, 2, 60)->with_margin(0.01f);

float random_float(SplitMix& random, float low, float high) {
    return low + (high - low) * static_cast<float>(random.integer(0, 1 << 20)) * 0x1p-20f;
}

/// The lights of every case, in lightbin's types and in the user's struct above.
struct Scene {
    std::vector<Lamp> lamps = std::vector<Lamp>(count);
    std::vector<Sphere> spheres;
    std::vector<Spot> spots;
    std::vector<Box> boxes, whole_boxes;
    std::vector<float> min, max;

    Scene() {
        SplitMix random(1);
        for (Lamp& lamp : lamps) {
            const auto any = [&](float size) { return random_float(random, -size, size); };
            const float z = random_float(random, -60, 4), range = random.integer(0, 30) == 0 ? -1 : 3 + any(3);
            const Spot spot = {any(1) * (4 - z), any(1) * (4 - z), z, range, any(1), any(1), any(1), any(1)};
            Box box = {spot.x, spot.y, spot.z, spot.radius, spot.x, spot.y, spot.z, {}, 0.5f + any(0.5f)};
            for (float(&half_axis)[3] : box.half_axes)
                for (float& number : half_axis)
                    number = any(4);
            spheres.push_back({spot.x, spot.y, spot.z, spot.radius});
            spots.push_back(spot);
            boxes.push_back(box);
            std::memcpy(&lamp.position, &spot.x, sizeof lamp.position);
            std::memcpy(&lamp.range, &spot.radius, sizeof lamp.range);
            std::memcpy(&lamp.axis, &spot.axis_x, sizeof lamp.axis);
            std::memcpy(&lamp.cosine, &spot.cos_half_angle, sizeof lamp.cosine);
            std::memcpy(&lamp.half_axes, box.half_axes, sizeof lamp.half_axes);
            std::memcpy(&lamp.taper, &box.taper, sizeof lamp.taper);
            box.radius = detail::infinity, box.taper = 1;
            whole_boxes.push_back(box);
        }
        for (std::size_t tile = 0; tile < tiles; ++tile) {
            min.push_back(random_float(random, 0.1f, 40));
            max.push_back(min.back() + random_float(random, -0.5f, 30));
        }
    }
};
const Scene scene;

struct Deleter {
    void operator()(lightbin_view* view) const { lightbin_view_destroy(view); }
    void operator()(lightbin_slices* slices) const { lightbin_slices_destroy(slices); }
    void operator()(lightbin_binner* binner) const { lightbin_binner_destroy(binner); }
    void operator()(lightbin_shader* shader) const { lightbin_shader_destroy(shader); }
};
template <class Handle> using Owned = std::unique_ptr<Handle, Deleter>;

std::string text(const lightbin_result& result) {
    std::string text(lightbin_error_text(result, nullptr, 0), ' ');
    lightbin_error_text(result, text.data(), text.size() + 1);
    return text;
}

void works(const lightbin_result& result) {
    REQUIRE_MESSAGE(result.error == LIGHTBIN_OK, text(result));
}

/// Returns the handle that create(&handle) makes.
template <class Handle, class Create> Owned<Handle> owned(const Create& create) {
    Handle* made = nullptr;
    works(create(&made));
    return Owned<Handle>(made);
}

/// Returns one of lightbin.h's structs with its size set and all else at the defaults.
template <class Struct> Struct sized() {
    Struct made = {};
    made.size = sizeof made;
    return made;
}

template <class Items, class OtherItems>
bool equal(const Items& a, const OtherItems* b, std::uint64_t number) {
    return a.size() == number && (number == 0 || std::memcmp(a.data(), b, number * sizeof *a.data()) == 0);
}
template <class A, class B> bool same(const A& a, const B& b) {
    return sizeof a == sizeof b && std::memcmp(&a, &b, sizeof a) == 0;
}

Owned<lightbin_view> make_view() {
    auto options = sized<lightbin_view_options>();
    options.width = 640, options.height = 360, options.tile_size = 24;
    options.projection.floats = projection;
    return owned<lightbin_view>([&](auto view) { return lightbin_view_create(&options, view); });
}
Owned<lightbin_slices> make_slices() {
    return owned<lightbin_slices>([](auto slices) { return lightbin_slices_exponential(9, 2, 60, 0.01f, slices); });
}
Owned<lightbin_binner> make_binner(const lightbin_binner_options* options = nullptr) {
    return owned<lightbin_binner>([=](auto binner) { return lightbin_binner_create(options, binner); });
}

/// Compares the counts of lights in a lightbin_grid or lightbin_masks with those of C++.
template <class Made> void compare_counts(const LightCounts& expected, const Made& made) {
    CHECK(made.lights == expected.lights);
    CHECK(made.rejected == expected.rejected);
    CHECK(made.culled == expected.culled);
    CHECK(made.first_spot == expected.first_spot);
    CHECK(made.first_box == expected.first_box);
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
    compare_counts(expected.light_counts(), grid);
}

void compare(const LightMasks& expected, const lightbin_masks& masks) {
    CHECK(masks.tiles_x == expected.tiles_x());
    CHECK(masks.tiles_y == expected.tiles_y());
    CHECK(masks.mask_words == expected.mask_words());
    CHECK(equal(expected.words(), masks.words, masks.word_count));
    CHECK(equal(expected.ids(), masks.ids, masks.id_count));
    CHECK(equal(expected.bins(), masks.bins, masks.bin_count));
    compare_counts(expected.light_counts(), masks);
}

/// Compares the lists of a grid in another format, made in C and in C++.
template <class Id>
void compare_encoded(const LightGrid<Id>& expected, const lightbin_grid& grid) {
    const ListFormat cpp_format = {ListEncoding::sentinel, IdWidth::u16, 5};
    const lightbin_format format = {sizeof format, LIGHTBIN_SENTINEL, LIGHTBIN_U16, 5};
    auto encoded = sized<lightbin_encoded>();
    works(lightbin_encode(&grid, &format, nullptr, 0, &encoded));
    CHECK(encoded.bytes == encoded_bytes(cpp_format, expected.ranges().size(), expected.ids().size()));
    std::vector<std::byte> out(encoded.bytes), cpp_out(encoded.bytes);
    works(lightbin_encode(&grid, &format, out.data(), out.size(), &encoded));
    const Encoded cpp_encoded = *encode(expected, cpp_format, cpp_out);
    CHECK(out == cpp_out);
    CHECK(encoded.entries_cut == cpp_encoded.entries_cut);
    CHECK(encoded.tiles_cut == cpp_encoded.tiles_cut);
    CHECK(encoded.capacity_needed == cpp_encoded.capacity_needed);
}

/// Compares a shader's text and bindings in C and C++ or, if it is refused, the sentence of the error.
template <class Create, class Given>
void compare_shaders(const Result<ShaderText>& expected, const Create& create, const Given& options) {
    lightbin_shader* made = nullptr;
    const lightbin_result result = create(&options, &made);
    const Owned<lightbin_shader> shader(made);
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

/// Returns where the floats of a member lie in an array of structs; `member` is that of the first struct.
template <class Floats> lightbin_floats in_lamps(const Floats& member) {
    return {&member, sizeof(Lamp)};
}

/// Describes the lights to the C API: spheres up to `first_spot`, spots up to `first_box`, then boxes.
///
/// cut  boxes are given with spheres and tapers
lightbin_lights lights_of(std::size_t first_spot, std::size_t first_box, bool in_world, bool cut) {
    auto lights = sized<lightbin_lights>();
    if (in_world) lights.view_matrix.floats = view_matrix;
    const Lamp &sphere = scene.lamps[0], &spot = scene.lamps[first_spot % count], &box = scene.lamps[first_box % count];
    lights.spheres = {first_spot, in_lamps(sphere.position), in_lamps(sphere.range)};
    lights.spots = {first_box - first_spot, in_lamps(spot.position), in_lamps(spot.range), in_lamps(spot.axis),
                    in_lamps(spot.cosine)};
    lights.boxes = {count - first_box, {}, {}, in_lamps(box.position), in_lamps(box.half_axes), {}};
    if (cut) {
        lights.boxes.centre = in_lamps(box.position), lights.boxes.radius = in_lamps(box.range);
        lights.boxes.taper = in_lamps(box.taper);
    }
    return lights;
}

/// Returns the text of a frame, of which a grid or masks are given.
std::string dumped(const lightbin_binner* binner, const lightbin_view* view, const lightbin_lights& lights,
                   const lightbin_inputs* inputs, const lightbin_grid* grid, const lightbin_masks* masks) {
    std::size_t size = 0;
    works(lightbin_dump(binner, view, &lights, inputs, grid, masks, nullptr, 0, &size));
    std::string text(size, ' ');
    works(lightbin_dump(binner, view, &lights, inputs, grid, masks, text.data(), size, &size));
    CHECK(text.back() == 0);
    text.pop_back();
    return text;
}

/// Bins lights of each kind alone, and together, with one set of options on both sides.
template <Options options> void compare_sides() {
    using Read = typename Binner<options>::Inputs;
    auto asked = sized<lightbin_binner_options>();
    detail::for_each_option([](const char*, auto option, std::int32_t& given) { given = static_cast<std::int32_t>(option); },
                    options, asked);
    const auto binner = make_binner(&asked);
    const auto view = make_view();
    const auto slices = make_slices();
    auto bounds = sized<lightbin_z_bounds>();
    bounds.min = scene.min.data(), bounds.max = scene.max.data(), bounds.tiles = tiles;
    auto inputs = sized<lightbin_inputs>();
    if (Read::reads_slices) inputs.slices = slices.get();
    if (Read::reads_bounds) inputs.bounds = &bounds;
    constexpr std::size_t firsts[][2] = {
        {count, count}, {0, count}, {0, 0}, {count / 3, count / 3 * 2}};  // the first spot and the first box
    for (const bool in_world : {false, true})
        for (const auto& [first_spot, first_box] : firsts) {
            CAPTURE(first_spot);
            const lightbin_lights lights = lights_of(first_spot, first_box, in_world, !in_world);
            const auto part = [&](const auto& all, std::size_t begin, std::size_t end) {
                const auto array = std::span(all).subspan(begin, end - begin);
                auto given = view_space(array);
                if (in_world)
                    given.to_view = world_space(array, matrix(view_matrix, MatrixLayout::column_major)).to_view;
                return given;
            };
            const auto cpp_lights = lightbin::lights(
                part(scene.spheres, 0, first_spot), part(scene.spots, first_spot, first_box),
                part(in_world ? scene.whole_boxes : scene.boxes, first_box, count));
            auto grid = sized<lightbin_grid>();
            works(lightbin_bin(binner.get(), view.get(), &lights, &inputs, &grid));
            Binner<options> expected;
            const auto cpp_inputs = inputs_for<options>({scene.min, scene.max}, cpp_slices);
            const auto cpp_grid = *expected.bin(cpp_view, cpp_lights, cpp_inputs);
            compare(cpp_grid, grid);
            CHECK(dumped(binner.get(), view.get(), lights, &inputs, &grid, nullptr) ==
                  dump(expected, cpp_grid, cpp_view, cpp_lights, cpp_inputs));
            if (first_spot == count / 3) compare_encoded(cpp_grid, grid);
            if constexpr (options.slicing == Slicing::clusters) {  // which may be given bounds
                inputs.bounds = &bounds;
                works(lightbin_bin(binner.get(), view.get(), &lights, &inputs, &grid));
                inputs.bounds = nullptr;
                Binner<options> bounded;
                compare(*bounded.bin(cpp_view, cpp_lights, {.slices = cpp_slices, .bounds = {scene.min, scene.max}}), grid);
            }
            if constexpr (!options.depth_test && options.slicing != Slicing::clusters) {
                MaskBinner cpp_binner;
                const LightMasks cpp_masks = options.slicing == Slicing::z_bins
                                                 ? *cpp_binner.bin(cpp_view, cpp_lights, cpp_slices)
                                                 : *cpp_binner.bin(cpp_view, cpp_lights);
                auto masks = sized<lightbin_masks>();
                works(lightbin_bin_masks(binner.get(), view.get(), &lights, &inputs, &masks));
                compare(cpp_masks, masks);
                CHECK(dumped(binner.get(), view.get(), lights, &inputs, nullptr, &masks) ==
                      (options.slicing == Slicing::z_bins ? dump(cpp_masks, cpp_view, cpp_lights, cpp_slices)
                                                          : dump(cpp_masks, cpp_view, cpp_lights)));
            }
        }
}

}  // namespace

TEST_CASE("C: lights are binned as in C++, with all options") {
    compare_sides<Options{}>();
    compare_sides<Options{.depth_test = true}>();
    compare_sides<Options{.ids = IdWidth::u16, .slicing = Slicing::clusters}>();
    compare_sides<Options{.depth_test = true, .slicing = Slicing::clusters}>();
    compare_sides<Options{.slicing = Slicing::z_bins}>();
    compare_sides<Options{.ids = IdWidth::u16, .depth_test = true, .slicing = Slicing::z_bins}>();
}

TEST_CASE("C: lights may lie in memory as the engine has them, nearly so, or in arrays of their own") {
    static_assert(offsetof(lightbin_spot, cosine) == offsetof(Spot, cos_half_angle));
    static_assert(offsetof(lightbin_box, taper) == offsetof(Box, taper) && sizeof(lightbin_box) == sizeof(Box));
    const auto view = make_view();
    const auto binner = make_binner();
    std::vector<float> centres, radii, axes, cosines;
    for (const Spot& spot : scene.spots) {
        centres.insert(centres.end(), {spot.x, spot.y, spot.z});
        radii.push_back(spot.radius);
        axes.insert(axes.end(), {spot.axis_x, spot.axis_y, spot.axis_z});
        cosines.push_back(spot.cos_half_angle);
    }
    const auto lists_are = [&](const auto& expected_lights, const lightbin_lights& lights) {
        Binner<> expected;
        auto grid = sized<lightbin_grid>();
        works(lightbin_bin(binner.get(), view.get(), &lights, nullptr, &grid));
        compare(*expected.bin(cpp_view, expected_lights), grid);
    };
    const auto in = [](const auto& array, std::size_t first, std::size_t stride) {
        return lightbin_floats{reinterpret_cast<const float*>(array.data()) + first, stride * sizeof(float)};
    };
    for (const lightbin_spheres& way : {lightbin_spheres{count, in(scene.spheres, 0, 4), in(scene.spheres, 3, 4)},
                                        {count, in(centres, 0, 3), in(radii, 0, 1)}}) {
        auto lights = sized<lightbin_lights>();
        lights.spheres = way;
        lists_are(scene.spheres, lights);
    }
    for (const lightbin_spots& way :
         {lightbin_spots{count, in(scene.spots, 0, 8), in(scene.spots, 3, 8), in(scene.spots, 4, 8), in(scene.spots, 7, 8)},
          {count, in(scene.spots, 0, 8), in(scene.spots, 3, 8), in(scene.spots, 4, 8), in(cosines, 0, 1)},
          {count, in(centres, 0, 3), in(radii, 0, 1), in(axes, 0, 3), in(cosines, 0, 1)}}) {
        auto lights = sized<lightbin_lights>();
        lights.spots = way;
        lists_are(scene.spots, lights);
    }
    auto lights = sized<lightbin_lights>();
    lights.boxes = {count,
                    in(scene.boxes, 0, 17),
                    in(scene.boxes, 3, 17),
                    in(scene.boxes, 4, 17),
                    in(scene.boxes, 7, 17),
                    in(scene.boxes, 16, 17)};
    lists_are(scene.boxes, lights);
}

TEST_CASE("C: with an eye, centres are doubles at any address") {
    const double eye[] = {1e9 + 0.37, 61.62, -5e8 + 0.11};
    const std::size_t stride = 3 * sizeof(double) + 1;
    std::vector<char> bytes(2 * count * stride);  // centres of balls, then centres of boxes
    std::vector<Placed<Sphere>> spheres;
    std::vector<Placed<Spot>> spots;
    std::vector<Placed<Box>> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        Spot spot = scene.spots[i];
        Box box = scene.boxes[i];
        double at[] = {eye[0] + static_cast<double>(spot.x), eye[1] + static_cast<double>(spot.y),
                       eye[2] + static_cast<double>(spot.z)};
        std::memcpy(&bytes[i * stride], at, sizeof at);
        spot.x = spot.y = spot.z = box.x = box.y = box.z = 0;
        box.box_x = 0.5f, box.box_y = -1, box.box_z = 0.25f;
        spots.push_back({{at[0], at[1], at[2]}, spot});
        spheres.push_back({{at[0], at[1], at[2]}, {0, 0, 0, spot.radius}});
        boxes.push_back({{at[0], at[1], at[2]}, box});
        at[0] += 0.5, at[1] -= 1, at[2] += 0.25;
        std::memcpy(&bytes[(count + i) * stride], at, sizeof at);
    }
    const auto in = [](const auto& first, std::size_t step) { return lightbin_floats{&first, step}; };
    const lightbin_floats centres = in(bytes[0], stride), box_centres = in(bytes[count * stride], stride);
    auto lights = sized<lightbin_lights>();
    lights.view_matrix.floats = view_matrix;
    lights.eye = eye;
    lights.spheres = {count, centres, in(spots[0].light.radius, sizeof spots[0])};
    lights.spots = {count, centres, in(spots[0].light.radius, sizeof spots[0]),
                    in(spots[0].light.axis_x, sizeof spots[0]), in(spots[0].light.cos_half_angle, sizeof spots[0])};
    lights.boxes = {count, centres, in(boxes[0].light.radius, sizeof boxes[0]), box_centres,
                    in(boxes[0].light.half_axes, sizeof boxes[0]), in(boxes[0].light.taper, sizeof boxes[0])};
    const auto far = [&](const auto& placed) {
        return world_space(placed, matrix(view_matrix, MatrixLayout::column_major), {eye[0], eye[1], eye[2]},
                           [](const auto& light) { return light; });
    };
    Binner<> expected;
    const auto cpp_lights = lightbin::lights(far(spheres), far(spots), far(boxes));
    const auto cpp_grid = *expected.bin(cpp_view, cpp_lights);
    CHECK(cpp_grid.ids().size() > 1000);
    const auto view = make_view();
    const auto binner = make_binner();
    auto grid = sized<lightbin_grid>();
    works(lightbin_bin(binner.get(), view.get(), &lights, nullptr, &grid));
    compare(cpp_grid, grid);
    CHECK(dumped(binner.get(), view.get(), lights, nullptr, &grid, nullptr) ==
          dump(expected, cpp_grid, cpp_view, cpp_lights));
}

TEST_CASE("C: a view knows what it knows in C++") {
    const auto view = make_view();
    auto info = sized<lightbin_view_info>();
    works(lightbin_view_describe(view.get(), &info));
    const ViewSummary summary = cpp_view.summary();
    const lightbin_view_info expected = {
        sizeof info, 640, 360, 24, cpp_view.tiles_x(), cpp_view.tiles_y(), false, false, cpp_view.near_depth(),
        cpp_view.far_depth(), summary.x_flipped, summary.y_flipped, true, summary.looks_transposed, false, false,
        summary.looks_behind, summary.looks_zero_to_one, summary.pixels_not_square, false, false, false};
    CHECK(same(info, expected));
    char line[600];
    lightbin_view_text(view.get(), line, sizeof line);
    CHECK(std::string(line) == to_string(summary).c_str());
    const double point[3] = {1, 2, -9};
    double image[3] = {}, back[3] = {};
    works(lightbin_view_project(view.get(), point, image));
    CHECK(same(image, cpp_view.image_point({1, 2, -9})));
    works(lightbin_view_unproject(view.get(), image, back));
    CHECK(same(back, cpp_view.view_point({image[0], image[1], image[2]})));
    float depths[2] = {};
    works(lightbin_view_depths(view.get(), 0.25, 0.5, depths));
    CHECK(same(depths, cpp_view.view_depths(0.25, 0.5)));
    CHECK(lightbin_view_window_depth(view.get(), image) == cpp_view.window_depth({image[0], image[1], image[2]}));
}

TEST_CASE("C: shader texts are those of C++, in each language") {
    const lightbin_format format = {sizeof format, LIGHTBIN_SENTINEL, LIGHTBIN_U8, 9};
    for (int language = LIGHTBIN_GLSL_430; language <= LIGHTBIN_WGSL; ++language)
        for (int storage = LIGHTBIN_STORAGE_BUFFER; storage <= LIGHTBIN_UNIFORM_BLOCK; ++storage) {
            CAPTURE(language);
            CAPTURE(storage);
            const int slicing = (language + storage) % 3;
            auto options = sized<lightbin_snippet_options>();
            options.language = language, options.storage = storage, options.slicing = slicing;
            options.prefix = "mine_", options.format = &format, options.tile_size = 24, options.packed_ids = 1;
            options.flip_y = 1, options.viewport_corner = 1, options.heat_map = 1, options.view_check = 1;
            options.list_check = 1, options.window = 1, options.texture_width = 1000, options.max_tiles = 64;
            options.max_entries = 512, options.max_slices = 8, options.views = 3, options.slots_given = 1;
            options.tiles = {6, 0}, options.lists = {5, 0}, options.grid = {4, 0};
            options.slices = {3, 0}, options.bins = {2, 0}, options.view = {1, 0};
            compare_shaders(shader_snippet({.language = static_cast<ShaderLanguage>(language),
                                            .storage = static_cast<ListStorage>(storage),
                                            .format = {ListEncoding::sentinel, IdWidth::u8, 9},
                                            .packed_ids = true,
                                            .slicing = static_cast<Slicing>(slicing),
                                            .views = 3,
                                            .tile_size = 24,
                                            .flip_y = true,
                                            .viewport_corner = true,
                                            .heat_map = true,
                                            .view_check = true,
                                            .list_check = true,
                                            .window = true,
                                            .texture_width = 1000,
                                            .max_tiles = 64,
                                            .max_entries = 512,
                                            .max_slices = 8,
                                            .tiles = {6},
                                            .lists = {5},
                                            .grid = {4},
                                            .slices = {3},
                                            .bins = {2},
                                            .view = {1},
                                            .prefix = "mine_"}),
                            lightbin_shader_snippet, options);
        }
    auto plain = sized<lightbin_snippet_options>();  // all 0: the defaults
    compare_shaders(shader_snippet({}), lightbin_shader_snippet, plain);
    plain.columns_and_rows = 1, plain.turned = 1;
    compare_shaders(shader_snippet({.columns_and_rows = true, .turned = true}), lightbin_shader_snippet, plain);
    plain = sized<lightbin_snippet_options>();
    plain.slicing = LIGHTBIN_Z_BINS, plain.masks = 1;
    compare_shaders(shader_snippet({.slicing = Slicing::z_bins, .masks = true}), lightbin_shader_snippet, plain);

    auto options = sized<lightbin_reduce_options>();
    compare_shaders(reduce_shader({}), lightbin_reduce_shader, options);
    options.language = LIGHTBIN_GLSL_VULKAN, options.prefix = "mine_", options.fragment = 1, options.samples = 4;
    options.format = LIGHTBIN_UNORM16, options.reversed_z = 1, options.orthographic = 1, options.skip_background = 1;
    options.flip_y = 1, options.viewport_corner = 1, options.push_constants = 1, options.slots_given = 1;
    options.depth = {5, 2}, options.z_bounds = {4, 1}, options.grid = {3, 0};
    compare_shaders(reduce_shader({.language = ShaderLanguage::glsl_vulkan,
                                   .fragment = true,
                                   .samples = 4,
                                   .reversed_z = true,
                                   .orthographic = true,
                                   .format = DepthFormat::unorm16,
                                   .skip_background = true,
                                   .flip_y = true,
                                   .viewport_corner = true,
                                   .depth = {5, 2},
                                   .z_bounds = {4, 1},
                                   .grid = {3},
                                   .push_constants = true,
                                   .prefix = "mine_"}),
                    lightbin_reduce_shader, options);
}

TEST_CASE("C: the data that shaders read is that of C++") {
    const auto view = make_view();
    const auto slices = make_slices();
    lightbin_grid_constants grid;
    works(lightbin_get_grid_constants(view.get(), 3, 4, &grid));
    CHECK(same(grid, grid_constants(cpp_view, 3, 4)));
    lightbin_view_constants check;
    works(lightbin_get_view_constants(view.get(), 2, &check));
    CHECK(same(check, view_constants(cpp_view, 2)));
    lightbin_reduce_constants reduce;
    works(lightbin_get_reduce_constants(view.get(), 3, 4, &reduce));
    CHECK(same(reduce, reduce_constants(cpp_view, 3, 4)));
    CHECK(lightbin_light_range(100, 0.01f) == light_range(100, 0.01f));
    CHECK(lightbin_slices_at(slices.get(), 30) == cpp_slices.slice_at(30));
    CHECK(equal(cpp_slices.boundaries(), lightbin_slices_boundaries(slices.get()), 8));
    std::vector<std::uint32_t> words(12);
    works(lightbin_shader_slices(slices.get(), words.data(), words.size()));
    CHECK(words == shader_slices(cpp_slices));
    lightbin_edges edges[100];
    const auto cpp_edges = shader_edges(cpp_view), cpp_slabs = shader_slabs(cpp_slices);
    CHECK(lightbin_shader_edges(view.get(), edges, cpp_edges.size() - 1).error == LIGHTBIN_BUFFER_TOO_SMALL);
    works(lightbin_shader_edges(view.get(), edges, cpp_edges.size()));
    CHECK(equal(cpp_edges, edges, 27 + 15));
    works(lightbin_shader_slabs(slices.get(), edges, 9));
    CHECK(equal(cpp_slabs, edges, 9));
}

TEST_CASE("C: the shaders that make light grids on the GPU, and their plans, are those of C++") {
    const auto view = make_view();
    const auto slices = make_slices();
    const lightbin_matrix to_view = {view_matrix, nullptr, LIGHTBIN_COLUMN_MAJOR, 0};
    const Matrix cpp_to_view = matrix(view_matrix, MatrixLayout::column_major);
    for (int kind = LIGHTBIN_CULL_SPHERE; kind <= LIGHTBIN_CULL_MIXED; ++kind)
        for (const bool all : {false, true}) {
            auto options = sized<lightbin_cull_options>();
            CullOptions cpp = {.kind = static_cast<CullKind>(kind)};
            options.kind = kind;
            if (kind == LIGHTBIN_CULL_SPOT) cpp.lights_at.stride = 8;
            if (kind == LIGHTBIN_CULL_BOX) cpp.lights_at.stride = 17;
            options.spots = 700, options.boxes = 80;
            if (all) {
                options.language = LIGHTBIN_WGSL, options.prefix = "mine_", options.stride = 20, options.centre = 3;
                options.box_centre = 21, options.half_axes = 24, options.taper = 33, options.spot_stride = 35;
                options.box_stride = 40;
                options.radius = 9, options.axis = 11, options.cosine = 17, options.world_space = 1;
                options.count_in_buffer = 1, options.count_at = 7, options.ids = LIGHTBIN_U16, options.depth_test = 1;
                options.slicing = kind % 2, options.max_only = kind == 0, options.orthographic = 1;
                options.slots_given = 1, options.lights = {9, 2}, options.z_bounds = {8, 2};
                options.scratch = {7, 2}, options.slices = {6, 2}, options.tiles = {5, 1};
                options.light_count = {4, 1}, options.lists = {3, 1}, options.grid = {2, 0};
                cpp = {.language = ShaderLanguage::wgsl,
                       .kind = cpp.kind,
                       .lights_at = {20, 3, 9, 11, 17, 21, 24, 33, 35, 40},
                       .world_space = true,
                       .count_in_buffer = true,
                       .count_at = 7,
                       .ids = IdWidth::u16,
                       .depth_test = true,
                       .slicing = static_cast<Slicing>(kind % 2),
                       .max_only = kind == 0,
                       .orthographic = true,
                       .lights = {9, 2},
                       .z_bounds = {8, 2},
                       .scratch = {7, 2},
                       .slices = {6, 2},
                       .tiles = {5, 1},
                       .light_count = {4, 1},
                       .lists = {3, 1},
                       .grid = {2},
                       .prefix = "mine_"};
            }
            for (int pass = LIGHTBIN_CULL_PROJECT; pass <= LIGHTBIN_CULL_MASKS; ++pass) {
                options.pass = pass;
                compare_shaders(cull_shader(static_cast<CullPass>(pass), cpp), lightbin_cull_shader, options);
            }
            const bool sliced = cpp.slicing != Slicing::none;
            auto plan = sized<lightbin_cull_plan>();
            const lightbin_result result =
                lightbin_plan_cull(view.get(), &options, 60'000, 5000, sliced ? slices.get() : nullptr,
                                   all ? &to_view : nullptr, &plan);
            const auto expected = plan_cull(cpp_view, cpp, {60'000, 5000, 700, 80}, sliced ? &cpp_slices : nullptr,
                                            all ? &cpp_to_view : nullptr);
            REQUIRE(expected);
            works(result);
            CHECK((plan.masks_suit == 1) == expected->masks_suit);
            CHECK(plan.scratch_bytes == expected->bytes.scratch);
            CHECK(plan.tile_bytes == expected->bytes.tiles);
            CHECK(plan.list_bytes == expected->bytes.lists);
            CHECK(plan.mask_bytes == expected->bytes.masks);
            CHECK(same(plan.groups, expected->groups));
            CHECK(std::memcmp(plan.constants, &expected->constants, sizeof expected->constants) == 0);
        }
    static_assert(sizeof(lightbin_cull_totals) == sizeof(CullTotals));
    static_assert(offsetof(lightbin_cull_totals, visible) == offsetof(CullTotals, visible));
}

TEST_CASE("C: each error of the C++ side has its sentence") {
    for (int code = LIGHTBIN_MATRIX_NOT_FINITE; code <= LIGHTBIN_EYE_NOT_FINITE; ++code)
        CHECK(text({code, 0, "", 123, 456}) == Error{static_cast<ErrorCode>(code), 123, 456}.message().c_str());
}
