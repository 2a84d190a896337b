// Sizes that fit 64 bits but overflow 32 bits are refused. Only tests/platforms.sh runs this: with 64 bits, tests of
// such sizes would take too much memory.
#include <cstdint>
#if SIZE_MAX == UINT32_MAX
#include <lightbin/lightbin.hpp>

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <vector>

namespace {

using namespace lightbin;

View view_of(ImageSize viewport) {
    const double projection[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, -1}, {0, 0, -0.2, 0}};
    return *View::from_projection(projection, viewport, {.tile_size = 1});
}

template <Options options> void check(const View& view, std::size_t count, const Parallel& parallel) {
    const std::vector<Sphere> lights(count, {0, 0, -1, std::numeric_limits<float>::infinity()});
    const std::vector<float> z(view.tile_count(), 1);
    const ZBounds bounds{z, z};
    Binner<options> binner;
    const auto bin = [&](const View& of, const auto& some) {
        return binner.bin(of, some, inputs_for<options>(bounds), parallel);
    };
    CHECK_THROWS_AS((void)bin(view, lights), const std::bad_alloc&);
    const auto grid = bin(view_of({5, 3}), std::vector<Sphere>(7, lights[0]));
    REQUIRE(grid);
    CHECK(grid->ids().size() == 5 * 3 * 7);
}

}  // namespace

TEST_CASE("2^32 - 1 entries, the most that offsets reach, and what kernels write beyond them") {
    const View view = view_of({255, 257});
    const auto run = [](std::size_t n, const auto& body) {
        for (std::size_t i = 0; i < n; ++i)
            body(i);
    };
    for (const std::size_t workers : {1u, 3u}) {
        const Parallel parallel(workers, run);
        check<Options{}>(view, 65537, parallel);
        check<Options{.depth_test = true}>(view, 65537, parallel);
        check<Options{.ids = IdWidth::u16}>(view, 65536, parallel);
    }
}
#endif
