// SPDX-License-Identifier: MIT
// The C side's binner, whose options are chosen at run time. Everything but the kernels stands in the program once, or
// once for each footprint, slicing or width of ids, and not once for each combination of options as a Binner does.
#pragma once

#include <lightbin/detail/c/lights.hpp>

#include <lightbin/binner.hpp>

#include <array>
#include <memory>
#include <utility>

namespace lightbin {
namespace c {

#if defined(LIGHTBIN_NO_BITS)
inline constexpr bool has_bits = false;
#else
inline constexpr bool has_bits = true;
#endif
#if defined(LIGHTBIN_NO_THREADS)
using Threads = Serial;
#else
using Threads = Parallel;
#endif

/// Calls body.operator()<kind>() with a kind of lights as a constant, one that the program has the code for.
template <class Body> decltype(auto) with_kind([[maybe_unused]] detail::LightKind kind, const Body& body) {
    using detail::LightKind;
    if constexpr (detail::kinds_have_spots)
        if (kind == LightKind::spot) return body.template operator()<LightKind::spot>();
    if constexpr (detail::kinds_have_boxes)
        if (kind == LightKind::box) return body.template operator()<LightKind::box>();
    if constexpr (!spheres_alone)
        if (kind == LightKind::mixed) return body.template operator()<LightKind::mixed>();
    return body.template operator()<LightKind::sphere>();
}

/// Whether a binner with these options reads Slices.
constexpr bool reads_slices(const Options& options) {
    return options.slicing != Slicing::none;
}
/// Whether a binner with these options reads ZBounds.
constexpr bool reads_bounds(const Options& options) {
    return options.depth_test != DepthTest::none && options.slicing != Slicing::clusters;
}

/// Returns the name of the define that leaves out the code for options, or null if the program has it.
constexpr const char* left_out(const Options& options) {
#if defined(LIGHTBIN_NO_U16)
    if (options.ids == IdWidth::u16) return "LIGHTBIN_NO_U16";
#endif
#if defined(LIGHTBIN_NO_SILHOUETTES)
    if (options.footprint == Footprint::silhouette) return "LIGHTBIN_NO_SILHOUETTES";
#endif
#if defined(LIGHTBIN_NO_INTERVAL)
    if (options.depth_test == DepthTest::interval) return "LIGHTBIN_NO_INTERVAL";
#endif
#if defined(LIGHTBIN_NO_BOX)
    if (options.depth_test == DepthTest::box) return "LIGHTBIN_NO_BOX";
#endif
#if defined(LIGHTBIN_NO_SPLIT_BOX)
    if (options.depth_test == DepthTest::split_box) return "LIGHTBIN_NO_SPLIT_BOX";
#endif
#if defined(LIGHTBIN_NO_CLUSTERS)
    if (options.slicing == Slicing::clusters) return "LIGHTBIN_NO_CLUSTERS";
#endif
#if defined(LIGHTBIN_NO_Z_BINS)
    if (options.slicing == Slicing::z_bins) return "LIGHTBIN_NO_Z_BINS";
#endif
#if defined(LIGHTBIN_NO_COVERAGE)
    if (options.coverage) return "LIGHTBIN_NO_COVERAGE";
#endif
    static_cast<void>(options);
    return nullptr;
}

/// Whether the program has the code for certain options.
inline constexpr bool has_silhouettes = left_out(Options{.footprint = Footprint::silhouette}) == nullptr,
                      has_clusters = left_out(Options{.slicing = Slicing::clusters}) == nullptr,
                      has_boxes_around_cells =
                          left_out(Options{.depth_test = DepthTest::box}) == nullptr ||
                          left_out(Options{.depth_test = DepthTest::split_box}) == nullptr,
                      has_depth_tests = has_boxes_around_cells ||
                                        left_out(Options{.depth_test = DepthTest::interval}) == nullptr;

/// Whether there are binners with these options in C++.
constexpr bool go_together(const Options& options) {
    return options.slicing != Slicing::clusters || options.depth_test == DepthTest::none ||
           options.depth_test == DepthTest::box;
}

/// What a binner's call is given.
struct Call {
    const View& view;
    const CallLights& lights;
    const Slices* slices;   ///< null if the options read none
    const ZBounds& bounds;  ///< no_bounds if the options read none
    Threads threads;
};
inline constexpr ZBounds no_bounds;

// ---- Projection: lights to footprints, in the slices that they meet ----

/// Footprints of any type, as a TileLists reads them.
struct AnyFootprints {
    const void* from;
    int count;
    detail::FootprintSlice (*slice_of)(const void* from, std::size_t slice);

