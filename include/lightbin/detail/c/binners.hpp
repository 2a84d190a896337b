// SPDX-License-Identifier: MIT
// The functions of lightbin.h that make lists and masks.
#pragma once

#include <lightbin/binner.hpp>
#include <lightbin/detail/c/lights.hpp>
#include <lightbin/detail/c/views.hpp>
#include <lightbin/masks.hpp>

namespace lightbin {
namespace c {

/// Returns the name of the define that leaves out code that a binner with these options needs, or null if none does.
constexpr const char* left_out([[maybe_unused]] const Options& options) {
#if defined(LIGHTBIN_NO_U16)
    if (options.ids == IdWidth::u16) return "LIGHTBIN_NO_U16";
#endif
#if defined(LIGHTBIN_NO_DEPTH_TEST)
    if (options.depth_test) return "LIGHTBIN_NO_DEPTH_TEST";
#endif
#if defined(LIGHTBIN_NO_DEPTH_SLICES)
    if (options.slicing != Slicing::none) return "LIGHTBIN_NO_DEPTH_SLICES";
#endif
    return nullptr;
}

/// The options of a binner, set at run time: the argument of the template detail::Stages, for which a C++ Binner has a
/// detail::FixedHow. So the program has the code of the stages once, not once for each combination of options.
struct AnyHow {
    Options is;

    template <class Value> static constexpr bool may(Value Options::*option, Value value = Value(true)) {
        Options options;
        options.*option = value;
        return left_out(options) == nullptr;
    }

    template <class Id, detail::LightKind kind> detail::ChooseKernel<Id> choose_kernel() const {
        if constexpr (may(&Options::depth_test))
            if (is.depth_test) {
                if constexpr (may(&Options::slicing, Slicing::clusters))
                    if (is.slicing == Slicing::clusters) return detail::choose_kernel<Id, true, true, kind>();
                return detail::choose_kernel<Id, true, false, kind>();
            }
        return detail::choose_kernel<Id, false, false, kind>();
    }

    template <class Source, class Body> auto with_kind(const Source& lights, const Body& body) const {
        using detail::LightKind;
        unsigned kinds = 0;  // a bit for each kind that is there
        detail::for_each_array(lights, [&]<class Array>(const Array& array) {
            kinds |= unsigned{array.array.size() > 0} << static_cast<int>(Array::kind);
        });
        const auto alone = [=](LightKind kind) { return kinds == 1u << static_cast<int>(kind); };
        if constexpr (detail::kinds_have_spots)
            if (alone(LightKind::spot)) return body.template operator()<LightKind::spot>();
        if constexpr (detail::kinds_have_boxes)
            if (alone(LightKind::box)) return body.template operator()<LightKind::box>();
        if constexpr (!spheres_alone)
            if (kinds != 0 && !alone(LightKind::sphere)) return body.template operator()<LightKind::mixed>();
        return body.template operator()<LightKind::sphere>();
    }
};

}  // namespace c
}  // namespace lightbin

struct lightbin_binner {
    lightbin::c::AnyHow how;
    lightbin::detail::Stages<lightbin::c::AnyHow> stages = {};
    lightbin::MaskBinner masks = {};
};

namespace lightbin {
namespace c {

/// Writes a LightGrid to the caller's struct.
template <class Id> lightbin_result write_grid(const LightGrid<Id>& from, lightbin_grid* to) {
    const LightCounts& counts = from.light_counts();
    const LightRanks& ranks = from.ranks();
    return write({0, from.tiles_x(), from.tiles_y(), from.slices(), same_layout<lightbin_range>(from.ranges().data()),
                  from.ids().data(), from.ranges().size(), from.ids().size(), sizeof(Id), counts.lights,
                  counts.rejected, counts.culled, ranks.order.data(),
                  same_layout<lightbin_bin_range>(ranks.bins.data()), ranks.order.size(), ranks.bins.size(),
                  counts.first_spot, counts.first_box},
                 to);
}

/// Returns why an input is refused that must be given if the options read it, and else must not be.
inline lightbin_result check_input(bool is_read, const void* given, lightbin_error if_missing, const char* name) {
    if (is_read == (given != nullptr)) return succeeded();
    return refused(is_read ? if_missing : LIGHTBIN_NOT_READ, name);
}

/// Reads the arguments of lightbin_bin() or lightbin_bin_masks(). Returns why they are refused, or a success.
///
/// masks  whether the function is lightbin_bin_masks()
inline lightbin_result read_call(bool masks, const lightbin_binner* binner, const lightbin_view* view,
                                 const lightbin_lights* given_lights, const lightbin_inputs* given_inputs,
                                 CallLights& lights, lightbin_inputs& inputs) {
    lightbin_result result = first_error(check_pointers({{binner, "binner"}, {view, "view"}}),
                                         read_lights(given_lights, lights));
    if (result.error == LIGHTBIN_OK && given_inputs != nullptr) result = read(given_inputs, inputs, "inputs");
    if (result.error != LIGHTBIN_OK) return result;
    const Options& options = binner->how.is;
    const bool clusters = options.slicing == Slicing::clusters;
    if (masks && (clusters || options.depth_test)) return refused(Error{ErrorCode::no_such_slicing_shader});
    return first_error(
        check_input(options.slicing != Slicing::none, inputs.slices, LIGHTBIN_NO_SLICES_GIVEN, "inputs.slices"),
        clusters ? succeeded()
                 : check_input(options.depth_test, inputs.bounds, LIGHTBIN_NO_BOUNDS_GIVEN, "inputs.bounds"));
}

}  // namespace c
}  // namespace lightbin

