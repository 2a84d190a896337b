// SPDX-License-Identifier: MIT
// Every form of the snippet, and runs of them for which it is known what every pixel must read.
#pragma once

#include "builders.hpp"
#include "reader_text.hpp"

#include <lightbin/encode.hpp>
#include <lightbin/lightbin.hpp>
#include <lightbin/masks.hpp>
#include <lightbin/shader.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

struct ScreenSize {
    int width, height, tile_size;
};

/// Returns the options with every storage and encoding of lists that a language has.
inline std::vector<lightbin::SnippetOptions> every_list(lightbin::SnippetOptions options) {
    using namespace lightbin;
    const detail::Dialect dialect = detail::Dialect{options.language};
    std::vector<SnippetOptions> every;
    for (const ListStorage storage :
         {ListStorage::storage_buffer, ListStorage::texel_buffer, ListStorage::texture_2d,
          ListStorage::uniform_block}) {
        if ((storage == ListStorage::storage_buffer && !dialect.storage_buffers) ||
            (storage == ListStorage::texel_buffer && (dialect.es || dialect.webgpu)))
            continue;
        options.storage = storage;
        const bool texels = storage == ListStorage::texel_buffer || storage == ListStorage::texture_2d;
        for (const ListEncoding encoding : {ListEncoding::offset_count, ListEncoding::sentinel})
            for (const IdWidth ids : {IdWidth::u8, IdWidth::u16, IdWidth::u32}) {
                options.format = {encoding, ids, encoding == ListEncoding::sentinel ? 5u : 0u};
                for (const bool packed : {false, true})
                    for (const bool block : {false, true}) {
                        if (packed && (!texels || ids == IdWidth::u32)) continue;
                        if (block &&
                            (encoding != ListEncoding::offset_count || storage == ListStorage::uniform_block))
                            continue;
                        options.packed_ids = packed;
                        options.tiles_in_uniform_block = block;
                        every.push_back(options);
                    }
            }
        if (options.slicing == Slicing::clusters || options.views > 1) continue;
        every.push_back(options);
        every.back().format = {};
        every.back().masks = true;
    }
    return every;
}

constexpr unsigned switch_count = 16;  // sets of the options that are on or off

inline lightbin::SnippetOptions with_switches(lightbin::SnippetOptions options, unsigned switches) {
    options.prefix = prefixes[(switches + 3 * static_cast<unsigned>(options.language)) % std::size(prefixes)];
    options.flip_y = switches & 1;
    options.viewport_corner = switches & 2;
    options.tile_size = switches & 4 ? 16 : 0;
    options.heat_map = switches & 8;
    // Some have one of these, and one set both.
    const unsigned turn = switches / 2;
    options.columns_and_rows = turn == 1 || turn == 4 || turn == 7;
    options.turned = turn == 2 || turn == 5 || turn == 7;
    // Only one of these options is on at a time.
    options.view_check = switches / 4 == 3;
    options.list_check = switches / 4 == 0;
    options.window = switches / 4 == 1;
    return options;
}

/// Returns every storage of lists and constants in a language, with all switches off. Bindings of different kinds get
/// different numbers, because glslang counts HLSL's registers t, u and b together.
inline std::vector<lightbin::SnippetOptions> every_list(lightbin::ShaderLanguage language,
                                                       lightbin::Slicing slicing) {
    const lightbin::detail::Dialect dialect = lightbin::detail::Dialect{language};
    const int set = dialect.spaces ? 1 : 0;
    lightbin::SnippetOptions options;
    options.language = language;
    options.slicing = slicing;
    options.texture_width = 37;  // no power of two
    options.max_tiles = 100;
    options.max_entries = 400;
    options.max_slices = 30;
    options.uniform_block_bytes = 65536;
    options.tiles = {3, set};
    options.lists = {4, set};
    options.grid = {5, 0};
    options.slices = {6, set};
    options.bins = {7, set};
    options.view = {8, set};

    std::vector<lightbin::SnippetOptions> every = every_list(options);
    options.push_constants = dialect.vulkan;
    if (dialect.vulkan)
        for (const lightbin::SnippetOptions& list : every_list(options))
            every.push_back(list);
    return every;
}

/// Returns the options for masks with loops by wave (subgroup) operations, if the language has them.
inline std::vector<lightbin::SnippetOptions> every_wave_list(lightbin::ShaderLanguage language,
                                                            lightbin::Slicing slicing) {
    std::vector<lightbin::SnippetOptions> every = every_list(language, slicing);
    for (lightbin::SnippetOptions& list : every)
        list.wave_loop = true;
    std::erase_if(every, [](const lightbin::SnippetOptions& list) { return !shader_snippet(list); });
    return every;
}

