// SPDX-License-Identifier: MIT
// Stage 2: spheres -> footprints, the tile rectangle and depth interval of each light in view, all rounded
// outward.
#pragma once

#include <lightbin/detail/buffer.hpp>
#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/kernels.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/options.hpp>
#include <lightbin/parallel.hpp>
#include <lightbin/view.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lightbin {

/// The footprints of the lights in view, in ascending order of id. Keeps its memory from call to call.
///
/// footprint     silhouette: with row spans
/// with_spheres  keep the view-space spheres too, for a depth test
template <Footprint footprint, bool with_spheres> class Footprints {
    static_assert(footprint == Footprint::rectangle, "lightbin: silhouettes are not built yet");

public:
    /// Projects every light with the kernel of an instruction set. After it, a light's rectangle holds each
    /// tile that the part of its sphere beyond the near plane projects to; it is the smallest such rectangle
    /// but for the rounding margin of the view.
    template <class Light, class ToViewSphere>
    void project(Isa isa, const View& view, const Lights<Light, ToViewSphere>& lights, const Parallel&) {
        lights_ = lights.array.size();
        const std::size_t room = lights_ + detail::FootprintArrays::padding;
        arrays_ = {.ids = ids_.room(room),
                   .x0 = x0_.room(room),
                   .y0 = y0_.room(room),
                   .x1 = x1_.room(room),
                   .y1 = y1_.room(room),
                   .span_begin = nullptr,
                   .spans = nullptr,
                   .spheres = nullptr};
        Sphere* kept = nullptr;
        if constexpr (with_spheres) arrays_.spheres = kept = spheres_.room(room);
        counts_ = {};
        const detail::ProjectKernel kernel = detail::project_kernel(isa);
        detail::for_each_block(lights, [&](const Sphere* spheres, std::uint32_t n, std::uint32_t first_id) {
            if constexpr (with_spheres) std::copy_n(spheres, n, kept + first_id);
            kernel(view.camera(), spheres, n, first_id, arrays_, counts_);
        });
        run_ = {0, counts_.visible};
    }

    std::size_t lights() const { return lights_; }
    std::uint32_t visible() const { return counts_.visible; }
    std::uint32_t rejected() const { return counts_.rejected; }  ///< bad input, see Sphere
    std::uint64_t area() const { return counts_.area; }          ///< sum of the rectangles' tiles
    const detail::FootprintArrays& arrays() const { return arrays_; }
    std::span<const detail::FootprintRun> runs() const { return {&run_, 1}; }

private:
    detail::Buffer<std::uint32_t> ids_;
    detail::Buffer<std::uint16_t> x0_, y0_, x1_, y1_;
    detail::Buffer<Sphere> spheres_;
    std::size_t lights_ = 0;
    detail::FootprintArrays arrays_ = {};
    detail::FootprintRun run_ = {};
    detail::ProjectCounts counts_;
};

}  // namespace lightbin
