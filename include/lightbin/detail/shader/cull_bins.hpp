// SPDX-License-Identifier: MIT
// The passes that z-bins add between project and count: a counting sort of the lights in view by the first bin that
// each meets, stable, so that lights that begin in one bin keep their order. Ranks then take the place of ids.
//
// bin_counts and rank have a group for each segment of lights. In the array at ShaderCull::bin_counts, bin_counts
// stores how many lights of each segment begin in each bin. bin_offsets replaces them by prefix sums over the segments,
// and appends those over the bins: a segment's first rank in a bin is the sum of both.
#pragma once

#include <lightbin/detail/shader/cull_common.hpp>
#include <lightbin/detail/shader/cull_lists.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Adds `bins_of`, which returns a light's first bin in the lower 16 bits and its last in the upper ones, or all bits
/// set if it is not in view; and `bin_batches`, which returns the number of batches of 64 lights in each segment.
inline void add_bins_of(ShaderWriter& writer, const CullShaderOptions& options) {
    const std::string words = std::to_string(cull_record_words(options)) + "u";
    writer.add(R"(
uint $bins_of(uint id) {
    uint ends = 0xffffffffu;
    if (id < $segments.x) {
        uint record = $places.x + id * )" + words + R"(;
        bool seen = ($scratch[record] & 0xffffu) <= ($scratch[record + 1u] & 0xffffu);
        if (seen) { ends = $scratch[record + 2u]; }
    }
    return ends;
}

uint $bin_batches() {
    uint batches = max(($segments.x + 63u) >> 6u, 1u);
    return (batches + $segments.w - 1u) / $segments.w;
}
)");
}

/// Adds the pass bin_counts. Its loops over bins have different variables, as fxc warns if a name is declared twice.
inline void add_bin_counts(ShaderWriter& writer, const CullShaderOptions& options) {
    declare_scratch(writer, options);
    writer.add("\n");
    writer.declare_shared("begun", cull_max_bins, true);
    add_bins_of(writer, options);
    writer.add(R"(
void $run(uvec2 group, uint thread) {
    uint bins = $grid.z;
    for (uint bin = thread; bin < bins; bin += 64u) { atomicStore(&$begun[bin], 0u); }
    sync_group();
    uint batches = $bin_batches();
    for (uint batch = 0u; batch < batches; batch += 1u) {
        uint ends = $bins_of((group.x * batches + batch) * 64u + thread);
        if (ends != 0xffffffffu) { atomicAdd(&$begun[ends & 0xffffu], 1u); }
    }
    sync_group();
    uint begin = $more.w + group.x * bins;
    for (uint done = thread; done < bins; done += 64u) { $scratch[begin + done] = atomicLoad(&$begun[done]); }
}
)");
}

/// Adds the pass bin_offsets: one group finds the first rank of each segment in each bin, and empties the bins.
inline void add_bin_offsets(ShaderWriter& writer, const CullShaderOptions& options) {
    declare_scratch(writer, options);
    writer.declare_storage("bins", "uvec2", "writeonly", options.bins, 8);
    add_scan(writer);
    writer.add(R"(
void $run(uvec2 group, uint thread) {
    uint bins = $grid.z;
    uint before = 0u;
    for (uint first = 0u; first < bins; first += 128u) {
        uint bin = first + thread;
        uint count = 0u;
        if (bin < bins) {
            for (uint i = 0u; i < $segments.w; i += 1u) {
                uint own = $scratch[$more.w + i * bins + bin];
                $scratch[$more.w + i * bins + bin] = count;
                count += own;
            }
            $bins[bin] = uvec2(0xffffffffu, 0u);
        }
        $scan(thread, count);
        uint base = before;
        if (thread > 0u) { base += $partial[thread - 1u]; }
        if (bin < bins) { $scratch[$more.w + $segments.w * bins + bin] = base; }
        before += $partial[127];
        sync_group();
    }
    if (thread == 0u) { $scratch[2] = before; }
}
)");
}