/// Returns the options for lists of two views.
inline std::vector<lightbin::SnippetOptions> every_list_of_views(lightbin::ShaderLanguage language,
                                                                lightbin::Slicing slicing) {
    std::vector<lightbin::SnippetOptions> every = every_list(language, slicing);
    std::erase_if(every, [](const lightbin::SnippetOptions& list) { return list.masks; });
    for (lightbin::SnippetOptions& list : every)
        list.views = 2;
    return every;
}

/// Returns the options of every storage with every set of switches. With depth slices each has two sets in turn, so
/// that every switch is on in some and off in others; with wave loops or two views one.
inline std::vector<lightbin::SnippetOptions> every_reader(lightbin::ShaderLanguage language) {
    using lightbin::Slicing;
    std::vector<lightbin::SnippetOptions> every;
    for (const Slicing slicing : {Slicing::none, Slicing::clusters, Slicing::z_bins}) {
        unsigned turn = 0;
        for (const lightbin::SnippetOptions& list : every_list(language, slicing)) {
            ++turn;
            for (unsigned switches = 0; switches < switch_count; ++switches)
                if (slicing == Slicing::none || switches == turn % switch_count ||
                    (switches ^ turn % switch_count) == switch_count - 1)
                    every.push_back(with_switches(list, switches));
        }
        for (const lightbin::SnippetOptions& list : every_wave_list(language, slicing))
            every.push_back(with_switches(list, ++turn % switch_count));
        for (const lightbin::SnippetOptions& list : every_list_of_views(language, slicing))
            every.push_back(with_switches(list, ++turn % switch_count));
    }
    return every;
}

/// Returns `count` spheres, about 40 of them in view, half of these close behind another one; the last one is in view,
/// the rest are behind the eye. Each in view exists `copies` times.
inline std::vector<lightbin::Sphere> reader_lights(std::size_t count, std::size_t copies) {
    std::mt19937 engine(5);
    const auto number = [&](float low, float high) {
        return low + (high - low) * static_cast<float>(engine() >> 8) / 16777216.0f;
    };
    std::vector<lightbin::Sphere> lights(count, {0, 0, 5, 1});
    for (std::size_t i = 1; i <= 40; ++i) {
        const float z = -number(2, 20);
        const std::size_t last = count * ((i + 1) / 2) / 20 - 1 - i % 2;
        lights[last] = {number(-0.8f, 0.8f) * z, number(-0.6f, 0.6f) * z, z, number(0.05f, 0.2f) * -z};
        for (std::size_t copy = 1; copy < copies; ++copy)
            lights[last - 10 * copy] = lights[last];
    }
    return lights;
}

/// Pads a texture to whole rows, as wide as the text says or as the grid has columns of tiles.
inline void fit_texture(Input& input, int tiles_x) {
    input.width = input.binding.width ? input.binding.width : static_cast<std::uint32_t>(tiles_x);
    const std::size_t row = std::size_t{input.width} * input.binding.stride;
    input.height = static_cast<std::uint32_t>((input.bytes.size() + row - 1) / row);
    input.bytes.resize(row * input.height, std::byte{0xee});
}

