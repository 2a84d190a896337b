// SPDX-License-Identifier: MIT
// Light Indexed Deferred Rendering (Pettineo, 2012): forward after a pre-pass, with a list a tile that ends with a sentinel
// and has room for every light, so that there is no table of tiles.
#include "passes.hpp"
#include "technique.hpp"

#include <lightbin/encode.hpp>

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

Technique light_indexed(int id_bits) {
    struct Memory {
        DepthBounds bounds;
        IntervalLists lists;
        std::vector<std::byte> encoded;
    };
    const auto memory = std::make_shared<Memory>();
    return {"LightIndexed " + std::to_string(id_bits) + " bit", [=](Stage& stage) {
                const std::size_t countable = (std::size_t{1} << id_bits) - 1;  // the last id is the sentinel
                if (stage.lights().size() > countable)
                    throw std::runtime_error("its ids number " + std::to_string(countable) + " lights, and " +
                                             std::to_string(stage.lights().size()) + " are in the scene");
                const lightbin::ListFormat format = {
                    .encoding = lightbin::ListEncoding::sentinel,
                    .ids = id_bits == 8 ? lightbin::IdWidth::u8 : lightbin::IdWidth::u16,
                    .capacity = static_cast<std::uint32_t>(stage.lights().size())};
                begin_picture(stage);
                depth_pre_pass(stage);
                const auto bounds = memory->bounds.reduce(stage);
                const auto grid = memory->lists.bin(stage, bounds);
                memory->encoded.resize(lightbin::encoded_bytes(format, grid.ranges().size(), 0));
                value_of(lightbin::encode(grid, format, memory->encoded));
                stage.lap("bin");
                const GLuint lists = stage.memory.buffer("lists", memory->encoded);
                stage.memory.read_texels(unit_lists, id_bits == 8 ? GL_R8UI : GL_R16UI, lists);
                stage.lap("upload");
                shade_forward(stage, listed_lights({.format = format}));
            }};
}
