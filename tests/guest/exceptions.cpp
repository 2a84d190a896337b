// An exception anywhere in a call of a Binner, from `new` or from the caller's functions: the next call gives the right
// lists, whether its input is the same or smaller.
#include "../unit/scene.hpp"
#include "counted_new.hpp"

#include <lightbin/advise.hpp>
#include <lightbin/shader_cull.hpp>
#include <lightbin/shader_reduce.hpp>

#include <cstddef>
#include <cstdint>
#include <new>
#include <string>
#include <vector>

namespace {

using namespace lightbin;

/// What the caller's own functions throw.
struct Thrown {};

/// The number of events in the user's functions up to the one that throws; 0 if none shall throw.
std::size_t events_left = 0;

void event() {
    if (events_left != 0 && --events_left == 0) throw Thrown{};
}

const auto as_sphere = [](const glm::vec4& light) {
    event();
    return Sphere{light.x, light.y, light.z, light.w};
};

/// A user's loop for Parallel, which may throw before, between and after the calls.
const auto run = [](std::size_t n, const auto& body) {
    event();
    while (n > 0) {
        body(--n);
        event();
    }
};

/// Returns whether a call throws the expected exception at the given place.
template <class Exception> bool throws(std::size_t& left, std::size_t place, const auto& call) {
    left = place;
    try {
        call();
    } catch (const Exception&) {
        left = 0;
        return true;
    }
    const bool reached = left == 0;
    left = 0;
    CHECK(!reached);  // nothing else may catch it
    return false;
}

struct Input {
    View view;
    std::vector<glm::vec4> lights;
    std::vector<float> min, max;
    Slices slices;

    /// size  factor for the radii of test::random_lights()
    Input(ImageSize viewport, int tile_size, std::size_t count, float size)
        : view(test::view(viewport, tile_size)), lights(test::random_lights(count, 7)),
          slices(*Slices::linear(static_cast<int>(count), 0, 40)) {
        for (glm::vec4& light : lights)
            light.w *= size;
        test::some_bounds(view, min, max);
    }

    ZBounds bounds() const { return {min, max}; }
};

/// Returns the lists that a Binner makes of a scene, as numbers.
template <Options options>
std::vector<std::uint32_t> made(Binner<options>& binner, const Input& scene, const Parallel& parallel) {
    const auto inputs = inputs_for<options>(scene.bounds(), scene.slices);
    const auto grid = *binner.bin(scene.view, view_space(scene.lights, as_sphere), inputs, parallel);
    std::vector<std::uint32_t> words(grid.ids().begin(), grid.ids().end());
    for (const ListRange range : grid.ranges())
        words.insert(words.end(), {range.offset, range.count});
    words.insert(words.end(), grid.ranks().order.begin(), grid.ranks().order.end());
    for (const BinRange bin : grid.ranks().bins)
        words.insert(words.end(), {bin.least, bin.greatest});
    return words;
}

/// Makes an exception at each place, or at one in `step`, in a new Binner and in one that has made lists. Returns the
/// number of places.
template <class Exception, Options options>
std::size_t survive(std::size_t& left, Isa isa, const Input& scene, const Input& less, const Parallel& parallel,
                    std::size_t step = 1) {
    Binner<options> fresh(isa), other(isa);
    const auto expected = made(fresh, scene, parallel), expected_less = made(other, less, parallel);
    std::size_t places = 0;
    for (const bool warm : {false, true})
        for (std::size_t place = 1;; place += step) {
            Binner<options> binner(isa);
            if (warm) (void)made(binner, less, parallel);
            const auto bin = [&] {
                const auto inputs = inputs_for<options>(scene.bounds(), scene.slices);
                (void)binner.bin(scene.view, view_space(scene.lights, as_sphere), inputs, parallel);
            };
            if (!throws<Exception>(left, place, bin)) break;
            const bool less_first = ++places % 2 == 0;
            const auto makes_less = [&] { return made(binner, less, parallel) == expected_less; };
            const bool right =
                (!less_first || makes_less()) && made(binner, scene, parallel) == expected && makes_less();
            CAPTURE(warm);
            CAPTURE(place);
            CHECK(right);
        }
    return places;
}

template <Options options> void check_options(Isa isa, const Input& scene, const Input& less, bool all = false) {
    CAPTURE(static_cast<int>(isa));
    for (const std::size_t workers : {1u, 3u}) {
        const Parallel parallel(workers, run);
        CHECK(survive<std::bad_alloc, options>(allocations_left, isa, scene, less, parallel) > 10);
        if (!all) continue;
        CHECK(survive<Thrown, options>(events_left, isa, scene, less, parallel, 37) >= 2 * (scene.lights.size() / 37));
    }
}

void check_tier(Isa isa) {
    // Large and small lights, and wide rows of tiles, for which lists are made by another method.
    const Input scene({160, 104}, 8, 150, 3), less({160, 120}, 16, 40, 3);
    const Input scattered({160, 104}, 8, 40, 0.1f), wide({980, 24}, 4, 100, 3);
    check_options<Options{}>(isa, scene, less, true);
    check_options<Options{}>(isa, scattered, less);
    check_options<Options{}>(isa, wide, less);
    check_options<Options{.ids = IdWidth::u16, .depth_test = true}>(isa, scene, less, true);
    check_options<Options{.slicing = Slicing::z_bins}>(isa, scene, less);
    check_options<Options{.depth_test = true, .slicing = Slicing::z_bins}>(isa, scene, less);
    check_options<Options{.depth_test = true, .slicing = Slicing::clusters}>(isa, scattered, less);
}

/// Makes each allocation of a function fail. The function must leave nothing behind.
void check_function(const auto& text_of) {
    const std::string expected = text_of();
    std::size_t place = 1;
    std::string text;
    while (throws<std::bad_alloc>(allocations_left, place, [&] { text = text_of(); }))
        ++place;
    CHECK(place > 1);
    CHECK(text == expected);
}

}  // namespace

TEST_CASE("a Binner is as good as new after an exception, on each tier") {
    check_tier(Isa::scalar);
    check_tier(Isa::simd128);
    check_tier(Isa::avx2);
    check_tier(compiled_isa);
}

TEST_CASE("a Binner is as good as new after an exception: more lights than 16 bits number") {
    Input scene({64, 48}, 8, 70000, 0.1f), less({64, 48}, 8, 10, 0.1f);
    for (std::size_t i = 1; i < scene.lights.size(); ++i)
        if (i % 1000 != 0) scene.lights[i].z = 50;  // behind the eye
    check_options<Options{}>(compiled_isa, scene, less);
}

TEST_CASE("what keeps nothing from call to call loses nothing, either") {
    const Input scene({320, 200}, 8, 300, 3);
    check_function([&] {
        std::uint64_t entries = 0;  // in any order: times differ from call to call
        const auto advice = advise(scene.view, scene.lights, {}, scene.bounds());
        for (const AdvicePlan& plan : advice->plans())
            entries += plan.entries;
        return std::to_string(entries);
    });
    check_function([&] { return shader_snippet()->text; });
    check_function([&] { return reduce_shader()->text; });
    check_function([&] { return cull_shader(CullPass::project)->text; });
    check_function([&] {
        const auto plan = plan_cull(scene.view, {}, {9, 9});
        return std::to_string(plan->bytes.scratch + shader_edges(scene.view).size());
    });
}
