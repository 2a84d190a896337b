// SPDX-License-Identifier: MIT
// How binning is divided among threads: each share is a range of tile rows, or of slices, with everything in it. So
// shares write separate memory and have only the lights in common, which they read.
#pragma once

#include <lightbin/detail/engine/costs.hpp>
#include <lightbin/detail/project/footprint_arrays.hpp>
#include <lightbin/parallel.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// One thread's share of the work: the tile rows, or depth slices, begin..end-1.
struct Share {
    unsigned begin, end;
    /// How many list entries the thread writes; until it has, an upper bound: the tiles of all rectangles in its share.
    std::uint64_t entries;
};

/// Divides `steps` tile rows or slices into shares of about equal work. There must be no more shares than steps. The
/// work of a step is area(step), the number of tiles that all lights' rectangles have in it, plus `overhead`, its
/// number of tiles: to write an empty tile takes as long as to write one entry of the index list.
template <class Area> void share_steps(std::span<Share> shares, std::size_t steps, std::uint64_t overhead, Area area) {
    const std::size_t count = shares.size();
    std::uint64_t work = 0, done = 0;
    for (std::size_t step = 0; step < steps; ++step)
        work += area(step) + overhead;
    unsigned step = 0;
    for (std::size_t i = 0; i < count; ++i) {
        Share share = {step, step, 0};
        const std::uint64_t goal = work / count * (i + 1);
        const std::size_t last = steps - (count - 1 - i);  // leaves a step for each later share
        while (step < last && (step == share.begin || i + 1 == count || done < goal)) {
            share.entries += area(step);
            done += area(step) + overhead;
            ++step;
        }
        share.end = step;
        shares[i] = share;
    }
}

/// Divides a grid's tile rows into shares of about equal work. A row's work is the number of tiles that the lights'
/// rectangles cover in it, each counted for each light: the prefix sums of difference arrays over the rows. Each run of
/// footprints has a difference array of its own, so that threads can fill them in parallel.
///
/// sums  memory for the difference arrays
inline void share_rows(const BinJob& job, const Parallel& parallel, Buffer<std::uint64_t>& sums,
                       std::span<Share> shares) {
    const std::size_t rows = static_cast<std::size_t>(job.camera->y.tiles), pitch = rows + 1;
    std::uint64_t* const row_area = sums.reserve(std::uint64_t{pitch} * job.runs.size());
    parallel.run(job.runs.size(), [&](std::size_t run) {
        std::uint64_t* const steps = row_area + run * pitch;
        fill_items(steps, pitch, 0);
        for (std::uint32_t i = job.runs[run].begin; i < job.runs[run].end; ++i) {
            const std::uint64_t width = job.lights.x1[i] - job.lights.x0[i] + 1u;
            steps[job.lights.y0[i]] += width;
            steps[job.lights.y1[i] + 1u] -= width;  // may wrap below 0, which the sums of these steps undo
        }
    });
    std::uint64_t area = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t run = 0; run < job.runs.size(); ++run)
            area += row_area[run * pitch + row];
        row_area[row] = area;
    }
    share_steps(shares, rows, static_cast<std::uint64_t>(job.camera->x.tiles),
                [&](std::size_t row) { return row_area[row]; });
}

/// Builds all shares in parallel, and joins their index lists. The first is built in `list`, each further one in memory
/// of its own; that is copied, and the offsets in its ranges are moved up accordingly. Returns the number of entries.
///
/// ranges  the grid's ranges, `width` for each tile row or slice
/// memory  the memory of all shares' lists but the first, kept from call to call
/// build   build(share, i, out) builds share i, its list at `out` with offsets from 0 on; returns its number of entries
template <class Id, class Build>
std::uint64_t build_shares(const Parallel& parallel, std::span<Share> shares, ListRange* ranges, std::size_t width,
                           Buffer<Buffer<Id>>& memory, Id* list, Build build) {
    memory.reserve(shares.size(), shares.size());
    parallel.run(shares.size(), [&](std::size_t i) {
        Id* const out = i == 0 ? list : memory.data()[i].reserve(shares[i].entries + widest_vector);
        shares[i].entries = build(shares[i], i, out);
    });
    parallel.run(shares.size() - 1, [&](std::size_t previous) {
        const Share& share = shares[previous + 1];
        std::uint64_t before = 0;
        for (std::size_t i = 0; i <= previous; ++i)
            before += shares[i].entries;
        for (ListRange *range = ranges + width * share.begin, *end = ranges + width * share.end; range < end; ++range)
            range->offset += static_cast<std::uint32_t>(before);
        copy_items(memory.data()[previous + 1].data(), static_cast<std::size_t>(share.entries), list + before);
    });
    std::uint64_t entries = 0;
    for (const Share& share : shares)
        entries += share.entries;
    return entries;
}

}}}  // namespace lightbin::detail
