// SPDX-License-Identifier: MIT
#include "technique.hpp"

std::vector<Technique> every_technique() {
    std::vector<Technique> all = {tiled_forward()};
    for (const ZEnds ends : {ZEnds::none, ZEnds::min, ZEnds::max, ZEnds::both})
        all.push_back(tiled_forward_pre_z(ends));
    all.push_back(tiled_forward_box());
    for (const int bits : {8, 16})
        all.push_back(light_indexed(bits));
    all.push_back(clustered_forward());
    all.push_back(z_binned_forward());
    for (const auto technique : {tiled_deferred, tiled_deferred_planes, deferred, deferred_stencil})
        for (const int bits : {16, 32})
            all.push_back(technique(bits));
    return all;
}
