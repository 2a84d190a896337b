// SPDX-License-Identifier: MIT
// The C side's advice.
#pragma once

#include <lightbin/detail/c/binners.hpp>

#include <lightbin/advise.hpp>

/// Advice: the plans and the texts follow the struct in the same piece of memory.
struct alignas(lightbin_plan) lightbin_advice {
    lightbin::c::Memory memory;
    const lightbin_plan* plans;
    std::size_t count;
    const char *text, *table;
};

namespace lightbin {
namespace c {

/// Copies of a call's lights, which advice moves sideways.
struct CopiedLights {
    std::vector<Sphere> spheres;
    std::vector<Spot> spots;
    std::vector<Box> boxes;
    std::optional<detail::WorldToView> to_view;

    std::size_t size() const { return spheres.size() + spots.size() + boxes.size(); }
};

template <class Given> auto copied(const Lights<LightCount, InPlace<Given>>& lights) {
    std::vector<typename Lights<LightCount, InPlace<Given>>::Made> made(lights.array.size());
    lights.make(0, made.size(), made.data());
    return made;
}
inline CopiedLights copied(const CallLights& lights) {
    return {copied(lights.spheres()), copied(lights.spots()), copied(lights.boxes()), lights.to_view};
}

/// Returns the lights of a binner's call that reads copies.
inline CallLights in_call(const CopiedLights& copies) {
    const auto floats = [](const auto& array, auto member) {
        return lightbin_floats{array.empty() ? nullptr : &(array[0].*member), sizeof array[0]};
    };
    lightbin_lights given = {};
    given.spheres = {copies.spheres.size(), floats(copies.spheres, &Sphere::x),
                     floats(copies.spheres, &Sphere::radius)};
    given.spots = {copies.spots.size(), floats(copies.spots, &Spot::x), floats(copies.spots, &Spot::radius),
                   floats(copies.spots, &Spot::axis_x), floats(copies.spots, &Spot::cos_half_angle)};
    given.boxes = {copies.boxes.size(),
                   floats(copies.boxes, &Box::x),
                   floats(copies.boxes, &Box::radius),
                   floats(copies.boxes, &Box::box_x),
                   {copies.boxes.empty() ? nullptr : &copies.boxes[0].half_axes, sizeof(Box)},
                   floats(copies.boxes, &Box::taper)};
    return {given, copies.to_view};
}

/// What weigh() calls of lights: see lights.hpp and weigh.hpp.
inline const CopiedLights& as_lights(const CopiedLights& lights) {
    return lights;
}
inline std::size_t light_count(const CopiedLights& lights) {
    return lights.size();
}
inline CopiedLights moved_aside(const CopiedLights& lights, float aside, bool orthographic) {
    const auto moved_array = [&]<class Light>(const std::vector<Light>& array) {
        const Lights<Light, AsLight> given = {array, {}, lights.to_view};
        const auto moved = detail::moved_aside(given, aside, orthographic);
        std::vector<Light> made;
        made.reserve(array.size());
        for (const Light& light : array)
            made.push_back(moved.made(light));
        return made;
    };
    return {moved_array(lights.spheres), moved_array(lights.spots), moved_array(lights.boxes), {}};
}

}  // namespace c

inline namespace LIGHTBIN_ABI_TAG {
namespace detail {

/// An AnyBinner in place of a Binner.
template <Options options> class WeighedBinner<c::CopiedLights, options> {
    using Inputs = typename Binner<options>::Inputs;

public:
    Result<LightGrid<std::uint32_t>> bin(const View& view, const c::CopiedLights& lights,
                                         const Inputs& inputs) {
        const c::CallLights in_place = c::in_call(lights);
        const Slices* slices = nullptr;
        const ZBounds* bounds = &c::no_bounds;
        if constexpr (Inputs::reads_slices) slices = &static_cast<const Slices&>(inputs.slices);
        if constexpr (Inputs::reads_bounds) bounds = &inputs.bounds;
        return binner_.bin<std::uint32_t>({view, in_place, slices, *bounds, {}});
    }

private:
    c::AnyBinner binner_ = options;
};

template <> constexpr bool has_code<c::CopiedLights>(const Options& options) {
    return c::left_out(options) == nullptr;
}

}  // namespace detail
}  // namespace LIGHTBIN_ABI_TAG

namespace c {

inline lightbin_result read_costs(const lightbin_costs* given, Costs& costs) {
    lightbin_costs known = {};
    const lightbin_result result = given != nullptr ? read(given, known, "costs") : succeeded();
    if (known.evaluation_ns != 0) costs.evaluation_ns = known.evaluation_ns;
    if (known.overdraw != 0) costs.overdraw = known.overdraw;
    costs.z_bounds_ns = known.z_bounds_ns;
    costs.upload_byte_ns = known.upload_byte_ns;
    return result;
}

/// Makes a handle with a copy of advice.
inline lightbin_result make_advice(const Memory& memory, const Advice& made, lightbin_advice** advice) {
    const std::string text = to_string(made), table = made.text();
    const std::span<const Plan> plans = made.plans();
    const std::size_t plan_bytes = plans.size() * sizeof(lightbin_plan);
    char* const place = static_cast<char*>(
        memory.allocate(sizeof(lightbin_advice) + plan_bytes + text.size() + table.size() + 2));
    if (place == nullptr) return refused(LIGHTBIN_OUT_OF_MEMORY, "");
    char *const first = place + sizeof(lightbin_advice), *const texts = first + plan_bytes;
    for (std::size_t i = 0; i < plans.size(); ++i)
        new (first + i * sizeof(lightbin_plan)) lightbin_plan{sizeof(lightbin_plan),
                                                              plans[i].tiled,
                                                              static_cast<std::int32_t>(plans[i].footprint),
                                                              static_cast<std::int32_t>(plans[i].depth_test),
                                                              static_cast<std::int32_t>(plans[i].slicing),
                                                              plans[i].tile_size,
                                                              plans[i].build_ns,
                                                              plans[i].upload_ns,
                                                              plans[i].evaluations,
                                                              plans[i].total_ns,
                                                              plans[i].entries};
    std::memcpy(texts, text.c_str(), text.size() + 1);
    std::memcpy(texts + text.size() + 1, table.c_str(), table.size() + 1);
    *advice = new (place) lightbin_advice{memory, reinterpret_cast<const lightbin_plan*>(first), plans.size(),
                                          texts, texts + text.size() + 1};
    return succeeded();
}

}  // namespace c
}  // namespace lightbin

