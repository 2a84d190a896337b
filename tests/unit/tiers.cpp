// Every instruction set that this machine has gives the same bytes as the scalar kernels.
#include "scene.hpp"

#include <glm/ext/matrix_transform.hpp>

#include <cstdlib>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>

using namespace lightbin;

namespace {

struct Struct {
    float intensity;
    glm::vec4 sphere;
};

/// What lights are binned as: structs go through a callable.
enum class Form { vec4s, structs, spots };

struct Input {
    View view;
    std::vector<glm::vec4> lights;
    std::vector<float> min, max, gap_min, gap_max;
    Form form = Form::vec4s;
    std::vector<glm::vec4> cones{};      ///< of spots: axes, and cosines of half angles
    std::optional<glm::mat4> to_view{};  ///< of lights in world space
};

/// Cameras, screens, tile sizes and lights of every order of magnitude, with some bad ones among them.
Input random_input(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto between = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    const auto small_more_often = [&](float high) {
        return static_cast<int>(between(0, 1) * between(0, high));
    };
    const glm::mat4 projections[] = {
        glm::perspective(between(0.01f, 3.0f), between(0.3f, 3.0f), 0.1f, 1000.0f),
        glm::ortho(-between(1, 50), between(1, 50), -between(1, 50), between(1, 50), -between(0, 20),
                   between(1, 200)),
        glm::frustum(-between(0, 1), between(0.01f, 3), -between(-0.5f, 1), between(1, 3), 1.0f, 100.0f),
        glm::infinitePerspective(1.0f, 1.5f, 1e-3f),
    };
    const View view = *View::from_projection(projections[seed % 4],
                                             {1 + small_more_often(2000), 1 + small_more_often(2000)},
                                             {.tile_size = 2 + small_more_often(100)});
    const auto most = static_cast<std::size_t>(2e7) / view.tile_count();
    std::vector<glm::vec4> lights((std::min)(most, static_cast<std::size_t>(small_more_often(3000))));
    const float scale = std::exp(between(-3, 4));
    for (glm::vec4& light : lights) {
        const float z = between(-60, 100), side = std::exp(between(-2, 1)) * (std::fabs(z) + 2);
        light = {between(-1, 1) * side, between(-1, 1) * side, -z, scale * std::exp(between(-1.5f, 1.5f))};
        switch (static_cast<int>(between(0, 200))) {
        case 0:
            light.w = std::nanf("");
            break;
        case 1:
            light.w = 0;
            break;
        case 2:
            light.w = -1;
            break;
        case 3:
            light.w = HUGE_VALF;
            break;
        case 4:
            light *= 1e20f;
            break;
        case 5:
            light *= 1e-20f;
            break;
        case 6:
            light.x = std::nanf("");
            break;
        default:
            break;
        }
    }
    std::vector<float> min(view.tile_count()), max(view.tile_count());
    for (float& bound : min)
        bound = between(0, 1) < 0.01f ? std::nanf("") : between(-10, 60);
    for (float& bound : max)
        bound = between(0, 1) < 0.01f ? HUGE_VALF : between(0, 100);
    std::vector<float> gap_min(view.tile_count()), gap_max(view.tile_count());
    for (float& bound : gap_min)
        bound = between(0, 1) < 0.01f ? std::nanf("") : between(-10, 80);
    for (float& bound : gap_max)
        bound = between(0, 1) < 0.01f ? HUGE_VALF : between(0, 100);
    // Whole vectors out of view.
    if (seed % 5 == 0)
        std::sort(lights.begin(), lights.end(), [](glm::vec4 a, glm::vec4 b) { return a.z < b.z; });
    Input input = {view, lights, min, max, gap_min, gap_max};
    input.form = static_cast<Form>(seed % 3);
    const float special[] = {0, 1, -1, 1e-30f, 1e20f, std::nanf(""), HUGE_VALF, 2};
    for (std::size_t i = 0; i < lights.size(); ++i) {
        glm::vec4 cone(between(-1, 1), between(-1, 1), between(-1, 1), std::cos(between(0, 2)));
        if (between(0, 20) < 1)
            cone[static_cast<int>(between(0, 4))] = special[static_cast<int>(between(0, 8))];
        input.cones.push_back(cone);
    }
    if (seed % 2 == 0) {
        // From rotations to what floats can't undo, near and far.
        glm::mat4 m = glm::rotate(glm::mat4(1), between(-3, 3),
                                  glm::normalize(glm::vec3(1, between(-1, 1), between(-1, 1))));
        const float stretch = std::exp(between(-1, 1) * static_cast<float>(seed / 2 % 8 == 0 ? 40 : 1));
        m = glm::scale(m, stretch * glm::vec3(seed % 10 == 2 ? -1 : 1, 1, seed % 10 == 4 ? 1e-6f : 1));
        m = glm::translate(m, between(-1, 1) * glm::vec3(1, 2, 3) * (seed % 8 == 0 ? 1e6f : 1.0f));
        input.to_view = m;
    }
    return input;
}

/// Runs the bodies on this thread in a shuffled order: what threads may do, and the same every time.
const auto shuffled = [](std::size_t n, auto body) {
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(static_cast<std::uint32_t>(n)));
    for (const std::size_t i : order)
        body(i);
};

