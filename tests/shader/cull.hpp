// SPDX-License-Identifier: MIT
// Runs the passes of lightbin/shader_cull.hpp on a device and compares their light grids with a Binner's.
#pragma once

#include "builders.hpp"
#include "reader_text.hpp"

#include <lightbin/masks.hpp>
#include <lightbin/shader_cull.hpp>

#include <bit>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <optional>

/// A pass and its options.
struct CullText {
    lightbin::CullPass pass;
    lightbin::CullOptions options;

    lightbin::ShaderText shader() const { return *lightbin::cull_shader(pass, options); }
};

/// Returns every text of the passes in a language.
inline std::vector<CullText> every_cull(lightbin::ShaderLanguage language) {
    using namespace lightbin;
    std::vector<CullText> every;
    for (const Slicing slicing : {Slicing::none, Slicing::clusters})
        for (const bool depth_test : {false, true})
            for (unsigned switches = 0; switches < 256; ++switches)
                for (int i = 0; i <= static_cast<int>(CullPass::masks); ++i) {
                    const auto pass = static_cast<CullPass>(i);
                    CullOptions options;
                    options.language = language;
                    options.slicing = slicing;
                    options.depth_test = depth_test;
                    options.kind = static_cast<CullKind>((switches & 1) + (switches >> 7 << 1));
                    options.world_space = switches & 2;
                    options.orthographic = switches & 4;
                    options.count_in_buffer = switches & 8;
                    options.max_only = switches & 16;
                    options.ids = switches & 32 ? IdWidth::u16 : IdWidth::u32;
                    options.bounded = switches & 64;
                    // Options of lights change the first pass only, kinds those with a depth test, and the format of
                    // ids the last.
                    const bool boxes = (switches & 128) != 0;  // of these, a quarter
                    const bool same = (boxes && (switches & 48) != 0) ||
                                      (pass != CullPass::project && (switches & 10) != 0) ||
                                      (pass != CullPass::project && !depth_test && (switches & 129) != 0) ||
                                      (pass != CullPass::fill && (switches & 32) != 0) ||
                                      (!depth_test && (switches & 16) != 0) ||
                                      ((slicing == Slicing::none || pass == CullPass::project ||
                                        pass == CullPass::masks) && (switches & 64) != 0);
                    options.prefix = prefixes[switches % std::size(prefixes)];
                    if (!same && cull_shader(pass, options)) every.push_back({pass, options});
                }
    return every;
}

/// The scene and options of a grid. `lights` are the words of the user's buffer.
struct CullCase {
    std::string name;
    lightbin::View view;
    lightbin::CullOptions options;
    std::vector<std::uint32_t> lights;
    std::uint32_t count = 0;
    std::uint32_t room = 0;  // list entries
    std::vector<float> z_bounds = {};
    std::optional<lightbin::Slices> slices = {};
    std::optional<lightbin::Matrix> to_view = {};
    bool binners_margin = false;  // the margins of the image axes are the Binner's
    std::uint32_t spots = 0, boxes = 0;   // of CullKind::mixed: as many of the `count` lights
    std::uint32_t left_out = 0;           // with count_in_buffer and CullKind::mixed: of each kind, so many of the last
};

/// The buffers that the passes wrote. Words that they did not write are 0xeeeeeeee.
struct CulledGrid {
    lightbin::CullTotals totals = {};
    std::vector<lightbin::ListRange> tiles;
    std::vector<std::uint32_t> lists;
    lightbin::CullTotals mask_totals = {};
    std::vector<std::uint32_t> masks;
    bool narrow = false;
    std::size_t idle_words = 0;  // words of block masks that `count` and `fill` read although they have no lights

    std::uint32_t id(std::size_t at) const {
        return narrow ? lists[at / 2] >> (at % 2 * 16) & 0xffff : lists[at];
    }
    /// Returns a hash of all bytes: FNV-1a of 64 bits (Fowler, Noll, Vo).
    std::uint64_t hash() const {
        std::uint64_t hash = 0xcbf29ce484222325;
        const auto add = [&hash](auto span) {
            for (const std::byte each : std::as_bytes(span))
                hash = (hash ^ static_cast<std::uint64_t>(each)) * 0x100000001b3;
        };
        add(std::span(&totals, 1));
        add(std::span(tiles));
        add(std::span(lists));
        add(std::span(masks));
        return hash;
    }
};

