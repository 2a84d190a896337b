// SPDX-License-Identifier: MIT
// Calls the C API as a fuzzer's bytes say: any numbers, null pointers, arrays and structs of exactly the stated size,
// memory that runs out. Each call fails with a sentence or makes something sound; nothing leaks.
#define LIGHTBIN_NO_SIMD  // of the kernels the scalar ones are enough
#define LIGHTBIN_IMPLEMENTATION
#include <lightbin/lightbin.h>

#include "bytes.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

namespace {

void require(bool condition, const char* what) {
    if (condition) return;
    std::fprintf(stderr, "%s\n", what);
    std::abort();
}

/// Whether memory is limited, as it is in calls of the library; how many of their allocations succeed from now on; and
/// how many blocks of all memory are not freed.
bool memory_is_limited = false;
long left = 0, blocks = 0;

/// Returns whether a call succeeded. If not, checks that its error is a sentence.
bool judged(const lightbin_result& result) {
    memory_is_limited = false;
    char text[600] = "";
    const std::size_t length = lightbin_error_text(result, text, sizeof text);
    require(length > 5 && length < 512 && std::strlen(text) == length, "no sentence");
    require(result.name != nullptr, "no name");
    return result.error == LIGHTBIN_OK;
}

/// Makes a call in which memory may run out; whether it succeeded.
#define succeeded(...) (memory_is_limited = true, judged(__VA_ARGS__))

/// Returns a small number that makes sense, or sometimes any number.
std::int32_t take_number(Bytes& bytes, unsigned below) {
    const unsigned kind = bytes.byte();
    return kind < 240 ? static_cast<std::int32_t>(kind % below) : bytes.take<std::int32_t>();
}

/// Returns a number that makes sense as a count of lights or entries, or sometimes any number.
std::uint32_t take_product(Bytes& bytes) {
    const auto first = static_cast<std::uint32_t>(take_number(bytes, 240));
    return first * static_cast<std::uint32_t>(take_number(bytes, 240));
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

/// Returns the lights' floats in an array of exactly the size that they take or, if the bytes say so, no array.
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

/// A struct in memory of exactly the size that its member `size` states: usually the full size, sometimes any.
template <class Struct> class Sized {
public:
    Sized(Struct values, Bytes& bytes)
        : size_(bytes.byte() < 245 ? sizeof values : bytes.byte()),
          memory_(new char[std::max(size_, sizeof values.size)]()) {
        values.size = static_cast<std::uint32_t>(size_);
        std::memcpy(memory_.get(), &values, std::min(std::max(size_, sizeof values.size), sizeof values));
    }
    Struct* get() const { return reinterpret_cast<Struct*>(memory_.get()); }
    bool whole() const { return size_ == sizeof(Struct); }
    std::vector<char> copy() const { return {memory_.get(), memory_.get() + size_}; }

private:
    std::size_t size_;
    std::unique_ptr<char[]> memory_;
};

lightbin_cull_options take_cull_options(Bytes& bytes, const char* prefix) {
    lightbin_cull_options options = {};
    options.language = take_number(bytes, 8), options.pass = take_number(bytes, 6);
    options.kind = take_number(bytes, 2), options.ids = take_number(bytes, 3);
    options.depth_test = bytes.flag(), options.slicing = take_number(bytes, 3);
    options.prefix = prefix;
    if (bytes.flag())
        for (std::uint32_t* word : {&options.stride, &options.centre, &options.radius, &options.axis,
                                    &options.cosine, &options.count_at})
            *word = static_cast<std::uint32_t>(take_number(bytes, 16));
    const unsigned flags = bytes.byte();
    options.world_space = flags & 1, options.count_in_buffer = flags & 2, options.max_only = flags & 4;
    options.orthographic = flags & 8, options.slots_given = flags & 16;
    int binding = 0;
    for (lightbin_slot* slot :
         {&options.lights, &options.z_bounds, &options.scratch, &options.slices, &options.tiles,
          &options.light_count, &options.lists, &options.grid}) {
        slot->binding = binding++;
        if (options.slots_given == 0 || bytes.byte() < 200) continue;
        slot->binding = take_number(bytes, 20), slot->set = take_number(bytes, 5);
    }
    return options;
}

/// Asks for a shader text and a plan that make lists on the GPU. Their contents, and reasons to refuse them, are tested
/// in shader.cpp.
void plan_lists_on_gpu(Bytes& bytes, const lightbin_view* view, const lightbin_slices* slices) {
    std::string prefix;
    for (unsigned length = bytes.byte() % 8; prefix.size() < length;)
        prefix += static_cast<char>(bytes.byte() % 255 + 1);
    const bool named = bytes.flag();
    const Sized<lightbin_cull_options> options(take_cull_options(bytes, named ? prefix.c_str() : nullptr),
                                               bytes);
    const lightbin_cull_options* const given = bytes.byte() > 250 ? nullptr : options.get();
    lightbin_shader* shader = nullptr;
    if (succeeded(lightbin_cull_shader(given, &shader))) {
        const std::string text = lightbin_shader_text(shader);
        const std::size_t count = lightbin_shader_binding_count(shader);
        for (std::size_t i = 0; i <= count; ++i) {
            lightbin_binding binding = {};
            binding.size = sizeof binding;
            require(succeeded(lightbin_shader_binding(shader, i, &binding)) == (i < count), "a binding is missing");
            require(i == count || text.find(binding.name) != std::string::npos, "a binding that is not in the text");
        }
    } else {
        require(shader == nullptr, "a shader in spite of an error");
    }
    lightbin_shader_destroy(shader);

    float numbers[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    if (bytes.flag()) numbers[bytes.byte() % 16] = bytes.flag() ? bytes.take<float>() : 0.5f;
    lightbin_matrix to_view = {};
    to_view.floats = bytes.byte() > 250 ? nullptr : numbers;
    to_view.layout = bytes.byte() > 240 ? take_number(bytes, 3) : 0;
    const std::uint32_t lights = take_product(bytes), entries = take_product(bytes);
    const lightbin_cull_options asked = options.whole() ? *options.get() : lightbin_cull_options{};
    const bool give_slices = (asked.slicing != LIGHTBIN_NO_SLICING) != (bytes.byte() > 240),
               give_matrix = (asked.world_space != 0) != (bytes.byte() > 240);
    const Sized<lightbin_cull_plan> plan(lightbin_cull_plan{}, bytes);
    const std::vector<char> before = plan.copy();
    lightbin_cull_plan* const to = bytes.byte() > 250 ? nullptr : plan.get();
    if (!succeeded(lightbin_plan_cull(view, given, lights, entries, give_slices ? slices : nullptr,
                                      give_matrix ? &to_view : nullptr, to)))
        require(plan.copy() == before, "a plan was written in spite of an error");
}

void use_calls(Bytes bytes) {
    const unsigned kind = bytes.byte();
    left = (kind & 1) != 0 ? 1'000'000 : static_cast<long>(bytes.byte());
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
    // Tiles of a few pixels in a large viewport would take the fuzzer too long.
    if (view_options.tile_size < 4 && view_options.tile_size != 0) view_options.tile_size += 4;
    if (view_options.width > 400 || view_options.height > 400) view_options.tile_size = 512;
    succeeded(lightbin_view_create(&view_options, &view));
    succeeded(lightbin_slices_exponential(take_number(bytes, 20), static_cast<float>(bytes.byte()) / 10,
                                          static_cast<float>(bytes.byte()),
                                          static_cast<float>(bytes.byte()) / 500, &slices));
    lightbin_binner_options options = {};
    options.size = sizeof options;
    options.ids = take_number(bytes, 3), options.depth_test = bytes.flag(), options.slicing = take_number(bytes, 3);
    succeeded(lightbin_binner_create(&options, &binner));

    std::size_t tiles = 0;
    lightbin_view_info info = {};
    info.size = sizeof info;
    if (succeeded(lightbin_view_describe(view, &info)))
        tiles = static_cast<std::size_t>(info.tiles_x) * static_cast<std::size_t>(info.tiles_y);
    // One in four of the fuzzer's inputs tries the shaders that make lists on the GPU, too.
    if (kind >= 192)
        for (int call = 0; call < 3 && !bytes.empty(); ++call)
            plan_lists_on_gpu(bytes, view, slices);
    std::vector<float> bounds_memory(2 * tiles);
    for (std::size_t i = 0; i < tiles; ++i) {
        bounds_memory[i] = static_cast<float>(bytes.byte()) / 16;
        bounds_memory[tiles + i] = bounds_memory[i] + static_cast<float>(bytes.byte()) / 16;
    }
    lightbin_z_bounds bounds = {};
    bounds.size = sizeof bounds;
    bounds.min = bytes.flag() ? nullptr : bounds_memory.data(), bounds.max = bounds_memory.data() + tiles;
    bounds.tiles = tiles;
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
            options.depth_test != 0 && options.slicing != LIGHTBIN_CLUSTERS;
        if (bytes.byte() > 240 || options.slicing != LIGHTBIN_NO_SLICING) inputs.slices = slices;
        if (bytes.byte() > 240 || reads_bounds) inputs.bounds = &bounds;
        lightbin_grid grid = {};
        grid.size = sizeof grid;
        if (succeeded(lightbin_bin(binner, view, &lights, bytes.byte() > 250 ? nullptr : &inputs, &grid))) {
            require(grid.lights == lights.spheres.count + lights.spots.count + lights.boxes.count,
                    "lights were lost");
            check_grid(grid);
            lightbin_format format = {sizeof format, take_number(bytes, 3), take_number(bytes, 3),
                                      bytes.byte() % 9u};
            lightbin_encoded encoded = {};
            encoded.size = sizeof encoded;
            std::vector<std::byte> out(bytes.take<std::uint16_t>());
            succeeded(lightbin_encode(&grid, &format, out.data(), out.size(), &encoded));
        }
        left += bytes.byte();
    }
    lightbin_binner_destroy(binner);
    lightbin_slices_destroy(slices);
    lightbin_view_destroy(view);
}

}  // namespace

void* operator new(std::size_t bytes) {
    const bool fails = memory_is_limited && (left-- <= 0 || bytes > 4'000'000);
    void* const memory = fails ? nullptr : std::malloc(bytes != 0 ? bytes : 1);
    if (memory == nullptr) throw std::bad_alloc();
    ++blocks;
    return memory;
}
// By default the array forms call these; but a sanitizer has array forms of its own.
void* operator new[](std::size_t bytes) {
    return operator new(bytes);
}
void operator delete(void* memory) noexcept {
    blocks -= memory != nullptr;
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    operator delete(memory);
}
void operator delete[](void* memory) noexcept {
    operator delete(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    operator delete(memory);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const long before = blocks;
    use_calls(Bytes(data, size));
    require(blocks == before, "memory leaks");
    return 0;
}
