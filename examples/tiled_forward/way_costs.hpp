// SPDX-License-Identifier: MIT
// What a frame costs that is lit in one way or another: measured, all ways in turns.
#pragma once

#include "binned_lights.hpp"
#include "cpu_depth.hpp"

#include <lightbin/advise.hpp>

#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

// A plan, and the parts that lightbin::advise() leaves to the caller.
struct Way {
    lightbin::AdvicePlan plan;
    bool minimum = true, maximum = true;  // sides of the Z bounds, where the plan has any
    bool narrow_ids = false;              // of 16 bits
    bool threads = false;                 // as many as the processor has, else one
    bool cones = true;                    // spots binned as spots, else as the least spheres around them
};

// Of a frame, in nanoseconds.
struct WayCost {
    double depth = 0;  // Z bounds, with the pre-pass where that was timed; or slices
    double build = 0, upload = 0, shade = 0;

    double total() const { return depth + build + upload + shade; }
};

// What is told by drawing, see DrawTimes.
struct Prices {
    double evaluation_ns = lightbin::AdviceCosts().evaluation_ns, upload_byte_ns = 0.1;
    double depth_pass_ns = 0;
    double read_back_ns = 0;             // of the depth buffer; infinite where it can't be
    double gpu_reduction_ns = HUGE_VAL;  // in place of the read-back and the reduction here
};

// Lights in view space, as spots where any has a cone, else as spheres; and the boxes of decals, probes and projectors.
struct ViewLights {
    std::vector<lightbin::Spot> spots;
    std::vector<lightbin::Sphere> spheres;
    std::vector<lightbin::Box> boxes;

    std::size_t size() const { return spots.size() + spheres.size() + boxes.size(); }
};

class Pool;

// A view, what is seen in it, and what there is to measure ways with.
class WayCosts {
public:
    // `lights`: placed in the view
    WayCosts(const lightbin::View& view, const glm::mat4& projection, const BinnedLights& lights,
             CpuDepth depth);
    ~WayCosts();

    void set(const Prices& prices) { prices_ = prices; }

    // Every plan of lightbin::advise(), with all Z bounds that can be had, and of advise_slices().
    // Plans with masks are left out, but for the cheapest of them, masks().
    lightbin::Advice advise();
    const lightbin::AdvicePlan& masks() const { return masks_; }

    // Builds each way's lists a dozen times, by turns, each time with the lights a little aside, and takes the medians.
    // Bytes and evaluations are counted with the lights where they are. A way whose plan it can't measure costs infinity.
    std::vector<WayCost> measure(std::span<const Way> ways);

    // Whether Z bounds of the way cost less where the depth buffer lies. measure() takes the cheaper.
    bool reduces_on_gpu(const Way& way);

    const lightbin::View& view() const { return view_; }
    std::string slices_in_words(lightbin::Slicing slicing) const;  // the call that makes them
    std::size_t light_count() const { return sets_[0].size(); }  // and boxes
    double overdraw() const { return depth_.overdraw; }
    bool has_cones() const { return !sets_[0].spots.empty(); }
    bool has_boxes() const { return !sets_[0].boxes.empty(); }
    std::size_t workers() const { return workers_; }

private:
    struct Reduced {
        std::vector<float> min, max;
        lightbin::ZBounds bounds;
        double ns = 0;
    };
    // What the lists of the lights where they are hold.
    struct Counts {
        double bytes = 0, evaluations = 0;
    };
    // Builds the lists of a light set, and returns how many nanoseconds that took. Counts if asked to.
    using Build = std::function<double(const ViewLights& lights, Counts* counts)>;

    const Reduced& reduced(int tile_size, bool minimum, bool maximum);
    double z_bounds_ns(const Way& way);
    Build build_of(const Way& way);
    template <lightbin::Options options> Build build_with(const Way& way);

    lightbin::View view_;
    CpuDepth depth_;
    std::vector<float> view_depth_;  // of each pixel; infinity where nothing is
    std::vector<ViewLights> sets_;   // the scene's own, then those a little aside
    lightbin::Slices clusters_, z_bins_;
    double clusters_ns_ = 0, z_bins_ns_ = 0;  // to make them
    Prices prices_;
    lightbin::AdvicePlan masks_;  // by advise()
    std::map<std::tuple<int, bool, bool>, Reduced> reduced_;
    std::size_t workers_;
    std::unique_ptr<Pool> pool_;
};