/// Returns the capacities of a scene; if the number of lights is read from a buffer, they exceed it.
inline lightbin::CullCapacity room_of(const CullCase& scene) {
    const bool mixed = scene.options.kind == lightbin::CullKind::mixed;
    return {scene.count - scene.spots - scene.boxes + (scene.options.count_in_buffer && !mixed ? 40 : 0), scene.room,
            scene.spots, scene.boxes};
}

inline lightbin::CullPlan plan_of(const CullCase& scene) {
    lightbin::CullPlan plan = *lightbin::plan_cull(scene.view, scene.options, room_of(scene),
                                                   scene.slices ? &*scene.slices : nullptr,
                                                   scene.to_view ? &*scene.to_view : nullptr);
    if (scene.binners_margin) {
        plan.constants.margin_x = lightbin::detail::camera_of(scene.view).x.margin;
        plan.constants.margin_y = lightbin::detail::camera_of(scene.view).y.margin;
    }
    return plan;
}

/// The words of the buffers that the passes write, by the buffer's name.
using CullBuffers = std::map<std::string, std::vector<std::uint32_t>>;

/// Makes buffers with a few more words than the plan asks for, to notice writes beyond the end.
inline CullBuffers blank_buffers(const lightbin::CullPlan& plan) {
    CullBuffers written;
    const auto blank = [&](const char* name, std::uint64_t bytes) {
        written[name].assign(static_cast<std::size_t>(bytes / 4 + 16), 0xeeeeeeee);
    };
    blank("scratch", plan.bytes.scratch);
    blank("tiles", plan.bytes.tiles);
    blank("lists", plan.bytes.lists);
    blank("masks", plan.bytes.masks);
    return written;
}

/// Runs passes on a device as one job for each buffer that a pass writes, as a job returns one buffer.
template <class Device>
void run_passes(Device& device, const CullCase& scene, const lightbin::CullPlan& plan,
                std::span<const lightbin::CullPass> passes, CullBuffers& written) {
    using namespace lightbin;
    BuilderData data;
    data.put_constants(std::as_bytes(std::span(&plan.constants, 1)), {});
    data.put("lights", scene.lights);
    std::vector<std::uint32_t> counts(scene.options.count_at + 1, 0xffffffff);
    counts.back() = scene.count - scene.spots - scene.boxes - scene.left_out;
    counts.insert(counts.end(), {scene.spots - scene.left_out, scene.boxes - scene.left_out});
    data.put("light_count", counts);
    data.put("z_bounds", scene.z_bounds);
    if (scene.slices) data.put("slices", shader_slices(*scene.slices));
    for (const CullPass pass : passes) {
        const ShaderText shader = *cull_shader(pass, scene.options);
        for (const auto& [name, words] : written)
            data.put(name.c_str(), words);
        for (const ShaderBinding& binding : shader.bindings) {
            if (binding.resource != ShaderResource::writable_buffer) continue;
            std::string name = binding.name.substr(scene.options.prefix.size());
            if (const auto end = name.find("_block"); end != name.npos) name.resize(end);
            Job job = builder_job(shader, scene.options.language, scene.options.prefix, data, name);
            job.name = scene.name + ", " + to_string(pass);
            const CullGroups groups = plan.groups_of(pass);
            job.groups = {groups.x, groups.y};
            written[name] = device.run(job);
        }
    }
}

