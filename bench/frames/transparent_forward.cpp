// SPDX-License-Identifier: MIT
// Transparent geometry (Tiled Forward Shading, section 4.5 and Listing 4.2): drawn from the farthest to the nearest over
// the opaque picture, with lists that begin at the eye, as it may stand anywhere before opaque surfaces.
#include "passes.hpp"
#include "technique.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace {

// Of the panes alone: nearer lights than the nearest pane of a tile are not needed there, and no light where none is.
std::span<const float> nearest_panes(Stage& stage, DepthBounds& bounds) {
    const GLuint depth = stage.target("depth of panes", GL_DEPTH_COMPONENT32F);
    stage.memory.draw_to({}, depth);
    glClear(GL_DEPTH_BUFFER_BIT);
    stage.use(stage.shaders().surface_vertex(), stage.shaders().depth_fragment());
    stage.geometry.draw_panes();
    stage.lap("pre-Z");
    return bounds.reduce_on_gpu(stage, depth).min;
}

struct Memory {
    DepthBounds opaque, all, panes;
    IntervalLists opaque_lists, pane_lists;
};

/// The grids of the opaque surfaces and of the panes.
std::array<lightbin::LightGrid<std::uint32_t>, 2> bin(Stage& stage, Memory& memory, TransparentLists lists) {
    lightbin::ZBounds of_panes = {.max = memory.all.reduce_on_gpu(stage, stage.depth(), true).max};
    if (lists == TransparentLists::own_min) of_panes.min = nearest_panes(stage, memory.panes);
    const auto panes = memory.pane_lists.bin(stage, of_panes);
    if (lists == TransparentLists::shared) return {panes, panes};
    return {memory.opaque_lists.bin(stage, memory.opaque.reduce_on_gpu(stage, stage.depth())), panes};
}

}  // namespace

Technique transparent_forward(TransparentLists lists) {
    const auto memory = std::make_shared<Memory>();
    static constexpr const char* names[] = {"PreZ with lists for panes", "PreZ with shared lists",
                                            "PreZ with lists from the nearest pane on"};
    return {names[static_cast<int>(lists)], [=](Stage& stage) {
                begin_picture(stage);
                depth_pre_pass(stage);
                const auto [opaque, transparent] = bin(stage, *memory, lists);
                stage.lap("bin");
                upload_lists(stage, opaque);
                shade_forward(stage, listed_lights());
                if (lists != TransparentLists::shared) upload_lists(stage, transparent);
                shade_panes(stage, listed_lights());
                stage.resolve();
            }};
}
