// SPDX-License-Identifier: MIT
// The limits of every size, taken and overstepped: these few need no luck.
#include "engines.hpp"
#include "guarded.hpp"
#include "round.hpp"

#include <lightbin/encode.hpp>

#include <algorithm>
#include <climits>
#include <cmath>
#include <string>
#include <vector>

namespace hunt {
namespace {

using lightbin::ErrorCode;
using lightbin::View;
constexpr lightbin::Options plain = {}, narrow = {.ids = IdWidth::u16},
                            interval = {.depth_test = DepthTest::interval};

/// Looks from z = 0 to z = 2 with x and y from -1 to 1: so pixels are easily hit.
glm::dmat4 unit_matrix() {
    glm::dmat4 m(1);
    m[2][2] = 0.5;
    return m;
}

View unit_view(int width, int height, int tile_size) {
    return *View::from_projection(unit_matrix(), {width, height},
                                  {.tile_size = tile_size, .clip_depth = lightbin::ClipDepth::zero_to_one});
}

class Limits {
public:
    explicit Limits(Report& report) : report_(report) {}

    void expect(bool is, const std::string& what) {
        ++report_.tally["limits"];
        if (!is) report_.faults.push_back("at a limit: " + what);
    }
    template <class T>
    void expect_error(const lightbin::Result<T>& result, ErrorCode code, const std::string& what,
                      std::uint64_t needed = 0, std::uint64_t available = 0) {
        expect(!result && result.error().code == code && (needed == 0 || result.error().needed == needed) &&
                   (available == 0 || result.error().available == available) &&
                   !result.error().message().empty(),
               what + (result ? " is taken" : " is refused with: " + result.error().message()));
    }

    void cameras() {
        for (const auto& [width, height] :
             {std::pair{-1, 5}, {5, -1}, {32769, 1}, {1, 32769}, {INT_MAX, 1}, {1, INT_MIN}})
            expect_error(View::from_projection(unit_matrix(), {width, height}),
                         ErrorCode::viewport_out_of_range,
                         "a viewport of " + std::to_string(width) + " x " + std::to_string(height));
        for (const int size : {0, -1, INT_MIN})
            expect_error(View::from_projection(unit_matrix(), {5, 5}, {.tile_size = size}),
                         ErrorCode::tile_size_out_of_range, "a tile size of " + std::to_string(size));
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) {
                glm::dmat4 m = unit_matrix();
                m[column][row] = std::nan("");
                expect_error(View::from_projection(m, {5, 5}), ErrorCode::matrix_not_finite, "a NaN");
            }
        expect(!View::from_projection(glm::dmat4(0), {5, 5}), "the matrix 0 is taken");
    }

    void lights() {
        // All ids that 16 bits have.
        std::vector<Sphere> many(65537, Sphere{0, 0, 1, 0.1f});
        lightbin::Binner<narrow> binner;
        const View view = unit_view(1, 1, 1);
        const auto all = binner.bin(view, std::span(many).first(65536));
        expect(all && all->ids().size() == 65536 && all->ids()[65535] == 65535, "65,536 lights with 16 bits");
        expect_error(binner.bin(view, many), ErrorCode::too_many_lights, "65,537 lights with 16 bits", 65537,
                     65536);
        for (const float bad : {std::nanf(""), infinite}) {
            glm::dmat4 matrix(1);
            matrix[3][0] = bad;
            expect_error(binner.bin(view, world_space(std::span(many).first(1), matrix)),
                         ErrorCode::view_matrix_not_affine, "a view matrix that is not finite");
        }
    }

    void entries() {
        lightbin::Binner<plain> binner;
        const std::vector<Sphere> covering(4096, Sphere{0, 0, 0, infinite});
        const std::uint64_t most = 0xffffffff;
        expect_error(binner.bin(unit_view(1024, 1024, 1), covering), ErrorCode::too_many_entries,
                     "2^32 entries", std::uint64_t{1} << 32, most);
        expect_error(binner.bin(unit_view(16384, 16384, 1), covering), ErrorCode::too_many_list_places,
                     "more than 2^32 list places", 0, most);
        expect_error(binner.bin(unit_view(32768, 32768, 1), std::span(covering).first(4)),
                     ErrorCode::too_many_entries, "2^32 entries of the largest grid", std::uint64_t{1} << 32,
                     most);
        const auto after = binner.bin(unit_view(8, 8, 1), std::span(covering).first(2));
        expect(after && after->ids().size() == 128, "a grid after a refused one");
    }

