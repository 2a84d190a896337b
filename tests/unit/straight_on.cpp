// Grids of View::max_side tiles each way, where a tile's number just fits what a kernel counts in, and more lights than
// 16 bits number: every tier, serially and in parts, against the rectangles and discs that the lights are.
#include "scene.hpp"

#include <array>
#include <cstdlib>
#include <random>
#include <string>

using namespace lightbin;

namespace {

/// A picture of one-pixel tiles seen straight on, a unit a pixel, and no light's edge within a quarter of a pixel of a
/// tile's.
struct Picture {
    /// radii  of each fifth light below these
    Picture(int width, int height, std::size_t count, std::uint32_t seed, const std::array<unsigned, 5>& radii)
        : view(*View::from_projection(
              glm::ortho(0.0f, static_cast<float>(width), 0.0f, static_cast<float>(height), 0.1f, 100.0f),
              {width, height}, {.tile_size = 1})) {
        std::mt19937 random(seed);
        const auto below = [&](int side) {
            return static_cast<float>(random() % static_cast<unsigned>(side)) + 0.25f;
        };
        for (std::size_t i = 0; i < count; ++i) {
            // In a corner, at an edge, anywhere.
            const float x = i % 5 == 0 ? 0.25f : i % 5 == 1 ? static_cast<float>(width) - 0.75f : below(width);
            const float y = i % 3 == 0 ? 0.25f : i % 3 == 1 ? static_cast<float>(height) - 0.75f : below(height);
            spheres.emplace_back(x, y, -50.0f, static_cast<float>(random() % radii[i % 5]));
        }
    }

    View view;
    std::vector<glm::vec4> spheres;
};

/// The columns x0 to x_end - 1 and the rows y0 to y_end - 1 of tiles that a light's rectangle meets.
struct Reach {
    std::uint32_t id;
    int x0, x_end, y0, y_end;
};

std::vector<Reach> reaches(const Picture& picture) {
    const auto first = [](float centre, float radius) { return std::floor(double{centre} - double{radius}); };
    const auto last = [](float centre, float radius) { return std::floor(double{centre} + double{radius}); };
    const double width = picture.view.tiles_x(), height = picture.view.tiles_y();
    std::vector<Reach> all;
    for (std::uint32_t id = 0; id < picture.spheres.size(); ++id) {
        const glm::vec4& s = picture.spheres[id];
        if (s.z > 0) continue;  // behind the eye
        all.push_back({id, static_cast<int>(std::max(first(s.x, s.w), 0.0)),
                       static_cast<int>(std::min(last(s.x, s.w) + 1, width)),
                       static_cast<int>(std::max(first(s.y, s.w), 0.0)),
                       static_cast<int>(std::min(last(s.y, s.w) + 1, height))});
    }
    return all;
}

/// Returns whether every tile's list is right: it has all lights whose disc contains the tile's centre, and none whose
/// rectangle misses the tile. With `rectangles` it has exactly the lights whose rectangles meet the tile.
template <class Id>
bool right(const Picture& picture, const std::vector<Reach>& lights, const LightGrid<Id>& grid, bool rectangles,
           const std::string& name) {
    std::uint32_t offset = 0;
    std::size_t tile = 0;
    for (int y = 0; y < grid.tiles_y(); ++y)
        for (int x = 0; x < grid.tiles_x(); ++x) {
            const auto ids = grid.lights_in(x, y);
            const ListRange range = grid.ranges()[tile++];
            std::size_t next = 0;
            for (const Reach& light : lights) {
                const bool listed = next < ids.size() && ids[next] == light.id;
                next += listed;
                const bool inside = x >= light.x0 && x < light.x_end && y >= light.y0 && y < light.y_end;
                const glm::vec4& s = picture.spheres[light.id];
                const double dx = x + 0.5 - double{s.x}, dy = y + 0.5 - double{s.y};
                const bool needed = inside && (rectangles || dx * dx + dy * dy <= double{s.w} * double{s.w});
                if (listed ? inside : !needed) continue;
                MESSAGE(name << ": light " << light.id << (listed ? " too many" : " missing") << " in tile " << x
                             << ", " << y << " of " << grid.tiles_x() << " x " << grid.tiles_y());
                return false;
            }
            if (next != ids.size() || range.offset != offset) return false;
            offset += range.count;
        }
    return offset == grid.ids().size();
}

template <Options options> void check(const Picture& picture, const std::vector<Reach>& lights) {
    static Binner<options> binner;
    for (const std::size_t workers : {1u, 2u, 5u}) {
        const Parallel parallel(workers, test::backwards);
        const auto grid = binner.bin(picture.view, picture.spheres, inputs_for<options>({}), parallel);
        REQUIRE(grid);
        CHECK(right(picture, lights, *grid, !options.depth_test, to_string(options.isa)));
    }
}

}  // namespace

TEST_CASE("lights are listed where they are, more than 16 bits number and projected in parts") {
    for (const bool spread : {true, false}) {
        Picture picture(9, 11, 400, 1, {1, 3, 4, 4, 20});
        // In view are each 500th, or the first and the last 200.
        std::vector<glm::vec4> few(200000, glm::vec4(0, 0, 50, 1));
        for (std::size_t i = 0; i < 400; ++i)
            few[spread ? 500 * i : i < 200 ? i : 199600 + i] = picture.spheres[i];
        picture.spheres.swap(few);
        const auto lights = reaches(picture);
        test::on_machine_tiers([&]<Isa isa>() {
            check<Options{.isa = isa}>(picture, lights);
            check<Options{.depth_test = true, .isa = isa}>(picture, lights);
        });
    }
}

TEST_CASE("grids of the most rows or columns list every light where it is") {
    if (std::getenv("LIGHTBIN_TEST_SHARE") != nullptr) return;  // in emulators, which are slow
    std::uint32_t seed = 0;
    for (const int side : {1, 9, 63})
        for (const bool tall : {true, false})
            for (const std::size_t count : {1u, 3u, 70u}) {
                if (side * static_cast<int>(count) > 200) continue;
                Picture picture(tall ? side : View::max_side, tall ? View::max_side : side, count, ++seed,
                                {1, 9, 100, 33000, 65536});
                picture.spheres[0] = {0.25f, 0.25f, -50.0f, 32767.0f};  // ends in the last row and column
                const auto lights = reaches(picture);
                test::on_machine_tiers([&]<Isa isa>() {
                    check<Options{.isa = isa}>(picture, lights);
                    check<Options{.ids = IdWidth::u16, .depth_test = true, .isa = isa}>(picture, lights);
                });
            }
}
