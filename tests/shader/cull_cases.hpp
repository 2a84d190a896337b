// SPDX-License-Identifier: MIT
// The cases in which light grids made on a device are compared with a Binner's.
#pragma once

#include "cull.hpp"
#include "run_jobs.hpp"

#include <lightbin/box.hpp>

#include <type_traits>

/// Returns the lists of a Binner. Clusters get Z bounds only if `bounded`.
template <lightbin::Options options, bool bounded = false, class Lights>
BuiltLists binned(const BuiltScene& scene, const Lights& lights, lightbin::LightCounts& counts) {
    lightbin::Binner<options> binner;
    typename lightbin::Binner<options>::Inputs inputs = lightbin::inputs_for<options>(scene.bounds, scene.slices);
    if constexpr (bounded) inputs.bounds = scene.bounds;
    const auto grid = *binner.bin(scene.view, lights, inputs);
    counts = grid.light_counts();
    const auto ranges = grid.ranges();
    const auto ids = grid.ids();
    return {{ranges.begin(), ranges.end()}, {ids.begin(), ids.end()}};
}

/// Lights of CullKind::mixed.
struct MixedLights {
    std::vector<lightbin::Sphere> spheres;
    std::vector<lightbin::Spot> spots;
    std::vector<lightbin::Box> boxes;

    std::size_t size() const { return spheres.size() + spots.size() + boxes.size(); }
};

/// Returns what a Binner takes: lights in view space, or in world space.
template <class Light>
auto source_of(const std::vector<Light>& lights, const lightbin::Matrix& to_view, bool world_space) {
    auto source = lightbin::world_space(lights, to_view);
    if (!world_space) source.to_view.reset();
    return source;
}
inline auto source_of(const MixedLights& lights, const lightbin::Matrix& to_view, bool world_space) {
    return lightbin::lights(source_of(lights.spheres, to_view, world_space),
                            source_of(lights.spots, to_view, world_space),
                            source_of(lights.boxes, to_view, world_space));
}

/// Options of a grid, for both the Binner and the shaders.
struct CullWay {
    bool depth_test = false;
    lightbin::Slicing slicing = lightbin::Slicing::none;
    bool world_space = false;
    bool max_only = false;   // the maximum Z bounds alone
    bool bounded = false;    // clusters of which the Z bounds leave cells empty
    float slice_margin = 0;  // of slices for readers that compute a depth's slice by a formula of their own
    constexpr lightbin::Options options() const { return {.depth_test = depth_test, .slicing = slicing}; }
};

class CullTests {
public:
    CullTests(lightbin::ShaderLanguage language, const Share& share) : language_(language), share_(share) {}

    template <class Device> bool run(Device& device) {
        constexpr auto tiles = lightbin::Slicing::none, clusters = lightbin::Slicing::clusters;
        smallest_and_largest(device);
        short_of_room(device);
        beyond_32_bits(device);
        as_the_binner(device);
        ordinary(device);
        constexpr int both_sizes[] = {16, 11}, one_size[] = {16};
        ways<CullWay{}>(device, both_sizes);
        ways<CullWay{false, tiles, true}>(device, both_sizes);
        ways<CullWay{false, clusters}>(device, both_sizes);
        ways<CullWay{true, tiles}>(device, both_sizes);
        ways<CullWay{true, clusters}>(device, both_sizes);
        ways<CullWay{true, clusters, true}>(device, both_sizes);
        ways<CullWay{true, tiles, true}>(device, both_sizes);
        ways<CullWay{true, tiles, false, true}>(device, one_size);
        ways<CullWay{true, clusters, false, false, false, 0x1p-5f}>(device, one_size);
        ways<CullWay{false, clusters, false, false, false, 0x1p-5f}>(device, one_size);
        ways<CullWay{true, clusters, false, false, true}>(device, both_sizes);
        ways<CullWay{false, clusters, true, false, true}>(device, one_size);
        ways<CullWay{false, clusters, false, false, true, 0x1p-5f}>(device, one_size);
        total_.print("all");
        return total_.cases > 0 && total_.missed == 0 && total_.wrong == 0;
    }

private:
    bool mine() {
        made_ = 0;
        return turn_++ % share_.count == share_.first;
    }

