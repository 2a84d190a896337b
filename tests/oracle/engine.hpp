// SPDX-License-Identifier: MIT
// The library behind an interface without it, so that it can be built with other flags, or another compiler, than
// the oracle that judges it.
#pragma once

#include "families.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace oracle {

/// What is built of a scene.
enum class Rung {
    rectangle,
    rectangle_interval,
    rectangle_box,
    rectangle_split_box,
    silhouette,
    silhouette_interval,
    silhouette_box,
    silhouette_split_box,
};

struct RungInfo {
    Rung rung;
    std::string name;
    bool split;  ///< of the depths of a tile, those in its gap do not count
};

inline const std::vector<RungInfo>& all_rungs() {
    static const std::vector<RungInfo> all = {
        {Rung::rectangle, "rectangle", false},
        {Rung::rectangle_interval, "rectangle, interval", false},
        {Rung::rectangle_box, "rectangle, box", false},
        {Rung::rectangle_split_box, "rectangle, split box", true},
        {Rung::silhouette, "silhouette", false},
        {Rung::silhouette_interval, "silhouette, interval", false},
        {Rung::silhouette_box, "silhouette, box", false},
        {Rung::silhouette_split_box, "silhouette, split box", true},
    };
    return all;
}

inline const RungInfo& info(Rung rung) {
    return all_rungs()[static_cast<std::size_t>(rung)];
}

/// The light lists a tile: of tile t, ids[offsets[t]] up to ids[offsets[t + 1]].
struct Lists {
    std::vector<std::uint32_t> offsets, ids;
    std::uint32_t rejected = 0;
    bool operator==(const Lists&) const = default;
};

/// Builds a scene's lists on every instruction set that the machine has.
class Engine {
public:
    /// flush_denormals  the processor takes denormal floats for 0 while the library runs (FTZ and DAZ)
    explicit Engine(bool flush_denormals = false) : flush_(flush_denormals) {}

    bool flushes_denormals() const { return flush_; }
    bool accepts(const Camera& camera) const;

    /// Returns the scalar tier's lists. What was wrong (the view refused, tiers that differ) is added to
    /// `complaints`.
    Lists lists(const Scene& scene, Rung rung, std::vector<std::string>& complaints) const;

private:
    bool flush_;
};

}  // namespace oracle