extern "C" {

lightbin_result lightbin_advise(const lightbin_view* view, const lightbin_lights* lights,
                                const lightbin_costs* costs, const lightbin_z_bounds* bounds,
                                const lightbin_allocator* allocator, lightbin_advice** advice) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    if (advice == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "advice");
    CallLights known;
    lightbin::Costs known_costs;
    lightbin::ZBounds known_bounds;
    lightbin_result result = first_error(read_lights(lights, known), read_costs(costs, known_costs));
    if (result.error == LIGHTBIN_OK && bounds != nullptr)
        result = read_bounds(bounds, view->value, known_bounds);
    if (result.error != LIGHTBIN_OK) return result;
    const Memory memory(allocator);
    return guarded(memory, [&] {
        const auto made = lightbin::advise(view->value, copied(known), known_costs, known_bounds);
        return made ? make_advice(memory, *made, advice) : refused(made.error());
    });
}

lightbin_result lightbin_advise_slices(const lightbin_view* view, const lightbin_lights* lights,
                                       const lightbin_slices* clusters, const lightbin_slices* z_bins,
                                       const float* depths, std::int32_t columns, std::int32_t rows,
                                       const lightbin_costs* costs, const lightbin_allocator* allocator,
                                       lightbin_advice** advice) {
    using namespace lightbin::c;
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    if (clusters == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "clusters");
    if (z_bins == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "z_bins");
    if (columns < 0)
        return refused(LIGHTBIN_NOT_A_VALUE, "columns", static_cast<std::uint64_t>(std::int64_t{columns}));
    if (rows < 0)
        return refused(LIGHTBIN_NOT_A_VALUE, "rows", static_cast<std::uint64_t>(std::int64_t{rows}));
    const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    if (depths == nullptr && count > 0) return refused(LIGHTBIN_NULL_ARGUMENT, "depths");
    if (advice == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "advice");
    CallLights known;
    lightbin::Costs known_costs;
    const lightbin_result result = first_error(read_lights(lights, known), read_costs(costs, known_costs));
    if (result.error != LIGHTBIN_OK) return result;
    const Memory memory(allocator);
    return guarded(memory, [&] {
        const auto made =
            lightbin::advise_slices(view->value, copied(known), {clusters->value, z_bins->value},
                                    {{depths, count}, {columns, rows}}, known_costs);
        return made ? make_advice(memory, *made, advice) : refused(made.error());
    });
}

void lightbin_advice_destroy(lightbin_advice* advice) {
    lightbin::c::destroy_handle(advice);
}

std::size_t lightbin_advice_count(const lightbin_advice* advice) {
    return advice != nullptr ? advice->count : 0;
}

lightbin_result lightbin_advice_plan(const lightbin_advice* advice, std::size_t index, lightbin_plan* plan) {
    using namespace lightbin::c;
    if (advice == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "advice");
    const lightbin_result result = check_size(plan, "plan");
    if (result.error != LIGHTBIN_OK) return result;
    if (index >= advice->count) return refused(LIGHTBIN_NOT_A_VALUE, "index", index, advice->count);
    write(advice->plans[index], plan);
    return result;
}

const char* lightbin_advice_text(const lightbin_advice* advice) {
    return advice != nullptr ? advice->text : nullptr;
}

const char* lightbin_advice_table(const lightbin_advice* advice) {
    return advice != nullptr ? advice->table : nullptr;
}

}  // extern "C"
