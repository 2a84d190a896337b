// SPDX-License-Identifier: MIT
// Stability: settled.
// Binner: makes light grids in one call. It owns the grids and the scratch memory that making them takes.
#pragma once

#include <lightbin/detail/stages/binner_inputs.hpp>
#include <lightbin/detail/stages/stages.hpp>
#include <lightbin/list_format.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

/// The inputs of Binner::bin() beside the lights. An input that the options read must be given, and no other may be.
template <bool depth_test, Slicing slicing = Slicing::none> struct Inputs {
    static constexpr bool reads_slices = slicing != Slicing::none,
                          reads_bounds = depth_test && slicing != Slicing::clusters;

    /// The depth slices. Temporary Slices are copied; other Slices must live until the Binner's call returns.
    std::conditional_t<reads_slices, detail::SlicesInput, detail::NotRead> slices =
        detail::slices_left_out<reads_slices>();
    /// Z bounds: minimum, maximum or both. Lights are not tested against a bound whose span is empty. With clusters
    /// they may be left out; the cells whose slice does not meet their tile's bounds then list no light.
    std::conditional_t<reads_bounds || slicing == Slicing::clusters, ZBounds, detail::NotRead> bounds =
        detail::bounds_left_out<reads_bounds>();
};

/// Returns Inputs with the bounds if the options read bounds, else without. For templates whose options vary.
template <Options options>
requires(options.slicing == Slicing::none)
Inputs<options.depth_test> inputs_for([[maybe_unused]] const ZBounds& bounds) {
    if constexpr (options.depth_test)
        return {.bounds = bounds};
    else
        return {};
}

/// Returns Inputs with the bounds or slices, or both, that the options read. For templates whose options vary,
/// Options::slicing among them. Temporary Slices are copied; others must live until the Binner's call returns.
template <Options options>
Inputs<options.depth_test, options.slicing> inputs_for([[maybe_unused]] const ZBounds& bounds,
                                                       [[maybe_unused]] const detail::SlicesInput& slices) {
    using Read = Inputs<options.depth_test, options.slicing>;
    if constexpr (!Read::reads_slices)
        return inputs_for<options>(bounds);
    else if constexpr (Read::reads_bounds)
        return {.slices = slices, .bounds = bounds};
    else
        return {.slices = slices};
}

/// Bins lights into screen tiles.
///
/// A Binner keeps its memory from call to call: it allocates only where an input needs more memory than all before, or
/// another kernel or number of threads is chosen for it. If a call throws, the Binner has no grid, and later calls work
/// as usual. Not thread-safe: use one Binner per thread. During a call, the library and the caller's callables compute
/// in the floating-point environment that threads start with: rounding to nearest, no traps, denormal numbers kept.
template <Options options = Options{}> class Binner {
    static_assert(options.ids != IdWidth::u8,
                  "lightbin: a Binner's ids have 16 or 32 bits: take Options{.ids = IdWidth::u16} and have "
                  "encode() make 8 bits of them");

public:
    using Id = std::conditional_t<options.ids == IdWidth::u16, std::uint16_t, std::uint32_t>;
    using Inputs = lightbin::Inputs<options.depth_test, options.slicing>;
    /// The format of the grids, to give to SnippetOptions::format for a shader that reads them.
    static constexpr ListFormat list_format = {.ids = options.ids};

    Binner() = default;
    /// isa  the widest instruction set to use, even where the machine has a wider one. The result is the same.
    explicit Binner(Isa isa) : isa_(isa) {}
    /// Takes over the memory and the grid of `other`, which is then like a new Binner.
    Binner(Binner&& other) = default;
    Binner& operator=(Binner&& other) = default;

    /// Returns the light grid of `lights` in `view`. Its memory belongs to the Binner and is valid until the next call.
    ///
    /// lights   view_space(...), world_space(...), or a contiguous range of vec4 (x, y, z, radius), Sphere, Spot or Box
    ///          in view space; or lights(...), which joins several of these
    /// inputs   {.slices = ...} with clusters or z_bins, {.bounds = ...} with a depth test unless with clusters, and
    ///          {.slices = ..., .bounds = ...} with z_bins and a depth test, or with clusters; else nothing
    /// threads  a Parallel, to share the work among the caller's threads. The grid does not depend on it.
    ///
    /// Afterwards every tile lists, in ascending order, every light whose sphere, spot or box meets the tile's cell;
    /// with clusters and Z bounds, in each slice that meets the tile's bounds. Errors: more lights than Id can number,
    /// or than 2^30; more than 2^32 - 1 cells, pairs of a light and a slice, or tiles in all lights' rectangles; a
    /// world_space() matrix that is not affine; Z bounds shorter than view.tile_count().
    template <class LightRange, std::convertible_to<Parallel> Threads = detail::Serial>
    Result<LightGrid<Id>> bin(const View& view, const LightRange& lights, const Inputs& inputs = {},
                              const Threads& threads = {}) {
        const Slices* slices = nullptr;
        if constexpr (Inputs::reads_slices) slices = &static_cast<const Slices&>(inputs.slices);
        return stages_.template bin<Id>(How(), isa_, view, detail::as_lights(lights), slices, inputs.bounds, threads);
    }

private:
    using How = detail::FixedHow<options>;
    Isa isa_ = compiled_isa;
    detail::Stages<How> stages_;
};

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
