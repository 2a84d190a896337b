// SPDX-License-Identifier: MIT
// Bytes to calls of the C side, with whatever numbers, pointers that may be null, arrays of exactly the size that is
// stated, and memory that may run out. A call is refused by a sentence, or its lists are sound; nothing leaks.
#define LIGHTBIN_IMPLEMENTATION
#include <lightbin/lightbin.h>

#include "bytes.hpp"

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

namespace {

void require(bool condition, const char* what) {
    if (condition) return;
    std::fprintf(stderr, "%s\n", what);
    std::abort();
}

struct Heap {
    long blocks = 0, left = 0;  ///< allocated and not released; how many allocations succeed from now on
};

void* allocate(void* user, std::size_t bytes) {
    Heap& heap = *static_cast<Heap*>(user);
    if (heap.left-- <= 0 || bytes > 4'000'000) return nullptr;
    ++heap.blocks;
    return std::malloc(bytes);
}

void release(void* user, void* memory) {
    --static_cast<Heap*>(user)->blocks;
    std::free(memory);
}

void run_tasks(void*, std::size_t count, lightbin_task task, void* context) {
    while (count > 0)
        task(context, --count);
}

/// Whether a call succeeded. If not, its sentence is sound.
bool succeeded(const lightbin_result& result) {
    char text[600] = "";
    const std::size_t length = lightbin_error_text(result, text, sizeof text);
    require(length > 5 && length < 512 && std::strlen(text) == length, "no sentence");
    require(result.name != nullptr && result.error != LIGHTBIN_CALLBACK_THREW, "no name, or an exception");
    return result.error == LIGHTBIN_OK;
}

/// Mostly a small number that makes sense, sometimes any.
std::int32_t take_number(Bytes& bytes, unsigned below) {
    const unsigned kind = bytes.byte();
    return kind < 240 ? static_cast<std::int32_t>(kind % below) : bytes.take<std::int32_t>();
}

void check_grid(const lightbin_grid& grid) {
    std::uint64_t at = 0;
    for (std::uint64_t i = 0; i < grid.range_count; ++i) {
        const lightbin_range range = grid.ranges[i];
        require(range.offset == at && range.offset + std::uint64_t{range.count} <= grid.id_count,
                "a range outside of the ids");
        at += range.count;
        std::uint32_t least = 0;
        for (std::uint64_t k = range.offset; k < at; ++k) {
            const std::uint32_t id = grid.id_bytes == 2 ? static_cast<const std::uint16_t*>(grid.ids)[k]
                                                        : static_cast<const std::uint32_t*>(grid.ids)[k];
            require(id >= least && id < grid.lights, "an id that does not ascend or is no light's");
            least = id + 1;
        }
    }
    require(at == grid.id_count, "ids in no list");
}

/// Makes of a finished grid what can be made of it.
void use_grid(const lightbin_grid& grid, lightbin_budget* budget, lightbin_grid_union* grid_union,
              Bytes& bytes) {
    std::vector<std::uint32_t> entries(bytes.flag() ? grid.lights : bytes.byte());
    std::uint32_t listed = 0;
    if (succeeded(lightbin_count_entries(&grid, entries.data(), entries.size(), &listed)))
        require(listed <= grid.lights - grid.rejected - grid.culled, "lights in lists that are not in view");
    std::vector<lightbin_kind_range> kinds(grid.range_count);
    succeeded(lightbin_split_kinds(&grid, kinds.data(), kinds.size()));
    std::vector<float> weights(bytes.flag() ? grid.lights : bytes.byte());
    for (float& weight : weights)
        weight = static_cast<float>(bytes.byte());
    lightbin_grid limited = {}, united = {};
    limited.size = united.size = sizeof limited;
    lightbin_cut cut = {};
    cut.size = sizeof cut;
    if (succeeded(lightbin_limit_grid(budget, &grid, weights.data(), weights.size(), bytes.byte(),
                                      bytes.take<std::uint16_t>(), &limited, &cut))) {
        check_grid(limited);
        require(limited.id_count + cut.entries_cut == grid.id_count, "entries that are neither kept nor cut");
        if (succeeded(lightbin_unite_grids(grid_union, &limited, &grid, &united)))
            require(united.id_count == grid.id_count, "a union of a grid and a part of it is another grid");
        std::vector<lightbin_range> ranges(grid.range_count + limited.range_count);
        std::vector<char> ids((grid.id_count + limited.id_count) * grid.id_bytes);
        lightbin_grid first = grid;
        if (succeeded(lightbin_copy_grid(&first, ranges.data(), ranges.size(), ids.data(),
                                         ids.size() / grid.id_bytes)) &&
            succeeded(lightbin_append_grid(&limited, &first, ranges.data(), ranges.size(), ids.data(),
                                           ids.size() / grid.id_bytes)))
            check_grid(limited);
    }
}

/// Floats of lights in an array of exactly the size that they take, or as the bytes have it, nothing.
lightbin_floats take_floats(Bytes& bytes, std::size_t count, std::size_t each,
                            std::vector<std::unique_ptr<char[]>>& memory) {
    const std::size_t stride = bytes.byte() % 40;
    if (bytes.byte() > 250) return {nullptr, stride};
    const std::size_t size = count == 0 ? 1 : (count - 1) * stride + each * sizeof(float);
    memory.push_back(std::make_unique<char[]>(size));
    for (std::size_t i = 0; i + sizeof(float) <= size; i += sizeof(float)) {
        const unsigned kind = bytes.byte();
        const float value = kind < 250 ? (static_cast<float>(kind) - 125) / 10 : bytes.take<float>();
        std::memcpy(memory.back().get() + i, &value, sizeof value);
    }
    return {memory.back().get(), stride};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    Heap heap;
    heap.left = bytes.flag() ? 1'000'000 : static_cast<long>(bytes.byte());
    const lightbin_allocator allocator = {allocate, release, &heap};
    lightbin_view* view = nullptr;
    lightbin_slices* slices = nullptr;
    lightbin_binner* binner = nullptr;

    float projection[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.2f, 0};
    if (bytes.byte() > 200) projection[bytes.byte() % 16] = bytes.take<float>();
    lightbin_view_options view_options = {};
    view_options.size = sizeof view_options;
    view_options.width = take_number(bytes, 200), view_options.height = take_number(bytes, 200);
    view_options.tile_size = take_number(bytes, 40), view_options.clip_depth = take_number(bytes, 2);
    view_options.origin = take_number(bytes, 2);
    view_options.projection.floats = projection;
    view_options.projection.layout = bytes.byte() > 240 ? take_number(bytes, 3) : 0;
    // Pixels-sized tiles of a large viewport would take the fuzzer's time.
    if (view_options.tile_size < 4 && view_options.tile_size != 0) view_options.tile_size += 4;
    if (view_options.width > 400 || view_options.height > 400) view_options.tile_size = 512;
    succeeded(lightbin_view_create(&view_options, &allocator, &view));
    succeeded(lightbin_slices_exponential(take_number(bytes, 20), static_cast<float>(bytes.byte()) / 10,
                                          static_cast<float>(bytes.byte()),
                                          static_cast<float>(bytes.byte()) / 500, &allocator, &slices));
    lightbin_binner_options options = {};
    options.size = sizeof options;
    options.ids = take_number(bytes, 3), options.footprint = take_number(bytes, 2);
    options.depth_test = take_number(bytes, 4), options.slicing = take_number(bytes, 3);
    options.coverage = bytes.flag();
    succeeded(lightbin_binner_create(&options, &allocator, &binner));

    std::size_t tiles = 0;
    lightbin_view_info info = {};
    info.size = sizeof info;
    if (succeeded(lightbin_view_describe(view, &info)))
        tiles = static_cast<std::size_t>(info.tiles_x) * static_cast<std::size_t>(info.tiles_y);
    std::vector<float> bounds_memory(2 * tiles);
    for (std::size_t i = 0; i < tiles; ++i) {
        bounds_memory[i] = static_cast<float>(bytes.byte()) / 16;
        bounds_memory[tiles + i] = bounds_memory[i] + static_cast<float>(bytes.byte()) / 16;
    }
    lightbin_z_bounds bounds = {};
    bounds.size = sizeof bounds;
    bounds.min = bytes.flag() ? nullptr : bounds_memory.data(), bounds.max = bounds_memory.data() + tiles;
    bounds.tiles = tiles;
    lightbin_budget* budget = nullptr;
    lightbin_grid_union* grid_union = nullptr;
    succeeded(lightbin_budget_create(&allocator, &budget));
    succeeded(lightbin_grid_union_create(&allocator, &grid_union));
    lightbin_threads threads = {sizeof threads, bytes.byte(), run_tasks, nullptr, bytes.flag() ? -1.0 : 0.0};
    for (int call = 0; call < 3 && !bytes.empty(); ++call) {
        std::vector<std::unique_ptr<char[]>> memory;
        lightbin_lights lights = {};
        lights.size = sizeof lights;
        lights.spheres.count = bytes.byte() % 20, lights.spots.count = bytes.flag() ? 0 : bytes.byte() % 20;
        lights.spheres.centre = take_floats(bytes, lights.spheres.count, 3, memory);
        lights.spheres.radius = take_floats(bytes, lights.spheres.count, 1, memory);
        lights.spots.centre = take_floats(bytes, lights.spots.count, 3, memory);
        lights.spots.radius = take_floats(bytes, lights.spots.count, 1, memory);
        lights.spots.axis = take_floats(bytes, lights.spots.count, 3, memory);
        lights.spots.cosine = take_floats(bytes, lights.spots.count, 1, memory);
        lights.boxes.count = bytes.flag() ? 0 : bytes.byte() % 6;
        lights.boxes.box_centre = take_floats(bytes, lights.boxes.count, 3, memory);
        lights.boxes.half_axes = take_floats(bytes, lights.boxes.count, 9, memory);
        if (bytes.flag()) {
            lights.boxes.centre = take_floats(bytes, lights.boxes.count, 3, memory);
            lights.boxes.radius = take_floats(bytes, lights.boxes.count, 1, memory);
            lights.boxes.taper = take_floats(bytes, lights.boxes.count, 1, memory);
        }
        float matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        matrix[bytes.byte() % 16] = static_cast<float>(bytes.byte()) / 100;
        if (bytes.flag()) lights.view_matrix.floats = matrix;
        lightbin_inputs inputs = {};
        inputs.size = sizeof inputs;
        const bool reads_bounds =
            options.depth_test != LIGHTBIN_NO_DEPTH_TEST && options.slicing != LIGHTBIN_CLUSTERS;
        if (bytes.byte() > 240 || options.slicing != LIGHTBIN_NO_SLICING) inputs.slices = slices;
        if (bytes.byte() > 240 || reads_bounds) inputs.bounds = &bounds;
        if (bytes.flag()) inputs.threads = &threads;
        lightbin_grid grid = {}, other = {};
        grid.size = other.size = sizeof grid;
        if (succeeded(lightbin_bin(binner, view, &lights, bytes.byte() > 250 ? nullptr : &inputs, &grid))) {
            require(grid.lights == lights.spheres.count + lights.spots.count + lights.boxes.count,
                    "lights were lost");
            check_grid(grid);
            lightbin_format format = {sizeof format, take_number(bytes, 3), take_number(bytes, 3),
                                      bytes.byte() % 9u, bytes.byte()};
            lightbin_encoded encoded = {};
            encoded.size = sizeof encoded;
            std::vector<std::byte> out(bytes.take<std::uint16_t>());
            succeeded(lightbin_encode(&grid, &format, out.data(), out.size(), &encoded));
            use_grid(grid, budget, grid_union, bytes);
            const lightbin_coverage* covered = nullptr;
            std::size_t covered_count = 0;
            if (succeeded(lightbin_binner_coverage(binner, &covered, &covered_count)))
                require(covered_count == grid.lights - grid.rejected - grid.culled,
                        "coverage of other lights");
            std::vector<lightbin_range> ranges(grid.range_count);
            std::vector<char> ids(grid.id_count * grid.id_bytes);
            if (succeeded(lightbin_copy_grid(&grid, ranges.data(), ranges.size(), ids.data(), grid.id_count)))
                check_grid(grid);
        }
        if (succeeded(lightbin_bin_transparency(binner, view, &lights, &inputs, &grid, &other))) {
            check_grid(grid);
            check_grid(other);
        }
        lightbin_bits bits = {};
        bits.size = sizeof bits;
        const std::uint32_t most = bytes.byte() % 64;
        std::vector<std::uint32_t> words(tiles * ((most + 31) / 32));
        if (succeeded(
                lightbin_bin_bits(binner, view, &lights, &inputs, most, words.data(), words.size(), &bits)))
            require(bits.lights == grid.lights || bits.lights <= 46, "lights were lost");
        heap.left += bytes.byte();
    }
    lightbin_budget_destroy(budget);
    lightbin_grid_union_destroy(grid_union);
    lightbin_binner_destroy(binner);
    lightbin_slices_destroy(slices);
    lightbin_view_destroy(view);
    require(heap.blocks == 0, "memory leaks");
    return 0;
}
