// SPDX-License-Identifier: MIT
// The C side's functions that make lists.
#pragma once

#include <lightbin/coverage.hpp>
#include <lightbin/detail/c/any_binner.hpp>
#include <lightbin/detail/c/views.hpp>

#include <atomic>

struct lightbin_binner {
    lightbin::c::AnyBinner value;
};

namespace lightbin {
namespace c {

/// Writes a LightGrid to the caller's struct.
template <class Id> void write_grid(const LightGrid<Id>& from, lightbin_grid* to) {
    static_assert(sizeof(ListRange) == sizeof(lightbin_range) &&
                  sizeof(BinRange) == sizeof(lightbin_bin_range));
    const LightCounts& counts = from.light_counts();
    const LightRanks& ranks = from.ranks();
    lightbin_grid grid = {};
    grid.lights = counts.lights;
    grid.rejected = counts.rejected;
    grid.culled = counts.culled;
    grid.first_spot = counts.first_spot;
    grid.first_box = counts.first_box;
    grid.order = ranks.order.data();
    grid.bins = reinterpret_cast<const lightbin_bin_range*>(ranks.bins.data());
    grid.order_count = ranks.order.size();
    grid.bin_count = ranks.bins.size();
    grid.tiles_x = from.tiles_x();
    grid.tiles_y = from.tiles_y();
    grid.slices = from.slices();
    grid.ranges = reinterpret_cast<const lightbin_range*>(from.ranges().data());
    grid.ids = from.ids().data();
    grid.range_count = from.ranges().size();
    grid.id_count = from.ids().size();
    grid.id_bytes = sizeof(Id);
    write(grid, to);
}

/// Calls body(Id()) with the type of ids that options ask for.
template <class Body> lightbin_result with_id([[maybe_unused]] const Options& options, const Body& body) {
#if !defined(LIGHTBIN_NO_U16)
    if (options.ids == IdWidth::u16) return body(std::uint16_t());
#endif
    return body(std::uint32_t());
}

/// Runs tasks on the caller's threads. What a task throws is thrown again on the thread that called run(), as
/// exceptions must not pass through the caller's functions.
class CallersThreads {
public:
    explicit CallersThreads(const lightbin_threads& threads) : threads_(threads) {}

    template <class Body> void operator()(std::size_t count, Body body) const {
        Context<Body> context = {body};
        threads_.run(
            threads_.user, count, [](void* at, std::size_t i) { static_cast<Context<Body>*>(at)->run(i); },
            &context);
        #if defined(__cpp_exceptions) || defined(_CPPUNWIND)
        if (context.failed) throw std::bad_alloc();
#endif
    }

private:
    template <class Body> struct Context {
        void run(std::size_t i) {
#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
            try {
                body(i);
            } catch (...) {  // only memory can run out: the library calls nothing of the program here
                failed = true;
            }
#else
            body(i);
#endif
        }

        Body body;
        std::atomic<bool> failed = false;
    };

