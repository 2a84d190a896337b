// SPDX-License-Identifier: MIT
#include "technique.hpp"

std::vector<Technique> without_pre_pass() {
    using lightbin::Slicing;
    return {tiled_forward(), clustered_forward(), z_binned_forward(), masked_forward(Slicing::none),
            masked_forward(Slicing::z_bins)};
}

std::vector<Technique> every_technique() {
    std::vector<Technique> all = without_pre_pass();
    for (const ZEnds ends : {ZEnds::none, ZEnds::min, ZEnds::max, ZEnds::both})
        all.push_back(tiled_forward_pre_z(ends));
    all.push_back(tiled_forward_box());
    for (const auto technique : {tiled_deferred, deferred, deferred_stencil})
        for (const int bits : {16, 32})
            all.push_back(technique(bits));
    return all;
}
