// SPDX-License-Identifier: MIT
// Stage 2: spheres -> footprints, the tile rectangle and depth interval of each light in view, all rounded
// outward.
#pragma once

#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/kernels.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/view.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lightbin {

/// The footprints of the lights in view, in ascending order of id. Keeps its memory from call to call.
template <bool with_depth> class Footprints {
public:
    /// Projects every light with a kernel of this machine's tier. After it, a light's rectangle holds each
    /// tile that the part of its sphere beyond the near plane projects to; it is the smallest such rectangle
    /// but for the rounding margin of the view. The depth interval is z - r to z + r in float: rounding is
    /// monotone, so comparing it with float bounds never loses a light.
    template <class Light, class ToViewSphere>
    void project(detail::ProjectKernel<with_depth> kernel, const View& view,
                 const Lights<Light, ToViewSphere>& lights) {
        lights_ = lights.array.size();
        if (ids_.size() < lights_) {
            ids_.resize(lights_);
            rects_.resize(lights_);
            if constexpr (with_depth) depths_.resize(lights_);
        }
        counts_ = {};
        detail::for_each_block(lights, [&](const Sphere* spheres, std::uint32_t n, std::uint32_t first_id) {
            const detail::ProjectCounts block =
                kernel(view.camera(), spheres, n, first_id, arrays(counts_.visible));
            counts_.visible += block.visible;
            counts_.rejected += block.rejected;
        });
    }

    std::size_t lights() const { return lights_; }
    std::uint32_t visible() const { return counts_.visible; }
    std::uint32_t rejected() const { return counts_.rejected; }  ///< bad input, see Sphere

    detail::FootprintArrays arrays(std::size_t first = 0) {
        return {ids_.data() + first, rects_.data() + first, with_depth ? depths_.data() + first : nullptr};
    }

private:
    std::vector<std::uint32_t> ids_;
    std::vector<detail::TileRect> rects_;
    std::vector<DepthInterval> depths_;
    std::size_t lights_ = 0;
    detail::ProjectCounts counts_;
};

}  // namespace lightbin
