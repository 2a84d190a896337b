// SPDX-License-Identifier: MIT
// The C side's binner, whose options are chosen at run time. Everything but the kernels stands in the program once, or
// once for each slicing or width of ids, and not once for each combination of options as a Binner does.
#pragma once

#include <lightbin/detail/c/lights.hpp>

#include <lightbin/binner.hpp>

#include <array>
#include <memory>
#include <utility>

namespace lightbin {
namespace c {

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
    return options.depth_test && options.slicing != Slicing::clusters;
}

/// Returns the name of the define that leaves out the code for options, or null if the program has it.
constexpr const char* left_out(const Options& options) {
#if defined(LIGHTBIN_NO_U16)
    if (options.ids == IdWidth::u16) return "LIGHTBIN_NO_U16";
#endif
#if defined(LIGHTBIN_NO_DEPTH_TEST)
    if (options.depth_test) return "LIGHTBIN_NO_DEPTH_TEST";
#endif
#if defined(LIGHTBIN_NO_CLUSTERS)
    if (options.slicing == Slicing::clusters) return "LIGHTBIN_NO_CLUSTERS";
#endif
#if defined(LIGHTBIN_NO_Z_BINS)
    if (options.slicing == Slicing::z_bins) return "LIGHTBIN_NO_Z_BINS";
#endif
    static_cast<void>(options);
    return nullptr;
}

/// Whether the program has the code for certain options.
inline constexpr bool has_clusters = left_out(Options{.slicing = Slicing::clusters}) == nullptr,
                      has_depth_test = left_out(Options{.depth_test = true}) == nullptr;

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

/// The stages before the lists, for one slicing.
class Projection {
public:
    virtual ~Projection() = default;
    /// Projects the lights of a call and orders them by depth.
    ///
    /// for_boxes  whether there is a depth test
    virtual std::optional<Error> project(Isa isa, const Call& call, bool for_boxes) = 0;
    virtual Projected projected() const = 0;
};

/// The Projection for a slicing.
///
/// keeps_lights  whether the lights are kept in view space, for a depth test or slices
template <bool keeps_lights, Slicing slicing>
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

    Projected projected() const override {
        const auto slice_of = [](const void* from, std::size_t i) {
            return static_cast<const Visible*>(from)->slice(i);
        };
        return {{&visible(), visible().slices(), slice_of}, visible().ranks(), footprints_.counts()};
    }

private:
    using All = Footprints<keeps_lights>;
    using Ordered = std::conditional_t<slicing == Slicing::clusters, SlicedFootprints,
                                       std::conditional_t<sliced, RankedFootprints, Nothing>>;
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
template <bool keeps_lights, Slicing slicing> LIGHTBIN_SMALL Projection* new_projection() {
    return new ProjectionOf<keeps_lights, slicing>;
}
inline Projection* new_projection([[maybe_unused]] const Options& options) {
    if constexpr (has_clusters)
        if (options.slicing == Slicing::clusters) return new_projection<true, Slicing::clusters>();
    if constexpr (left_out(Options{.slicing = Slicing::z_bins}) == nullptr)
        if (options.slicing == Slicing::z_bins) return new_projection<true, Slicing::z_bins>();
    if constexpr (has_depth_test)
        if (options.depth_test) return new_projection<true, Slicing::none>();
    return new_projection<false, Slicing::none>();
}

// ---- Kernels ----

/// The binning kernels for options and a kind of lights.
template <class Id> struct Kernels {
    /// Returns the kernel for one slice.
    detail::BinKernel<Id> (*choose)(Isa isa, const View& view, const detail::BinJob<>& job);
    std::uint64_t (*count)(const detail::BinJob<>& job,
                           detail::Scratch& scratch);  ///< null where nothing is tested
};
template <bool depth_test, class Id, bool by_slab, detail::LightKind kind>
detail::BinKernel<Id> choose_kernel(Isa isa, const View& view, const detail::BinJob<>& job) {
    return detail::bin_kernel<depth_test, Id, by_slab, kind>(isa, view, job.area);
}

/// The numbers of the options that have kernels of their own: with and without depth test, clusters or not. Z-bins have
/// the kernels of lists without slices.
inline constexpr std::size_t kernel_count = 4;
constexpr std::size_t kernel_number(const Options& options) {
    return (options.slicing == Slicing::clusters ? 2 : 0) + (options.depth_test ? 1 : 0);
}
constexpr Options kernel_options(std::size_t number) {
    return {.depth_test = number % 2 == 1, .slicing = number / 2 == 1 ? Slicing::clusters : Slicing::none};
}
constexpr bool has_kernels(std::size_t number) {
    return left_out(kernel_options(number)) == nullptr;
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
    else if constexpr (!options.depth_test)
        return {choose_kernel<options.depth_test, Id, by_slab, read>, nullptr};
    else
        return {choose_kernel<options.depth_test, Id, by_slab, read>,
                detail::least::count_entries<options.depth_test, by_slab, read, std::uint32_t>};
});

// ---- The binner ----

/// What TileLists is asked for, at run time. See FixedLists.
struct AnyLists {
    static constexpr bool may_test = has_depth_test, may_slice = has_clusters;
    bool tested, sliced;
};

/// A Binner whose options are known at run time. Its functions are those of Binner.
class AnyBinner {
public:
    AnyBinner(const Options& options)
        : options_(options), how_{options.depth_test, options.slicing == Slicing::clusters},
          projection_(new_projection(options)) {}

    const Options& options() const { return options_; }

    template <class Id> Result<LightGrid<Id>> bin(const Call& call) {
        const detail::DefaultFloatEnvironment environment;
        if (const auto error = project(call)) return *error;
        return build<Id>(call);
    }

private:
    template <class Id> using Lists = detail::TileLists<Id, AnyLists>;

    template <class Id> Lists<Id>& lists() {
        if constexpr (sizeof(Id) == 2)
            return narrow_;
        else
            return wide_;
    }

    LIGHTBIN_ONCE std::optional<Error> project(const Call& call) {
        if (const auto error =
                detail::refuse(call.lights.all(), options_.ids == IdWidth::u16 ? 0x10000 : 0xffffffff))
            return error;
        scratch_.reserve(1, 1);
        isa_ = machine_isa(options_.isa);
        return projection_->project(isa_, call, how_.tested);
    }

    template <class Id> LIGHTBIN_ONCE Result<LightGrid<Id>> build(const Call& call) {
        Lists<Id>& made = lists<Id>();
        const std::size_t number = kernel_number(options_);
        const Kernels<Id> kernels = with_kind(
            call.lights.kind(), [number]<detail::LightKind kind>() { return kernels_of<Id, kind>[number]; });
        const Projected projected = projection_->projected();
        if (const auto error = made.build(isa_, call.view, projected.footprints, call.bounds, scratch_, call.threads,
                                          how_, kernels.choose, kernels.count))
            return *error;
        return LightGrid<Id>(call.view.tiles_x(), call.view.tiles_y(), made.tiles(), made.indices(),
                             projected.counts, projected.footprints.slices(), projected.ranks);
    }

    Options options_;
    AnyLists how_;
    Isa isa_ = Isa::scalar;
    detail::Buffer<detail::Scratch> scratch_;
    std::unique_ptr<Projection> projection_;
    Lists<std::uint32_t> wide_;
    Lists<std::uint16_t> narrow_;
};

}  // namespace c
}  // namespace lightbin
