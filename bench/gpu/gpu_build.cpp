// SPDX-License-Identifier: MIT
#include "gpu_build.hpp"

#include <value_of.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace {

template <class Range> std::span<const std::byte> bytes_of(const Range& range) {
    return std::as_bytes(std::span(range));
}

lightbin::CullPlan plan_of(const GpuFrame& frame, const lightbin::View& view,
                           const lightbin::CullOptions& options, const lightbin::CullCapacity& room,
                           const std::optional<lightbin::Slices>& slices) {
    std::optional<lightbin::Matrix> to_view;
    if (frame.to_view)
        to_view = lightbin::matrix(&(*frame.to_view)[0][0], lightbin::MatrixLayout::column_major);
    return value_of(
        lightbin::plan_cull(view, options, room, slices ? &*slices : nullptr, to_view ? &*to_view : nullptr));
}

/// Returns the content of the buffer `z_bounds`: with clusters the slices' depths, the tiles' edges, and the bounds if
/// there are any, otherwise the bounds and the edges.
std::vector<lightbin::ShaderEdges> depths_of(const lightbin::View& view, const lightbin::Options& options,
                                             const lightbin::Slices* slices,
                                             const lightbin::ZBounds& bounds) {
    std::vector<lightbin::ShaderEdges> depths;
    const std::vector<lightbin::ShaderEdges> edges = lightbin::shader_edges(view);
    const bool clusters = options.slicing == lightbin::Slicing::clusters;
    if (clusters) {
        depths = lightbin::shader_slabs(*slices);
        depths.insert(depths.end(), edges.begin(), edges.end());
    }
    for (std::size_t tile = 0; tile < bounds.min.size(); ++tile)
        depths.push_back({bounds.min[tile], bounds.max[tile]});
    if (!clusters) depths.insert(depths.end(), edges.begin(), edges.end());
    return depths;
}

template <class T> std::vector<T> read_as(GpuDevice& device, const std::string& buffer, std::size_t count) {
    std::vector<T> values(count);
    const std::vector<std::uint32_t> words = device.read(buffer, count * sizeof(T) / 4);
    if (count > 0) std::memcpy(values.data(), words.data(), count * sizeof(T));
    return values;
}

}  // namespace

ReadLists lists_of(const lightbin::LightMasks& masks) {
    ReadLists lists = {};
    for (int y = 0; y < masks.tiles_y(); ++y)
        for (int x = 0; x < masks.tiles_x(); ++x) {
            const auto begin = std::uint32_t(lists.ids.size());
            for (std::size_t i = 0; i < masks.ids().size(); ++i)
                if (masks.column(x)[i / 32] & masks.row(y)[i / 32] & (1u << i % 32))
                    lists.ids.push_back(masks.ids()[i]);
            lists.ranges.push_back({begin, std::uint32_t(lists.ids.size()) - begin});
        }
    lists.totals.entries = std::uint32_t(lists.ids.size());
    return lists;
}

GpuBuild::GpuBuild(GpuDevice& device, const lightbin::Options& options, bool masks, int tile_size,
                   const GpuFrame& first, std::uint32_t entries, const lightbin::Slices* slices,
                   const lightbin::ZBounds& bounds)
    : device_(device),
      view_(first.lens.view(tile_size)), bounds_(bounds),
      room_{static_cast<std::uint32_t>(first.lights.size()), entries} {
    if (slices) {
        slices_ = *slices;
        slabs_ = lightbin::shader_slabs(*slices);
    }
    options_.world_space = first.to_view.has_value();
    options_.depth_test = options.depth_test;
    options_.slicing = options.slicing;
    options_.bounded = !bounds.min.empty();
    plan_ = plan_of(first, view_, options_, room_, slices_);
    std::vector<ComputePass> passes;
    passes_ = masks ? std::span<const lightbin::CullPass>(lightbin::cull_mask_passes) : lightbin::cull_passes;
    for (const lightbin::CullPass pass : passes_) {
        const lightbin::CullGroups groups = plan_.groups_of(pass);
        passes.push_back(
            {to_string(pass), value_of(lightbin::cull_shader(pass, options_)), groups.x, groups.y});
    }
    device.set_passes(passes);
    const auto make = [&](const char* name, std::uint64_t bytes) {
        device.make_buffer(name, static_cast<std::size_t>(std::max<std::uint64_t>(bytes, 16)));
    };
    const auto fill = [&](const char* name, std::span<const std::byte> bytes) {
        make(name, bytes.size());
        if (!bytes.empty()) device.write(name, bytes);
    };
    make("grid", sizeof(lightbin::CullConstants));
    make("scratch", plan_.bytes.scratch);
    make("tiles", plan_.bytes.tiles);
    make("lists", masks ? plan_.bytes.masks : plan_.bytes.lists);
    fill("lights", bytes_of(first.lights));
    fill("slices", slices ? bytes_of(lightbin::shader_slices(*slices)) : std::span<const std::byte>());
    if (options.depth_test || options_.bounded) fill("z_bounds", bytes_of(depths_of(view_, options, slices, bounds)));
}