extern "C" {

lightbin_result lightbin_binner_create(const lightbin_binner_options* options,
                                       lightbin_binner** binner) {
    using namespace lightbin::c;
    lightbin_binner_options given = {};
    lightbin::Options known;
    lightbin_result result = check_pointers({{binner, "binner"}});
    if (result.error == LIGHTBIN_OK && options != nullptr) result = read(options, given, "options");
    if (result.error == LIGHTBIN_OK)
        lightbin::detail::for_each_option(
            [&](const char* name, const auto& from, auto& to) {
                result = first_error(result, read_member(from, to, name));
            },
            given, known);
    if (result.error == LIGHTBIN_OK && known.ids == lightbin::IdWidth::u8)
        result = not_a_value(given.ids, "options.ids");
    if (const char* const define = left_out(known); result.error == LIGHTBIN_OK && define != nullptr)
        result = refused(LIGHTBIN_LEFT_OUT, define);
    return call_if(result, [&] { return make_handle(binner, AnyHow{known}); });
}

void lightbin_binner_destroy(lightbin_binner* binner) {
    delete binner;
}

lightbin_result lightbin_bin(lightbin_binner* binner, const lightbin_view* view,
                             const lightbin_lights* given_lights, const lightbin_inputs* given_inputs,
                             lightbin_grid* grid) {
    using namespace lightbin::c;
    CallLights lights;
    lightbin_inputs inputs = {};
    lightbin::ZBounds bounds;
    lightbin_result result = first_error(check_size(grid, "grid"),
                                         read_call(false, binner, view, given_lights, given_inputs, lights, inputs));
    if (result.error == LIGHTBIN_OK && inputs.bounds != nullptr)
        result = read_bounds(inputs.bounds, view->value, bounds);
    return call_if(result, [&] {
        const auto bin = [&]<class Id>(Id) {
            const auto made = binner->stages.template bin<Id>(
                binner->how, lightbin::compiled_isa, view->value, lights.all(),
                inputs.slices != nullptr ? &inputs.slices->value : nullptr, bounds, lightbin::detail::Serial());
            return made ? write_grid(*made, grid) : refused(made.error());
        };
#if !defined(LIGHTBIN_NO_U16)
        if (binner->how.is.ids == lightbin::IdWidth::u16) return bin(std::uint16_t());
#endif
        return bin(std::uint32_t());
    });
}

lightbin_result lightbin_bin_masks(lightbin_binner* binner, const lightbin_view* view,
                                   const lightbin_lights* given_lights, const lightbin_inputs* given_inputs,
                                   lightbin_masks* masks) {
    using namespace lightbin::c;
    CallLights lights;
    lightbin_inputs inputs = {};
    const lightbin_result result = first_error(
        check_size(masks, "masks"), read_call(true, binner, view, given_lights, given_inputs, lights, inputs));
    return call_if(result, [&] {
        const auto bin = [&](const auto&... slices) {
            const auto made = binner->masks.bin(view->value, lights.all(), slices...);
            if (!made) return refused(made.error());
            const lightbin::LightCounts& counts = made->light_counts();
            return write({0, made->tiles_x(), made->tiles_y(), made->mask_words(), made->words().data(),
                          made->ids().data(), same_layout<lightbin_bin_range>(made->bins().data()),
                          made->words().size(), made->ids().size(), made->bins().size(), counts.lights,
                          counts.rejected, counts.culled, counts.first_spot, counts.first_box, 0},
                         masks);
        };
        if constexpr (AnyHow::may(&lightbin::Options::slicing, lightbin::Slicing::z_bins))
            if (inputs.slices != nullptr) return bin(inputs.slices->value);
        return bin();
    });
}

}  // extern "C"
