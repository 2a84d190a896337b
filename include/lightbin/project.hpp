// SPDX-License-Identifier: MIT
// Stage 2: spheres -> footprints, the tile rectangle and depth interval of each light in view, all rounded
// outward.
#pragma once

#include <lightbin/detail/buffer.hpp>
#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/kernels.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/view.hpp>

#include <cstddef>
#include <cstdint>

namespace lightbin {

/// The footprints of the lights in view, in ascending order of id. Keeps its memory from call to call.
template <bool with_depth> class Footprints {
public:
    /// Projects every light with the kernel of an instruction set. After it, a light's rectangle holds each
    /// tile that the part of its sphere beyond the near plane projects to; it is the smallest such rectangle
    /// but for the rounding margin of the view. The depth interval is z - r to z + r in float: rounding is
    /// monotone, so comparing it with float bounds never loses a light.
    template <class Light, class ToViewSphere>
    void project(Isa isa, const View& view, const Lights<Light, ToViewSphere>& lights) {
        lights_ = lights.array.size();
        const std::size_t room = lights_ + detail::FootprintArrays::padding;
        arrays_ = {ids_.room(room), x0_.room(room), y0_.room(room), x1_.room(room), y1_.room(room), nullptr};
        if constexpr (with_depth) arrays_.depths = depths_.room(room);
        counts_ = {};
        const detail::ProjectKernel<with_depth> kernel = detail::project_kernel<with_depth>(isa);
        detail::for_each_block(lights, [&](const Sphere* spheres, std::uint32_t n, std::uint32_t first_id) {
            kernel(view.camera(), spheres, n, first_id, arrays_, counts_);
        });
    }

    std::size_t lights() const { return lights_; }
    std::uint32_t visible() const { return counts_.visible; }
    std::uint32_t rejected() const { return counts_.rejected; }  ///< bad input, see Sphere
    std::uint64_t area() const { return counts_.area; }          ///< sum of the rectangles' tiles
    const detail::FootprintArrays& arrays() const { return arrays_; }

private:
    detail::Buffer<std::uint32_t> ids_;
    detail::Buffer<std::uint16_t> x0_, y0_, x1_, y1_;
    detail::Buffer<DepthInterval> depths_;
    std::size_t lights_ = 0;
    detail::FootprintArrays arrays_ = {};
    detail::ProjectCounts counts_;
};

}  // namespace lightbin