double GpuBuild::upload(const GpuFrame& frame) {
    plan_ = plan_of(frame, view_, options_, room_, slices_);
    const auto constants = bytes_of(std::span(&plan_.constants, 1));
    const double milliseconds = device_.write("grid", constants);
    return frame.to_view ? milliseconds : milliseconds + device_.write("lights", bytes_of(frame.lights));
}

bool GpuBuild::draws(std::uint32_t slice, std::uint32_t x, std::uint32_t y) const {
    const lightbin::CullConstants& c = plan_.constants;
    const lightbin::ShaderEdges slab = slabs_[slice];
    for (std::uint32_t i = 0; i < 64 && !bounds_.min.empty(); ++i) {
        const std::uint32_t column = x + i % 8, row = y + i / 8;
        if (column >= c.tiles_x || row >= c.tiles_y) continue;
        const float low = bounds_.min[row * c.tiles_x + column], high = bounds_.max[row * c.tiles_x + column];
        if (low <= high && low - std::abs(low) * c.depth_margin <= slab.high &&
            slab.low <= high + std::abs(high) * c.depth_margin)
            return true;
    }
    return bounds_.min.empty();
}

GroupWork GpuBuild::work_of_groups() {
    const lightbin::CullConstants& c = plan_.constants;
    const auto scratch = device_.read("scratch", std::size_t(plan_.bytes.scratch / 4));
    const std::uint32_t blocks = c.blocks_x * c.blocks_y * (((c.slices - 1) >> c.slice_shift) + 1),
                        steps = (c.lights + 1023) / 1024;
    const std::uint32_t *const words = &scratch[c.masks], *const summaries = words + (c.lights + 63) / 64 * 2 * blocks;
    double tests = 0;
    GroupWork work;
    const auto add_group = [&](bool drawn, std::uint32_t block, std::uint32_t first, std::uint32_t end) {
        int found = 0;
        for (std::uint32_t step = first; drawn && step < end; ++step) {
            int lights = 0;
            for (std::uint32_t word = 0; word < 32; ++word)
                if (summaries[step * blocks + block] >> word & 1) {
                    ++found;
                    lights += std::popcount(words[(32 * step + word) * blocks + block]);
                }
            tests += lights + 8 * lights + 64 * ((lights + 31) / 32);
        }
        tests += found + (found > 0 ? 2 : 1) * double(end - first);  // a group with lights reads its summaries twice
        ++work.groups;
        work.idle += found == 0;
    };
    for (std::uint32_t slice = 0; slice < c.slices; ++slice)
        for (std::uint32_t y = 0; y < c.tiles_y; y += 8)
            for (std::uint32_t x = 0; x < c.tiles_x; x += 8) {
                const bool drawn = draws(slice, x, y);
                for (std::uint32_t first = 0; first < steps; first += c.steps)
                    add_group(drawn,
                              ((slice >> c.slice_shift) * c.blocks_y + (y >> c.block_shift)) * c.blocks_x +
                                  (x >> c.block_shift),
                              first, std::min(first + c.steps, steps));
            }
    work.tests_a_light = 2 * tests / std::max(1u, scratch[2]);
    return work;
}

ReadLists GpuBuild::read() {
    const lightbin::CullTotals totals = read_as<lightbin::CullTotals>(device_, "scratch", 1)[0];
    if (passes_.back() == lightbin::CullPass::masks) {
        const auto words = read_as<std::uint32_t>(device_, "lists", std::size_t(plan_.bytes.masks / 4));
        ReadLists lists = lists_of({view_.tiles_x(), view_.tiles_y(), words, {.lights = room_.lights}, {}});
        lists.totals.visible = totals.visible;
        return lists;
    }
    return {totals, read_as<lightbin::ListRange>(device_, "tiles", std::size_t(plan_.bytes.tiles / 8)),
            read_as<std::uint32_t>(device_, "lists", std::min(totals.entries, room_.entries))};
}
