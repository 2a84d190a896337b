// SPDX-License-Identifier: MIT
// How binning is shared among threads: each part is some tile rows, or slices, and everything in them, so parts share nothing
// but the lights they read.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/algorithms.hpp>
#include <lightbin/detail/base/buffer.hpp>
#include <lightbin/detail/engine/costs.hpp>
#include <lightbin/detail/project/footprint_arrays.hpp>
#include <lightbin/parallel.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// Tile rows begin..end-1, or slices, and the tiles of all rectangles in them.
struct Part {
    unsigned begin, end;
    std::uint64_t before, area;  ///< of the parts before it, of its own
    /// From this tile row on there are BandJob::slack tiles or few more; before it, the rest.
    unsigned spare_row;
    std::uint64_t spare_area;
};

/// Writes parts of about equal work of `steps` tile rows or slices, no more parts than those. A step has area(step)
/// tiles in rectangles, and takes as long as `each` more of them.
template <class Area> void share_steps(Items<Part> parts, std::size_t steps, std::uint64_t each, Area area) {
    const std::size_t count = parts.size();
    std::uint64_t work = 0, before = 0, done = 0;
    for (std::size_t step = 0; step < steps; ++step)
        work += area(step) + each;
    unsigned step = 0;
    for (std::size_t i = 0; i < count; ++i) {
        Part part = {step, step, before, 0, 0, 0};
        const std::uint64_t goal = work / count * (i + 1);
        const std::size_t last = steps - (count - 1 - i);  // leave a step for each later part
        while (step < last && (step == part.begin || i + 1 == count || done < goal)) {
            part.area += area(step);
            done += area(step) + each;
            ++step;
        }
        part.end = part.spare_row = step;
        before += part.area;
        parts[i] = part;
    }
}

/// The same of a grid's tile rows.
template <class Id>
void make_parts(const BinJob<Id>& job, const Parallel& parallel, Buffer<std::uint64_t>& sums,
                Items<Part> parts) {
    // Each run of lights adds its widths to the steps between rows, in a column of its own.
    const std::size_t rows = static_cast<std::size_t>(job.camera->y.tiles), pitch = rows + 1;
    std::uint64_t* row_area = sums.reserve(std::uint64_t{pitch} * job.runs.size());
    parallel.run(job.runs.size(), [&](std::size_t run) {
        std::uint64_t* steps = row_area + run * pitch;
        fill_items(steps, pitch, 0);
        for (std::uint32_t i = job.runs[run].begin; i < job.runs[run].end; ++i) {
            const std::uint64_t width = job.lights.x1[i] - job.lights.x0[i] + 1u;
            steps[job.lights.y0[i]] += width;
            steps[job.lights.y1[i] + 1u] -= width;  // sums wrap, and come out right
        }
    });
    std::uint64_t step_sum = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t run = 0; run < job.runs.size(); ++run)
            step_sum += row_area[run * pitch + row];
        row_area[row] = step_sum;
    }
    share_steps(parts, rows, empty_row_cost(static_cast<std::uint64_t>(job.camera->x.tiles)),
                [&](std::size_t row) { return row_area[row]; });
    for (Part& part : parts)
        while (part.spare_row > part.begin && part.spare_area < BandJob<Id>::slack)
            part.spare_area += row_area[--part.spare_row];
}

/// Has build(part, out) make a list of its own of each part, the first one in `list`, and puts the others in their places
/// after it. A step's ranges are `width`. Returns the number of all entries.
template <class Id, class Build>
std::uint64_t build_apart(const Parallel& parallel, Items<Part> parts, ListRange* ranges, std::size_t width,
                          Buffer<Buffer<Id>>& spares, Id* list, Build build) {
    spares.reserve(parts.size(), parts.size());
    parallel.run(parts.size(), [&](std::size_t i) {
        Id* const out = i == 0 ? list : spares.data()[i].reserve(parts[i].area + BandJob<Id>::slack);
        parts[i].area = build(i, out);
    });
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
        copy_items(spares.data()[previous + 1].data(), static_cast<std::size_t>(part.area),
                   list + part.before);
    });
    return entries;
}

}}}  // namespace lightbin::detail
