// SPDX-License-Identifier: MIT
// Stages: takes lights through all stages to their lists, for Binner and for the binners of lightbin.h, and owns the
// memory that this takes.
#pragma once

#include <lightbin/detail/stages/grid_lists.hpp>
#include <lightbin/detail/stages/ranked_footprints.hpp>
#include <lightbin/detail/stages/sliced_footprints.hpp>
#include <lightbin/options.hpp>

#include <lightbin/detail/base/warnings_off.inl>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// How a Binner works, as constants. In its place lightbin.h has a struct whose `is` is set at run time.
template <Options options> struct FixedHow {
    static constexpr Options is = options;

    /// Whether the program has code for a value of an option, such as may(&Options::slicing, Slicing::clusters).
    template <class Value> static constexpr bool may(Value Options::*option, Value value = Value(true)) {
        return is.*option == value;
    }
    template <class Id, LightKind kind> static constexpr ChooseKernel<Id> choose_kernel() {
        return detail::choose_kernel<Id, is.depth_test, is.slicing == Slicing::clusters, kind>();
    }
    /// Calls body.operator()<kind>() with the kind of a call's lights.
    template <class Source, class Body> static auto with_kind(const Source&, const Body& body) {
        return body.template operator()<Source::kind>();
    }
};

/// The stages, and the memory that they keep from call to call.
///
/// How  a FixedHow, or a struct with the same members. Its member `is` may be set at run time. Its function may() is
///      constant: no code is compiled for what it denies
template <class How> class Stages {
    struct Nothing {};
    template <bool is_held, class T> using Held = std::conditional_t<is_held, T, Nothing>;
    template <class Id> using Lists = TileLists<Id, How>;

public:
    /// See Binner::bin().
    ///
    /// cap             the widest instruction set to use
    /// slices, bounds  null, and empty, if the options do not read them
    template <class Id, class Source, class Threads>
    Result<LightGrid<Id>> bin(const How& how, Isa cap, const View& view, const Source& source, const Slices* slices,
                              const ZBounds& bounds, const Threads& threads) {
        const DefaultFloatEnvironment environment;
        const Isa isa = machine_isa(cap);
        if (const auto error = project(how, isa, view, source, slices, threads)) return *error;
        const ChooseKernel<Id> choose =
            how.with_kind(source, [&]<LightKind kind>() { return how.template choose_kernel<Id, kind>(); });
        Lists<Id>& lists = lists_of<Id>();
        FootprintSlice all = footprints_.all();
        LightRanks ranks;
        if constexpr (How::may(&Options::slicing, Slicing::z_bins))
            if (how.is.slicing == Slicing::z_bins) {
                all = ranked_.all();
                ranks = ranked_.ranks();
            }
        if (const auto error = lists.build(how, isa, view, all, sliced_, bounds, choose, scratch_, threads))
            return *error;
        const bool clusters = how.is.slicing == Slicing::clusters;
        return LightGrid<Id>(view.tiles_x(), view.tiles_y(), lists.tiles(), lists.indices(), footprints_.counts(),
                             clusters ? slices->count() : 1, ranks);
    }

private:
    /// Projects the lights to footprints and, with clusters or z-bins, orders the footprints by depth.
    template <class Source>
    std::optional<Error> project(const How& how, Isa isa, const View& view, const Source& source,
                                 [[maybe_unused]] const Slices* slices, const Parallel& threads) {
        if (const auto error = refuse(source, how.is.ids == IdWidth::u16 ? 0x10000 : max_lights)) return error;
        scratch_.reserve(1, 1);
        const bool sliced = how.is.slicing != Slicing::none;
        footprints_.project(isa, view, source, threads,
                            how.is.depth_test ? Kept::lights_and_planes
                            : sliced          ? Kept::lights
                                              : Kept::nothing);
        if constexpr (How::may(&Options::slicing, Slicing::clusters) || How::may(&Options::slicing, Slicing::z_bins)) {
            const DepthBucketsKernel kernel = depth_buckets_kernel<Source::kind>(isa);
            if constexpr (How::may(&Options::slicing, Slicing::clusters))
                if (how.is.slicing == Slicing::clusters) return sliced_.order(kernel, view, footprints_, *slices);
            if constexpr (How::may(&Options::slicing, Slicing::z_bins))
                if (how.is.slicing == Slicing::z_bins) ranked_.order(kernel, view, footprints_, *slices);
        }
        return {};
    }

    template <class Id> Lists<Id>& lists_of() {
        if constexpr (sizeof(Id) == 2)
            return narrow_;
        else
            return wide_;
    }

    Buffer<Scratch> scratch_;  ///< working memory, one Scratch per worker
    Footprints footprints_;
    Held<How::may(&Options::slicing, Slicing::clusters), SlicedFootprints> sliced_;
    Held<How::may(&Options::slicing, Slicing::z_bins), RankedFootprints> ranked_;
    Held<How::may(&Options::ids, IdWidth::u16), Lists<std::uint16_t>> narrow_;
    Held<How::may(&Options::ids, IdWidth::u32), Lists<std::uint32_t>> wide_;
};

}}}  // namespace lightbin::detail

#include <lightbin/detail/base/warnings_on.inl>