template <Options options> class Tier {
public:
    std::vector<std::uint32_t> bytes(const Input& input, const Parallel& parallel = {}) {
        const ZBounds bounds = {input.min, input.max, input.gap_min, input.gap_max};
        const auto inputs = inputs_for<options>(bounds, slices_);
        const auto bin = [&](const auto& lights, const auto& to_light) {
            return input.to_view ? binner_.bin(input.view, world_space(lights, *input.to_view, to_light),
                                               inputs, parallel)
                                 : binner_.bin(input.view, view_space(lights, to_light), inputs, parallel);
        };
        const auto bin_all = [&] {
            if constexpr (takes_spots)
                if (input.form == Form::spots) return bin(spots_of(input), AsLight());
            std::vector<Struct> structs;
            if (input.form == Form::structs)
                for (const glm::vec4& light : input.lights)
                    structs.push_back({1, light});
            const auto sphere_of = [](const Struct& light) { return AsLight()(light.sphere); };
            return input.form == Form::structs ? bin(structs, sphere_of) : bin(input.lights, AsLight());
        };
        const auto grid = bin_all();
        REQUIRE(grid);
        std::vector<std::uint32_t> all = {grid->light_counts().rejected};
        for (const ListRange range : grid->ranges())
            all.insert(all.end(), {range.offset, range.count});
        all.insert(all.end(), grid->ids().begin(), grid->ids().end());
        all.insert(all.end(), grid->ranks().order.begin(), grid->ranks().order.end());
        for (const BinRange range : grid->ranks().bins)
            all.insert(all.end(), {range.least, range.greatest});
        return all;
    }

private:
    /// Not with all options, for the time that it takes to compile.
    static constexpr bool takes_spots = options.ids == IdWidth::u32;

    static std::vector<Spot> spots_of(const Input& input) {
        std::vector<Spot> spots;
        for (std::size_t i = 0; i < input.lights.size(); ++i) {
            const glm::vec4 light = input.lights[i],
                            cone = i < input.cones.size() ? input.cones[i] : glm::vec4(1);
            spots.push_back({light.x, light.y, light.z, light.w, cone.x, cone.y, cone.z, cone.w});
        }
        return spots;
    }

    Binner<options> binner_;
    Slices slices_ = *Slices::exponential(11, 2, 80);
};

constexpr Options with(Options options, Isa isa) {
    options.isa = isa;
    return options;
}

/// The tiers of this machine, serial and shared among workers, against the serial scalar one.
template <Options options, Isa... vector_tiers> class TiersOf {
public:
    void compare(const Input& input, std::size_t workers = 3) {
        const auto expected = std::get<0>(tiers_).bytes(input);
        on_each([&](auto& tier) {
            CHECK((tier.bytes(input) == expected));
            // With three the start costs something, so that less is shared.
            const double start_ns = workers == 3 ? 2000 : 0;
            CHECK((tier.bytes(input, Parallel(workers, shuffled, start_ns)) == expected));
        });
    }

    void compare_on_threads(const Input& input) {
        const auto expected = std::get<0>(tiers_).bytes(input);
        on_each([&](auto& tier) {
            for (const std::size_t workers : {1u, 2u, 3u, 7u})
                CHECK((tier.bytes(input, {workers, test::on_threads, 0}) == expected));
        });
    }

private:
    /// A Binner takes its Isa for a cap, so one that the machine lacks would be a narrower one again.
    template <class Visit> void on_each(Visit visit) {
        std::size_t visited = 0;
        const auto visit_one = [&](Isa isa, auto& tier) {
            const auto& there = test::machine_tiers();
            if (std::find(there.begin(), there.end(), isa) == there.end()) return;
            visit(tier);
            ++visited;
        };
        std::apply(
            [&](auto& scalar, auto&... vectors) {
                visit_one(Isa::scalar, scalar);
                (visit_one(vector_tiers, vectors), ...);
            },
            tiers_);
        REQUIRE(visited == test::machine_tiers().size());
    }

    std::tuple<Tier<with(options, Isa::scalar)>, Tier<with(options, vector_tiers)>...> tiers_;
};

#if defined(LIGHTBIN_X86)
template <Options options> using Tiers = TiersOf<options, Isa::sse2, Isa::avx2, Isa::avx512>;
#elif defined(LIGHTBIN_NEON)
template <Options options> using Tiers = TiersOf<options, Isa::neon>;
#else
template <Options options> using Tiers = TiersOf<options>;
#endif

