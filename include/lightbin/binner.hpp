// SPDX-License-Identifier: MIT
// Binner: the one easy call. It owns the scratch memory of the stages, and the lists.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>
#include <lightbin/detail/base/checked_sizes.hpp>
#include <lightbin/detail/base/float_environment.hpp>
#include <lightbin/detail/base/maybe.hpp>
#include <lightbin/detail/depth/ranked_footprints.hpp>
#include <lightbin/detail/depth/sliced_footprints.hpp>
#include <lightbin/detail/engine/block.hpp>
#include <lightbin/detail/engine/grid_lists.hpp>
#include <lightbin/detail/project/footprints.hpp>
#include <lightbin/isa.hpp>
#include <lightbin/light_grid.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/list_format.hpp>
#include <lightbin/options.hpp>
#include <lightbin/parallel.hpp>
#include <lightbin/result.hpp>
#include <lightbin/slices.hpp>
#include <lightbin/view.hpp>
#include <lightbin/z_bounds.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG {

namespace detail {

/// In place of an input that the options don't need. Given all the same, it is a sentence of the compiler.
struct NotRead {
    NotRead() = default;
    template <class Given> NotRead(const Given&) {
        static_assert(
            sizeof(Given) == 0,
            "lightbin: this Binner does not read this input: bounds want an Options::depth_test, and "
            "slices an Options::slicing; clusters read no bounds");
    }
};

/// In place of what is needed and was not given: the same.
template <bool read> auto bounds_left_out() {
    static_assert(
        !read, "lightbin: this Binner's depth test needs Z bounds: bin(view, lights, {.bounds = ...}), with "
               "what reduce_depth() returns or bounds of your own");
    return std::conditional_t<read, ZBounds, NotRead>();
}
/// The slices of an Inputs: a reference to the caller's, or a copy of temporary ones, which would be gone after the
/// expression that makes the Inputs.
class SlicesInput {
public:
    SlicesInput(const Slices& slices) : given_(&slices) {}
    // Not inline: g++ 12 would warn of what is not there, in programs with the address sanitizer.
    LIGHTBIN_NOINLINE SlicesInput(const SlicesInput& other) : given_(other.given_), own_(other.own_) {}
    LIGHTBIN_NOINLINE ~SlicesInput() {}
    SlicesInput& operator=(const SlicesInput&) = delete;
    SlicesInput(const Slices&& slices) : own_(slices) {}
    template <class Given>
    SlicesInput(const Result<Given>& result) : own_(result) {}  // says that it is no Slices yet

    operator const Slices&() const { return given_ != nullptr ? *given_ : *own_; }

private:
    const Slices* given_ = nullptr;
    Maybe<Slices> own_;
};
struct NoSlices {
    operator SlicesInput() const;
};
template <bool read> auto slices_left_out() {
    static_assert(!read,
                  "lightbin: this Binner slices depth: bin(view, lights, {.slices = *slices}), with what "
                  "Slices::exponential() or linear() returns");
    return std::conditional_t<read, NoSlices, NotRead>();
}

}  // namespace detail

/// What Binner::bin() reads beside the lights. What the options need must be given, and nothing else can be.
template <DepthTest depth_test, Slicing slicing = Slicing::none> struct Inputs {
    static constexpr bool reads_slices = slicing != Slicing::none,
                          reads_bounds = depth_test != DepthTest::none && slicing != Slicing::clusters;

    /// Read where they are: they must live until the call. Temporary ones are copied.
    std::conditional_t<reads_slices, detail::SlicesInput, detail::NotRead> slices =
        detail::slices_left_out<reads_slices>();
    /// Minimum, maximum or both. See ZBounds for what an empty side means.
    std::conditional_t<reads_bounds, ZBounds, detail::NotRead> bounds =
        detail::bounds_left_out<reads_bounds>();
};

/// Returns the inputs of a Binner whose options vary, such as with_options() gives them: what they don't need is
/// left out.
template <Options options>
requires(options.slicing == Slicing::none) Inputs<options.depth_test> inputs_for([[maybe_unused]] const ZBounds& bounds) {
    if constexpr (options.depth_test == DepthTest::none)
        return {};
    else
        return {.bounds = bounds};
}

/// The same where slices are among the options that vary. They are read where they are, temporary ones copied, as by an
/// Inputs.
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

/// The two grids of Tiled Forward Shading, section 4.5, Listing 4.2: `opaque` is pruned by minimum and maximum depth;
/// `transparent` by the maximum alone, as transparent geometry may lie anywhere in front of the opaque.
template <class Id> struct TransparencyGrids { LightGrid<Id> opaque, transparent; };

