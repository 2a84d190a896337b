// SPDX-License-Identifier: MIT
// The projection stage: from lights to footprints, the tile rectangles of the lights in view, rounded outward, and with
// silhouettes the spans of tiles in each tile row.
#pragma once

#include <lightbin/detail/tiers/kernels.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/parallel.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

namespace detail {

/// Returns why lights can't be binned, or nothing if they can.
template <class Light, class ToLight>
std::optional<Error> refuse(const Lights<Light, ToLight>& lights, std::uint64_t max_lights = 0xffffffff) {
    if (lights.to_view)
        if (const auto code = lights.to_view->refusal()) return Error{*code};
    if (lights.array.size() > max_lights) return Error{ErrorCode::too_many_lights, lights.array.size(), max_lights};
    return {};
}

/// Writes the spheres or spots that `lights`, a Lights, makes of its array. LightSource::copy points to this function.
template <class Light, class ToLight>
void copy_lights(const void* lights, std::size_t first, std::size_t count, Sphere* to, [[maybe_unused]] Sphere* cones) {
    const auto& from = *static_cast<const Lights<Light, ToLight>*>(lights);
    for (std::size_t i = 0; i < count; ++i)
        if constexpr (Lights<Light, ToLight>::spots) {
            const Spot spot = from.made(from.array[first + i]);
            to[i] = {spot.x, spot.y, spot.z, spot.radius};
            cones[i] = {spot.axis_x, spot.axis_y, spot.axis_z, spot.cos_half_angle};
        } else {
            to[i] = from.made(from.array[first + i]);
        }
}

}  // namespace detail

