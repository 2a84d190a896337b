// SPDX-License-Identifier: MIT
// Stability: may change.
// Which options and tile size light a scene in the least time? advise() measures them on the scene itself, both the
// time to build the lists and the time to shade with them. docs/advise.md shows its use.
#pragma once

#include <lightbin/options.hpp>
#include <lightbin/slices.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// Costs that advise() can't measure, as they depend on the renderer and the GPU. Times are in nanoseconds, 0 or more.
struct AdviceCosts {
    /// The time to evaluate one light at one pixel: about 1 on a CPU core, and 0.005 to 0.05 on a whole, parallel GPU.
    double evaluation_ns = 0.02;
    /// The time to look at one word of masks, in light evaluations: about 1 with a plain shader on Mesa's software
    /// renderer. The longer a material takes for a light, the less it is.
    double word_evaluations = 1;
    /// The time of the depth pre-pass and its reduction to each tile's Z bounds; 0 if the renderer does both anyway.
    double z_bounds_ns = 0;
    /// The time to move one byte of the lists to where the shader reads it: 0.1 at 10 GB/s.
    double upload_byte_ns = 0;
    /// The number of fragments that are shaded per visible pixel without a depth pre-pass, 1 or more. It multiplies the
    /// light evaluations (AdvicePlan::evaluations) of each plan without Z bounds, as such a plan has no pre-pass.
    double overdraw = 1;
};

/// One way to light a view, and its costs per frame. `depth_test` and `slicing` are the Options of a Binner, and
/// View::with_tile_size() applies the tile size. A plan with masks is for a MaskBinner, which is given the slices if
/// `slicing` is z_bins.
struct AdvicePlan {
    bool tiled = true;  ///< false: every pixel evaluates every light; `depth_test` to `tile_size` mean nothing
    bool depth_test = false;
    Slicing slicing = Slicing::none;  ///< values other than `none` need the slices given to advise_slices()
    bool masks = false;               ///< masks of columns and rows, which a MaskBinner makes, in place of lists
    int tile_size = 0;
    double build_ns = 0;        ///< the time to build the lists, plus AdviceCosts::z_bounds_ns if the plan has Z bounds
    double upload_ns = 0;       ///< the time to move the lists to where the shader reads them
    std::uint64_t entries = 0;  ///< the length of the light index list, or of LightMasks::words()
    /// The list lengths summed over all pixels with something to light; without Z bounds multiplied by
    /// AdviceCosts::overdraw.
    double evaluations = 0;
    double words = 0;  ///< the words of masks that all these pixels look at; multiplied like `evaluations`
    /// The time of a frame:
    /// build_ns + upload_ns + (evaluations + words * AdviceCosts::word_evaluations) * AdviceCosts::evaluation_ns
    double total_ns = 0;

    bool has_z_bounds() const { return tiled && depth_test && slicing != Slicing::clusters; }
};

/// Returns a plan in words, such as "16 px, depth test".
inline std::string to_string(const AdvicePlan& plan) {
    if (!plan.tiled) return "every light in every pixel";
    std::string words = std::to_string(plan.tile_size) + " px";
    if (plan.masks) words += ", masks";
    if (plan.depth_test) words += ", depth test";
    if (plan.slicing != Slicing::none) words += std::string(", ") + to_string(plan.slicing);
    return words;
}

/// What one technique saves or costs in a plan that verdicts() judges. Techniques are tiles, masks, a depth
/// pre-pass, the depth test, Slicing::clusters and Slicing::z_bins.
struct AdviceVerdict {
    std::string part;     ///< the technique's name, such as "clusters"
    bool keep = false;    ///< whether the judged plan uses the technique that `part` names
    AdvicePlan other = {};  ///< the cheapest measured plan that lacks the technique if `keep` is true, or else uses it
    std::string instead;  ///< `other` in words; empty if no measured plan differs from the judged one in `part`
    double saved_ns = 0;  ///< the time of a frame with the AdvicePlan `other` minus that with the judged plan
};

/// Returns a line such as  "clusters     keep: saves 1.200 ms    instead: 16 px, z_bins".  This says that the judged
/// plan has clusters, and that the cheapest plan without them, which has tiles of 16 pixels and z-bins, takes 1.2 ms
/// more per frame.
inline std::string to_string(const AdviceVerdict& verdict);