/// Bins lights into screen tiles. Keeps its memory: the same input again allocates nothing, another one only where
/// it outgrows the earlier ones, or where another kernel or number of threads takes it. After an exception in a call,
/// there is no grid, and the next call is as any other. Not thread-safe: one Binner a thread.
///
/// A call computes, and has the caller's callables compute, in the floating-point environment that threads start with
/// (rounding to nearest, no traps, denormal numbers kept), and leaves the caller's as it was.
template <Options options = Options{}> class Binner {
    static_assert(options.ids != IdWidth::u8,
                  "lightbin: a Binner's ids have 16 or 32 bits: take Options{.ids = IdWidth::u16} and have "
                  "encode() make 8 bits of them");
    static constexpr bool clusters = options.slicing == Slicing::clusters,
                          z_bins = options.slicing == Slicing::z_bins,
                          with_depth = Inputs<options.depth_test, options.slicing>::reads_bounds;

public:
    using Id = std::conditional_t<options.ids == IdWidth::u16, std::uint16_t, std::uint32_t>;
    using Inputs = lightbin::Inputs<options.depth_test, options.slicing>;
    /// The form of the grid as it is, for a shader that reads it: ShaderOptions::format.
    static constexpr ListFormat list_format = {.ids = options.ids};

    Binner() = default;
    /// Takes over the other's memory and grid. The other is as new.
    Binner(Binner&& other) noexcept { swap(other); }
    Binner& operator=(Binner&& other) noexcept {
        Binner(std::move(other)).swap(*this);
        return *this;
    }

    /// Returns the light grid of `lights` in `view`, in the Binner's memory: valid until its next call.
    ///
    /// lights   a contiguous range of vec4 (x, y, z, radius), Sphere or Spot in view space, view_space(...) or
    ///          world_space(...)
    /// inputs   {.slices = ...} with clusters; else {.slices = ...} with z_bins, {.bounds = ...} with a depth test, both in
    ///          this order with both, else {} or nothing
    /// threads  a Parallel: threads to share the work among. The grid is the same with any number of them.
    ///
    /// After it, every tile lists every light whose sphere, or spot, meets the tile's cell (no miss), in ascending
    /// order. Errors: more lights than Id can number; more than 2^32 - 1 entries, cells, or pairs of a light
    /// and a slice or block of 8x8 tiles; a world_space() matrix that is not affine; a side of the Z bounds that is
    /// shorter than view.tile_count().
    template <class LightRange, std::convertible_to<Parallel> Threads = Serial>
    Result<LightGrid<Id>> bin(const View& view, const LightRange& lights, const Inputs& inputs = {},
                              const Threads& threads = {}) {
        const detail::DefaultFloatEnvironment environment;
        if (const auto error = project(view, lights, inputs, threads)) return *error;
        return build<spots<LightRange>>(lists_, view, bounds_of(inputs), threads);
    }

    /// Returns both grids of a scene with transparent geometry from one projection, valid until the Binner's
    /// next call. Errors as bin(), and bounds that leave out the background without a transparent_max.
    ///
    /// inputs  the bounds are those of the opaque geometry; transparent lights are pruned by transparent_max or,
    ///         without it, by max
    template <class LightRange, std::convertible_to<Parallel> Threads = Serial>
    requires(with_depth) Result<TransparencyGrids<Id>> bin_transparency(const View& view,
                                                                        const LightRange& lights,
                                                                        const Inputs& inputs,
                                                                        const Threads& threads = {}) {
        const detail::DefaultFloatEnvironment environment;
        const ZBounds& bounds = inputs.bounds;
        const bool own_max = !bounds.transparent_max.empty();
        if (bounds.background_skipped && !bounds.max.empty() && !own_max)
            return Error{ErrorCode::no_transparent_max};
        if (const auto error = project(view, lights, inputs, threads)) return *error;
        const ZBounds in_front = {.max = own_max ? bounds.transparent_max : bounds.max};
        const auto transparent = build<spots<LightRange>>(transparent_, view, in_front, threads);
        if (!transparent) return transparent.error();
        const auto opaque = build<spots<LightRange>>(lists_, view, bounds, threads);
        if (!opaque) return opaque.error();
        return TransparencyGrids<Id>{*opaque, *transparent};
    }

    /// Writes to `bits` what encode() makes of bin()'s grid with {.encoding = ListEncoding::bitmask, .max_lights =
    /// max_lights}: of each tile (max_lights + 31) / 32 words, bit b of word w being light 32 w + b. Up to about a
    /// thousand lights that is faster without the lists. Returns what became of the lights, and with z_bins the
    /// ranks, valid until the next call. Errors as bin(), but for entries, which nothing counts; and, then without
    /// a bit written, fewer words than that, or more lights than max_lights, with z_bins more lights in view.
    template <class LightRange, std::convertible_to<Parallel> Threads = Serial>
    requires(!clusters) Result<LightBits> bin_bits(const View& view, const LightRange& lights,
                                                   std::uint32_t max_lights, std::span<std::uint32_t> bits,
                                                   const Inputs& inputs = {}, const Threads& threads = {}) {
        const detail::DefaultFloatEnvironment environment;
        const std::uint64_t each = (max_lights + std::uint64_t{31}) / 32,
                            words = detail::product_of_sizes(view.tile_count(), each);
        if (bits.size() < words) return Error{ErrorCode::bit_buffer_too_small, words, bits.size()};
        if (const auto error = project(view, lights, inputs, threads)) return *error;
        const std::uint64_t numbered = z_bins ? footprints_.visible() : footprints_.lights();
        if (numbered > max_lights) return Error{ErrorCode::ids_too_narrow, numbered, max_lights};
        if (const auto error = lists_.template write_bits<spots<LightRange>>(
                isa_, view, lit(), bounds_of(inputs), scratch_, threads, bits.data(),
                static_cast<std::size_t>(each)))
            return *error;
        return LightBits{counts(), ranks()};
    }

private:
    using Lists = detail::GridLists<Id, options.footprint, options.depth_test, clusters>;
    struct Nothing {};
    using Ordered = std::conditional_t<
        clusters, SlicedFootprints<options.footprint>,
        std::conditional_t<z_bins, RankedFootprints<options.footprint, with_depth>, Nothing>>;

    template <class LightRange>
    static constexpr bool spots =
        std::remove_cvref_t<decltype(detail::as_lights(std::declval<const LightRange&>()))>::spots;

    template <class LightRange>
    detail::Maybe<Error> project(const View& view, const LightRange& lights,
                                 [[maybe_unused]] const Inputs& inputs, const Parallel& threads) {
        const auto& source = detail::as_lights(lights);
        if (const auto error = detail::refuse(source, options.ids == IdWidth::u16 ? 0x10000 : 0xffffffff))
            return error;
        scratch_.reserve(1, 1);
        isa_ = machine_isa(options.isa);
        footprints_.project(isa_, view, source, threads, lists_.shared(),
                            detail::with_boxes<options.depth_test>);
        if constexpr (Inputs::reads_slices)
            return ordered_.template order<spots<LightRange>>(isa_, view, footprints_, inputs.slices);
        else
            return {};
    }

    const auto& lit() const {
        if constexpr (Inputs::reads_slices)
            return ordered_;
        else
            return footprints_;
    }

    static ZBounds bounds_of([[maybe_unused]] const Inputs& inputs) {
        if constexpr (with_depth)
            return inputs.bounds;
        else
            return {};
    }

    template <bool of_spots, class Threads>
    Result<LightGrid<Id>> build(Lists& lists, const View& view, const ZBounds& bounds,
                                const Threads& threads) {
        if (const auto error = lists.template build<of_spots>(isa_, view, lit(), bounds, scratch_, threads))
            return *error;
        return LightGrid<Id>(view.tiles_x(), view.tiles_y(), lists.tiles(), lists.indices(), counts(),
                             lit().slices(), ranks());
    }

    LightCounts counts() const {
        const auto all = static_cast<std::uint32_t>(footprints_.lights());
        return {all, footprints_.rejected(), all - footprints_.rejected() - footprints_.visible()};
    }

    LightRanks ranks() const {
        if constexpr (z_bins)
            return ordered_.ranks();
        else
            return {};
    }

    void swap(Binner& other) noexcept {
        std::swap(isa_, other.isa_);
        scratch_.swap(other.scratch_);
        std::swap(footprints_, other.footprints_);
        std::swap(ordered_, other.ordered_);
        std::swap(lists_, other.lists_);
        std::swap(transparent_, other.transparent_);
    }

    Isa isa_ = Isa::scalar;
    detail::Buffer<detail::Scratch> scratch_;  ///< one a worker
    Footprints<options.footprint, with_depth || options.slicing != Slicing::none> footprints_;
    Ordered ordered_;
    Lists lists_;
    std::conditional_t<with_depth, Lists, Nothing> transparent_;
};

}}  // namespace lightbin

#include <lightbin/detail/base/warnings_on.inl>
