// SPDX-License-Identifier: MIT
// Every form of the shaders of lightbin/shader_build.hpp, and runs of them: what the CPU makes is expected.
#pragma once

#include "job.hpp"

#include <lightbin/lightbin.hpp>
#include <lightbin/shader_build.hpp>
#include <lightbin/spot.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

inline std::vector<lightbin::ReduceShaderOptions> every_reduction(lightbin::ShaderLanguage language) {
    using namespace lightbin;
    std::vector<ReduceShaderOptions> every;
    for (const ShaderStage stage : {ShaderStage::compute, ShaderStage::fragment})
        for (const int samples : {1, 4})
            for (const DepthFormat format :
                 {DepthFormat::float32, DepthFormat::unorm24, DepthFormat::unorm16})
                for (unsigned switches = 0; switches < 64; ++switches) {
                    ReduceShaderOptions options;
                    options.language = language;
                    options.stage = stage;
                    options.samples = samples;
                    options.format = format;
                    options.reversed_z = switches & 1;
                    options.orthographic = switches & 2;
                    options.skip_background = switches & 4;
                    options.flip_y = switches & 8;
                    options.viewport_corner = switches & 16;
                    options.push_constants = switches & 32;
                    if (switches & 1) options.prefix = "my_";
                    if (reduce_shader(options)) every.push_back(options);
                }
    return every;
}

inline std::vector<lightbin::BuildShaderOptions> every_build(lightbin::ShaderLanguage language) {
    using namespace lightbin;
    std::vector<BuildShaderOptions> every;
    for (const BuildPass pass : {BuildPass::count, BuildPass::offsets, BuildPass::fill})
        for (const DepthTest depth_test : {DepthTest::none, DepthTest::interval, DepthTest::box})
            for (unsigned switches = 0; switches < 16; ++switches) {
                BuildShaderOptions options;
                options.language = language;
                options.pass = pass;
                options.depth_test = depth_test;
                options.max_only = switches & 1;
                options.orthographic = switches & 2;
                options.push_constants = switches & 4;
                options.slicing = switches & 8 ? Slicing::clusters : Slicing::none;
                if (switches & 1) options.prefix = "my_";
                if (build_shader(options)) every.push_back(options);
            }
    return every;
}

// Cameras: 0 perspective, 1 reversed and infinite, 2 orthographic.
constexpr int camera_count = 3;

inline lightbin::View builder_view(int camera, int width, int height, int tile_size, bool flip_y) {
    using namespace lightbin;
    constexpr float perspective[4][4] = {
        {1.2f, 0, 0, 0}, {0, 1.7f, 0, 0}, {0.1f, -0.2f, -1.002f, -1}, {0, 0, -0.2002f, 0}};
    constexpr float reversed[4][4] = {{1.2f, 0, 0, 0}, {0, -1.7f, 0, 0}, {0, 0, 0, -1}, {0, 0, 0.1f, 0}};
    constexpr float orthographic[4][4] = {
        {0.06f, 0, 0, 0}, {0, 0.08f, 0, 0}, {0, 0, -0.02f, 0}, {0.1f, 0, -1, 1}};
    const auto& matrix = camera == 0 ? perspective : camera == 1 ? reversed : orthographic;
    ViewOptions options{.tile_size = tile_size};
    if (camera == 1) options.clip_depth = ClipDepth::zero_to_one;
    if (flip_y) options.origin = WindowOrigin::upper_left;
    return *View::from_projection(matrix, {width, height}, options);
}

class BuilderNumbers {
public:
    explicit BuilderNumbers(unsigned seed) : engine_(seed) {}
    float operator()(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_() >> 8) / 16777216.0f;
    }

private:
    std::mt19937 engine_;
};

/// The bytes of what a shader binds, by the names in its text.
class BuilderData {
public:
    template <class T> void put(const char* name, std::span<const T> elements) {
        const auto bytes = std::as_bytes(elements);
        data_[name].assign(bytes.begin(), bytes.end());
    }
    template <class T> void put(const char* name, const std::vector<T>& elements) {
        put(name, std::span<const T>(elements));
    }

