// SPDX-License-Identifier: MIT
// TiledFwd-PreZ (Tiled Shading, section 6.3; Tiled Forward Shading, section 4.4): draws depth first, so that each pixel
// is shaded once and a tile's list leaves out lights that are not at the depths drawn there.
#include "passes.hpp"
#include "technique.hpp"

#include <memory>

namespace {

struct BoxLists {
    auto bin(Stage& stage, const lightbin::ZBounds& bounds) {
        return value_of(binner.bin(stage.view(), stage.lights(), {.bounds = bounds}));
    }
    lightbin::Binner<lightbin::Options{.depth_test = true}> binner;
};

template <class Lists> Technique pre_z(const std::string& name, ZEnds ends) {
    struct Memory {
        DepthBounds bounds;
        Lists lists;
    };
    const auto memory = std::make_shared<Memory>();
    return {name, [=](Stage& stage) {
                begin_picture(stage);
                depth_pre_pass(stage);
                lightbin::ZBounds bounds;
                if (ends != ZEnds::none) bounds = memory->bounds.reduce(stage);
                if (ends == ZEnds::min) bounds.max = {};
                if (ends == ZEnds::max) bounds.min = {};
                const auto grid = memory->lists.bin(stage, bounds);
                stage.lap("bin");
                upload_lists(stage, grid);
                shade_forward(stage, listed_lights());
            }};
}

}  // namespace

Technique tiled_forward_pre_z(ZEnds ends) {
    static constexpr const char* names[] = {"", " min", " max", " both"};
    return pre_z<IntervalLists>(std::string("TiledForward-PreZ") + names[static_cast<int>(ends)], ends);
}

Technique tiled_forward_box() {
    return pre_z<BoxLists>("TiledForward-PreZ box", ZEnds::both);
}
