// SPDX-License-Identifier: MIT
// Every form of the shader of lightbin/shader_reduce.hpp, and runs whose results are compared with the CPU's. Also what
// tests of shaders that write buffers have in common.
#pragma once

#include "job.hpp"

#include <lightbin/lightbin.hpp>
#include <lightbin/shader_reduce.hpp>
#include <lightbin/spot.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <span>
#include <string>
#include <vector>

inline std::vector<lightbin::ReduceOptions> every_reduction(lightbin::ShaderLanguage language) {
    using namespace lightbin;
    std::vector<ReduceOptions> every;
    for (const bool fragment : {false, true})
        for (const int samples : {1, 4})
            for (const DepthFormat format :
                 {DepthFormat::float32, DepthFormat::unorm24, DepthFormat::unorm16, DepthFormat::view_depth})
                for (unsigned switches = 0; switches < 128; ++switches) {
                    if ((switches & 64) != 0 && (switches & 0x28) != 0) continue;  // a quarter of the oblique ones
                    ReduceOptions options;
                    options.language = language;
                    options.fragment = fragment;
                    options.samples = samples;
                    options.format = format;
                    options.reversed_z = switches & 1;
                    options.orthographic = switches & 2;
                    options.skip_background = switches & 4;
                    options.flip_y = switches & 8;
                    options.viewport_corner = switches & 16;
                    options.push_constants = switches & 32;
                    options.oblique = switches & 64;
                    options.prefix = prefixes[switches % std::size(prefixes)];
                    if (reduce_shader(options)) every.push_back(options);
                }
    return every;
}

// Cameras: 0 perspective, 1 reversed and infinite, 2 orthographic; with oblique near planes 3 perspective, 4 reversed,
// 5 orthographic.
constexpr int camera_count = 3, camera_count_with_oblique = 6;