    /// A struct of constants: as one block, and as vectors.
    void put_constants(std::span<const std::byte> bytes, std::span<const char* const> names) {
        data_["grid_block"].assign(bytes.begin(), bytes.end());
        for (std::size_t i = 0; i < names.size(); ++i)
            data_[names[i]].assign(bytes.begin() + static_cast<std::ptrdiff_t>(16 * i),
                                   bytes.begin() + static_cast<std::ptrdiff_t>(16 * i + 16));
    }

    Input input(const lightbin::ShaderBinding& binding, std::string_view prefix) const {
        std::string name = binding.name.substr(prefix.size());
        const bool constants = binding.resource == lightbin::ShaderResource::uniform_block ||
                               binding.resource == lightbin::ShaderResource::push_constants;
        if (const auto end = name.find("_block"); end != name.npos && !constants) name.resize(end);
        Input input;
        input.binding = binding;
        input.bytes = data_.at(name);
        if (binding.bytes != 0) input.bytes.resize(binding.bytes);
        if (input.bytes.empty()) input.bytes.resize(16);
        return input;
    }

private:
    std::map<std::string, std::vector<std::byte>> data_;
};

inline Job builder_job(const lightbin::ShaderText& shader, lightbin::ShaderLanguage language,
                       std::string_view prefix, const BuilderData& data, std::string_view result) {
    Job job;
    job.hlsl = lightbin::detail::Dialect{language}.hlsl;
    job.text = version_line(language) + shader.text;
    for (const lightbin::ShaderBinding& binding : shader.bindings) {
        if (binding.name.starts_with(std::string(prefix) + std::string(result)))
            job.result = job.inputs.size();
        job.inputs.push_back(data.input(binding, prefix));
    }
    return job;
}

/// The lists of a build, of all slices.
struct BuiltLists {
    std::vector<lightbin::ListRange> tiles;
    std::vector<std::uint32_t> ids;
    int slices = 1;

    std::span<const std::uint32_t> of(std::size_t tile) const {
        return std::span(ids).subspan(tiles[tile].offset, tiles[tile].count);
    }
};

/// What a scene has beside its lights.
struct BuiltScene {
    lightbin::View view;
    lightbin::ZBounds bounds;
    lightbin::Slices slices;
};

template <lightbin::Options options, class Light>
BuiltLists binned(const BuiltScene& scene, const std::vector<Light>& lights) {
    lightbin::Binner<options> binner;
    const auto grid =
        binner.bin(scene.view, lights, lightbin::inputs_for<options>(scene.bounds, scene.slices));
    const auto ranges = grid->ranges();
    const auto ids = grid->ids();
    return {{ranges.begin(), ranges.end()}, {ids.begin(), ids.end()}, grid->slices()};
}

/// A Binner's lists.
template <class Light>
BuiltLists binned(const lightbin::BuildShaderOptions& options, const BuiltScene& scene,
                  const std::vector<Light>& lights) {
    using enum lightbin::DepthTest;
    constexpr auto clusters = lightbin::Slicing::clusters;
    const bool sliced = options.slicing == clusters;
    return sliced && options.depth_test == none
               ? binned<lightbin::Options{.slicing = clusters}>(scene, lights)
           : sliced ? binned<lightbin::Options{.depth_test = box, .slicing = clusters}>(scene, lights)
           : options.depth_test == none     ? binned<lightbin::Options{}>(scene, lights)
           : options.depth_test == interval ? binned<lightbin::Options{.depth_test = interval}>(scene, lights)
                                            : binned<lightbin::Options{.depth_test = box}>(scene, lights);
}

/// What build_shader() promises: the Binner's lists.
inline BuiltLists promised(const lightbin::BuildShaderOptions& options, const BuiltScene& scene,
                           const std::vector<lightbin::Sphere>& lights) {
    return binned(options, scene, lights);
}