/// Runs all passes on a device: those for lists, then the one for masks, without the results of the pass `offsets`.
/// Behind the last light the buffer holds lights that would be in all tiles.
template <class Device> CulledGrid run_cull(Device& device, const CullCase& scene) {
    using namespace lightbin;
    const CullPlan plan = plan_of(scene);
    CullBuffers written = blank_buffers(plan);
    run_passes(device, scene, plan, cull_passes, written);
    CulledGrid grid;
    grid.narrow = scene.options.ids == IdWidth::u16;
    std::memcpy(&grid.totals, written["scratch"].data(), sizeof grid.totals);
    const CullConstants& made = plan.constants;
    const std::uint32_t blocks = made.blocks_x * made.blocks_y * (((made.slices - 1) >> made.slice_shift) + 1);
    const std::uint32_t *const words = &written["scratch"][made.masks],
                        *const summaries = words + (made.lights + 63) / 64 * 2 * blocks;
    for (std::uint32_t i = 0; i < (made.lights + 1023) / 1024 * 32 * blocks; ++i)
        if (summaries[i / blocks / 32 * blocks + i % blocks] >> (i / blocks % 32) & 1)
            grid.idle_words += words[i] == 0 || words[i] == 0xeeeeeeee;
    grid.tiles.resize((written["tiles"].size() - 16) / 2);
    std::memcpy(grid.tiles.data(), written["tiles"].data(), grid.tiles.size() * 8);
    grid.lists = written["lists"];
    std::swap(written["lists"], written["masks"]);
    std::fill_n(written["scratch"].begin(), 3, 0xeeeeeeee);
    for (std::size_t light = plan.constants.lights; light % 64 != 0; ++light) {
        const std::size_t record = 4 + light * detail::cull_record_words(scene.options);
        written["scratch"][record] = 0;
        written["scratch"][record + 1] = 0xffffffff;
    }
    run_passes(device, scene, plan, std::span(cull_mask_passes).last(1), written);
    std::memcpy(&grid.mask_totals, written["scratch"].data(), sizeof grid.mask_totals);
    grid.masks = written["lists"];
    return grid;
}

/// How a grid compares with a Binner's.
struct CullTally {
    std::size_t cases = 0, entries = 0, missed = 0, excess = 0, wrong = 0;

    void add(const CullTally& other) {
        cases += other.cases;
        entries += other.entries;
        missed += other.missed;
        excess += other.excess;
        wrong += other.wrong;
    }
    void print(const char* name) const {
        std::printf("%s: %zu cases, %zu entries, %zu missed, %zu excess (%.4f %%), %zu wrong\n", name, cases,
                    entries, missed, excess,
                    entries == 0 ? 0.0 : 100.0 * static_cast<double>(excess) / static_cast<double>(entries),
                    wrong);
    }
};

/// Counts what a grid lacks of the expected lists, which are sorted by id, what it has beyond them, and faults of its
/// own: ids that do not ascend, ranges that do not follow each other, a wrong total.
inline CullTally compare_lists(const CulledGrid& grid, const BuiltLists& expected) {
    CullTally tally;
    tally.cases = 1;
    tally.entries = expected.ids.size();
    std::size_t end = 0;
    for (std::size_t cell = 0; cell < expected.tiles.size(); ++cell) {
        const lightbin::ListRange range = grid.tiles[cell];
        if (range.offset != end) ++tally.wrong;
        end += range.count;
        if (end > grid.lists.size() * (grid.narrow ? 2 : 1)) {
            ++tally.wrong;
            break;
        }
        std::vector<std::uint32_t> own;
        for (std::uint32_t i = 0; i < range.count; ++i) {
            const std::uint32_t id = grid.id(range.offset + i);
            if (i > 0 && id <= grid.id(range.offset + i - 1)) ++tally.wrong;
            own.push_back(id);
        }
        std::sort(own.begin(), own.end());
        const auto wanted = expected.of(cell);
        std::vector<std::uint32_t> both;
        std::set_intersection(wanted.begin(), wanted.end(), own.begin(), own.end(), std::back_inserter(both));
        tally.missed += wanted.size() - both.size();
        tally.excess += own.size() - both.size();
    }
    if (grid.totals.entries != end) ++tally.wrong;
    tally.wrong += grid.idle_words;
    return tally;
}

