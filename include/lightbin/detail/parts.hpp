// SPDX-License-Identifier: MIT
// How binning is shared among threads: each part is some tile rows and everything in them, so parts share nothing
// but the lights they read.
#pragma once

#include <lightbin/detail/buffer.hpp>
#include <lightbin/detail/costs.hpp>
#include <lightbin/detail/flavour.hpp>
#include <lightbin/detail/footprint.hpp>
#include <lightbin/parallel.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lightbin::inline LIGHTBIN_FLAVOUR::detail {

/// Tile rows begin..end-1, and the tiles of all rectangles in them.
struct Part {
    unsigned begin, end;
    std::uint64_t before, area;  ///< of the parts before it, of its own
    /// From this tile row on there are BandJob::slack tiles or few more; before it, the rest.
    unsigned spare_row;
    std::uint64_t spare_area;
};

/// Writes `count` parts of about equal work, no more than there are tile rows.
template <class Id>
void make_parts(const BinJob<Id>& job, const Parallel& parallel, Buffer<std::uint64_t>& sums, Part* parts,
                std::size_t count) {
    // Each run of lights adds its widths to the steps between rows, in a column of its own.
    const std::size_t rows = static_cast<std::size_t>(job.camera->y.tiles), pitch = rows + 1;
    std::uint64_t* row_area = sums.reserve(std::uint64_t{pitch} * job.runs.size());
    parallel.run(job.runs.size(), [&](std::size_t run) {
        std::uint64_t* steps = row_area + run * pitch;
        std::fill_n(steps, pitch, 0u);
        for (std::uint32_t i = job.runs[run].begin; i < job.runs[run].end; ++i) {
            const std::uint64_t width = job.lights.x1[i] - job.lights.x0[i] + 1u;
            steps[job.lights.y0[i]] += width;
            steps[job.lights.y1[i] + 1u] -= width;  // sums wrap, and come out right
        }
    });
    std::uint64_t step_sum = 0, work = 0;
    const std::uint64_t row_work = empty_row_cost(static_cast<std::uint64_t>(job.camera->x.tiles));
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t run = 0; run < job.runs.size(); ++run)
            step_sum += row_area[run * pitch + row];
        row_area[row] = step_sum;
        work += step_sum + row_work;
    }

    std::uint64_t before = 0, done = 0;
    unsigned row = 0;
    for (std::size_t i = 0; i < count; ++i) {
        Part part = {row, row, before, 0, 0, 0};
        const std::uint64_t goal = work / count * (i + 1);
        const std::size_t last = rows - (count - 1 - i);  // leave a row for each later part
        while (row < last && (row == part.begin || i + 1 == count || done < goal)) {
            part.area += row_area[row];
            done += row_area[row] + row_work;
            ++row;
        }
        part.end = part.spare_row = row;
        while (part.spare_row > part.begin && part.spare_area < BandJob<Id>::slack)
            part.spare_area += row_area[--part.spare_row];
        before += part.area;
        parts[i] = part;
    }
}

/// Puts the lists of parts side by side in `list`, where the first one is; the others are in `spares`. Their areas are
/// the numbers of their entries; steps `begin` to `end` have `width` ranges each. Returns the number of all entries.
template <class Id>
std::uint64_t join_parts(const Parallel& parallel, std::span<Part> parts, ListRange* ranges,
                         std::size_t width, const Buffer<Id>* spares, Id* list) {
    std::uint64_t entries = 0;
    for (Part& part : parts) {
        part.before = entries;
        entries += part.area;
    }
    parallel.run(parts.size() - 1, [&](std::size_t previous) {
        const Part& part = parts[previous + 1];
        for (ListRange *range = ranges + width * part.begin, *end = ranges + width * part.end; range < end;
             ++range)
            range->offset += static_cast<std::uint32_t>(part.before);
        std::copy_n(spares[previous + 1].data(), static_cast<std::size_t>(part.area), list + part.before);
    });
    return entries;
}

}  // namespace lightbin::inline LIGHTBIN_FLAVOUR::detail