/// Of spots: in each tile those of its rectangles whose least spheres meet the cell. Without boxes none is missing that the
/// Binner finds. With boxes some are: its tests are those of the whole balls and of half spaces around the cones.
inline BuiltLists promised(const lightbin::BuildShaderOptions& options, const BuiltScene& scene,
                           const std::vector<lightbin::Spot>& lights) {
    const BuiltLists rectangles = binned<lightbin::Options{}>(scene, lights),
                     spheres =
                         binned(options, scene, std::vector<lightbin::Sphere>(lights.begin(), lights.end())),
                     spots = binned(options, scene, lights);
    BuiltLists lists;
    lists.slices = spots.slices;
    for (std::size_t cell = 0; cell < spots.tiles.size(); ++cell) {
        const auto sphere = spheres.of(cell), rectangle = rectangles.of(cell % rectangles.tiles.size());
        const std::size_t begin = lists.ids.size();
        std::set_intersection(sphere.begin(), sphere.end(), rectangle.begin(), rectangle.end(),
                              std::back_inserter(lists.ids));
        lists.tiles.push_back(
            {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(lists.ids.size() - begin)});
        const auto spot = spots.of(cell), both = lists.of(cell);
        if (options.depth_test != lightbin::DepthTest::box &&
            !std::includes(both.begin(), both.end(), spot.begin(), spot.end()))
            throw std::logic_error("a build of spots would lack one that the Binner finds");
    }
    return lists;
}

/// Some spots are wider than a half sphere, that is whole spheres.
inline void add_light(std::vector<lightbin::Spot>& lights, const lightbin::Sphere& ball,
                      BuilderNumbers& number) {
    lights.push_back(
        {ball.x, ball.y, ball.z, ball.radius, number(-1, 1), number(-1, 1), number(-1, 1), number(-0.3f, 1)});
}
inline void add_light(std::vector<lightbin::Sphere>& lights, const lightbin::Sphere& ball, BuilderNumbers&) {
    lights.push_back(ball);
}