    template <CullWay way, class Device> void ways(Device& device, std::span<const int> tile_sizes) {
        for (int kind = 0; kind < 3; ++kind)
            for (int camera = 0; camera < camera_count; ++camera)
                for (const int tile_size : tile_sizes) {
                    if (!mine()) continue;
                    const auto spheres = cull_lights(kind, 700, static_cast<unsigned>(kind * 10 + camera));
                    one<way>(device, spheres, camera, tile_size);
                    one<way>(device, cull_spots(spheres), camera, tile_size);
                    one<way>(device, cull_boxes(spheres), camera, tile_size);
                    if constexpr (way.world_space || (way.depth_test && way.slicing == lightbin::Slicing::none)) {
                        // More of each kind than of the one before it: so kinds with each other's counts lack lights.
                        const auto some = [&](int count) {
                            return std::vector<lightbin::Sphere>(spheres.begin(), spheres.begin() + count);
                        };
                        one<way>(device, MixedLights{some(200), cull_spots(some(250)), cull_boxes(some(300))}, camera,
                                 tile_size);
                    }
                }
    }

    template <class Light>
    CullCase simple(const lightbin::View& view, const std::vector<Light>& lights, std::size_t room) const {
        constexpr bool spots = std::is_same_v<Light, lightbin::Spot>, boxes = std::is_same_v<Light, lightbin::Box>;
        CullCase made{spots ? "spots" : boxes ? "boxes" : "spheres",
                      view,
                      {},
                      words_of(lights),
                      static_cast<std::uint32_t>(lights.size()),
                      static_cast<std::uint32_t>(room)};
        made.options.language = language_;
        using enum lightbin::CullKind;
        made.options.kind = spots ? spot : boxes ? box : sphere;
        made.options.lights_at.stride = sizeof(Light) / 4;
        made.options.orthographic = view.orthographic();
        return made;
    }
    CullCase simple(const lightbin::View& view, const MixedLights& lights, std::size_t room) const {
        CullCase made = simple(view, lights.spheres, room);
        made.name = "mixed";
        made.options.kind = lightbin::CullKind::mixed;
        made.lights = words_of(lights);
        made.count = static_cast<std::uint32_t>(lights.size());
        made.spots = static_cast<std::uint32_t>(lights.spots.size());
        made.boxes = static_cast<std::uint32_t>(lights.boxes.size());
        return made;
    }
    /// Returns mixed lights as words, an array behind the other, or with a number behind and before each light.
    static std::vector<std::uint32_t> words_of(const MixedLights& lights, std::size_t more = 0) {
        std::vector<std::uint32_t> words = words_of(lights.spheres, more);
        for (const auto& others : {words_of(lights.spots, more), words_of(lights.boxes, more)})
            words.insert(words.end(), others.begin(), others.end());
        return words;
    }
    template <class Light>
    static std::vector<std::uint32_t> words_of(const std::vector<Light>& lights, std::size_t more = 0) {
        return ::words_of(lights, sizeof(Light) / 4 + more, more / 2);
    }

    /// Runs all passes, in every fourth case twice, which must give the same bytes. Prints their hash, to compare runs
    /// on other devices or with more threads.
    template <class Device> CulledGrid make(Device& device, const CullCase& scene) {
        const CulledGrid grid = run_cull(device, scene);
        if (turn_ % 4 == 0 && run_cull(device, scene).hash() != grid.hash()) {
            std::printf("%s: a second run leaves other bytes\n", scene.name.c_str());
            ++total_.wrong;
        }
        std::printf("bytes of case %zu.%zu: %016llx\n", turn_, ++made_,
                    static_cast<unsigned long long>(grid.hash()));
        return grid;
    }

    /// Adds the counts of a case to the total, and prints its name and faults if it has any.
    void add(const std::string& name, const CullTally& tally) {
        if (tally.missed + tally.wrong > 0) tally.print(name.c_str());
        total_.add(tally);
    }