/// Returns a run of a snippet, fit to a screen: options.tile_size other than 0 becomes that of the screen.
/// unset      the constants of the grid are 0: no pixel has lights
/// multiview  the views are drawn at once
template <lightbin::Slicing slicing>
Job reader_job(lightbin::SnippetOptions options, Stage stage, const ScreenSize& screen, bool unset,
               bool multiview) {
    using namespace lightbin;
    constexpr Options of_binner = {.slicing = slicing};
    const Slices slices = reader_slices();
    std::vector<Binner<of_binner>> binners(options.views);
    const std::vector<Sphere> spheres = reader_lights(reader_light_count(options), options.masks ? 8 : 1);
    std::vector<View> views;
    std::vector<ViewConstants> of_views;
    std::vector<LightGrid<std::uint32_t>> grids;
    std::vector<BinRange> bins;
    for (Binner<of_binner>& binner : binners) {
        const float aside = view_shift * static_cast<float>(views.size());
        float projection[4][4] = {
            {scale_x, 0, 0, 0}, {0, scale_y, 0, 0}, {aside, 0, -1.01f, -1}, {0, 0, -0.2f, 0}};
        for (auto& column : projection)
            if (options.turned) std::swap(column[0], column[1]);
        ViewOptions of_view = {.tile_size = screen.tile_size};
        if (options.columns_and_rows) of_view.columns = 5, of_view.rows = 4;
        views.push_back(*View::from_projection(projection, {screen.width, screen.height}, of_view));
        of_views.push_back(view_constants(views.back()));
        const auto inputs = inputs_for<of_binner>({}, slices);
        grids.push_back(*binner.bin(views.back(), spheres, inputs));
        bins.insert(bins.end(), grids.back().ranks().bins.begin(), grids.back().ranks().bins.end());
    }
    // Makes the grids of the views one after another.
    std::size_t cells = 0, entries = 0;
    for (const auto& each : grids) {
        cells += each.ranges().size();
        entries += each.ids().size();
    }
    std::vector<ListRange> all_ranges(cells);
    std::vector<std::uint32_t> all_ids(entries);
    auto grid = grids[0].copy_to(all_ranges, all_ids);
    for (std::size_t i = 1; i < grids.size(); ++i)
        grid = grids[i].copy_to(all_ranges, all_ids, *grid);
    std::vector<std::byte> lists(encoded_bytes(options.format, cells, entries));
    Job job;
    job.name = to_string(options.language) + std::string(" ") + to_string(options.storage) +
               (stage == Stage::compute ? ", compute, " : ", fragment, ") + std::to_string(screen.width) +
               "x" + std::to_string(screen.height) + ", tile " + std::to_string(screen.tile_size) +
               (options.columns_and_rows ? ", columns and rows" : "") + (options.turned ? ", turned" : "");
    if (options.tile_size != 0) options.tile_size = screen.tile_size;
    options.max_tiles = static_cast<std::uint32_t>(grid->ranges().size());
    options.max_entries = static_cast<std::uint32_t>(grid->ids().size()) + 1;  // 0 would be unknown
    const auto snippet = shader_snippet(options);
    if (!snippet || !encode(*grid, options.format, lists)) return job;  // no text: the runner refuses it

    job.stage = stage;
    job.hlsl = detail::Dialect{options.language}.hlsl;
    job.width = static_cast<std::uint32_t>(screen.width + beyond);
    const auto band = static_cast<std::uint32_t>(screen.height + beyond);
    job.views = multiview ? options.views : 1;
    job.height = band * (options.views > 1 && !multiview ? options.views + 1 : 1);
    job.corner = {corner_x, corner_y};
    job.groups = {(job.width + 7) / 8, (job.height + 7) / 8};
    job.text = reader_text(options, *snippet, stage, job.width, job.height, multiview);
    GridConstants constants = grid_constants(views[0], corner_x, corner_y);
    if (unset) constants = {0, 0, 0, 0, corner_x, corner_y};
    MaskBinner mask_binner;
    const auto masks = slicing == Slicing::z_bins ? mask_binner.bin(views[0], spheres, slices)
                                                  : mask_binner.bin(views[0], spheres);
    BuilderData data;
    data.put("grid", std::span(&constants, 1));
    data.put("corner", std::span(&constants.corner_x, 2));
    data.put("image", of_views);
    data.put("depths", std::span(&of_views[0].forward, 4));
    data.put("tiles", grid->ranges());
    data.put("lists", lists);
    data.put("slices", shader_slices(slices));
    data.put("bins", bins);
    data.put("masks", masks->words());
    for (const ShaderBinding& binding : snippet->bindings) {
        job.inputs.push_back(data.input(binding, options.prefix));
        if (binding.resource == ShaderResource::texture_2d) fit_texture(job.inputs.back(), grid->tiles_x());
    }

    // The tile size in the shader: the constants may be unset, and rows below the viewport wrap around.
    const std::uint32_t tile_size =
        unset && options.tile_size == 0 ? 1 : static_cast<std::uint32_t>(screen.tile_size);
    const auto tile_of = [&](std::uint32_t pixel, int tiles, std::uint32_t side) {
        if (!options.columns_and_rows) return pixel / tile_size;
        return (2 * pixel + 1) * (unset ? 0 : static_cast<std::uint32_t>(tiles)) / (std::max)(2 * side, 1u);
    };
    const std::vector<float> depths = reader_depths();
    for (std::uint32_t y = 0; y < job.height * job.views; ++y)
        for (std::uint32_t x = 0; x < job.width; ++x) {
            const std::uint32_t view = y / band, own_y = y % band,
                                height = options.turned ? constants.width : constants.height;
            std::uint32_t column = x, row = options.flip_y ? height - 1 - own_y : own_y;
            if (options.turned) std::swap(column, row);
            const std::uint32_t tx = tile_of(column, grid->tiles_x(), constants.width),
                                ty = tile_of(row, grid->tiles_y(), constants.height);
            std::uint32_t hash = 2166136261u, sum = 0, count = 0, listed = 0;
            const float depth = depths[static_cast<std::size_t>(5 * x + 3 * own_y) % depths.size()];
            const int slice = slices.slice_at(depth);
            const BinRange all = {0, 0xffffffff};
            const bool inside = column < constants.width && row < constants.height && view < options.views;
            const BinRange bin = slicing == Slicing::z_bins && inside
                                     ? grids[view].ranks().bins[static_cast<std::size_t>(slice)]
                                     : all;
            std::span<const std::uint32_t> list;
            if (inside)
                list = grids[view].lights_in(static_cast<int>(tx), static_cast<int>(ty),
                                             slicing == Slicing::clusters ? slice : 0);
            for (const std::uint32_t id : list) {
                if (options.format.encoding == ListEncoding::sentinel && listed++ == options.format.capacity)
                    break;
                if (id < bin.least || id > bin.greatest) continue;
                const std::uint32_t light =
                    options.masks && slicing == Slicing::z_bins ? grids[view].ranks().order[id] : id;
                hash = (hash ^ light) * 16777619u;
                sum += ++count * light;
            }
            for (const std::uint32_t word : {tx + (ty << 16), count, hash, sum})
                job.expected.push_back(word);
        }
    if (stage == Stage::compute) {
        job.result = job.inputs.size();
        job.inputs.push_back(result_input(job.expected.size() * 4));
    }
    return job;
}

