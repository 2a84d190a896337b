// Every public template instantiated with every kind of argument, in a function named by the macro UNIT:
// compiled by several compilers with several flags for its warnings, and twice into one program.
#include <lightbin/advise.hpp>
#include <lightbin/box.hpp>
#include <lightbin/budget.hpp>
#include <lightbin/coverage.hpp>
#include <lightbin/dump.hpp>
#include <lightbin/encode.hpp>
#include <lightbin/lightbin.hpp>
#include <lightbin/masks.hpp>
#include <lightbin/shader_cull.hpp>
#include <lightbin/shader_reduce.hpp>
#include <lightbin/spot.hpp>

#include <glm/glm.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

std::uint64_t UNIT();

namespace {

using namespace lightbin;

struct Lamp {
    double position[3];
    double reach;
};

// FNV-1a: equal hashes stand for equal bytes.
struct Hash {
    std::uint64_t value = 14695981039346656037u;

    void add(std::uint64_t word) {
        for (int byte = 0; byte < 8; ++byte)
            value = (value ^ ((word >> (8 * byte)) & 255)) * 1099511628211u;
    }

    template <class Id> void add(const LightGrid<Id>& grid) {
        add(grid.light_counts().culled);
        for (const ListRange range : grid.ranges()) {
            add(range.offset);
            add(range.count);
        }
        for (const Id id : grid.ids())
            add(id);
        for (const Id id : grid.lights_in(0, 0))
            add(id);
    }
};

template <class T> T value_of(const Result<T>& result) {
    if (result) return *result;
    std::printf("%s\n", result.error().message().c_str());
    std::abort();
}

template <Options options>
void use_binner(Hash& hash, const View& view, const auto& lights, const ZBounds& bounds) {
    Binner<options> binner;
    using Id = typename Binner<options>::Id;
    const auto grid = value_of(binner.bin(view, lights, inputs_for<options>(bounds)));
    std::vector<ListRange> ranges(grid.ranges().size());
    std::vector<Id> ids(grid.ids().size());
    hash.add(value_of(grid.copy_to(ranges, ids)));
    // Not resize(), because both units of tests/guest/two_units.sh would share the function.
    std::vector<ListRange> more_ranges(2 * ranges.size());
    std::vector<Id> more_ids(2 * ids.size());
    hash.add(value_of(grid.copy_to(more_ranges, more_ids, value_of(grid.copy_to(more_ranges, more_ids)))));
    hash.add(longest_list(grid));
    if constexpr (options.depth_test) {
        hash.add(value_of(binner.bin(view, lights, {.bounds = bounds})));
    } else {
        hash.add(value_of(binner.bin(view, lights)));
        hash.add(value_of(binner.bin(view, lights, {})));
    }
}

void use_lights(Hash& hash, const View& view, const auto& lights, const ZBounds& bounds) {
    use_binner<Options{}>(hash, view, lights, bounds);
    use_binner<Options{.depth_test = true}>(hash, view, lights, bounds);
}

void use_encodings(Hash& hash, const auto& grid) {
    for (const ListFormat& format :
         {ListFormat{.ids = IdWidth::u8}, ListFormat{ListEncoding::sentinel, IdWidth::u16, 9}}) {
        std::vector<std::byte> bytes(
            static_cast<std::size_t>(encoded_bytes(format, grid.ranges().size(), grid.ids().size())));
        hash.add(value_of(encode(grid, format, bytes)).entries_cut);
    }
}

/// weights  one per light
void use_coverage(Hash& hash, const View& view, const auto& lights, const std::vector<float>& weights) {
    Binner<Options{.ids = IdWidth::u16}> binner;
    const auto grid = value_of(binner.bin(view, lights));
    for (const LightCoverage& light : value_of(coverage(view, lights)))
        hash.add(std::bit_cast<std::uint32_t>(light.pixels));
    MaskBinner masks;
    hash.add(value_of(masks.bin(view, lights)).mask_words());
    hash.add(dump(value_of(masks.bin(view, lights)), view, lights).size());
    for (const std::uint32_t word : value_of(masks.bin(view, lights, value_of(Slices::linear(5, 0, 50)))).words())
        hash.add(word);
    Budget<std::uint16_t> budget;
    const auto limited = value_of(budget.limit(grid, weights, {.per_cell = 9, .per_frame = 500}));
    hash.add(limited.grid);
    std::vector<std::uint32_t> entries(weights.size());
    hash.add(value_of(count_entries(limited.grid, entries)));
}

void use_shader_data(Hash& hash, const View& view, const std::vector<Sphere>& lights) {
    hash.add(shader_edges(view).size());
    hash.add(reduce_constants(view).height);
    hash.add(value_of(plan_cull(view, {}, {static_cast<std::uint32_t>(lights.size()), 9})).bytes.scratch);
}

void add_plans(Hash& hash, const Advice& advice) {
    double evaluations = 0;  // in any order: which plan is best depends on the machine
    for (const AdvicePlan& plan : advice.plans()) {
        evaluations += plan.evaluations;
        hash.value += plan.entries;
    }
    hash.add(static_cast<std::uint64_t>(evaluations));
    hash.value += to_string(advice).empty();
}

void use_advice(Hash& hash, const View& view, const auto& lights, const ZBounds& bounds) {
    add_plans(hash, value_of(advise(view, lights, {}, bounds)));
    const Slices slices = value_of(Slices::exponential(6, 2, 50)).with_margin(0x1p-14f);
    const std::array<float, 6> depths = {1, 3, 10, 20, 40, 80};
    add_plans(hash, value_of(advise_slices(view, lights, {.clusters = slices, .z_bins = slices},
                                           {.depths = depths, .size = {3, 2}})));
}

void use_view(Hash& hash, const View& view) {
    hash.add(static_cast<std::uint64_t>(view.tile_size()));
    hash.add(static_cast<std::uint64_t>(view.viewport().width));
    hash.add(static_cast<std::uint64_t>(view.origin()) + (view.orthographic() ? 8u : 0u) +
             (view.reversed_z() ? 16u : 0u));
    hash.add(grid_constants(view).tiles_x);
    const ImagePoint place = view.image_point({1, 2, -3});
    const ViewPoint back = view.view_point(place);
    if (const auto tile = view.tile_at(place)) hash.add(static_cast<std::uint64_t>(tile->x));
    hash.add(back.z < 0);
    hash.add(view.tile_of_pixel(3, 4).has_value());
    hash.add(to_string(view.summary()).size());

    const std::size_t pixels =
        static_cast<std::size_t>(view.viewport().width) * static_cast<std::size_t>(view.viewport().height);
    std::vector<float> depth(2 * pixels), min(view.tile_count()), max(view.tile_count());
    for (std::size_t i = 0; i < depth.size(); ++i)
        depth[i] = static_cast<float>(i % 1000) / 1000.0f;
    DepthBuffer buffer{.depth = depth, .samples = 2};
    buffer.format = DepthFormat::unorm24;
    const ZBounds bounds = value_of(reduce_depth(view, buffer, {.min = min, .max = max}));

    std::vector<Sphere> spheres;
    std::vector<glm::vec4> vectors;
    std::vector<Lamp> lamps;
    for (int i = 0; i < 200; ++i) {
        const int x = i * 37 % 101 - 50, y = i * 53 % 61 - 30, z = -(i * 29 % 83);
        const float radius = light_range(static_cast<float>(1 + i % 40), 0.25f);
        spheres.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), radius});
        vectors.emplace_back(x, y, z, radius);
        lamps.push_back({{1.0 * x, 1.0 * y, 1.0 * z}, static_cast<double>(radius)});
    }
    const auto to_light = [](const Lamp& lamp) {
        return Sphere{static_cast<float>(lamp.position[0]), static_cast<float>(lamp.position[1]),
                      static_cast<float>(lamp.position[2]), static_cast<float>(lamp.reach)};
    };
    const auto to_spot = [](const glm::vec4& v) {
        return Spot{v.x, v.y, v.z, v.w, v.y, v.z, 1, static_cast<float>(static_cast<int>(v.w) % 5) / 5.0f};
    };
    const glm::vec3 corner(1, 2, -3), side(0, 4, 1.5f);
    spheres[0] = tube_sphere(corner, side, 2);
    spheres[1] = rectangle_sphere(corner, side, corner, 2);
    const glm::mat4 camera(0.8f, 0, 0.6f, 0, 0, 1, 0, 0, -0.6f, 0, 0.8f, 0, 1, 2, -3, 1);
    const float numbers[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const Matrix identity = matrix(numbers, MatrixLayout::row_major);

    Binner<> binner;
    hash.add(dump(binner, value_of(binner.bin(view, spheres)), view, spheres).size());
    use_encodings(hash, value_of(binner.bin(view, spheres)));
    use_shader_data(hash, view, spheres);
    std::vector<float> weights;
    for (const Sphere& sphere : spheres)
        weights.push_back(sphere.radius);
    use_coverage(hash, view, spheres, weights);
    use_coverage(hash, view, world_space(vectors, camera, to_spot), weights);
    use_advice(hash, view, spheres, bounds);
    use_advice(hash, view, world_space(lamps, identity, to_light), {});
    use_lights(hash, view, spheres, bounds);
    use_binner<Options{.ids = IdWidth::u16}>(hash, view, spheres, bounds);
    use_binner<Options{.ids = IdWidth::u16, .depth_test = true}>(hash, view, spheres, bounds);
    const std::vector<Spot> spots = {to_spot(vectors[0]), to_spot(vectors[1]), Spot::whole(spheres[2])};
    const glm::vec3 up(0, 1, 0), along(0, 0, -1);
    const std::vector<Box> boxes = {oriented_box(corner, side, up, along),
                                    oriented_box(camera, 0.5),
                                    half_sphere(spheres[3], up),
                                    clipped_sphere(spheres[4], oriented_box(corner, side, up, along)),
                                    projector_box(corner, along, side, up, 0.1),
                                    tube_box(corner, side, 2)};
    const auto all = lights(spheres, spots, world_space(boxes, camera));
    use_lights(hash, view, boxes, bounds);
    use_lights(hash, view, lights(spots, boxes), bounds);
    use_binner<Options{.depth_test = true}>(hash, view, all, bounds);
    while (weights.size() < spheres.size() + spots.size() + boxes.size())
        weights.push_back(1);
    use_coverage(hash, view, all, weights);
    use_advice(hash, view, all, bounds);
    use_lights(hash, view, std::span<const glm::vec4>(vectors), bounds);
    use_lights(hash, view, view_space(lamps, to_light), bounds);
    use_lights(hash, view, world_space(vectors, camera), bounds);
    use_lights(hash, view, world_space(vectors, camera, to_spot), bounds);
    use_lights(hash, view, world_space(lamps, identity, to_light), bounds);
}

}  // namespace