    /// Tests numbers of lights near the sizes of words and work groups, and pictures from one pixel to the largest.
    template <class Device> void smallest_and_largest(Device& device) {
        using namespace lightbin;
        struct Size {
            int width, height, tile_size;
            std::size_t lights;
        };
        for (const Size& size :
             {Size{333, 217, 32, 0}, Size{333, 217, 32, 1}, Size{333, 217, 32, 31}, Size{333, 217, 32, 32},
              Size{333, 217, 32, 33}, Size{333, 217, 32, 1024}, Size{333, 217, 32, 1025},
              Size{333, 217, 64, 32769}, Size{1, 1, 32, 100}, Size{64, 64, 64, 100}, Size{33, 17, 1, 100},
              Size{32768, 32768, 64, 100}, Size{0, 0, 32, 40}}) {
            if (!mine()) continue;
            const View view = builder_view(0, size.width, size.height, size.tile_size, false);
            const auto lights = cull_lights(size.lights == 32769 ? 1 : 2, size.lights, 3);
            LightCounts counts;
            const BuiltLists expected =
                binned<Options{}>({view, {}, *Slices::linear(1, 0, 1)}, lights, counts);
            const CullCase scene = simple(view, lights, 2 * expected.ids.size() + 1000);
            const CulledGrid grid = make(device, scene);
            CullTally tally = compare_lists(grid, expected);
            tally.wrong += grid.totals.rejected != counts.rejected || grid.totals.lights != lights.size();
            add("sizes", tally);
            add("sizes, masks", compare_masks(scene, grid, lights));
            if (view.tile_count() > 0 && view.viewport().width < 1000)
                total_.wrong += !read_masks(device, scene, grid);
        }
    }

    /// Tests buffers that are too small for all entries: the first entries are written, nothing beyond the end, and the
    /// need is counted. Two runs give the same bytes.
    template <class Device> void short_of_room(Device& device) {
        using namespace lightbin;
        CullTally tally;
        const View view = builder_view(0, 333, 217, 16, false);
        const auto lights = cull_lights(0, 1500, 7);
        for (const IdWidth ids : {IdWidth::u32, IdWidth::u16}) {
            if (!mine()) continue;
            CullCase scene = simple(view, lights, 30000);
            scene.options.ids = ids;
            const CulledGrid full = run_cull(device, scene);
            ++tally.cases;
            tally.wrong += run_cull(device, scene).hash() != full.hash();
            const std::uint32_t total = full.totals.entries;
            for (const std::uint32_t room : {0u, 1u, total / 2, total - 1, total}) {
                scene.room = room;
                const CulledGrid grid = run_cull(device, scene);
                ++tally.cases;
                tally.wrong +=
                    std::memcmp(&grid.totals, &full.totals, sizeof grid.totals) != 0 || total < 100;
                for (std::size_t cell = 0; cell < full.tiles.size(); ++cell) {
                    const ListRange whole = full.tiles[cell], cut = grid.tiles[cell];
                    const std::uint32_t begin = (std::min)(whole.offset, room);
                    tally.wrong += cut.offset != begin || cut.count != (std::min)(whole.count, room - begin);
                }
                const std::uint32_t blank = grid.narrow ? 0xeeee : 0xeeeeeeee;
                for (std::uint32_t i = 0; i < grid.lists.size() * (grid.narrow ? 2 : 1); ++i)
                    tally.wrong += grid.id(i) != (i < room ? full.id(i) : blank);
            }
        }
        add("rooms", tally);
    }