    int slices() const { return count; }
    detail::FootprintSlice slice(std::size_t i) const { return slice_of(from, i); }
};

/// What a Projection has found of the lights of a call.
struct Projected {
    AnyFootprints footprints;
    LightRanks ranks;
    LightCounts counts;
};

/// The stages before the lists, for one footprint and slicing.
class Projection {
public:
    virtual ~Projection() = default;
    /// Projects the lights of a call and orders them by depth.
    ///
    /// shared     whether the lists of the last call were built on several threads
    /// for_boxes  whether the depth test is against boxes
    virtual std::optional<Error> project(Isa isa, const Call& call, bool for_boxes) = 0;
    virtual void find_coverage(const Call& call, detail::CoverageList& coverage) = 0;
    virtual Projected projected() const = 0;
};

/// The Projection for a footprint and a slicing.
///
/// with_spheres  whether the lights are kept in view space, for a depth test, slices or coverage
template <Footprint footprint, bool with_spheres, Slicing slicing>
class ProjectionOf final : public Projection {
    struct Nothing {};
    static constexpr bool sliced = slicing != Slicing::none;

public:
    LIGHTBIN_ONCE std::optional<Error> project(Isa isa, const Call& call, bool for_boxes) override {
        footprints_.project(isa, call.view, call.lights.all(), call.threads, for_boxes);
        if constexpr (sliced) {
            return with_kind(call.lights.kind(), [&]<detail::LightKind kind>() {
                return ordered_.template order<kind>(isa, call.view, footprints_, *call.slices);
            });
        } else {
            return {};
        }
    }

    LIGHTBIN_ONCE void find_coverage([[maybe_unused]] const Call& call,
                                     [[maybe_unused]] detail::CoverageList& coverage) override {
#if !defined(LIGHTBIN_NO_COVERAGE)
        if constexpr (with_spheres)
            coverage.template find<spheres_alone ? detail::LightKind::sphere : detail::LightKind::mixed>(
                call.view, footprints_, call.threads);
#endif
    }

    Projected projected() const override {
        const auto slice_of = [](const void* from, std::size_t i) {
            return static_cast<const Visible*>(from)->slice(i);
        };
        return {{&visible(), visible().slices(), slice_of}, visible().ranks(), footprints_.counts()};
    }

private:
    using All = Footprints<footprint, with_spheres>;
    using Ordered = std::conditional_t<slicing == Slicing::clusters, SlicedFootprints<footprint>,
                                       std::conditional_t<sliced, RankedFootprints<footprint>, Nothing>>;
    using Visible = std::conditional_t<sliced, Ordered, All>;

    const Visible& visible() const {
        if constexpr (sliced)
            return ordered_;
        else
            return footprints_;
    }

