// SPDX-License-Identifier: MIT
// The projection stage: from lights to footprints, the tile rectangles of the lights in view, rounded outward.
#pragma once

#include <lightbin/detail/dispatch/kernels.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/parallel.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The most lights of a call. Where their rectangles have less than 2^32 tiles in all, 32 bits then count the lists of
/// the blocks of 8x8 tiles in one band: a light meets up to two blocks more than an eighth of its width.
inline constexpr std::uint64_t max_lights = std::uint64_t{1} << 30;

/// Returns why lights can't be binned, or nothing if they can.
template <class Source> std::optional<Error> refuse(const Source& source, std::uint64_t most = max_lights) {
    std::optional<Error> error;
    for_each_array(source, [&](const auto& lights) {
        if (error || !lights.to_view) return;
        if (const auto code = lights.to_view->refusal()) error = Error{*code};
    });
    const std::uint64_t count = light_count(source);
    if (!error && count > most) return Error{ErrorCode::too_many_lights, count, most};
    return error;
}

/// Returns into how many parts an array of lights is divided to be projected: four a thread, so that little time is
/// lost where one thread starts late. It is 1 if there is one thread, as each part takes memory, and where the padding
/// behind each part's run of footprints could push indices beyond 32 bits.
inline std::size_t parts_of_array(std::size_t lights, const Parallel& parallel) {
    const std::size_t chunks = lights / ChunkRects::size + 1, workers = parallel.workers();
    return workers > 1 && lights >> 31 == 0 ? min_of(chunks, 4 * min_of(chunks, workers)) : 1;
}

/// Writes the lights that `lights`, a Lights, makes of its array. LightSource::copy points to this function.
template <class Array> void copy_lights(const void* lights, std::size_t first, std::size_t count, void* to) {
    static_cast<const Array*>(lights)->make(first, count, static_cast<typename Array::Made*>(to));
}

/// What Footprints keep of the lights in view space for later stages: nothing; the lights, for slices or coverage();
/// with each spot or Box also what the depth test needs.
enum class Kept : std::uint8_t { nothing, lights, lights_and_planes };

/// The footprints of the lights in view, in ascending order of id.
class Footprints {
public:
    /// Projects all lights. A light's rectangle then holds each tile that the part of its sphere, or spot, beyond the
    /// near plane is projected to, and is the smallest such rectangle but for the view's rounding margin. For a spot
    /// whose sphere does not lie wholly beyond the near plane, it is the intersection of the rectangles of its sphere
    /// and of its bounding_sphere(). For a Box it is the intersection of the rectangles of its sphere and of its box.
    template <class Source>
    void project(Isa isa, const View& view, const Source& source, const Parallel& parallel, Kept kept = Kept::nothing) {
        lights_ = light_count(source);
        const auto parts_of = [&](const auto& lights) { return parts_of_array(lights.array.size(), parallel); };
        run_count_ = 0;
        for_each_array(source, [&](const auto& lights) { run_count_ += parts_of(lights); });
        runs_.reserve(run_count_);
        part_counts_.reserve(run_count_);
        arrays_ = buffers_.reserve(lights_ + (run_count_ - 1) * widest_vector);
        std::size_t first_id = 0, first_part = 0;
        for_each_array(source, [&](const auto& lights) {
            project_array(isa, view, lights, parallel, kept, first_id, first_part, parts_of(lights));
            first_id += lights.array.size();
            first_part += parts_of(lights);
        });
        counts_ = {};
        for (std::size_t part = 0; part < run_count_; ++part) {
            const ProjectCounts& counts = part_counts_.data()[part];
            counts_.visible += counts.visible;
            counts_.rejected += counts.rejected;
            counts_.area += counts.area;
        }
    }

    std::uint32_t visible() const { return counts_.visible; }  ///< lights in view
    std::uint64_t area() const { return counts_.area; }        ///< tiles in all rectangles
    const FootprintArrays& arrays() const { return arrays_; }
    std::span<const FootprintRun> runs() const { return {runs_.data(), run_count_}; }

    /// How many lights were given and left out, and the ids at which kinds begin.
    LightCounts counts() const {
        const auto all = static_cast<std::uint32_t>(lights_);
        const ViewLights& kinds = arrays_.view_lights;
        return {all, counts_.rejected, all - counts_.rejected - counts_.visible, kinds.first_spot, kinds.first_box};
    }

    FootprintSlice all() const { return {arrays_, runs(), visible(), area()}; }

private:
    static constexpr std::size_t chunk = ChunkRects::size;

    /// Projects one array of lights, divided into `parts` parts, each of which becomes a run of footprints.
    ///
    /// first_id, first_part  the number of lights, and of parts, in the arrays before this one
    template <class Array>
    void project_array(Isa isa, const View& view, const Array& lights, const Parallel& threads, Kept kept,
                       std::size_t first_id, std::size_t first_part, std::size_t parts) {
        constexpr LightKind kind = Array::kind;
        const std::size_t count = lights.array.size();
        LightSource source = {.array = lights.as_they_are(),
                                      .lights = &lights,
                                      .first_id = static_cast<std::uint32_t>(first_id),
                                      .to_view = lights.to_view ? &*lights.to_view : nullptr,
                                      .with_planes = kept == Kept::lights_and_planes};
        if (source.array == nullptr) source.copy = copy_lights<Array>;
        ViewLights& view_lights = arrays_.view_lights;
        const bool keep = kept != Kept::nothing;
        const std::uint64_t capacity = std::uint64_t{count} + chunk;
        if constexpr (kind == LightKind::sphere) {
            view_lights.spheres = static_cast<const Sphere*>(source.array);
            if (keep && (source.copy != nullptr || source.to_view != nullptr))
                view_lights.spheres = source.out_spheres = spheres_.reserve(capacity);
            view_lights.first_spot = view_lights.first_box = static_cast<std::uint32_t>(first_id + count);
        } else if constexpr (kind == LightKind::spot) {
            if (keep) view_lights.spots = source.out_spots = spots_.reserve(capacity);
            view_lights.first_box = static_cast<std::uint32_t>(first_id + count);
        } else if (keep) {
            view_lights.boxes = source.out_boxes = boxes_.reserve(capacity);
        }
        // A single light is projected faster alone than in a vector that is filled up with copies of it.
        const auto kernel = project_kernel<kind>(count > 1 ? isa : Isa::scalar);
        // Each part consists of whole chunks.
        const auto first_of = [&](std::size_t part) {
            const std::uint64_t chunks = count / chunk + 1;
            return static_cast<std::size_t>(min_of<std::uint64_t>(chunks * part / parts * chunk, count));
        };
        threads.run(parts, [&](std::size_t i) {
            const std::size_t first = first_of(i), end = first_of(i + 1), part = first_part + i;
            const std::size_t to = first_id + first + part * widest_vector;
            ProjectCounts sum;
            kernel(camera_of(view), source, static_cast<std::uint32_t>(first),
                   static_cast<std::uint32_t>(end - first), arrays_.from(to), sum);
            const FootprintRun run = {static_cast<std::uint32_t>(to),
                                              static_cast<std::uint32_t>(to) + sum.visible};
            part_counts_.data()[part] = sum;
            runs_.data()[part] = run;
        });
    }

    FootprintBuffers buffers_;
    Buffer<Sphere> spheres_;
    Buffer<ViewSpot> spots_;
    Buffer<ViewBox> boxes_;
    Buffer<FootprintRun> runs_;
    Buffer<ProjectCounts> part_counts_;
    std::size_t lights_ = 0, run_count_ = 0;
    FootprintArrays arrays_ = {};
    ProjectCounts counts_;
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