    lightbin_threads threads_;
};

/// Checks the caller's threads, null for none, and calls body(threads) with them.
template <class Body>
lightbin_result with_threads(const lightbin_threads* given, const char* name, const char* name_of_run,
                             const Body& body) {
    lightbin_threads threads = {};
    if (given == nullptr) return guarded([&] { return body(Threads()); });
    const lightbin_result result = read(given, threads, name);
    if (result.error != LIGHTBIN_OK) return result;
    if (threads.run == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, name_of_run);
#if defined(LIGHTBIN_NO_THREADS)
    return refused(LIGHTBIN_LEFT_OUT, "LIGHTBIN_NO_THREADS");
#else
    const CallersThreads run(threads);
    return guarded([&] { return body(Threads(threads.workers, run)); });
#endif
}

/// Checks the arguments of a binner's call and calls body(call) with them.
template <class Body>
lightbin_result with_call(lightbin_binner* binner, const lightbin_view* view,
                          const lightbin_lights* given_lights, const lightbin_inputs* given_inputs,
                          const Body& body) {
    if (binner == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "binner");
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    CallLights lights;
    lightbin_inputs inputs = {};
    lightbin_result result = read_lights(given_lights, lights);
    if (result.error == LIGHTBIN_OK && given_inputs != nullptr) result = read(given_inputs, inputs, "inputs");
    if (result.error != LIGHTBIN_OK) return result;
    const bool with_slices = reads_slices(binner->value.options()),
               with_bounds = reads_bounds(binner->value.options());
    if (with_slices && inputs.slices == nullptr) return refused(LIGHTBIN_NO_SLICES_GIVEN, "inputs.slices");
    if (with_bounds && inputs.bounds == nullptr) return refused(LIGHTBIN_NO_BOUNDS_GIVEN, "inputs.bounds");
    if (!with_slices && inputs.slices != nullptr) return refused(LIGHTBIN_NOT_READ, "inputs.slices");
    if (!with_bounds && inputs.bounds != nullptr) return refused(LIGHTBIN_NOT_READ, "inputs.bounds");
    std::optional<ZBounds> given_bounds;
    if (with_bounds) result = read_bounds(inputs.bounds, view->value, given_bounds.emplace());
    const ZBounds& bounds = with_bounds ? *given_bounds : no_bounds;
    if (result.error != LIGHTBIN_OK) return result;
    const Slices* const slices = inputs.slices != nullptr ? &inputs.slices->value : nullptr;
    return with_threads(inputs.threads, "inputs.threads", "inputs.threads.run", [&](const Threads& threads) {
        return body(Call{view->value, lights, slices, bounds, threads});
    });
}

/// Returns the options that a caller asks for.
inline lightbin_result read_options(const lightbin_binner_options* given, Options& options) {
    lightbin_binner_options known = {};
    lightbin_result result = given != nullptr ? read(given, known, "options") : succeeded();
    if (result.error == LIGHTBIN_OK)
        result = first_error(check_value(known.slicing, LIGHTBIN_Z_BINS, "options.slicing"));
    if (result.error != LIGHTBIN_OK) return result;
    if (known.ids != LIGHTBIN_U32 && known.ids != LIGHTBIN_U16)
        return refused(LIGHTBIN_NOT_A_VALUE, "options.ids",
                       static_cast<std::uint64_t>(std::int64_t{known.ids}));
    options = {.ids = known.ids == LIGHTBIN_U16 ? IdWidth::u16 : IdWidth::u32,
               .depth_test = known.depth_test != 0,
               .slicing = static_cast<Slicing>(known.slicing)};
    result = read_isa(known.isa, options.isa, "options.isa");
    if (result.error != LIGHTBIN_OK) return result;
    const char* const define = left_out(options);
    return define != nullptr ? refused(LIGHTBIN_LEFT_OUT, define) : result;
}

}  // namespace c
}  // namespace lightbin

extern "C" {

lightbin_result lightbin_binner_create(const lightbin_binner_options* options,
                                       lightbin_binner** binner) {
    using namespace lightbin::c;
    if (binner == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "binner");
    lightbin::Options known;
    const lightbin_result result = read_options(options, known);
    return result.error != LIGHTBIN_OK ? result : make_handle(binner, known);
}

void lightbin_binner_destroy(lightbin_binner* binner) {
    delete binner;
}

lightbin_result lightbin_bin(lightbin_binner* binner, const lightbin_view* view,
                             const lightbin_lights* lights, const lightbin_inputs* inputs,
                             lightbin_grid* grid) {
    using namespace lightbin::c;
    const lightbin_result result = check_size(grid, "grid");
    if (result.error != LIGHTBIN_OK) return result;
    return with_call(binner, view, lights, inputs, [&](const Call& call) {
        return with_id(binner->value.options(), [&](auto id) {
            const auto made = binner->value.template bin<decltype(id)>(call);
            if (!made) return refused(made.error());
            write_grid(*made, grid);
            return succeeded();
        });
    });
}

#if !defined(LIGHTBIN_NO_COVERAGE)
lightbin_result lightbin_coverage(const lightbin_view* view, const lightbin_lights* given_lights,
                                  const lightbin_threads* given_threads, lightbin_light_coverage* coverage,
                                  std::size_t capacity, std::size_t* count) {
    using namespace lightbin::c;
    static_assert(sizeof(lightbin::LightCoverage) == sizeof(lightbin_light_coverage));
    if (view == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "view");
    if (count == nullptr) return refused(LIGHTBIN_NULL_ARGUMENT, "count");
    CallLights lights;
    const lightbin_result result = read_lights(given_lights, lights);
    if (result.error != LIGHTBIN_OK) return result;
    return with_threads(given_threads, "threads", "threads.run", [&](const Threads& threads) {
        const lightbin::detail::DefaultFloatEnvironment environment;
        if (const auto error = lightbin::detail::refuse(lights.all())) return refused(*error);
        lightbin::Footprints<true> footprints;
        footprints.project(lightbin::machine_isa(), view->value, lights.all(), threads);
        *count = footprints.visible();
        if (capacity < *count) return refused(LIGHTBIN_BUFFER_TOO_SMALL, "coverage", *count, capacity);
        using lightbin::detail::LightKind;
        lightbin::detail::find_coverage<spheres_alone ? LightKind::sphere : LightKind::mixed>(
            view->value, footprints, threads, reinterpret_cast<lightbin::LightCoverage*>(coverage));
        return succeeded();
    });
}
#endif

}  // extern "C"