/// The footprints of the lights in view, in ascending order of id.
///
/// footprint     with Footprint::silhouette, row spans are found, too
/// with_spheres  keep the lights in view space, spheres or spots, for a depth test; silhouettes keep them anyway
template <Footprint footprint, bool with_spheres> class Footprints {
    static constexpr bool with_spans = footprint == Footprint::silhouette, keeps_lights = with_spheres || with_spans;

public:
    /// Projects all lights. A light's rectangle then holds each tile that the part of its sphere, or spot, beyond the
    /// near plane is projected to, and is the smallest such rectangle but for the view's rounding margin. If a spot's
    /// sphere is not wholly beyond the near plane, it is where the rectangles of its sphere and least_sphere() meet.
    ///
    /// force_parallel  use the caller's threads even if projecting is too little work to wake them up for, because a
    ///                 stage that follows has enough
    /// for_boxes       store with each spot what depth tests against boxes need; only if with_spheres
    template <class Light, class ToLight>
    void project(Isa isa, const View& view, const Lights<Light, ToLight>& lights, const Parallel& parallel,
                 bool force_parallel = false, bool for_boxes = false) {
        lights_ = lights.array.size();
        const bool share = force_parallel || parallel.pays_off(detail::project_ns(isa, static_cast<double>(lights_)));
        const Parallel threads = share ? parallel : Parallel();
        constexpr bool spots = Lights<Light, ToLight>::spots;
        // The lights are divided into parts, each of which becomes a run of footprints. Their number is the same
        // whether or not threads share the work; it is 1 where the runs' padding could push indices beyond 32 bits.
        run_count_ = lights_ >> 31 == 0 ? detail::project_parts(lights_ / chunk + 1, parallel.workers()) : 1;
        runs_.reserve(run_count_);
        part_counts_.reserve(run_count_);
        arrays_ = buffers_.reserve(lights_ + (run_count_ - 1) * detail::FootprintArrays::padding, with_spans);
        detail::LightSource source = {.spheres = detail::as_they_are(lights),
                                      .lights = &lights,
                                      .to_view = lights.to_view ? &*lights.to_view : nullptr,
                                      .with_planes = for_boxes};
        if (source.spheres == nullptr) source.copy = detail::copy_lights<Light, ToLight>;
        arrays_.spheres = source.spheres;
        [[maybe_unused]] const std::uint64_t capacity = std::uint64_t{lights_} + chunk;
        if constexpr (keeps_lights && spots)
            arrays_.spots = source.out_spots = spots_.reserve(capacity);
        else if constexpr (keeps_lights)
            if (source.copy != nullptr || source.to_view != nullptr)
                arrays_.spheres = source.out_spheres = spheres_.reserve(capacity);
        // A single light is projected faster alone than in a vector that is filled up with copies of it.
        const auto kernel = detail::project_kernel<spots>(lights_ > 1 ? isa : Isa::scalar);
        // Each part consists of whole chunks, and its footprints are a run of their own.
        const auto first_of = [&](std::size_t part) {
            const std::uint64_t chunks = lights_ / chunk + 1;
            return static_cast<std::size_t>(
                detail::min_of<std::uint64_t>(chunks * part / run_count_ * chunk, lights_));
        };
        threads.run(run_count_, [&](std::size_t part) {
            const std::size_t first = first_of(part), end = first_of(part + 1);
            const std::size_t to = first + part * detail::FootprintArrays::padding;
            detail::ProjectCounts sum;
            kernel(detail::camera_of(view), source, static_cast<std::uint32_t>(first),
                   static_cast<std::uint32_t>(end - first), arrays_.from(to), sum);
            const detail::FootprintRun run = {static_cast<std::uint32_t>(to),
                                              static_cast<std::uint32_t>(to) + sum.visible};
            if constexpr (with_spans)
                for (std::uint32_t i = run.begin; i < run.end; ++i)
                    sum.rows += arrays_.y1[i] - arrays_.y0[i] + 1u;
            part_counts_.data()[part] = sum;
            runs_.data()[part] = run;
        });
        counts_ = {};
        for (std::size_t part = 0; part < run_count_; ++part) {
            const detail::ProjectCounts& counts = part_counts_.data()[part];
            counts_.visible += counts.visible;
            counts_.rejected += counts.rejected;
            counts_.area += counts.area;
            counts_.rows += counts.rows;
        }
        if constexpr (with_spans) add_spans(detail::row_span_kernel<spots>(isa), view, threads);
    }

    std::size_t lights() const { return lights_; }               ///< lights given
    std::uint32_t visible() const { return counts_.visible; }    ///< lights in view
    std::uint32_t rejected() const { return counts_.rejected; }  ///< lights that are bad input, as Sphere defines it
    std::uint64_t area() const { return counts_.area; }          ///< tiles in all rectangles
    const detail::FootprintArrays& arrays() const { return arrays_; }
    detail::Items<const detail::FootprintRun> runs() const { return {runs_.data(), run_count_}; }

    int slices() const { return 1; }
    detail::FootprintSlice slice(std::size_t) const { return {arrays_, runs(), visible(), area()}; }
    LightRanks ranks() const { return {}; }

private:
    static constexpr std::size_t chunk = detail::ChunkRects::size;

    /// Finds the row spans of all footprints, that is, the tiles of each tile row that a silhouette touches, and stores
    /// them in one array, in which the spans of each run of footprints are contiguous.
    void add_spans(detail::RowSpanKernel kernel, const View& view, const Parallel& threads) {
        constexpr std::uint64_t padding = 8;  // kernels store vectors of up to 8 rows
        // Lights whose row spans would have an index above 32 bits get no spans, and cover their whole rectangles.
        const std::uint64_t capacity = detail::min_of(counts_.rows + run_count_ * padding, std::uint64_t{0xffffffff});
        detail::RowSpan* spans = spans_.reserve(capacity + padding);
        arrays_.spans = spans;
        std::uint64_t begin = 0;
        for (std::size_t part = 0; part < run_count_; ++part) {
            detail::ProjectCounts& counts = part_counts_.data()[part];
            const std::uint64_t rows = counts.rows;
            counts.rows = begin;  // from here on, the index of the part's first span
            begin += rows + padding;
        }
        threads.run(run_count_, [&](std::size_t part) {
            kernel(detail::camera_of(view), arrays_, runs_.data()[part], spans, part_counts_.data()[part].rows);
        });
    }

    detail::FootprintBuffers buffers_;
    detail::Buffer<detail::RowSpan> spans_;
    detail::Buffer<Sphere> spheres_;
    detail::Buffer<detail::ViewSpot> spots_;
    detail::Buffer<detail::FootprintRun> runs_;
    detail::Buffer<detail::ProjectCounts> part_counts_;
    std::size_t lights_ = 0, run_count_ = 0;
    detail::FootprintArrays arrays_ = {};
    detail::ProjectCounts counts_;
};

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