/// The three passes of a build, and the offsets where the room is short. Lights: in view, across the near
/// plane, of no and of endless radius; Z bounds: some empty, infinite or NaN.
template <class Light>
std::vector<Job> build_jobs(lightbin::BuildShaderOptions options, int camera, int width, int height,
                            int tile_size, std::size_t light_count) {
    using namespace lightbin;
    const View view = builder_view(camera, width, height, tile_size, false);
    BuilderNumbers number(static_cast<unsigned>(width + tile_size));
    std::vector<Light> lights;
    for (std::size_t i = 0; i < light_count; ++i) {
        const float z = number(0, 1) < 0.1f ? number(-3, 3) : -number(0.2f, 90);
        const float wide = camera == 2 ? 15 : z;
        const Sphere ball = {number(-1, 1) * wide, number(-0.8f, 0.8f) * wide, z,
                             number(0, 1) * number(0, 9)};
        add_light(lights, ball, number);
    }
    add_light(lights, {1, 1, -9, std::numeric_limits<float>::infinity()}, number);
    add_light(lights, {0, 0, -9, 0}, number);
    add_light(lights, {0, 0, -9, -1}, number);

    std::vector<float> min(view.tile_count()), max(view.tile_count()), both;
    for (std::size_t tile = 0; tile < min.size(); ++tile) {
        min[tile] = number(0.1f, 60);
        max[tile] = min[tile] * number(1, 2);
        if (tile % 11 == 3) max[tile] = std::numeric_limits<float>::infinity();
        if (tile % 13 == 4) std::swap(min[tile], max[tile]);
        if (tile % 17 == 5) min[tile] = std::numeric_limits<float>::quiet_NaN();
        if (tile % 19 == 6) max[tile] = std::numeric_limits<float>::quiet_NaN();
        if (tile % 23 == 7) max[tile] = 0;
        both.insert(both.end(), {min[tile], max[tile]});
    }
    ZBounds bounds;
    if (!options.max_only) bounds.min = min;
    bounds.max = max;
    const Slices slices = *Slices::from_boundaries(std::vector<float>{0, 3.5f, 9, 20, 50});
    const bool sliced = options.slicing == Slicing::clusters;
    const BuiltLists lists = promised(options, {view, bounds, slices}, lights);
    const std::vector<ListRange>& tiles = lists.tiles;
    const auto entries = static_cast<std::uint32_t>(lists.ids.size());

    options.orthographic = view.orthographic();
    const auto footprints = *shader_footprints(view, lights);
    BuilderData data;
    data.put("footprints", footprints);
    std::vector<float> z_bounds = both;
    const auto append = [&](const std::vector<ShaderEdges>& pairs) {
        for (const ShaderEdges& pair : pairs)
            z_bounds.insert(z_bounds.end(), {pair.low, pair.high});
    };
    if (sliced) {
        z_bounds.clear();
        append(shader_slabs(slices));
    }
    if (options.depth_test == DepthTest::box) append(shader_edges(view));
    data.put("z_bounds", z_bounds);
    std::vector<Job> jobs;
    const auto add = [&](BuildPass pass, std::string_view result, std::uint32_t room,
                         std::span<const std::byte> expected) {
        options.pass = pass;
        const ShaderBuild constants =
            shader_build(view, static_cast<std::uint32_t>(footprints.size()), room, lists.slices);
        constexpr const char* names[] = {"grid", "planes"};
        data.put_constants(std::as_bytes(std::span(&constants, 1)), names);
        Job job = builder_job(*build_shader(options), options.language, options.prefix, data, result);
        job.name = std::string(std::is_same_v<Light, Spot> ? "build of spots" : "build") + ", pass " +
                   std::to_string(static_cast<int>(pass)) + ", test " +
                   std::to_string(static_cast<int>(options.depth_test)) + ", camera " +
                   std::to_string(camera) +
                   (sliced             ? ", clusters"
                    : options.max_only ? ", max only"
                                       : "") +
                   ", " + std::string(result) + " " + std::to_string(width) + "x" + std::to_string(height) +
                   ", tile " + std::to_string(tile_size);
        if (pass != BuildPass::offsets)
            job.groups = {static_cast<std::uint32_t>(view.tiles_x()),
                          static_cast<std::uint32_t>(view.tiles_y() * lists.slices)};
        job.expected.resize((std::max)(expected.size(), std::size_t{16}) / 4);
        std::memset(job.expected.data(), 0xee, job.expected.size() * 4);
        std::memcpy(job.expected.data(), expected.data(), expected.size());
        jobs.push_back(job);
    };

    // What is written is 0xee before, in the list too where it has room beyond its end.
    std::vector<ListRange> counts = tiles;
    for (ListRange& range : counts)
        range.offset = 0;
    const auto blank = [](std::size_t bytes) { return std::vector<std::byte>(bytes, std::byte{0xee}); };
    data.put("tiles", blank((std::max)(tiles.size() * 8, std::size_t{16})));
    add(BuildPass::count, "tiles", entries, std::as_bytes(std::span(counts)));
    data.put("tiles", counts);
    data.put("total", blank(16));
    add(BuildPass::offsets, "total", entries, std::as_bytes(std::span(&entries, 1)));
    if (tiles.size() > 1) {
        add(BuildPass::offsets, "tiles", entries, std::as_bytes(std::span(tiles)));
        std::vector<ListRange> cut = tiles;
        const std::uint32_t room = entries / 2;
        for (ListRange& range : cut) {
            range.offset = (std::min)(range.offset, room);
            range.count = (std::min)(range.count, room - range.offset);
        }
        add(BuildPass::offsets, "tiles", room, std::as_bytes(std::span(cut)));
        data.put("tiles", cut);
        data.put("lists", blank((std::max)(entries * std::size_t{4}, std::size_t{16})));
        add(BuildPass::fill, "lists", room, std::as_bytes(std::span(lists.ids).first(room)));
        jobs.back().expected.resize((std::max)(entries, 4u), 0xeeeeeeee);
    }
    data.put("tiles", tiles);
    data.put("lists", blank((std::max)(entries * std::size_t{4}, std::size_t{16})));
    add(BuildPass::fill, "lists", entries, std::as_bytes(std::span(lists.ids)));
    return jobs;
}