    /// Tests cells whose counts add up to just below 2^32 - 1, to that, and to more: the total stays at the greatest
    /// number, and so do later offsets. The counts are written where the pass `count` would put them.
    template <class Device> void beyond_32_bits(Device& device) {
        using namespace lightbin;
        if (!mine()) return;
        const View view = builder_view(0, 333, 217, 16, false);
        constexpr std::uint32_t all = 7, room = 1000;
        const auto cells = static_cast<std::uint32_t>(view.tile_count());
        const std::vector<Sphere> lights(all, {0, 0, -9, std::numeric_limits<float>::infinity()});
        const CullCase scene = simple(view, lights, room);
        const CullPlan plan = plan_of(scene);
        CullTally tally;
        // The two large counts are next to each other, or farther apart than one work group adds up.
        for (const std::uint32_t other : {11u, 200u})
            for (const std::uint64_t total : {0xfffffffeull, 0xffffffffull, 0x100000000ull, 0x180000000ull}) {
                std::vector<std::uint32_t> counts(cells, all);
                counts[10] = 0xc0000000;
                counts[other] =
                    static_cast<std::uint32_t>(total - counts[10] - all * std::uint64_t{cells - 2});
                CullBuffers written = blank_buffers(plan);
                const std::span<const CullPass> passes = cull_passes;
                run_passes(device, scene, plan, passes.first(2), written);
                std::copy(counts.begin(), counts.end(), written["scratch"].begin() + plan.constants.counts);
                run_passes(device, scene, plan, passes.subspan(2), written);

                std::vector<std::uint32_t> ranges(written["tiles"].size(), 0xeeeeeeee),
                    lists(written["lists"].size(), 0xeeeeeeee);
                std::uint64_t end = 0;
                for (std::uint32_t cell = 0; cell < cells; ++cell) {
                    const std::uint64_t begin = (std::min)(end, std::uint64_t{room});
                    for (std::uint32_t id = 0; id < all && end + id < room; ++id)
                        lists[end + id] = id;
                    end += counts[cell];
                    ranges[2 * cell] = static_cast<std::uint32_t>(begin);
                    ranges[2 * cell + 1] =
                        static_cast<std::uint32_t>((std::min)(end, std::uint64_t{room}) - begin);
                }
                ++tally.cases;
                tally.wrong += end != total || written["tiles"] != ranges || written["lists"] != lists ||
                               written["scratch"][0] != (std::min)(total, std::uint64_t{0xffffffff});
            }
        add("counts beyond 32 bits", tally);
    }

    /// With the Binner's margin, and arithmetic that rounds like the CPU's, the GPU's bytes must equal the Binner's.
    template <class Device> void as_the_binner(Device& device) {
        using namespace lightbin;
        if (!mine()) return;
        for (const int kind : {0, 1}) {
            const View view = builder_view(0, 333, 217, 16, false);
            const auto lights = cull_lights(kind, 1500, 7);
            LightCounts counts;
            const BuiltLists expected =
                binned<Options{}>({view, {}, *Slices::linear(1, 0, 1)}, lights, counts);
            CullCase scene = simple(view, lights, expected.ids.size() + 100);
            scene.binners_margin = true;
            const CulledGrid grid = make(device, scene);
            CullTally tally = compare_lists(grid, expected);
            tally.add(compare_masks(scene, grid, lights));
            tally.wrong += tally.excess;
            add("the Binner's margin", tally);
        }
    }

    /// Limits how many entries ordinary lights have beyond the Binner's: 1 in 1,000 of spheres, 1 in 400 of spots in
    /// tiles with Z bounds, 1 in 50 of the others.
    template <class Device> void ordinary(Device& device) {
        using namespace lightbin;
        if (!mine()) return;
        const View view = builder_view(0, 1920, 1080, 32, false);
        const auto bounds = cull_z_bounds(view);
        const BuiltScene tiles{view, {bounds[0], bounds[1]}, *Slices::linear(1, 0, 1)},
            clusters{view, {}, *Slices::exponential(24, 1, 100)};
        const auto lights = cull_lights(0, 3000, 1);
        std::vector<Spot> wide = cull_spots(lights);
        BuilderNumbers number(5);
        for (Spot& spot : wide) {
            spot.radius *= 3;
            spot.cos_half_angle = number(0, 0.866f);
        }
        make_ordinary<CullWay{}>(device, "ordinary spheres", tiles, lights, 1000);
        make_ordinary<CullWay{}>(device, "ordinary spots", tiles, cull_spots(lights), 50);
        make_ordinary<CullWay{true}>(device, "ordinary spots, depth test", tiles, wide, 400);
        make_ordinary<CullWay{true, Slicing::clusters}>(device, "ordinary spots, clusters, depth test",
                                                        clusters, wide, 50);
        make_ordinary<CullWay{}>(device, "ordinary boxes", tiles, cull_boxes(lights), 50);
        make_ordinary<CullWay{true}>(device, "ordinary boxes, depth test", tiles, cull_boxes(lights), 50);
        make_ordinary<CullWay{true, Slicing::clusters}>(device, "ordinary boxes, clusters, depth test", clusters,
                                                        cull_boxes(lights), 50);
    }

