// Sizes that are refused: of lights, entries, buffers and Z bounds.
#include "scene.hpp"

#include <lightbin/advise.hpp>

#include <cmath>
#include <new>
#include <string>
#include <vector>

using namespace lightbin;

namespace {

bool names(const Error& error, std::uint64_t number) {
    return std::string(error.message()).find(std::to_string(number)) != std::string::npos;
}

}  // namespace

TEST_CASE("more lights than 32 bits number") {
    if constexpr (sizeof(std::size_t) > 4) {
        // Lights of a byte, of which there is one: they are refused before they are read.
        const char byte = 0;
        const std::span<const char> array(&byte, static_cast<std::size_t>(std::uint64_t{1} << 32));
        const auto lights = view_space(array, [](char) { return Sphere{0, 0, -5, 1}; });
        const View view = test::view({64, 64}, 32);
        const auto refused = [](const auto& result) {
            REQUIRE(!result);
            CHECK(result.error().code == ErrorCode::too_many_lights);
            CHECK(result.error().needed == std::uint64_t{1} << 32);
        };
        Binner<> binner;
        refused(binner.bin(view, lights));
        refused(advise(view, lights));
    }
}

TEST_CASE("a buffer refuses what no machine holds, and is as any other after it") {
    const auto check = [](auto buffer) {
        for (const std::uint64_t size :
             {~std::uint64_t{0}, (std::uint64_t{1} << 63) + 1, (std::uint64_t{1} << 62) + 1}) {
            CHECK_THROWS_AS(buffer.reserve(size), const std::bad_alloc&);
            CHECK(buffer.data() == nullptr);
            auto* const few = buffer.reserve(3);
            few[0] = few[2] = 7;
            CHECK_THROWS_AS(buffer.reserve(size, 3), const std::bad_alloc&);
            CHECK(buffer.reserve(3) == few);
            CHECK(buffer.reserve(5, 3)[2] == 7);
        }
    };
    check(detail::Buffer<std::uint8_t>());
    check(detail::Buffer<std::uint64_t>());
}

TEST_CASE("more entries than 32-bit offsets reach") {
    const std::vector<glm::vec4> lights(256, glm::vec4(0, 0, 0, HUGE_VALF));
    Binner<> binner;
    const auto grid = binner.bin(test::view({4096, 4096}, 1), lights);
    REQUIRE(!grid);
    CHECK(grid.error().code == ErrorCode::too_many_entries);
    CHECK(names(grid.error(), std::uint64_t{1} << 32));
}

TEST_CASE("Z bounds shorter than the grid are an error that names the size") {
    const View view = test::view({960, 540}, 16);
    const auto lights = test::random_lights(10, 32);
    Binner<Options{.depth_test = true}> binner;
    const std::vector<float> right(view.tile_count()), small(view.tile_count() - 1);
    for (const ZBounds& bounds :
         {ZBounds{small, right}, ZBounds{right, small}, ZBounds{small, {}}, ZBounds{{}, small}}) {
        const auto grid = binner.bin(view, lights, {.bounds = bounds});
        REQUIRE(!grid);
        CHECK(grid.error().code == ErrorCode::z_bounds_too_small);
        CHECK(names(grid.error(), view.tile_count()));
    }
    CHECK(binner.bin(view, lights, {.bounds = {right, right}}));
}