/// The offsets of counts that no scene of a test reaches, held against sums of 64 bits: more than 2^32 entries, in one
/// thread's run of tiles and over several, and rooms up to the largest.
inline std::vector<Job> sum_jobs(lightbin::ShaderLanguage language) {
    using namespace lightbin;
    constexpr std::uint32_t most = 0xffffffff;
    std::vector<std::vector<std::uint32_t>> sets = {{1u << 31, 1u << 31, 5, 7},
                                                    {most, most, most, most},
                                                    {3, most - 3, 0, 1},
                                                    {3, most - 4, 0, 1},
                                                    std::vector<std::uint32_t>(1001, 1u << 26)};
    std::vector<std::uint32_t>& mixed = sets.emplace_back();
    std::mt19937 engine(7);
    for (int i = 0; i < 700; ++i) {
        const auto bits = static_cast<std::uint32_t>(engine());
        mixed.push_back(bits % 5 == 0 ? bits : bits % 5 < 3 ? bits >> 26 : bits >> 9);
    }
    std::vector<Job> jobs;
    for (const std::vector<std::uint32_t>& counts : sets)
        for (const std::uint32_t room : {0u, 1u << 30, (1u << 31) + 6, most}) {
            std::vector<ListRange> before, after;
            std::uint64_t sum = 0;
            for (const std::uint32_t count : counts) {
                const std::uint64_t begin = (std::min)(sum, std::uint64_t{room});
                before.push_back({0, count});
                after.push_back({static_cast<std::uint32_t>(begin),
                                 static_cast<std::uint32_t>((std::min)(room - begin, std::uint64_t{count}))});
                sum += count;
            }
            const auto total = static_cast<std::uint32_t>((std::min)(sum, std::uint64_t{most}));
            const ShaderBuild constants = {static_cast<std::uint32_t>(counts.size()), 1, 0, room, 0, 0, 1};
            BuildShaderOptions options;
            options.language = language;
            options.pass = BuildPass::offsets;
            BuilderData data;
            constexpr const char* names[] = {"grid", "planes"};
            data.put_constants(std::as_bytes(std::span(&constants, 1)), names);
            data.put("tiles", before);
            data.put("total", std::vector<std::uint32_t>(4, 0xeeeeeeee));
            const auto add = [&](const char* result) {
                jobs.push_back(builder_job(*build_shader(options), language, options.prefix, data, result));
                jobs.back().name = "sums of " + std::to_string(counts.size()) + " counts from " +
                                   std::to_string(counts[0]) + ", room " + std::to_string(room) + ", " +
                                   result;
            };
            add("tiles");
            jobs.back().expected.resize(2 * after.size());
            std::memcpy(jobs.back().expected.data(), after.data(), 8 * after.size());
            add("total");
            jobs.back().expected = {total, 0xeeeeeeee, 0xeeeeeeee, 0xeeeeeeee};
        }
    return jobs;
}