/// A run that is not put together yet.
struct ReaderRun {
    lightbin::SnippetOptions options;
    Stage stage;
    ScreenSize screen;
    bool unset = false, multiview = false;
    Job job() const {
        using lightbin::Slicing;
        return options.slicing == Slicing::none
                   ? reader_job<Slicing::none>(options, stage, screen, unset, multiview)
               : options.slicing == Slicing::clusters
                   ? reader_job<Slicing::clusters>(options, stage, screen, unset, multiview)
                   : reader_job<Slicing::z_bins>(options, stage, screen, unset, multiview);
    }
};

/// Returns runs of every storage with two views, drawn by multiview in fragment shaders; other options take turns.
inline std::vector<ReaderRun> multiview_runs(lightbin::ShaderLanguage language) {
    using lightbin::Slicing;
    std::vector<ReaderRun> runs;
    const auto add = [&](const lightbin::SnippetOptions& list) {
        runs.push_back({with_switches(list, static_cast<unsigned>(runs.size()) % switch_count),
                        Stage::fragment,
                        {33, 17, 7},
                        false,
                        true});
    };
    for (const Slicing slicing : {Slicing::none, Slicing::clusters, Slicing::z_bins}) {
        for (const lightbin::SnippetOptions& list : every_list_of_views(language, slicing))
            add(list);
    }
    return runs;
}

/// What a language runs: every list, flipped and not, in fragment and compute shaders, at each small screen; the other
/// options take turns, and now and then the constants are not set. At the large screen: one width of ids. With slicing,
/// wave loops or two views: flipped in compute shaders, not flipped in fragment shaders, or where there are only those
/// in both, at two small screens in turns.
/// each_flip  false: half of the small screens are flipped, the other half not; the next list has it the other way round
/// waves      the device has what wave loops need
inline std::vector<ReaderRun> reader_runs(lightbin::ShaderLanguage language, bool each_flip = true,
                                          bool waves = false) {
    using lightbin::Slicing;
    constexpr ScreenSize small[] = {{33, 17, 7},  {33, 17, 16}, {33, 17, 1},
                                    {33, 17, 64}, {1, 1, 1},    {1, 1, 64}};
    constexpr ScreenSize large = {1919, 1079, 32};
    std::vector<ReaderRun> runs;
    const bool computes = lightbin::detail::Dialect{language}.storage_buffers;
    unsigned turn = 0;
    const auto add_list = [&](const lightbin::SnippetOptions& list, unsigned place, unsigned flip,
                              Stage stage) {
        const auto add = [&](const ScreenSize& screen) {
            turn = (turn + 1) % (switch_count / 2);
            runs.push_back({with_switches(list, 2 * turn + flip), stage, screen});
            if (turn == 3) runs.push_back({with_switches(list, 2 * (place % 8) + flip), stage, screen, true});
        };
        const bool few = list.slicing != Slicing::none || list.wave_loop || list.views > 1;
        if (few && computes && (stage == Stage::compute) != (flip == 1)) return;
        for (unsigned i = 0; i < (few ? 2 : std::size(small)); ++i)
            if ((each_flip && !few) || (i + flip + place) % 2 == 0) add(small[i]);
        if (!few && (list.masks || list.format.ids == lightbin::IdWidth::u16)) add(large);
    };
    for (const Slicing slicing : {Slicing::none, Slicing::clusters, Slicing::z_bins}) {
        unsigned place = 0;
        std::vector<lightbin::SnippetOptions> lists = every_list(language, slicing);
        if (waves)
            for (const lightbin::SnippetOptions& list : every_wave_list(language, slicing))
                lists.push_back(list);
        for (const lightbin::SnippetOptions& list : every_list_of_views(language, slicing))
            lists.push_back(list);
        for (const lightbin::SnippetOptions& list : lists) {
            for (unsigned flip = 0; flip < 2; ++flip)
                for (const Stage stage : {Stage::fragment, Stage::compute})
                    if (stage == Stage::fragment || computes) add_list(list, place, flip, stage);
            ++place;
        }
    }
    return runs;
}