    template <CullWay way, class Device, class Light>
    void make_ordinary(Device& device, const char* name, const BuiltScene& scene,
                       const std::vector<Light>& lights, std::size_t one_in) {
        using namespace lightbin;
        LightCounts counts;
        const BuiltLists expected = binned<way.options()>(scene, lights, counts);
        CullCase made = simple(scene.view, lights, 2 * expected.ids.size());
        made.options.slicing = way.slicing;
        made.options.depth_test = way.depth_test;
        if (way.slicing != Slicing::none) made.slices = scene.slices;
        if (way.depth_test) made.z_bounds = cull_depths(scene, cull_z_bounds(scene.view), true, way.slicing);
        const CulledGrid grid = make(device, made);
        for (CullTally tally : {compare_lists(grid, expected), compare_masks(made, grid, lights)}) {
            tally.wrong += tally.excess * one_in > tally.entries;
            add(name, tally);
        }
    }

    /// Makes and compares one grid. World-space lights are the view-space ones moved by the inverse of a view matrix;
    /// the Binner gets the same lights.
    template <CullWay way, class Lights, class Device>
    void one(Device& device, Lights lights, int camera, int tile_size) {
        using namespace lightbin;
        constexpr Slicing slicing = way.slicing;
        const bool counted = turn_ % 4 == 1, turned = turn_ % 5 == 2;
        BuiltScene scene{builder_view(camera, 333, 217, tile_size, false, counted ? 23 : 0, counted ? 14 : 0, turned),
                         {},
                         Slices::exponential(17, 0.7f, 90)->with_margin(way.slice_margin)};
        const auto bounds = cull_z_bounds(scene.view);
        if (!way.max_only) scene.bounds.min = bounds[0];
        scene.bounds.max = bounds[1];
        CullCase made = simple(scene.view, lights, 0);
        made.lights = words_of(lights, 3);
        made.options.lights_at = {made.options.lights_at.stride + 3, 1, 4, 5, 8, 5, 8, 17, 8 + 3, 17 + 3};
        made.options.depth_test = way.depth_test;
        made.options.slicing = slicing;
        made.options.max_only = way.max_only;
        made.options.bounded = way.bounded;
        made.options.world_space = way.world_space;
        made.options.ids = turn_ % 2 == 0 ? IdWidth::u16 : IdWidth::u32;
        made.options.count_in_buffer = turn_ % 3 == 0;
        made.options.count_at = static_cast<std::uint32_t>(turn_ % 5);
        if (slicing != Slicing::none) made.slices = scene.slices;
        made.z_bounds = cull_depths(scene, bounds, way.depth_test, slicing, way.bounded);
        if (way.world_space) made.to_view = to_view();
        if constexpr (std::is_same_v<Lights, MixedLights>)
            if (made.options.count_in_buffer) {  // which leaves out some lights of each kind
                made.left_out = 20;
                const auto switch_off = [](auto& of) {
                    for (std::size_t i = of.size() - 20; i < of.size(); ++i)
                        of[i].radius = -1;
                };
                switch_off(lights.spheres), switch_off(lights.spots), switch_off(lights.boxes);
            }
        LightCounts counts;
        const auto source = source_of(lights, to_view(), way.world_space);
        const BuiltLists expected = binned<way.options(), way.bounded>(scene, source, counts);
        made.room = static_cast<std::uint32_t>(2 * expected.ids.size() + 30000);
        const CulledGrid grid = make(device, made);
        CullTally tally = compare_lists(grid, expected);
        tally.add(compare_masks(made, grid, source));
        tally.wrong += grid.totals.rejected != counts.rejected ||
                       grid.totals.lights != lights.size() - 3 * made.left_out;
        add(made.name + (way.depth_test ? ", depth test, " : ", ") + to_string(slicing) +
                (way.bounded ? ", bounded, camera " : ", camera ") + std::to_string(camera) + ", tile " +
                std::to_string(scene.view.tile_size()) + (turned ? ", turned" : ""),
            tally);
    }

    static lightbin::Matrix to_view() {
        constexpr float m[4][4] = {{0.6f, 0, -0.8f, 0}, {0, 1, 0, 0}, {0.8f, 0, 0.6f, 0}, {130, -20, 70, 1}};
        return lightbin::detail::to_matrix(m);
    }