/// What a language runs: nothing where it has no compute shaders.
inline std::vector<Job> build_jobs(lightbin::ShaderLanguage language) {
    using namespace lightbin;
    std::vector<Job> jobs;
    if (!detail::Dialect{language}.storage_buffers) return jobs;
    jobs = sum_jobs(language);
    struct Size {
        int width, height, tile_size;
        std::size_t lights;
    };
    const auto add = [&](int camera, const BuildShaderOptions& options, const Size& size) {
        for (Job& job :
             build_jobs<Sphere>(options, camera, size.width, size.height, size.tile_size, size.lights))
            jobs.push_back(std::move(job));
    };
    const auto add_spots = [&](int camera, const BuildShaderOptions& options) {
        for (Job& job : build_jobs<Spot>(options, camera, 333, 217, 16, 150))
            jobs.push_back(std::move(job));
    };
    for (const DepthTest depth_test : {DepthTest::none, DepthTest::interval, DepthTest::box})
        for (int camera = 0; camera < camera_count; ++camera) {
            BuildShaderOptions options;
            options.language = language;
            options.depth_test = depth_test;
            for (const bool max_only : {false, true}) {
                options.max_only = max_only;
                if (max_only && depth_test == DepthTest::none) continue;
                for (const Size& size :
                     {Size{1, 1, 32, 0}, Size{33, 17, 1, 40}, Size{333, 217, 16, 300}, Size{640, 360, 8, 64}})
                    add(camera, options, size);
                add_spots(camera, options);
            }
            options.max_only = false;
            options.slicing = Slicing::clusters;
            if (!build_shader(options)) continue;
            for (const Size& size : {Size{1, 1, 32, 0}, Size{33, 17, 7, 40}, Size{333, 217, 32, 300}})
                add(camera, options, size);
            add_spots(camera, options);
        }
    return jobs;
}

