// Grids of View::max_side tiles each way, where a tile's number just fits what a kernel counts in: every tier, serially
// and in parts, against the rectangles and discs that the lights are.
#include "scene.hpp"

#include <array>
#include <random>
#include <string>

using namespace lightbin;

namespace {

/// A picture of one-pixel tiles seen straight on, a unit a pixel, and no light's edge within a quarter of a pixel of a
/// tile's.
struct Picture {
    Picture(int width, int height, std::size_t count, std::uint32_t seed)
        : view(*View::from_projection(
              glm::ortho(0.0f, static_cast<float>(width), 0.0f, static_cast<float>(height), 0.1f, 100.0f),
              {width, height}, {.tile_size = 1})) {
        std::mt19937 random(seed);
        const auto below = [&](int side) {
            return static_cast<float>(random() % static_cast<unsigned>(side)) + 0.25f;
        };
        for (std::size_t i = 0; i < count; ++i) {
            // In a corner, at an edge, anywhere; from one tile to many times the picture.
            const float x = i % 5 == 0   ? 0.25f
                            : i % 5 == 1 ? static_cast<float>(width) - 0.75f
                                         : below(width);
            const float y = i % 3 == 0   ? 0.25f
                            : i % 3 == 1 ? static_cast<float>(height) - 0.75f
                                         : below(height);
            const std::array<int, 5> radii = {1, 9, 100, 33000, 65536};
            const float radius = static_cast<float>(random() % static_cast<unsigned>(radii[i % 5]));
            spheres.emplace_back(x, y, -50.0f, radius);
        }
        // Ends in the last row and column, and begins in the first.
        if (count > 0) spheres[0] = {0.25f, 0.25f, -50.0f, 32767.0f};
    }

    View view;
    std::vector<glm::vec4> spheres;
};

/// The tiles first..end-1 of `side` that a light at `centre` with `radius` reaches along an axis.
struct Reach {
    int first, end;
};
Reach reach(float centre, float radius, int side) {
    const double low = std::floor(static_cast<double>(centre) - static_cast<double>(radius)),
                 high = std::floor(static_cast<double>(centre) + static_cast<double>(radius));
    return {static_cast<int>(std::max(low, 0.0)), static_cast<int>(std::min(high + 1, double(side)))};
}

/// Whether a tile's list is what it must be: all lights whose disc has the tile's middle, in none whose rectangle does
/// not meet it; with rectangles, all of those.
template <class Id>
bool right(const Picture& picture, const LightGrid<Id>& grid, bool rectangles, const std::string& name) {
    const int width = grid.tiles_x(), height = grid.tiles_y();
    std::vector<Reach> columns, rows;
    for (const glm::vec4& s : picture.spheres) {
        columns.push_back(reach(s.x, s.w, width));
        rows.push_back(reach(s.y, s.w, height));
    }
    std::uint32_t offset = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto ids = grid.lights_in(x, y);
            const ListRange range =
                grid.ranges()[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(x)];
            std::size_t next = 0;
            for (std::uint32_t id = 0; id < picture.spheres.size(); ++id) {
                const bool listed = next < ids.size() && ids[next] == id;
                next += listed;
                const bool inside =
                    x >= columns[id].first && x < columns[id].end && y >= rows[id].first && y < rows[id].end;
                const glm::vec4& s = picture.spheres[id];
                const double dx = x + 0.5 - double{s.x}, dy = y + 0.5 - double{s.y};
                const bool needed = inside && (rectangles || dx * dx + dy * dy <= double{s.w} * double{s.w});
                if (listed ? inside : !needed) continue;
                MESSAGE(name << ": light " << id << (listed ? " too many" : " missing") << " in tile " << x
                             << ", " << y << " of " << width << " x " << height);
                return false;
            }
            if (next != ids.size() || range.offset != offset) return false;
            offset += range.count;
        }
    return offset == grid.ids().size();
}

template <Options options> void check(const Picture& picture, const std::string& name) {
    Binner<options> binner;
    for (const std::size_t workers : {1u, 5u}) {
        const Parallel parallel(workers, test::backwards, 0);
        const auto grid = binner.bin(picture.view, picture.spheres, inputs_for<options>({}), parallel);
        REQUIRE(grid);
        CHECK(right(picture, *grid, options.footprint == Footprint::rectangle, name));
    }
}

template <Isa isa> void check_tier(const Picture& picture, const std::string& name) {
    check<Options{.isa = isa}>(picture, name);
    check<Options{.footprint = Footprint::silhouette, .isa = isa}>(picture, name);
    check<Options{.ids = IdWidth::u16, .depth_test = DepthTest::interval, .isa = isa}>(picture, name);
}

}  // namespace

TEST_CASE("grids of the most rows or columns list every light where it is") {
    std::uint32_t seed = 0;
    for (const int side : {1, 9, 63}) {
        for (const bool tall : {true, false})
            for (const std::size_t count : {1u, 3u, 70u}) {
                if (side * static_cast<int>(count) > 200) continue;  // for time's sake
                const Picture picture(tall ? side : View::max_side, tall ? View::max_side : side, count,
                                      ++seed);
                test::on_machine_tiers([&]<Isa isa>() { check_tier<isa>(picture, to_string(isa)); });
            }
    }
}
