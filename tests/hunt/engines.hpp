// SPDX-License-Identifier: MIT
// Every kind of Binner behind one function type. The depth tests are units of their own, as each takes long to
// compile.
#pragma once

#include "scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace hunt {

using lightbin::DepthTest;
using lightbin::Footprint;
using lightbin::IdWidth;

/// How the lights are given, in view space or world space.
enum class Form { vectors, spheres, own };
inline constexpr const char* form_names[] = {"vec4 array", "Sphere array", "own struct"};

/// Which calls make the grid.
enum class Calls { bin, copy, transparency };
inline constexpr const char* call_names[] = {"bin", "bin and copy_to", "bin_transparency"};

/// The order or the threads in which bodies are run.
enum class Order { serial, forward, backward, shuffled, threads };
inline constexpr const char* order_names[] = {"Serial", "forward", "backward", "shuffled", "threads"};

inline constexpr const char* tier_names[] = {"scalar", "sse2", "avx2", "widest"};
inline constexpr unsigned tier_count = 4;

struct Input {
    const lightbin::View* view;
    const Scene* scene;
    lightbin::ZBounds bounds;
    Form form = Form::vectors;
    Calls calls = Calls::bin;
    Order order = Order::serial;
    unsigned workers = 1;
    std::uint64_t seed = 0;  ///< of what is random in a call
};

/// A grid, with ids of 32 bits, in memory of its own.
struct Lists {
    std::vector<lightbin::ListRange> tiles;
    std::vector<std::uint32_t> ids;

    std::span<const std::uint32_t> of(std::size_t tile) const {
        return std::span(ids).subspan(tiles[tile].offset, tiles[tile].count);
    }
};

struct Output {
    std::optional<lightbin::Error> error;
    int tiles_x = 0, tiles_y = 0;
    lightbin::LightCounts counts;
    lightbin::ListLengths lengths;
    Lists lists, transparent;
    std::string wrong;  ///< what was found in the call itself; empty: nothing
};

struct Engine {
    Output (*run)(const Input& input);
    void (*forget)();  ///< starts again with a new Binner
};

/// Narrow ids are there for some depth tests, for the time that they take to compile.
constexpr bool has_narrow_ids(DepthTest depth_test) {
    return depth_test == DepthTest::none || depth_test == DepthTest::box;
}

/// The Binner of these options; it lives on from call to call.
template <DepthTest depth_test> Engine engine(Footprint footprint, unsigned tier, IdWidth ids);

inline Engine engine_of(DepthTest depth_test, Footprint footprint, unsigned tier, IdWidth ids) {
    switch (depth_test) {
    case DepthTest::none:
        return engine<DepthTest::none>(footprint, tier, ids);
    case DepthTest::interval:
        return engine<DepthTest::interval>(footprint, tier, ids);
    case DepthTest::box:
        return engine<DepthTest::box>(footprint, tier, ids);
    default:
        return engine<DepthTest::split_box>(footprint, tier, ids);
    }
}

}  // namespace hunt