    All footprints_;
    Ordered ordered_;
};

/// Returns a Projection for options, of new.
template <Footprint footprint, bool with_spheres, Slicing slicing>
LIGHTBIN_SMALL Projection* new_projection() {
    return new ProjectionOf<footprint, with_spheres, slicing>;
}
template <Footprint footprint> Projection* new_projection([[maybe_unused]] const Options& options) {
    if constexpr (has_clusters)
        if (options.slicing == Slicing::clusters) return new_projection<footprint, true, Slicing::clusters>();
    if constexpr (left_out(Options{.slicing = Slicing::z_bins}) == nullptr)
        if (options.slicing == Slicing::z_bins) return new_projection<footprint, true, Slicing::z_bins>();
    if constexpr (has_depth_tests || left_out(Options{.coverage = true}) == nullptr)
        if (options.depth_test != DepthTest::none || options.coverage)
            return new_projection<footprint, true, Slicing::none>();
    return new_projection<footprint, footprint == Footprint::silhouette, Slicing::none>();
}

// ---- Kernels ----

/// The binning kernels for options and a kind of lights.
template <class Id> struct Kernels {
    /// Returns the kernel for one slice.
    detail::BinKernel<Id> (*choose)(Isa isa, const View& view, const detail::BinJob<>& job);
    std::uint64_t (*count)(const detail::BinJob<>& job,
                           detail::Scratch& scratch);  ///< null where nothing is tested
};
using BitsKernelOf = detail::BitsKernel (*)(Isa isa);

template <Footprint footprint, DepthTest depth_test, class Id, bool by_slab, detail::LightKind kind>
detail::BinKernel<Id> choose_kernel(Isa isa, const View& view, const detail::BinJob<>& job) {
    return detail::bin_kernel<footprint, depth_test, Id, by_slab, kind>(isa, view, job.area);
}

/// The numbers of footprints, depth tests and slicings that have kernels of their own: two footprints, clusters or not,
/// four depth tests. Z-bins have the kernels of lists without slices.
inline constexpr std::size_t kernel_count = 16;
constexpr std::size_t kernel_number(const Options& options) {
    return 8 * static_cast<std::size_t>(options.footprint) + (options.slicing == Slicing::clusters ? 4 : 0) +
           static_cast<std::size_t>(options.depth_test);
}
constexpr Options kernel_options(std::size_t number) {
    return {.footprint = static_cast<Footprint>(number / 8),
            .depth_test = static_cast<DepthTest>(number % 4),
            .slicing = number / 4 % 2 == 1 ? Slicing::clusters : Slicing::none};
}
constexpr bool has_kernels(std::size_t number) {
    return go_together(kernel_options(number)) && left_out(kernel_options(number)) == nullptr;
}

/// Calls make.operator()<number>() for each number of kernels, and returns an array of the results.
template <class Made, class Make> constexpr std::array<Made, kernel_count> for_each_number(const Make& make) {
    return [&]<std::size_t... number>(std::index_sequence<number...>) {
        return std::array<Made, kernel_count>{make.template operator()<number>()...};
    }
    (std::make_index_sequence<kernel_count>());
}

/// The kernels of all options; null where there are none, or they are left out.
template <class Id, detail::LightKind kind>
inline constexpr auto kernels_of = for_each_number<Kernels<Id>>([]<std::size_t number>() -> Kernels<Id> {
    constexpr Options options = kernel_options(number);
    constexpr detail::LightKind read = detail::kind_read<options.depth_test, kind>;
    constexpr bool by_slab = detail::by_slab<options.depth_test, read, options.slicing == Slicing::clusters>;
    if constexpr (!has_kernels(number))
        return {};
    else if constexpr (!detail::has_tests<options.footprint, options.depth_test>)
        return {choose_kernel<options.footprint, options.depth_test, Id, by_slab, read>, nullptr};
    else
        return {choose_kernel<options.footprint, options.depth_test, Id, by_slab, read>,
                detail::least::count_entries<options.footprint, options.depth_test, by_slab, read,
                                             std::uint32_t>};
});

/// The kernels that write bitmasks, of all options but clusters. They do not depend on the width of ids.
template <detail::LightKind kind>
inline constexpr auto
    bits_kernels_of = for_each_number<BitsKernelOf>([]<std::size_t number>() -> BitsKernelOf {
        constexpr Options options = kernel_options(number);
        if constexpr (has_bits && has_kernels(number) && options.slicing == Slicing::none)
            return detail::bits_kernel<options.footprint, options.depth_test,
                                       detail::kind_read<options.depth_test, kind>>;
        else
            return nullptr;
    });

// ---- The binner ----

/// What TileLists is asked for, at run time. See FixedLists.
struct AnyLists {
    static constexpr bool may_test = has_silhouettes || has_depth_tests,
                          may_have_boxes = has_boxes_around_cells, may_slice = has_clusters;
    bool tested, with_boxes, sliced;
};

/// A Binner whose options are known at run time. Its functions are those of Binner.
class AnyBinner {
public:
    AnyBinner(const Options& options)
        : options_(options), how_{options.footprint != Footprint::rectangle ||
                                      options.depth_test != DepthTest::none,
                                  options.depth_test == DepthTest::box ||
                                      options.depth_test == DepthTest::split_box,
                                  options.slicing == Slicing::clusters},
          projection_(has_silhouettes && options.footprint == Footprint::silhouette
                          ? new_projection < has_silhouettes ? Footprint::silhouette
                                                             : Footprint::rectangle > (options)
                          : new_projection<Footprint::rectangle>(options)) {}

    const Options& options() const { return options_; }
    std::span<const LightCoverage> coverage() const { return coverage_.all(); }