template <Options options> void compare(std::uint32_t seeds, std::uint32_t first_seed) {
    Tiers<options> tiers;
    const std::uint32_t share = test::share_of_cases(2);  // the campaign runs them all
    for (std::uint32_t seed = first_seed; seed < first_seed + (seeds + share - 1) / share; ++seed)
        tiers.compare(random_input(seed), seed % 3 == 0 ? 2 : seed % 3 == 1 ? 3 : 7);
}

constexpr Options plain = {}, interval = {.depth_test = DepthTest::interval},
                  box = {.depth_test = DepthTest::box}, split_box = {.depth_test = DepthTest::split_box},
                  clusters = {.slicing = Slicing::clusters},
                  box_clusters = {.depth_test = DepthTest::box, .slicing = Slicing::clusters},
                  z_bins = {.footprint = Footprint::silhouette,
                            .depth_test = DepthTest::box,
                            .slicing = Slicing::z_bins};

}  // namespace

// Who runs this in an emulator says in LIGHTBIN_TIERS what the emulated machine has, so that it cannot be less in silence.
TEST_CASE("this machine has the tiers that it is said to have") {
    const char* const wanted = std::getenv("LIGHTBIN_TIERS");
    MESSAGE("tiers: " << test::tier_names());
    if (wanted) CHECK(test::tier_names() == std::string(wanted));
}

TEST_CASE("all tiers give the same bytes, on any number of workers") {
    compare<plain>(150, 0);
    compare<Options{.ids = IdWidth::u16}>(50, 1000);
    compare<interval>(150, 2000);
    compare<box>(100, 4000);
    compare<Options{.footprint = Footprint::silhouette}>(100, 6000);
    compare<Options{.footprint = Footprint::silhouette, .depth_test = DepthTest::split_box}>(50, 7000);
    compare<Options{.ids = IdWidth::u16, .depth_test = DepthTest::split_box}>(100, 5000);
    compare<clusters>(50, 8000);
    compare<box_clusters>(50, 9000);
    compare<Options{.ids = IdWidth::u16, .footprint = Footprint::silhouette, .slicing = Slicing::clusters}>(
        30, 10000);
    compare<Options{.slicing = Slicing::z_bins}>(50, 11000);
    compare<z_bins>(30, 12000);
}

TEST_CASE("each tier scatters by its own text, the scalar one without vectors") {
    const auto scalar = detail::scatter_kernel<std::uint32_t>(Isa::scalar);
    for (const Isa isa : {Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon})
        if (const Isa here = machine_isa(isa); here != Isa::scalar)
            CHECK_UNARY(detail::scatter_kernel<std::uint32_t>(here) != scalar);
}

TEST_CASE("threads write their own parts only") {
    Input input = random_input(5);
    input.lights = test::random_lights(3000, 51);
    input.view = test::view({1280, 720}, 16);
    input.min.assign(input.view.tile_count(), 5.0f);
    input.max.assign(input.view.tile_count(), 40.0f);
    input.gap_min.assign(input.view.tile_count(), 10.0f);
    input.gap_max.assign(input.view.tile_count(), 20.0f);
    Tiers<plain>().compare_on_threads(input);
    Tiers<split_box>().compare_on_threads(input);
    Tiers<clusters>().compare_on_threads(input);
    Tiers<box_clusters>().compare_on_threads(input);
    Tiers<z_bins>().compare_on_threads(input);
}

TEST_CASE("more lights than 16 bits count, and more tiles than 8 bits count") {
    Input input = random_input(5);
    input.gap_min.clear();
    input.gap_max.clear();
    const auto check = [&](Extent viewport, int tile_size, std::size_t lights, float scale) {
        input.lights = test::random_lights(lights, 50);
        for (glm::vec4& light : input.lights)
            light.w *= scale;
        input.view = test::view(viewport, tile_size);
        input.min.assign(input.view.tile_count(), 5.0f);
        input.max.assign(input.view.tile_count(), 9.0f);
        Tiers<plain>().compare(input);
        Tiers<box>().compare(input);
        Tiers<box_clusters>().compare(input);
    };
    check({992, 300}, 4, 1500, 0.2f);  // the widest grid of one panel of lists_scan.inl, and one tile more
    check({996, 300}, 4, 1500, 0.2f);
    check({3000, 300}, 4, 1500, 0.2f);
    check({300, 3000}, 4, 1500, 0.2f);
    if (test::share_of_cases(1) > 1) return;  // an emulator takes seconds for as many lights
    check({1280, 720}, 40, 70000, 0.05f);
    check({40000 / 2, 8}, 8, 70000, 0.01f);
}