/// A reduction of a random depth buffer. The result must hold what reduce_depth() allows for, and exceed it
/// by no more than a few times the float's and the format's step.
inline Job reduce_job(lightbin::ReduceShaderOptions options, int camera, int width, int height,
                      int tile_size) {
    using namespace lightbin;
    const View view = builder_view(camera, width, height, tile_size, options.flip_y);
    options.reversed_z = view.reversed_z();
    options.orthographic = view.orthographic();
    const int corner_x = options.viewport_corner ? 3 : 0, corner_y = options.viewport_corner ? 5 : 0;
    const int full_width = width + corner_x, full_height = height + corner_y;
    const auto samples = static_cast<std::size_t>(options.samples);

    // Rows as the texture counts them, and as the view does.
    BuilderNumbers number(static_cast<unsigned>(width + camera));
    std::vector<float> texels(static_cast<std::size_t>(full_width) * static_cast<std::size_t>(full_height) *
                                  samples,
                              std::numeric_limits<float>::quiet_NaN());
    std::vector<float> depth;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (std::size_t s = 0; s < samples; ++s) {
                const int kind = (x / 7 * 5 + y / 5 * 3) % 8;
                float value = kind == 0   ? (view.reversed_z() ? 0.0f : 1.0f)
                              : kind == 1 ? number(0, 1)
                              : kind == 2 ? 1 - number(0, 1e-4f)
                                          : number(0, 1e-3f);
                if (x == 20 && y == 9) value = std::numeric_limits<float>::quiet_NaN();
                if (x == 22 && y == 3) value = -2;
                if (x == 23 && y == 2) value = 7;
                depth.push_back(value);
                const int row = options.flip_y ? height - 1 - y : y;
                texels[(static_cast<std::size_t>(row + corner_y) * static_cast<std::size_t>(full_width) +
                        static_cast<std::size_t>(x + corner_x)) *
                           samples +
                       s] = value;
            }
    std::vector<float> min(view.tile_count()), max(view.tile_count());
    const DepthBuffer buffer{.depth = depth,
                             .samples = options.samples,
                             .format = options.format,
                             .skip_background = options.skip_background};
    if (!reduce_depth(view, buffer, {.min = min, .max = max})) return {};

    BuilderData data;
    data.put("depth", texels);
    data.put("z_bounds", std::vector<float>(2 * (std::max)(min.size(), std::size_t{2}), -1.0f));
    const ShaderReduce constants = shader_reduce(view, corner_x, corner_y);
    constexpr const char* names[] = {"grid", "planes", "corner"};
    data.put_constants(std::as_bytes(std::span(&constants, 1)), names);
    Job job = builder_job(*reduce_shader(options), options.language, options.prefix, data, "z_bounds");
    for (Input& input : job.inputs)
        if (input.binding.format == TexelFormat::r32f) {
            input.width = static_cast<std::uint32_t>(full_width);
            input.height = static_cast<std::uint32_t>(full_height);
            input.samples = static_cast<std::uint32_t>(samples);
        }
    job.name = "reduce, camera " + std::to_string(camera) + ", format " +
               std::to_string(static_cast<int>(options.format)) + ", " + std::to_string(samples) +
               " samples, " + std::to_string(width) + "x" + std::to_string(height) + ", tile " +
               std::to_string(tile_size);
    job.stage = options.stage == ShaderStage::compute ? Stage::compute : Stage::fragment;
    job.groups = {static_cast<std::uint32_t>(view.tiles_x()), static_cast<std::uint32_t>(view.tiles_y())};
    job.width = job.groups[0];
    job.height = job.groups[1];

    // The depths of the tile's samples, moved outward by a few steps of the format and of floats.
    const double step = options.format == DepthFormat::unorm16 ? 0x1p-15 : 0x1p-22;
    std::vector<double> lower(min.size(), 1), upper(min.size(), 0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (std::size_t s = 0; s < samples; ++s) {
                const float value = depth[static_cast<std::size_t>(y * width + x) * samples + s];
                const auto tile = static_cast<std::size_t>(y / tile_size * view.tiles_x() + x / tile_size);
                if (options.skip_background && value == (view.reversed_z() ? 0.0f : 1.0f)) continue;
                const bool unknown = std::isnan(value);
                lower[tile] = (std::min)(lower[tile], unknown ? 0.0 : static_cast<double>(value));
                upper[tile] = (std::max)(upper[tile], unknown ? 1.0 : static_cast<double>(value));
            }
    for (std::size_t tile = 0; tile < min.size(); ++tile) {
        if (min[tile] > max[tile]) {  // nothing is drawn
            job.within.insert(job.within.end(), {{min[tile], min[tile]}, {max[tile], max[tile]}});
            continue;
        }
        const auto widened =
            view.view_depths((std::max)(lower[tile] - step, 0.0), (std::min)(upper[tile] + step, 1.0));
        const float rounding = 0x1p-17f;
        const float planes =
            options.orthographic ? std::fabs(view.near_depth()) + std::fabs(view.far_depth()) : 0;
        job.within.push_back({widened.min - rounding * (std::fabs(widened.min) + planes), min[tile]});
        job.within.push_back({max[tile], widened.max + rounding * (std::fabs(widened.max) + planes)});
    }
    while (job.within.size() < 4 && job.stage == Stage::compute)
        job.within.push_back({-1, -1});  // the buffer's end, not written
    return job;
}

/// What a language runs. Multisample textures have 4 samples, or are left out.
inline std::vector<Job> reduce_jobs(lightbin::ShaderLanguage language, bool multisample) {
    using namespace lightbin;
    std::vector<Job> jobs;
    int turn = 0;
    for (const ShaderStage stage : {ShaderStage::compute, ShaderStage::fragment})
        for (const int samples : {1, 4})
            for (const DepthFormat format :
                 {DepthFormat::float32, DepthFormat::unorm24, DepthFormat::unorm16})
                for (const bool skip : {false, true})
                    for (int camera = 0; camera < camera_count; ++camera) {
                        ReduceShaderOptions options;
                        options.language = language;
                        options.stage = stage;
                        options.samples = samples;
                        options.format = format;
                        options.skip_background = skip;
                        options.flip_y = ++turn & 1;
                        options.viewport_corner = turn & 2;
                        if ((samples > 1 && !multisample) || !reduce_shader(options)) continue;
                        struct Size {
                            int width, height, tile_size;
                        };
                        for (const Size& size : {Size{1, 1, 64}, Size{33, 17, 7}, Size{333, 217, 16}})
                            jobs.push_back(
                                reduce_job(options, camera, size.width, size.height, size.tile_size));
                    }
    return jobs;
}
