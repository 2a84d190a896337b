// SPDX-License-Identifier: MIT
// The data of the passes that make a light grid on the GPU: plan_cull() has the constants, sizes and group counts, and
// shader_edges() and shader_slabs() what a buffer holds.
#pragma once

#include <lightbin/cull_options.hpp>
#include <lightbin/detail/base/float_environment.hpp>
#include <lightbin/detail/base/rounding.hpp>
#include <lightbin/detail/shaders/cull_common.hpp>
#include <lightbin/detail/view/cell_boxes.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/slices.hpp>
#include <lightbin/view.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

namespace detail {

inline constexpr std::uint32_t cull_group_row = 32768;  ///< the most work groups in x; more go on in y
inline constexpr std::uint32_t cull_max_segments = 32;

/// Returns `dividend` / `divisor`, rounded up.
constexpr std::uint32_t divided_up(std::uint64_t dividend, std::uint64_t divisor) {
    return static_cast<std::uint32_t>((dividend + divisor - 1) / divisor);
}

inline CullGroups cull_groups(std::uint64_t count) {
    return {static_cast<std::uint32_t>(min_of<std::uint64_t>(count, cull_group_row)),
            divided_up(count, cull_group_row)};
}

/// Sets the columns and rows of mask blocks: 8x8 tiles each, or more where that would make too many.
inline void plan_blocks(CullConstants& to) {
    for (to.block_shift = 3, to.slice_shift = 0;;) {
        to.blocks_x = max_of(divided_up(to.tiles_x, 1u << to.block_shift), 1u);
        to.blocks_y = max_of(divided_up(to.tiles_y, 1u << to.block_shift), 1u);
        const std::uint32_t layers = divided_up(to.slices, 1u << to.slice_shift);
        if (to.blocks_x * to.blocks_y * layers <= cull_max_blocks) return;
        ++(to.blocks_x * to.blocks_y > 1 ? to.block_shift : to.slice_shift);
    }
}

/// Sets an image axis. The margin is the Binner's plus how far its results and the GPU's may differ, which add_span()
/// derives. As in ImageAxis::margin the last term is for denormal numbers that are flushed to zero.
inline void plan_axis(const ImageAxis& axis, float& scale, float& offset, float& margin, float& limit) {
    scale = static_cast<float>(axis.scale);
    offset = static_cast<float>(axis.offset);
    const double tiles = axis.tiles, farthest = max_of(abs_of(axis.offset), abs_of(tiles - axis.offset));
    margin = float_above(static_cast<double>(axis.margin) + 0x1.7p-19 * farthest +
                         0x1p-21 * (abs_of(axis.offset) + tiles) + 0x1p-60 * axis.scale);
    limit = axis.limit;
}

inline void plan_camera(const Camera& camera, CullConstants& to) {
    plan_axis(camera.x, to.scale_x, to.offset_x, to.margin_x, to.limit_x);
    plan_axis(camera.y, to.scale_y, to.offset_y, to.margin_y, to.limit_y);
    to.sign_x = camera.x.sign;
    to.sign_y = camera.y.sign;
    to.sign_z = camera.z_sign;
    to.near_depth = camera.near_depth;
    to.near_fast = camera.min_float_depth;
    // A depth z +- r that the GPU computes is off by 2u of itself, and by 2^-126 where it is flushed to zero.
    // Lights beyond 2^40 are in view anyway, so the far plane may be there.
    const double near_depth = static_cast<double>(camera.near_depth),
                 far_depth = min_of(static_cast<double>(camera.far_depth), 0x1p42);
    to.front = float_below(near_depth - 0x1p-20 * abs_of(near_depth) - 0x1p-120);
    to.back = float_above(far_depth + 0x1p-20 * abs_of(far_depth) + 0x1p-120);
}

/// Sets the transform from world space. The GPU's sums may be off by twice what correctly rounded ones are, and its
/// sphere must hold the Binner's, whose radius is enlarged by its own bound: together four times the Binner's
/// bound.
inline void plan_transform(const FloatTransform& from, CullConstants& to) {
    const auto copy = [](const float (&numbers)[3], float (&into)[3]) { copy_items(numbers, 3, into); };
    copy(from.origin, to.origin);
    copy(from.columns[0], to.column_x);
    copy(from.columns[1], to.column_y);
    copy(from.columns[2], to.column_z);
    copy(from.origin_image, to.origin_image);
    to.stretch = float_above(static_cast<double>(from.stretch) * (1 + 0x1p-20));
    to.error_rate = 4 * from.error_rate;
    to.error_at_origin = 4 * from.error_at_origin;
    to.cone_error = from.cone_error;
    to.max_distance = from.max_distance;
}

/// Sets where in the buffer `scratch` each of its arrays begins, and returns how many words they take in all.
inline std::uint64_t plan_scratch(const CullOptions& options, std::uint64_t cells, CullConstants& to) {
    const std::uint64_t groups = max_of(divided_up(to.lights, 64), 1u),
                        record_words = cull_record_words(options) * 64 * groups,
                        layers = divided_up(to.slices, 1u << to.slice_shift);
    std::uint64_t end = sizeof(CullTotals) / 4 + record_words;
    const auto place = [&](std::uint64_t words) {
        const std::uint64_t begin = end;
        end += words;
        return static_cast<std::uint32_t>(begin);
    };
    to.masks = place((2 * groups + divided_up(groups, 16)) * to.blocks_x * to.blocks_y * layers);
    to.counts = place(cells * to.segments);
    to.ranges = place(2 * cells);
    to.sums = place(divided_up(cells, 128));
    to.groups = place(groups);
    return end;
}

}  // namespace detail