std::uint64_t UNIT() {
    Hash hash;
    const ImageSize viewport{200, 120};
    // Written as numbers, because glm's results may differ with the flags.
    const glm::mat4 opengl(1.2f, 0, 0, 0, 0, 1.8f, 0, 0, 0, 0, -1.01f, -1, 0, 0, -0.2f, 0);
    const glm::dmat4 reversed(1.2, 0, 0, 0, 0, 1.8, 0, 0, 0.1, 0.2, 0, -1, 0, 0, 0.1, 0);
    const float infinite[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, -1}, {0, 0, -0.2f, 0}};
    const double orthographic[4][4] = {{0.02, 0, 0, 0}, {0, 0.03, 0, 0}, {0, 0, -0.02, 0}, {0, 0, -1, 1}};
    const ViewOptions upper{
        .tile_size = 16, .clip_depth = ClipDepth::zero_to_one, .origin = WindowOrigin::upper_left};
    for (const auto& view :
         {View::from_projection(opengl, viewport), View::from_projection(reversed, viewport, upper),
          View::from_projection(infinite, viewport), View::from_projection(orthographic, viewport)})
        use_view(hash, value_of(view));
    hash.add(value_of(shader_snippet({.language = ShaderLanguage::hlsl_5_0})).text.size());
    hash.add(value_of(reduce_shader()).text.size());
    hash.add(value_of(cull_shader(CullPass::project)).text.size());
    return hash.value;
}