/// Counts bits of columns and rows that masks lack of a MaskBinner's, and bits beyond them. Faults are bits and ids of
/// lights that do not exist, a layout unlike LightMasks, and totals unlike those of the lists.
template <class Lights>
CullTally compare_masks(const CullCase& scene, const CulledGrid& grid, const Lights& lights) {
    lightbin::MaskBinner binner;
    const lightbin::LightMasks expected = *binner.bin(scene.view, lights);
    const int columns = scene.view.tiles_x(), rows = scene.view.tiles_y();
    const std::size_t room = plan_of(scene).constants.lights, each = (room + 31) / 32,
                      size = 1 + static_cast<std::size_t>(columns + 1 + rows + 32) * each;
    CullTally tally;
    tally.cases = tally.wrong = 1;
    const std::span<const std::uint32_t> words = grid.masks;
    if (words.size() != (std::max)(size, std::size_t{4}) + 16 || words[0] != each) return tally;
    const lightbin::LightMasks made(columns, rows, words.first(size), {static_cast<std::uint32_t>(32 * each)},
                                    {});
    const auto only = [](std::span<const std::uint32_t> part, std::uint32_t value) {
        return std::all_of(part.begin(), part.end(), [&](std::uint32_t word) { return word == value; });
    };
    std::vector<std::uint32_t> numbers(32 * each);
    std::iota(numbers.begin(), numbers.end(), 0);
    const auto empty = words.subspan(1 + static_cast<std::size_t>(columns) * each, each);
    tally.wrong = !only(empty, 0) || !only(words.subspan(size), 0xeeeeeeee) ||
                  !std::equal(numbers.begin(), numbers.end(), made.ids().begin(), made.ids().end()) ||
                  grid.totals.rejected != grid.mask_totals.rejected ||
                  grid.totals.visible != grid.mask_totals.visible ||
                  grid.totals.lights != grid.mask_totals.lights;
    const auto compare = [&](std::span<const std::uint32_t> own, std::span<const std::uint32_t> theirs) {
        std::vector<std::uint32_t> wanted(each);
        for (std::size_t i = 0; i < expected.ids().size(); ++i)
            wanted[expected.ids()[i] / 32] |= (theirs[i / 32] >> (i % 32) & 1) << (expected.ids()[i] % 32);
        for (std::size_t i = 0; i < each; ++i) {
            tally.entries += static_cast<std::size_t>(std::popcount(wanted[i]));
            tally.missed += static_cast<std::size_t>(std::popcount(wanted[i] & ~own[i]));
            tally.excess += static_cast<std::size_t>(std::popcount(own[i] & ~wanted[i]));
        }
        for (std::size_t i = scene.count; i < 32 * each; ++i)
            tally.wrong += own[i / 32] >> (i % 32) & 1;
    };
    for (int x = 0; x < columns; ++x)
        compare(made.column(x), expected.column(x));
    for (int y = 0; y < rows; ++y)
        compare(made.row(y), expected.row(y));
    return tally;
}

/// Reads masks by the shader snippet in every pixel, on the device that made them. Returns whether each pixel gets the
/// lights with bits in its column and its row, in ascending order.
template <class Device> bool read_masks(Device& device, const CullCase& scene, const CulledGrid& grid) {
    using namespace lightbin;
    const SnippetOptions options = {
        .language = scene.options.language, .masks = true, .grid = {5}, .prefix = scene.options.prefix};
    const ShaderText snippet = *shader_snippet(options);
    const auto columns = static_cast<std::size_t>(scene.view.tiles_x()), each = std::size_t{grid.masks[0]};
    Job job;
    job.name = scene.name + ", masks read";
    job.hlsl = detail::Dialect{options.language}.hlsl;
    job.width = static_cast<std::uint32_t>(scene.view.viewport().width);
    job.height = static_cast<std::uint32_t>(scene.view.viewport().height);
    job.groups = {(job.width + 7) / 8, (job.height + 7) / 8};
    job.text = reader_text(options, snippet, Stage::compute, job.width, job.height);
    BuilderData data;
    const GridConstants constants = grid_constants(scene.view);
    data.put("grid", std::span(&constants, 1));
    data.put("masks", grid.masks);
    for (const ShaderBinding& binding : snippet.bindings)
        job.inputs.push_back(data.input(binding, options.prefix));
    for (std::uint32_t y = 0; y < job.height; ++y)
        for (std::uint32_t x = 0; x < job.width; ++x) {
            const std::uint32_t tx = x / constants.tile_size, ty = y / constants.tile_size;
            const std::uint32_t *const column = &grid.masks[1 + tx * each],
                                *const row = &grid.masks[1 + (columns + 1 + ty) * each];
            std::uint32_t hash = 2166136261u, sum = 0, count = 0;
            for (std::uint32_t light = 0; light < 32 * each; ++light)
                if ((column[light / 32] & row[light / 32]) >> (light % 32) & 1) {
                    hash = (hash ^ light) * 16777619u;
                    sum += ++count * light;
                }
            for (const std::uint32_t word : {tx + (ty << 16), count, hash, sum})
                job.expected.push_back(word);
        }
    job.result = job.inputs.size();
    job.inputs.push_back(result_input(job.expected.size() * 4));
    return job.accepts(device.run(job));
}

