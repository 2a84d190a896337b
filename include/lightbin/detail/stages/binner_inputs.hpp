// SPDX-License-Identifier: MIT
// The members of Binner's Inputs: one that is missing, or that the options do not read, is refused at compile time.
#pragma once

#include <lightbin/slices.hpp>
#include <lightbin/z_bounds.hpp>

namespace lightbin { inline namespace LIGHTBIN_ABI_TAG { namespace detail {

/// The type of an input that the Binner's options do not read. Passing such an input is a compile error.
struct NotRead {
    NotRead() = default;
    template <class Given> NotRead(const Given&) {
        static_assert(
            sizeof(Given) == 0,
            "lightbin: this Binner does not read this input: bounds want an Options::depth_test "
            "or clusters, and slices an Options::slicing");
    }
    operator ZBounds() const { return {}; }
};

/// The default of Inputs::bounds. Leaving out bounds that the options read is a compile error.
template <bool read> auto bounds_left_out() {
    static_assert(
        !read, "lightbin: this Binner's depth test needs Z bounds: bin(view, lights, {.bounds = ...}), with "
               "what reduce_depth() returns or bounds of your own");
    return std::conditional_t<read, ZBounds, NotRead>();
}

/// The slices of an Inputs: a reference to the caller's Slices, or a copy of a temporary, which would be destroyed at
/// the end of the expression that makes the Inputs.
class SlicesInput {
public:
    SlicesInput(const Slices& slices) : given_(&slices) {}
    // Not inline, as g++ 12 would give false warnings in programs built with the address sanitizer.
    LIGHTBIN_NOINLINE SlicesInput(const SlicesInput& other) : given_(other.given_), own_(other.own_) {}
    LIGHTBIN_NOINLINE ~SlicesInput() {}
    SlicesInput& operator=(const SlicesInput&) = delete;
    SlicesInput(const Slices&& slices) : own_(slices) {}
    template <class Given>
    SlicesInput(const Result<Given>& result)
        : own_(static_cast<const Given&>(result)) {}  // refuses: this is still a Result

    operator const Slices&() const { return given_ != nullptr ? *given_ : *own_; }

private:
    const Slices* given_ = nullptr;
    std::optional<Slices> own_;
};

/// The default of Inputs::slices. Leaving out slices that the options read is a compile error.
template <bool read> std::conditional_t<read, SlicesInput, NotRead> slices_left_out() {
    static_assert(!read,
                  "lightbin: this Binner slices depth: bin(view, lights, {.slices = *slices}), with what "
                  "Slices::exponential() or linear() returns");
    if constexpr (!read) return {};
}

}}}  // namespace lightbin::detail