/// Adds the pass rank. A light's rank is the next one of its first bin plus the number of lights before it in its batch
/// of 64 that begin in the same bin. `beginning` has two words for each bin, with a bit for each light of the batch
/// that begins in the bin; they are 0 between batches.
inline void add_rank(ShaderWriter& writer, const CullShaderOptions& options) {
    const std::uint32_t words = cull_record_words(options);
    declare_scratch(writer, options);
    writer.declare_storage("order", "uint", "writeonly", options.order, 4);
    writer.add("\n");
    writer.declare_shared("next_rank", cull_max_bins, false);
    writer.declare_shared("beginning", 2 * cull_max_bins, true);
    add_bins_of(writer, options);
    writer.add(R"(
void $run(uvec2 group, uint thread) {
    uint bins = $grid.z;
    for (uint bin = thread; bin < bins; bin += 64u) {
        $next_rank[bin] = $scratch[$more.w + group.x * bins + bin] + $scratch[$more.w + $segments.w * bins + bin];
        atomicStore(&$beginning[2u * bin], 0u);
        atomicStore(&$beginning[2u * bin + 1u], 0u);
    }
    sync_group();
    uint batches = $bin_batches();
    for (uint batch = 0u; batch < batches; batch += 1u) {
        uint id = (group.x * batches + batch) * 64u + thread;
        uint ends = $bins_of(id);
        uint first = ends & 0xffffu;
        bool seen = ends != 0xffffffffu;
        if (seen) { atomicOr(&$beginning[2u * first + (thread >> 5u)], 1u << (thread & 31u)); }
        sync_group();
        uint before = 0u;
        uint same = 0u;
        uint rank = 0u;
        if (seen) {
            uint low = atomicLoad(&$beginning[2u * first]);
            uint high = atomicLoad(&$beginning[2u * first + 1u]);
            uint bits_below = (1u << (thread & 31u)) - 1u;
            same = uint(bitCount(low)) + uint(bitCount(high));
            before = uint(bitCount(low & bits_below));
            if (thread >= 32u) { before = uint(bitCount(low)) + uint(bitCount(high & bits_below)); }
            rank = $next_rank[first] + before;
        }
        sync_group();
        if (seen) {
            if (before == 0u) {
                $next_rank[first] += same;
                atomicStore(&$beginning[2u * first], 0u);
                atomicStore(&$beginning[2u * first + 1u], 0u);
            }
            $order[rank] = id;
            uint record = $places.x + id * )" + std::to_string(words) + R"(u;
            uint ranked = $places.y + rank * )" + std::to_string(words) + R"(u;
            for (uint word = 0u; word < )" + std::to_string(words) + R"(u; word += 1u) {
                $scratch[ranked + word] = $scratch[record + word];
            }
        }
        sync_group();
    }
}
)");
}

/// Adds the pass masks: marks the mask blocks of the lights by rank, and finds the range of ranks of each bin. A group
/// has 64 ranks, which begin in ascending bins, so few bins meet them. The ranges are made by atomic minima and maxima,
/// so that they do not depend on the order in which groups run.
inline void add_masks(ShaderWriter& writer, const CullShaderOptions& options) {
    declare_scratch(writer, options);
    writer.declare_storage("bins", writer.dialect.webgpu ? "atomic<uint>" : "uint", "", options.bins, 4);
    writer.add("\n");
    writer.declare_shared("met_bins", 64, false);
    writer.declare_shared("last_bin", 1, true);
    add_masks_of_group(writer, options);
    writer.add(R"(
void $run(uvec2 group, uint thread) {
    uint number = group.y * 32768u + group.x;
    uint rank = number * 64u + thread;
    if (thread == 0u) { atomicStore(&$last_bin[0], 0u); }
    $clear_masks(thread);
    sync_group();
    uint met = 0xffffu;
    if (rank < $scratch[2]) {
        uint record = $places.y + rank * )" + std::to_string(cull_record_words(options)) + R"(u;
        uint first = $scratch[record];
        uint last = $scratch[record + 1u];
        $mark(thread, uvec2(first & 0xffffu, last & 0xffffu), uvec2(first >> 16u, last >> 16u), uvec2(0u, 0u));
        met = $scratch[record + 2u];
        atomicMax(&$last_bin[0], met >> 16u);
    }
    $met_bins[thread] = met;
    sync_group();
    uint last_bin = atomicLoad(&$last_bin[0]);
    for (uint bin = ($met_bins[0] & 0xffffu) + thread; bin <= last_bin; bin += 64u) {
        uint least = 64u;
        uint greatest = 0u;
        for (uint i = 0u; i < 64u; i += 1u) {
            uint ends = $met_bins[i];
            if ((ends & 0xffffu) <= bin && bin <= ends >> 16u) {
                least = min(least, i);
                greatest = i;
            }
        }
        if (least < 64u) {
            atomicMin(&$bins[2u * bin], number * 64u + least);
            atomicMax(&$bins[2u * bin + 1u], number * 64u + greatest);
        }
    }
    uint groups = max(($segments.x + 63u) >> 6u, 1u);
    if (number < groups) { $write_masks(number, thread); }
}
)");
}

}}}  // namespace lightbin::detail