/// Returns lights as words: each takes `stride` words and begins at word `first` of them.
template <class Light>
std::vector<std::uint32_t> words_of(const std::vector<Light>& lights, std::size_t stride = sizeof(Light) / 4,
                                    std::size_t first = 0) {
    std::vector<std::uint32_t> words(lights.size() * stride, 0x7fc00000);
    for (std::size_t i = 0; i < lights.size(); ++i)
        std::memcpy(words.data() + i * stride + first, &lights[i], sizeof(Light));
    if (words.empty()) words.resize(4);
    return words;
}

/// Returns ordinary lights in view (kind 0), small ones on a shell around a point (1), or difficult ones (2): around
/// the eye and touching it, through the near plane at depth 0.1 and touching it, tiny, huge and bad ones.
inline std::vector<lightbin::Sphere> cull_lights(int kind, std::size_t count, unsigned seed) {
    BuilderNumbers number(seed);
    const auto pick = [&](int choices) {
        return static_cast<int>(number(0, static_cast<float>(choices) * 0.9999f));
    };
    std::vector<lightbin::Sphere> lights;
    for (std::size_t i = 0; i < count; ++i) {
        float z = kind == 2 ? std::pow(10.0f, number(-1, 2.3f)) : number(5, 100),
              y = z * number(-0.55f, 0.55f), x = z * number(-0.98f, 0.98f),
              r = z * 0.0345f * number(0.7f, 1.4f);
        if (kind == 1) {
            const float a = number(0, 6.2831853f), c = number(-1, 1), q = std::sqrt(1 - c * c);
            x = 50 * q * std::cos(a) - 3;
            y = 50 * c;
            z = 50 * q * std::sin(a) + 10;
            r = 1;
        }
        const int trouble = kind == 2 ? pick(16) : 16;
        if (trouble < 4) {
            r = std::sqrt(x * x + y * y + z * z) * (1 + number(-0.5f, 0.5f) * std::pow(2.0f, -number(0, 23)));
        } else if (trouble < 7) {
            z = 0.1f + number(-2, 2) * r;
            x *= number(0, 3);
        } else if (trouble == 7) {
            r = std::pow(2.0f, number(-60, 60));
        } else if (trouble == 8) {
            r = 0;
        } else if (trouble == 9) {
            z = -z;
        } else if (trouble == 10) {
            constexpr float infinity = std::numeric_limits<float>::infinity(),
                            nan = std::numeric_limits<float>::quiet_NaN();
            constexpr float bad[] = {nan, infinity, -1, -0.0f, -infinity, 1e-45f, 3e38f, 1e30f};
            float* const which[] = {&r, &r, &x, &y, &z};
            *which[pick(5)] = bad[pick(8)];
        } else if (trouble == 11) {
            r = z - 0.1f;
            if (pick(2) == 0) r = std::nextafter(r, pick(2) == 0 ? 1e9f : 0.0f);
        }
        lights.push_back({x, y, -z, r});
    }
    return lights;
}