inline Result<CullPlan> plan_cull(const View& view, const CullOptions& options, const CullCapacity& room,
                                  const Slices* slices, const Matrix* to_view) {
    using namespace detail;
    const DefaultFloatEnvironment environment;
    if (const auto error = refuse_cull(options)) return *error;
    const bool clusters = options.slicing == Slicing::clusters;
    LIGHTBIN_ASSERT((slices != nullptr) == clusters && (to_view != nullptr) == options.world_space);
    const std::uint32_t slice_count = clusters ? static_cast<std::uint32_t>(slices->count()) : 1;
    if (slice_count > cull_max_slices) return Error{ErrorCode::too_many_slices, slice_count, cull_max_slices};
    const bool mixed = options.kind == CullKind::mixed;
    const std::uint64_t lights = std::uint64_t{room.lights} + (mixed ? std::uint64_t{room.spots} + room.boxes : 0),
                        most_lights = options.ids == IdWidth::u16 ? 0x10000 : 0xffffffff;
    if (lights > most_lights) return Error{ErrorCode::too_many_lights, lights, most_lights};
    CullPlan plan;
    CullConstants& to = plan.constants;
    to.tiles_x = static_cast<std::uint32_t>(view.tiles_x());
    to.tiles_y = static_cast<std::uint32_t>(view.tiles_y());
    to.slices = slice_count;
    to.entries = room.entries;
    to.lights = static_cast<std::uint32_t>(lights);
    if (mixed) {
        to.first_spot = room.lights;
        to.first_box = room.lights + room.spots;
        to.spots_at = room.lights * options.lights_at.stride;
        to.boxes_at = to.spots_at + room.spots * options.lights_at.spot_stride;
    }
    plan_blocks(to);
    plan_camera(camera_of(view), to);
    // Lights' depths are widened by the margin of the slices, and by how far they may differ from the Binner's.
    to.depth_margin = float_above((clusters ? static_cast<double>(table_of(*slices).margin) : 0) + 0x1p-20);
    if (to_view != nullptr) {
        const WorldToView transform(*to_view);
        if (const auto refused = transform.refusal()) return Error{*refused};
        if (transform.in_float().max_distance < 0) return Error{ErrorCode::view_matrix_distorts};
        plan_transform(transform.in_float(), to);
    }

    // The lights are divided into segments, which work groups go through side by side. Where there are many cells, few
    // segments suffice to occupy a GPU.
    const std::uint64_t tiles = std::uint64_t{to.tiles_x} * to.tiles_y, cells = tiles * slice_count;
    const std::uint32_t steps = max_of(divided_up(to.lights, 1024), 1u),
                        groups = max_of(divided_up(to.lights, 64), 1u);
    const std::uint64_t wanted = max_of<std::uint64_t>((1u << 20) / max_of<std::uint64_t>(cells, 1), 1);
    to.steps = divided_up(steps, min_of<std::uint64_t>(wanted, cull_max_segments));
    to.segments = divided_up(steps, to.steps);
    const std::uint64_t words = plan_scratch(options, cells, to);
    if (words > 0xffffffff) return Error{ErrorCode::scratch_too_large, 4 * words, 4 * std::uint64_t{0xffffffff}};
    const std::uint64_t mask_words = divided_up(to.lights, 32), of_each = to.tiles_x + to.tiles_y + 33,
                        masks = 1 + of_each * mask_words;
    if (masks > 0xffffffff) return Error{ErrorCode::too_many_entries, masks, 0xffffffff};

    const auto size = [](std::uint64_t bytes) { return max_of<std::uint64_t>((bytes + 3) / 4 * 4, 16); };
    plan.bytes = {size(4 * words), size(8 * cells),
                  size(std::uint64_t{room.entries} * static_cast<unsigned>(options.ids)), size(4 * masks)};
    const std::uint64_t blocks = std::uint64_t{divided_up(to.tiles_x, 8)} * divided_up(to.tiles_y, 8) * slice_count;
    const auto set = [&](CullPass pass, std::uint64_t count) {
        plan.groups[static_cast<std::size_t>(pass)] = cull_groups(max_of<std::uint64_t>(count, 1));
    };
    set(CullPass::project, groups);
    set(CullPass::count, blocks * to.segments);
    set(CullPass::sums, divided_up(cells, 128));
    set(CullPass::offsets, 1);
    set(CullPass::fill, blocks * to.segments);
    set(CullPass::masks, mask_words * divided_up(of_each, 128));
    plan.masks_suit = lights <= 1024 && !clusters && !options.depth_test;
    return plan;
}

inline std::vector<ShaderEdges> shader_edges(const View& view) {
    const detail::DefaultFloatEnvironment environment;
    std::vector<ShaderEdges> edges;
    const detail::Camera& camera = detail::camera_of(view);
    for (const detail::ImageAxis* axis : {&camera.x, &camera.y})
        for (int tile = 0; tile < axis->tiles; ++tile) {
            edges.emplace_back();
            detail::tile_edges(*axis, tile, edges.back().low, edges.back().high);
        }
    return edges;
}

inline std::vector<ShaderEdges> shader_slabs(const Slices& slices) {
    const detail::SliceTable& table = table_of(slices);
    std::vector<ShaderEdges> slabs;
    float low = -detail::infinity;
    for (const float boundary : table.boundaries()) {
        slabs.push_back({low, table.farther(boundary)});
        low = table.nearer(boundary);
    }
    slabs.push_back({low, detail::infinity});
    return slabs;
}

}}  // namespace lightbin