    template <class Id> Result<LightGrid<Id>> bin(const Call& call) {
        const detail::DefaultFloatEnvironment environment;
        if (const auto error = project(call)) return *error;
        return build<Id>(lists<Id>()[0], call, call.bounds);
    }

    template <class Id> Result<TransparencyGrids<Id>> bin_transparency(const Call& call) {
        const detail::DefaultFloatEnvironment environment;
        const Result<ZBounds> in_front = detail::transparent_bounds(call.bounds);
        if (!in_front) return in_front.error();
        if (const auto error = project(call)) return *error;
        const auto transparent = build<Id>(lists<Id>()[1], call, *in_front);
        if (!transparent) return transparent.error();
        const auto opaque = build<Id>(lists<Id>()[0], call, call.bounds);
        if (!opaque) return opaque.error();
        return TransparencyGrids<Id>{*opaque, *transparent};
    }

    Result<LightBits> bin_bits(const Call& call, std::uint32_t max_lights, std::span<std::uint32_t> bits) {
        const detail::DefaultFloatEnvironment environment;
        const std::uint64_t each = (max_lights + std::uint64_t{31}) / 32,
                            words = detail::product_of_sizes(call.view.tile_count(), each);
        if (bits.size() < words) return Error{ErrorCode::bit_buffer_too_small, words, bits.size()};
        if (const auto error = project(call)) return *error;
        const Projected projected = projection_->projected();
        const LightCounts& counts = projected.counts;
        const std::uint64_t numbered = options_.slicing == Slicing::z_bins
                                           ? counts.lights - counts.rejected - counts.culled
                                           : counts.lights;
        if (numbered > max_lights) return Error{ErrorCode::ids_too_narrow, numbered, max_lights};
        const std::size_t number = kernel_number(options_);
        const BitsKernelOf kernel = with_kind(
            call.lights.kind(), [number]<detail::LightKind kind>() { return bits_kernels_of<kind>[number]; });
        if (const auto error = wide_[0].write_bits(isa_, call.view, projected.footprints, call.bounds,
                                                   scratch_, call.threads, how_, kernel(isa_), bits.data(),
                                                   static_cast<std::size_t>(each)))
            return *error;
        return LightBits{counts, projected.ranks};
    }

private:
    template <class Id> using Lists = detail::TileLists<Id, AnyLists>;

    /// Returns the lists for opaque geometry, or for all, and those for transparent geometry.
    template <class Id> Lists<Id>* lists() {
        if constexpr (sizeof(Id) == 2)
            return narrow_;
        else
            return wide_;
    }

    LIGHTBIN_ONCE std::optional<Error> project(const Call& call) {
        coverage_.clear();
        if (const auto error =
                detail::refuse(call.lights.all(), options_.ids == IdWidth::u16 ? 0x10000 : 0xffffffff))
            return error;
        scratch_.reserve(1, 1);
        isa_ = machine_isa(options_.isa);
        if (const auto error = projection_->project(isa_, call, how_.with_boxes)) return error;
        if (options_.coverage) projection_->find_coverage(call, coverage_);
        return {};
    }

    template <class Id>
    LIGHTBIN_ONCE Result<LightGrid<Id>> build(Lists<Id>& lists, const Call& call, const ZBounds& bounds) {
        const std::size_t number = kernel_number(options_);
        const Kernels<Id> kernels = with_kind(
            call.lights.kind(), [number]<detail::LightKind kind>() { return kernels_of<Id, kind>[number]; });
        const Projected projected = projection_->projected();
        if (const auto error = lists.build(isa_, call.view, projected.footprints, bounds, scratch_,
                                           call.threads, how_, kernels.choose, kernels.count))
            return *error;
        return LightGrid<Id>(call.view.tiles_x(), call.view.tiles_y(), lists.tiles(), lists.indices(),
                             projected.counts, projected.footprints.slices(), projected.ranks);
    }

    Options options_;
    AnyLists how_;
    Isa isa_ = Isa::scalar;
    detail::Buffer<detail::Scratch> scratch_;
    std::unique_ptr<Projection> projection_;
    Lists<std::uint32_t> wide_[2];
    Lists<std::uint16_t> narrow_[2];
    detail::CoverageList coverage_;
};

}  // namespace c
}  // namespace lightbin