    static std::vector<lightbin::Spot> cull_spots(const std::vector<lightbin::Sphere>& spheres) {
        BuilderNumbers number(77);
        std::vector<lightbin::Spot> spots;
        for (const lightbin::Sphere& s : spheres) {
            const float cosine = number(0, 1) < 0.15f ? number(-1, 0.1f) : number(0.5f, 1);
            spots.push_back({s.x, s.y, s.z, s.radius, number(-1, 1), number(-1, 1), number(-1, 1), cosine});
            lightbin::Spot& spot = spots.back();
            if (spots.size() % 19 == 7)
                spot.axis_x = spot.axis_y = spot.axis_z = 0;  // bad, or a whole sphere
            if (spots.size() % 38 == 7) spot.cos_half_angle = -1;
        }
        return spots;
    }

    /// Returns boxes of all shapes in and around spheres: at right angles or not, flat, tapered, cut by a ball or not.
    static std::vector<lightbin::Box> cull_boxes(const std::vector<lightbin::Sphere>& spheres) {
        BuilderNumbers number(78);
        std::vector<lightbin::Box> boxes;
        for (const lightbin::Sphere& s : spheres) {
            lightbin::Box box = {s.x, s.y, s.z, s.radius, s.x, s.y, s.z, {}, 1};
            for (float(&axis)[3] : box.half_axes)
                for (float& each : axis)
                    each = s.radius * number(-1, 1);
            const std::size_t i = boxes.size();
            if (i % 3 == 0) box = half_sphere(s, lightbin::WorldPoint{number(-1, 1), number(-1, 1), number(-1, 1)});
            if (i % 3 == 1) box.radius = std::numeric_limits<float>::infinity();
            if (i % 5 == 2) box.taper = number(0, 1) < 0.3f ? 0 : number(0, 1);
            if (i % 7 == 3) box.half_axes[i % 2][0] = box.half_axes[i % 2][1] = box.half_axes[i % 2][2] = 0;
            if (i % 61 == 9) std::fill_n(box.half_axes[0], 9, 0.0f);
            if (i % 67 == 9) box.taper = i % 2 == 0 ? 1.5f : -1e-9f;
            if (i % 71 == 9) box.half_axes[1][1] = std::numeric_limits<float>::quiet_NaN();
            if (i % 73 == 9) box.box_y = 1e30f;
            if (i % 79 == 9) box.x = 1e30f;
            boxes.push_back(box);
        }
        return boxes;
    }

    static std::array<std::vector<float>, 2> cull_z_bounds(const lightbin::View& view) {
        BuilderNumbers number(9);
        std::array<std::vector<float>, 2> bounds;
        for (std::size_t tile = 0; tile < view.tile_count(); ++tile) {
            float low = number(0.1f, 60), high = low * number(1, 2);
            if (tile % 11 == 3) high = std::numeric_limits<float>::infinity();
            if (tile % 13 == 4) std::swap(low, high);
            if (tile % 17 == 5) low = std::numeric_limits<float>::quiet_NaN();
            bounds[0].push_back(low);
            bounds[1].push_back(high);
        }
        return bounds;
    }

public:
    /// The content of the buffer `z_bounds`.
    static std::vector<float> cull_depths(const BuiltScene& scene,
                                          const std::array<std::vector<float>, 2>& bounds, bool depth_test,
                                          lightbin::Slicing slicing, bool bounded = false) {
        std::vector<float> depths;
        const auto add_bounds = [&] {
            for (std::size_t tile = 0; tile < scene.view.tile_count(); ++tile)
                depths.insert(depths.end(), {bounds[0][tile], bounds[1][tile]});
        };
        if (slicing == lightbin::Slicing::clusters)
            for (const lightbin::ShaderEdges& slab : lightbin::shader_slabs(scene.slices))
                depths.insert(depths.end(), {slab.low, slab.high});
        else
            add_bounds();
        if (depth_test || bounded)
            for (const lightbin::ShaderEdges& edge : lightbin::shader_edges(scene.view))
                depths.insert(depths.end(), {edge.low, edge.high});
        if (bounded) add_bounds();
        return depths;
    }

private:
    lightbin::ShaderLanguage language_;
    Share share_;
    std::size_t turn_ = 0, made_ = 0;
    CullTally total_;
};
