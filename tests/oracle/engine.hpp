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
    rectangles,
    depth_test,
#if defined(ORACLE_EVERY_WAY)  // not for a Judge: lists in slices, which tests/same_bytes.sh compares
    clusters,
    tested_clusters,
    z_bins,
    tested_z_bins,
#endif
};

struct RungInfo {
    Rung rung;
    std::string name;
};

inline const std::vector<RungInfo>& all_rungs() {
    static const std::vector<RungInfo> all = {
        {Rung::rectangles, "rectangles"},
        {Rung::depth_test, "depth test"},
#if defined(ORACLE_EVERY_WAY)
        {Rung::clusters, "clusters"},
        {Rung::tested_clusters, "clusters, depth test"},
        {Rung::z_bins, "z-bins"},
        {Rung::tested_z_bins, "z-bins, depth test"},
#endif
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