    void z_bounds() {
        lightbin::Binner<interval> binner;
        const View view = unit_view(8, 8, 1);
        const std::vector<Sphere> light = {{0, 0, 1, 0.1f}};
        std::vector<float> floats(64), few(63);
        for (int side = 0; side < 4; ++side) {
            std::span<const float> sides[] = {floats, floats, floats, floats};
            sides[side] = few;
            expect_error(binner.bin(view, light, {.bounds = {sides[0], sides[1], sides[2], sides[3]}}),
                         ErrorCode::z_bounds_too_small, "Z bounds of 63 tiles", 64, 63);
        }
        std::vector<float> depth(64 * 9, 0.5f);
        const auto reduce = [&](lightbin::DepthBuffer buffer, std::size_t samples, std::size_t bounds = 64) {
            buffer.depth = std::span(depth).first(samples);
            return lightbin::reduce_depth(view, buffer, {.min = std::span(floats).first(bounds)});
        };
        expect_error(reduce({.samples = 0}, 64), ErrorCode::samples_out_of_range, "0 samples");
        expect_error(reduce({.samples = 9}, 64 * 9), ErrorCode::samples_out_of_range, "9 samples");
        expect_error(reduce({.samples = INT_MIN}, 64), ErrorCode::samples_out_of_range, "fewest samples");
        expect_error(reduce({}, 63), ErrorCode::depth_buffer_too_small, "a short depth buffer", 64, 63);
        expect_error(reduce({.row_pitch = 7}, 64), ErrorCode::row_pitch_too_small, "a short pitch", 8, 7);
        expect_error(reduce({}, 64, 63), ErrorCode::z_bounds_too_small, "short bounds to write", 64, 63);
        expect(reduce({.row_pitch = 9}, 7 * 9 + 8).has_value(), "a last row without its pitch is refused");
    }

    /// A light in each corner's pixel, one that covers all, and small ones, on grids as long as can be.
    void longest(int width, int height) {
        const View view = unit_view(width, height, 1);
        const double half_x = 1.0 / width, half_y = 1.0 / height;
        Scene scene;
        for (int corner = 0; corner < 4; ++corner)
            scene.lights.push_back({static_cast<float>((corner % 2 == 0 ? -1 : 1) * (1 - half_x)),
                                    static_cast<float>((corner / 2 == 0 ? -1 : 1) * (1 - half_y)), 1,
                                    static_cast<float>(0.25 * std::min(half_x, half_y))});
        scene.lights.push_back({0, 0, 1, infinite});
        scene.lights.push_back({0, 0, 1, 10});
        for (int more = 0; more < 70; ++more)  // in few tiles, but enough for other kernels
            scene.lights.push_back(
                {static_cast<float>(std::cos(more)), static_cast<float>(std::sin(more)), 1, 0});
        const std::vector<float> least(view.tile_count(), 0.5f), most(view.tile_count(), 1.5f);
        for (const Footprint footprint : {Footprint::rectangle, Footprint::silhouette})
            for (const DepthTest depth_test : {DepthTest::none, DepthTest::box})
                for (unsigned tier = 0; tier < tier_count; ++tier) {
                    const Engine engine = engine_of(depth_test, footprint, tier, IdWidth::u32);
                    Input input = {&view, &scene, {least, most}};
                    input.order = tier % 2 == 0 ? Order::serial : Order::shuffled;
                    input.workers = 7;
                    const Output out = engine.run(input);
                    engine.forget();
                    const std::string where =
                        std::to_string(width) + " x " + std::to_string(height) + " tiles, " +
                        (footprint == Footprint::rectangle ? "rectangle, " : "silhouette, ") +
                        (depth_test == DepthTest::none ? "none, " : "box, ") + tier_names[tier];
                    expect(!out.error && out.lists.tiles.size() == view.tile_count(), where + " are refused");
                    if (out.error) continue;
                    std::size_t without = 0;
                    for (std::size_t tile = 0; tile < view.tile_count(); ++tile) {
                        const auto list = out.lists.of(tile);
                        without +=
                            !std::ranges::binary_search(list, 4u) || !std::ranges::binary_search(list, 5u);
                    }
                    expect(without == 0, "MISS: " + std::to_string(without) +
                                             " tiles lack a light that covers all of " + where);
                    for (std::uint32_t corner = 0; corner < 4; ++corner) {
                        const std::size_t x = corner % 2 == 0 ? 0 : static_cast<std::size_t>(width - 1),
                                          y = corner / 2 == 0 ? 0 : static_cast<std::size_t>(height - 1);
                        expect(std::ranges::binary_search(
                                   out.lists.of(y * static_cast<std::size_t>(width) + x), corner),
                               "MISS: the light in corner " + std::to_string(corner) + " of " + where);
                    }
                }
    }

    /// What takes gigabytes or long.
    void large() {
        longest(16384, 4096);
        longest(2048, 32768);
        // Rectangles out of reach, of which Z leaves next to nothing.
        const View view = unit_view(1024, 1024, 1);
        const std::vector<Sphere> covering(4096, Sphere{0, 0, 0, infinite});
        std::vector<float> least(view.tile_count(), 1), most(view.tile_count(), 0);
        most[12345] = 1;
        lightbin::Binner<interval> binner;
        const auto grid = binner.bin(view, covering, {.bounds = {least, most}});
        expect(grid && grid->ids().size() == 4096, "4,096 entries of 2^32 in rectangles");
    }

private:
    Report& report_;
};

}  // namespace

void hunt_limits(Report& report, bool large) {
    Limits limits(report);
    limits.cameras();
    limits.lights();
    limits.entries();
    limits.z_bounds();
    for (const auto& [width, height] :
         {std::pair(1, 32768), {32768, 1}, {9, 32768}, {32768, 9}, {8, 32761}, {248, 249}, {249, 248}})
        limits.longest(width, height);
    if (large) limits.large();
}

}  // namespace hunt