/// columns, rows  in place of the tile size, unless they are 0
/// turned         exchanges x and y of the image
inline lightbin::View builder_view(int camera, int width, int height, int tile_size, bool flip_y, int columns = 0,
                                   int rows = 0, bool turned = false) {
    using namespace lightbin;
    constexpr float matrices[camera_count_with_oblique][4][4] = {
        {{1.2f, 0, 0, 0}, {0, 1.7f, 0, 0}, {0.1f, -0.2f, -1.002f, -1}, {0, 0, -0.2002f, 0}},
        {{1.2f, 0, 0, 0}, {0, -1.7f, 0, 0}, {0, 0, 0, -1}, {0, 0, 0.1f, 0}},
        {{0.06f, 0, 0, 0}, {0, 0.08f, 0, 0}, {0, 0, -0.02f, 0}, {0.1f, 0, -1, 1}},
        {{1.2f, 0, 0.2f, 0}, {0, 1.7f, 1.1f, 0}, {0.1f, -0.2f, -0.8f, -1}, {0, 0, -0.5f, 0}},
        {{1.2f, 0, -0.1f, 0}, {0, -1.7f, 0.2f, 0}, {0, 0, 0.1f, -1}, {0, 0, 0.1f, 0}},
        {{0.06f, 0, 0.01f, 0}, {0, 0.08f, -0.02f, 0}, {0, 0, -0.02f, 0}, {0.1f, 0, -1, 1}}};
    float matrix[4][4];
    for (int i = 0; i < 16; ++i)
        matrix[i / 4][i % 4] = matrices[camera][i / 4][turned && i % 4 < 2 ? 1 - i % 4 : i % 4];
    ViewOptions options{.tile_size = tile_size, .columns = columns, .rows = rows};
    if (camera == 1 || camera == 4) options.clip_depth = ClipDepth::zero_to_one;
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

/// The bytes of the buffers and textures that a shader binds, by their names in its text.
class BuilderData {
public:
    template <class Elements> void put(const char* name, const Elements& elements) {
        const auto bytes = std::as_bytes(std::span(elements));
        data_[name].assign(bytes.begin(), bytes.end());
    }

    /// Binds a struct of constants in both forms: as one uniform block, and as the uniform vectors `names`.
    void put_constants(std::span<const std::byte> bytes, std::span<const char* const> names) {
        data_["grid_block"].assign(bytes.begin(), bytes.end());
        for (std::size_t i = 0; i < names.size(); ++i)
            data_[names[i]].assign(bytes.begin() + static_cast<std::ptrdiff_t>(16 * i),
                                   bytes.begin() + static_cast<std::ptrdiff_t>(16 * i + 16));
    }

    /// Returns the bytes of a binding, found by its name without `_block`. Bytes beyond the given ones are 0xee.
    Input input(const lightbin::ShaderBinding& binding, std::string_view prefix) const {
        std::string name = binding.name.substr(prefix.size());
        if (data_.count(name) == 0) name.resize(name.find("_block"));
        Input input;
        input.binding = binding;
        input.bytes = data_.at(name);
        const std::size_t wanted = binding.bytes != 0 ? binding.bytes : input.bytes.size();
        input.bytes.resize((std::max)(wanted, std::size_t{16}), std::byte{0xee});
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

/// The lists of a Binner, of all slices.
struct BuiltLists {
    std::vector<lightbin::ListRange> tiles;
    std::vector<std::uint32_t> ids;

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

/// Returns a job that reduces a random depth buffer. Its result must hold all depths that reduce_depth() allows for,
/// and be no wider than that by more than a few steps of floats and of the format.
inline Job reduce_job(lightbin::ReduceOptions options, int camera, int width, int height,
                      int tile_size, int columns = 0, int rows = 0, bool turned = false) {
    using namespace lightbin;
    const View view = builder_view(camera, width, height, tile_size, options.flip_y, columns, rows, turned);
    options.reversed_z = view.reversed_z();
    options.orthographic = view.orthographic();
    options.oblique = view.oblique();
    const bool converted = options.format == DepthFormat::view_depth;
    const float background = converted ? std::numeric_limits<float>::infinity() : view.reversed_z() ? 0.0f : 1.0f;
    const int corner_x = options.viewport_corner ? 3 : 0, corner_y = options.viewport_corner ? 5 : 0;
    const int full_width = width + corner_x, full_height = height + corner_y;
    const auto samples = static_cast<std::size_t>(options.samples);

    // The number of rows in the texture and in the view.
    BuilderNumbers number(static_cast<unsigned>(width + camera));
    std::vector<float> texels(static_cast<std::size_t>(full_width) * static_cast<std::size_t>(full_height) *
                                  samples,
                              std::numeric_limits<float>::quiet_NaN());
    std::vector<float> depth;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (std::size_t s = 0; s < samples; ++s) {
                const int kind = (x / 7 * 5 + y / 5 * 3) % 8;
                float value = kind == 0   ? background
                              : converted ? 1 / number(0, 0.5f)
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
    const ReduceConstants constants = reduce_constants(view, corner_x, corner_y);
    constexpr const char* names[] = {"grid", "planes", "corner", "tilt"};
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
               std::to_string(tile_size) + (columns > 0 ? ", columns and rows" : "") + (turned ? ", turned" : "");
    job.stage = options.fragment ? Stage::fragment : Stage::compute;
    job.groups = {static_cast<std::uint32_t>(view.tiles_x()), static_cast<std::uint32_t>(view.tiles_y())};
    job.width = job.groups[0];
    job.height = job.groups[1];

    // The depths of the tile's samples, moved outward by a few steps of the depth format and of floats.
    const double step = options.format == DepthFormat::unorm16 ? 0x1p-15 : 0x1p-22;
    std::vector<double> lower(min.size(), 1), upper(min.size(), 0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (std::size_t s = 0; s < samples; ++s) {
                const float value = depth[static_cast<std::size_t>(y * width + x) * samples + s];
                const int across = columns > 0 ? (2 * x + 1) * columns / (2 * width) : x / tile_size,
                          down = rows > 0 ? (2 * y + 1) * rows / (2 * height) : y / tile_size;
                const auto tile = static_cast<std::size_t>(turned ? across * view.tiles_x() + down
                                                                  : down * view.tiles_x() + across);
                if (options.skip_background && value == background) continue;
                const bool unknown = std::isnan(value);
                lower[tile] = (std::min)(lower[tile], unknown ? 0.0 : static_cast<double>(value));
                upper[tile] = (std::max)(upper[tile], unknown ? 1.0 : static_cast<double>(value));
            }
    for (std::size_t tile = 0; tile < min.size(); ++tile) {
        if (min[tile] > max[tile]) {  // nothing is drawn
            job.within.insert(job.within.end(), {{min[tile], min[tile]}, {max[tile], max[tile]}});
            continue;
        }
        if (converted || view.oblique()) {
            // By so much of the depth, or of one over it.
            double least = static_cast<double>(min[tile]) * (min[tile] < 0 ? 1 + 0x1p-17 : 1 - 0x1p-17),
                   most = static_cast<double>(max[tile]) * (max[tile] < 0 ? 1 - 0x1p-17 : 1 + 0x1p-17);
            const double off = converted ? 0
                                         : 3 * (static_cast<double>(constants.margin) +
                                                static_cast<double>(constants.slope) * step);
            if (view.orthographic()) {
                least -= off, most += off;
            } else if (!converted) {
                least = 1 / (1 / least + off);
                most = 1 / most > off ? 1 / (1 / most - off) : static_cast<double>(HUGE_VALF);
            }
            job.within.push_back({static_cast<float>(least), min[tile]});
            job.within.push_back({max[tile], static_cast<float>(most)});
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

/// Returns all reduce jobs of a language; multisample textures have 4 samples and are optional.
inline std::vector<Job> reduce_jobs(lightbin::ShaderLanguage language, bool multisample) {
    using namespace lightbin;
    std::vector<Job> jobs;
    int turn = 0;
    for (const bool fragment : {false, true})
        for (const int samples : {1, 4})
            for (const DepthFormat format :
                 {DepthFormat::float32, DepthFormat::unorm24, DepthFormat::unorm16, DepthFormat::view_depth})
                for (const bool skip : {false, true})
                    for (int camera = 0; camera < camera_count_with_oblique; ++camera) {
                        ReduceOptions options;
                        options.language = language;
                        options.fragment = fragment;
                        options.samples = samples;
                        options.format = format;
                        options.skip_background = skip;
                        options.flip_y = ++turn & 1;
                        options.viewport_corner = turn & 2;
                        if ((samples > 1 && !multisample) || !reduce_shader(options)) continue;
                        struct Size {
                            int width, height, tile_size;
                        };
                        // Four, so that each third of the jobs has all of them.
                        for (const Size& size :
                             {Size{1, 1, 64}, Size{33, 17, 7}, Size{333, 217, 16}, Size{100, 60, 32}})
                            jobs.push_back(
                                reduce_job(options, camera, size.width, size.height, size.tile_size));
                        jobs.push_back(reduce_job(options, camera, 33, 17, 7, 0, 0, true));
                        jobs.push_back(reduce_job(options, camera, 33, 17, 7, 5, 40, turn % 3 == 0));
                    }
    return jobs;
}
