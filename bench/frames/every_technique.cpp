// SPDX-License-Identifier: MIT
#include "technique.hpp"

std::vector<Technique> every_technique() {
    std::vector<Technique> all = {tiled_forward(), tiled_forward_gpu()};
    for (const ZEnds ends : {ZEnds::none, ZEnds::min, ZEnds::max, ZEnds::both})
        all.push_back(tiled_forward_pre_z(ends, Reduction::cpu));
    all.push_back(tiled_forward_pre_z(ZEnds::both, Reduction::gpu));
    all.push_back(tiled_forward_box());
    for (const int bits : {8, 16})
        all.push_back(light_indexed(bits));
    all.push_back(clustered_forward());
    all.push_back(clustered_forward_gpu());
    all.push_back(z_binned_forward());
    for (const auto technique : {tiled_deferred, tiled_deferred_passes, tiled_deferred_kernel,
                                 tiled_deferred_planes, deferred, deferred_stencil})
        for (const int bits : {16, 32})
            all.push_back(technique(bits));
    return all;
}