/// Every plan (options of a Binner and a tile size) that was measured, in ascending order of the time of a frame.
class Advice {
public:
    /// Sorts the plans by insertion: plans of equal time keep their order. (std::stable_sort warns in some compilers.)
    explicit Advice(std::vector<AdvicePlan> plans) : plans_(std::move(plans)) {
        const auto is_cheaper = [](const AdvicePlan& a, const AdvicePlan& b) { return a.total_ns < b.total_ns; };
        for (auto plan = plans_.begin(); plan != plans_.end(); ++plan)
            std::rotate(std::upper_bound(plans_.begin(), plan, *plan, is_cheaper), plan, plan + 1);
    }

    const AdvicePlan& best() const { return plans_[0]; }
    std::span<const AdvicePlan> plans() const& { return plans_; }
    std::span<const AdvicePlan> plans() && = delete;  // would dangle

    /// Returns a verdict on each technique, such as tiles: compares `plan` with the cheapest measured plan that lacks
    /// the technique if `plan` uses it, or uses it if `plan` lacks it. Other options of that plan may differ as well.
    std::vector<AdviceVerdict> verdicts(const AdvicePlan& plan) const;

private:
    std::vector<AdvicePlan> plans_;
};

/// Returns the advice for people to read: the cheapest plan, and a line for each technique with what it saves or costs.
inline std::string to_string(const Advice& advice);

/// Measures what each way to light a view costs: without tiles; and with tiles of the view's tile size, of 2, 4 and 8
/// times that size, and of one tile as large as the screen, each by masks and by lists without and, if there are
/// `bounds`, with the depth test. So pass the view with the smallest tiles that you would use. Errors: those of
/// Binner::bin().
///
/// Call it once per scene, not once per frame, in an optimised build. It takes as long as some hundreds of plain builds
/// of the view's grid, or a thousand if these are short: it builds every grid 3 to 9 times on this thread, with the
/// image moved slightly sideways each time but the first, and takes the shortest time. It keeps no memory.
///
/// lights  as for Binner::bin()
/// bounds  Z bounds of the view's own tiles, from which bounds of larger tiles are merged. Without bounds, the
///         depth test is not measured, and every pixel is assumed to have something to light: if a third of the pixels
///         is sky, multiply AdviceCosts::evaluation_ns by two thirds
/// Clock   a clock like those of <chrono>; one that counts this thread's own time is better on a busy machine
template <class Clock = std::chrono::steady_clock, class LightRange>
Result<Advice> advise(const View& view, const LightRange& lights, const AdviceCosts& costs = {},
                      const ZBounds& bounds = {});

/// View depths of the visible surfaces at points evenly spread over the viewport, from the previous frame or from a few
/// frames that are typical of the scene.
struct DepthSamples {
    /// One view depth per point, row by row from the view's WindowOrigin; NaN or infinity where nothing is to be lit.
    std::span<const float> depths;
    ImageSize size;  ///< the number of columns and of rows of depths, such as one depth for every 8x8 pixels
};

/// The slices that advise_slices() uses for Slicing::clusters and Slicing::z_bins.
struct WeighedSlices {
    const Slices& clusters;  ///< typically some dozens
    const Slices& z_bins;    ///< typically some hundreds
};

/// Measures, like advise(), the ways to light a view that need no depth pre-pass: without tiles; tiles, and tiles with
/// z-bins, by lists and by masks; clusters without and with the depth test. The tile sizes are those of advise(). Each
/// depth sample stands for an equal share of the pixels, which evaluate the list of their tile; with z-bins its part
/// between the ranks of the depth's bin; with clusters the list of the cell. Errors: those of Binner::bin(), and
/// fewer depths than samples.size says.
///
/// Compared with what advise() finds for the same view with Z bounds, the result shows whether a depth pre-pass pays
/// off. It takes longer than advise(), because clusters of the smallest tiles do.
template <class Clock = std::chrono::steady_clock, class LightRange>
Result<Advice> advise_slices(const View& view, const LightRange& lights, const WeighedSlices& slices,
                             const DepthSamples& samples, const AdviceCosts& costs = {});

}}  // namespace lightbin

// The definitions.
#include <lightbin/detail/tools/weigh.hpp>
