// SPDX-License-Identifier: MIT
#include "brute_force.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace {

// The texts are GLSL 4.30 as well as GLSL 4.50 for Vulkan.
const std::string constants = R"(
layout(std140, binding = 4) uniform grid_block {
    uvec4 grid;  // tile columns, tile rows, lights, room for entries
};
)";

// 64 lights at a time, one each invocation.
const std::string tests = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer rectangles_block {
    uvec4 rectangles[];  // a light's id, its first tile and its last one: the column in the lower 16 bits, and the row
};
shared uint hits[2];

bool meets(uvec4 light, uvec2 tile) {
    uvec2 low = uvec2(light.y & 0xffffu, light.y >> 16u);
    uvec2 high = uvec2(light.z & 0xffffu, light.z >> 16u);
    return tile.x >= low.x && tile.x <= high.x && tile.y >= low.y && tile.y <= high.y;
}

// Sets the bits of those of 64 lights that the tile meets.
bool find_hits(uint light, uint thread) {
    if (thread < 2u) { hits[thread] = 0u; }
    memoryBarrierShared();
    barrier();
    bool hit = false;
    if (light < grid.z) { hit = meets(rectangles[light], gl_WorkGroupID.xy); }
    if (hit) { atomicOr(hits[thread >> 5u], 1u << (thread & 31u)); }
    memoryBarrierShared();
    barrier();
    return hit;
}
)";

const std::string count_text = constants + tests + R"(
layout(std430, binding = 1) writeonly buffer tiles_block { uvec2 tiles[]; };

void main() {
    uint thread = gl_LocalInvocationIndex;
    uint count = 0u;
    for (uint first = 0u; first < grid.z; first += 64u) {
        find_hits(first + thread, thread);
        count += uint(bitCount(hits[0]) + bitCount(hits[1]));
        barrier();
    }
    if (thread == 0u) { tiles[gl_WorkGroupID.y * grid.x + gl_WorkGroupID.x] = uvec2(0u, count); }
}
)";

const std::string offsets_text = constants + R"(
layout(local_size_x = 128) in;
layout(std430, binding = 1) buffer tiles_block { uvec2 tiles[]; };
layout(std430, binding = 2) writeonly buffer total_block { uint total; };
shared uint sums[128];

// Each invocation sums a run of tiles; the sums of the runs before it are added up.
void main() {
    uint thread = gl_LocalInvocationIndex;
    uint tile_count = grid.x * grid.y;
    uint each = (tile_count + 127u) / 128u;
    uint first = min(thread * each, tile_count);
    uint last = min(first + each, tile_count);
    uint sum = 0u;
    for (uint tile = first; tile < last; ++tile) { sum += tiles[tile].y; }
    sums[thread] = sum;
    for (uint distance = 1u; distance < 128u; distance *= 2u) {
        memoryBarrierShared();
        barrier();
        uint before = 0u;
        if (thread >= distance) { before = sums[thread - distance]; }
        barrier();
        sums[thread] += before;
    }
    uint offset = sums[thread] - sum;
    for (uint tile = first; tile < last; ++tile) {
        uint count = tiles[tile].y;
        uint begin = min(offset, grid.w);
        tiles[tile] = uvec2(begin, min(count, grid.w - begin));
        offset += count;
    }
    if (thread == 127u) { total = offset; }
}
)";

const std::string fill_text = constants + tests + R"(
layout(std430, binding = 1) readonly buffer tiles_block { uvec2 tiles[]; };
layout(std430, binding = 3) writeonly buffer lists_block { uint lists[]; };

void main() {
    uint thread = gl_LocalInvocationIndex;
    uvec2 list = tiles[gl_WorkGroupID.y * grid.x + gl_WorkGroupID.x];
    uint count = 0u;
    for (uint first = 0u; first < grid.z; first += 64u) {
        bool hit = find_hits(first + thread, thread);
        uint place = count + uint(bitCount(hits[thread >> 5u] & ((1u << (thread & 31u)) - 1u)));
        if (thread >= 32u) { place += uint(bitCount(hits[0])); }
        if (hit && place < list.y) { lists[list.x + place] = rectangles[first + thread].x; }
        count += uint(bitCount(hits[0]) + bitCount(hits[1]));
        barrier();
    }
}
)";

lightbin::ShaderBinding storage(const char* name, int binding) {
    return {name, lightbin::ShaderResource::writable_buffer, {binding}};
}
const lightbin::ShaderBinding grid = {"grid", lightbin::ShaderResource::uniform_block, {4}};

}  // namespace

BruteForce::BruteForce(GpuDevice& device, const lightbin::View& view, std::size_t lights,
                       std::uint32_t entries)
    : device_(device), tiles_(view.tile_count()), constants_{std::uint32_t(view.tiles_x()),
                                                             std::uint32_t(view.tiles_y()), 0, entries} {
    device.make_buffer("rectangles", 16 * std::max<std::size_t>(lights, 1));
    device.make_buffer("grid", sizeof constants_);
    device.make_buffer("tiles", 8 * tiles_);
    device.make_buffer("total", 4);
    device.make_buffer("lists", 4 * std::size_t(entries));
    const lightbin::ShaderBinding rectangles = storage("rectangles", 0), tiles = storage("tiles", 1);
    const std::uint32_t columns = constants_[0], rows = constants_[1];
    device.set_passes({{"count", {count_text, {grid, rectangles, tiles}}, columns, rows},
                       {"offsets", {offsets_text, {grid, tiles, storage("total", 2)}}, 1, 1},
                       {"fill", {fill_text, {grid, rectangles, tiles, storage("lists", 3)}}, columns, rows}});
}

void BruteForce::upload(std::span<const lightbin::LightCoverage> lights) {
    std::vector<std::array<std::uint32_t, 4>> rectangles;
    for (const lightbin::LightCoverage& light : lights)
        rectangles.push_back(
            {light.id, light.x0 | std::uint32_t(light.y0) << 16, light.x1 | std::uint32_t(light.y1) << 16});
    if (!rectangles.empty()) device_.write("rectangles", std::as_bytes(std::span(rectangles)));
    constants_[2] = std::uint32_t(rectangles.size());
    device_.write("grid", std::as_bytes(std::span(constants_)));
}

ReadLists BruteForce::read() {
    ReadLists lists;
    lists.totals.entries = device_.read("total", 1)[0];
    const std::vector<std::uint32_t> words = device_.read("tiles", 2 * tiles_);
    lists.ranges.resize(tiles_);
    std::memcpy(lists.ranges.data(), words.data(), 8 * tiles_);
    lists.ids = device_.read("lists", std::min(lists.totals.entries, constants_[3]));
    return lists;
}
