// SPDX-License-Identifier: MIT
// lists [SCENES [threads]]: builds the lists and masks of so many random scenes (60 if not given) by every option, on
// every instruction set that this machine has and for several threads, which must not change a byte. Prints a hash for
// each option, and one of all of them: these are the same on every platform. tests/platforms.sh holds them against each
// other. Then it does so again in every floating-point environment that a caller may have set, of a sixth of the
// scenes: that must not change a byte either, and what traps must not end the program. With `threads`, Binners of all
// options work at once, each on a thread of its own, and some whose work several threads share: the thread sanitizer
// says whether they share more than their input.
//
// Every input is a whole number times a power of two, or a rounded product: fused sums, functions, the distributions of
// <random> and the order of calls within an expression are not the same everywhere. Nothing but the standard library, and
// of that no streams: the memory sanitizer knows of no byte that a library writes which is not compiled with it.
#include "tests/platforms/environments.hpp"
#include "tests/split_mix.hpp"

#include <lightbin/box.hpp>
#include <lightbin/budget.hpp>
#include <lightbin/coverage.hpp>
#include <lightbin/encode.hpp>
#include <lightbin/lightbin.hpp>
#include <lightbin/masks.hpp>
#include <lightbin/shader.hpp>
#include <lightbin/spot.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace lightbin;

class Random : public SplitMix {
public:
    using SplitMix::SplitMix;
    /// Returns a number with 20 bits behind the point; both limits are in units of 2^-10.
    float between(int low, int high) {
        return static_cast<float>(integer(low * 1024, high * 1024)) * 0x1p-20f;
    }
    float unit() { return static_cast<float>(integer(-0xffffff, 0xffffff)) * 0x1p-24f; }
    /// From 2^low to 2^high.
    float magnitude(int low, int high) {
        const float mantissa = static_cast<float>(integer(0x800000, 0xffffff)) * 0x1p-23f;
        return std::ldexp(mantissa, integer(low, high - 1));
    }
    bool one_in(int n) { return integer(1, n) == 1; }
    float sign(int n) { return one_in(n) ? -1.0f : 1.0f; }  ///< -1 in one of n
};

/// A hash of numbers rather than of bytes, so that the order of bytes in memory is no matter.
class Hash {
public:
    void add(std::uint64_t number) {
        value_ = (value_ ^ number) * 0x100000001b3u;
        value_ ^= value_ >> 29;
    }
    void add(float number) { add(std::uint64_t{std::isnan(number) ? 0x7fc00000u : bits_of(number)}); }
    std::uint64_t value() const { return value_; }

private:
    static std::uint32_t bits_of(float number) {
        std::uint32_t bits;
        std::memcpy(&bits, &number, sizeof bits);
        return bits;
    }
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

/// A light in the program's own form, so that the library reads it through a callable.
struct Lamp {
    double reach;
    Spot spot;
};

struct Scene {
    View view;
    std::vector<Sphere> spheres{};
    std::vector<Spot> spots{};
    std::vector<Lamp> lamps{};
    float to_view[4][4]{};
    std::vector<float> min{}, max{};
};

View any_view(Random& random) {
    const bool reversed = random.one_in(3), orthographic = random.one_in(4);
    const double forward = random.sign(2);
    const float near_plane = random.magnitude(-6, 2), depth = near_plane * random.magnitude(1, 12);
    const float sign_x = random.sign(8), sign_y = random.sign(3);
    double m[4][4] = {};
    m[0][0] = sign_x * random.between(100, 3000);
    m[1][1] = sign_y * random.between(100, 3000);
    m[2][2] = forward * (reversed ? -1 : 1) * random.between(1025, 1200);
    m[3][2] = (reversed ? 1 : -1) * static_cast<double>(near_plane);
    if (orthographic) {
        m[0][0] *= 0x1p-5;
        m[1][1] *= 0x1p-5;
        m[2][2] = forward * (reversed ? -1 : 1) / static_cast<double>(depth);
        m[3][0] = random.between(-512, 512);
        m[3][3] = 1;
    } else {
        m[2][0] = random.one_in(2) ? random.between(-700, 700) : 0;
        m[2][1] = random.one_in(2) ? random.between(-700, 700) : 0;
        m[2][3] = forward;
    }
    const int tile_size = random.integer(1, 48), most = tile_size * 90;
    const int width = random.integer(1, random.one_in(9) ? 2000 : most < 800 ? most : 800);
    const int height = random.integer(1, most < 500 ? most : 500);
    return *View::from_projection(
        m, {width, height},
        {.tile_size = tile_size,
         .clip_depth = random.one_in(2) ? ClipDepth::zero_to_one : ClipDepth::minus_one_to_one,
         .origin = random.one_in(2) ? WindowOrigin::upper_left : WindowOrigin::lower_left,
         .reversed_z = reversed});
}

/// Returns the number, or once in a hundred times one that no sensible program passes.
float or_special(float number, Random& random) {
    constexpr float values[] = {0,
                                -1,
                                1e30f,
                                -1e30f,
                                1e-40f,
                                std::numeric_limits<float>::infinity(),
                                -std::numeric_limits<float>::infinity(),
                                std::numeric_limits<float>::quiet_NaN()};
    return random.one_in(100) ? values[random.integer(0, 7)] : number;
}

Sphere any_sphere(Random& random, int size) {
    const float away = random.magnitude(-2, 8), z = -random.sign(6) * away;
    const float x = random.unit() * 2 * away, y = random.unit() * 2 * away;
    const float radius = random.magnitude(size, size + 3);
    if (random.one_in(60)) {  // of any size
        const float scale = random.magnitude(-70, 70);
        return {x * scale, y * scale, z * scale, radius * scale};
    }
    return {or_special(x, random), or_special(y, random), or_special(z, random), or_special(radius, random)};
}

/// A rotation by a multiple of the angle of the 3-4-5 triangle, a scale, a move; some mirror, flatten or are extreme.
void any_move(float (&m)[4][4], Random& random) {
    const int range = random.one_in(6) ? 60 : 2;
    const float scale = random.magnitude(-range, range), c = 0.6f * scale, s = 0.8f * scale;
    const float columns[4][4] = {{c, 0, s, 0}, {0, scale, 0, 0}, {-s, 0, c, 0}, {0, 0, 0, 1}};
    std::memcpy(m, columns, sizeof m);
    for (int row = 0; row < 3; ++row)
        m[3][row] = random.unit() * 8;
    if (random.one_in(4)) m[1][1] *= random.one_in(2) ? -1.0f : 0x1p-20f;
    if (random.one_in(4)) m[3][0] *= 0x1p17f;
}

Scene make_scene(Random& random) {
    Scene scene{any_view(random)};
    const int size = random.integer(-4, 4);
    const int count = random.one_in(8) ? random.integer(0, 3) : random.integer(4, 700);
    for (int i = 0; i < count; ++i) {
        const Sphere ball = any_sphere(random, size);
        const float axis[] = {random.unit(), random.unit(), random.unit(), random.unit()};
        const Spot spot = {ball.x,
                           ball.y,
                           ball.z,
                           ball.radius,
                           or_special(axis[0], random),
                           axis[1],
                           axis[2],
                           or_special(axis[3], random)};
        scene.spheres.push_back(ball);
        scene.spots.push_back(spot);
        scene.lamps.push_back({static_cast<double>(ball.radius), spot});
    }
    if (random.one_in(5))  // whole vectors on one side of the eye
        std::stable_partition(scene.spheres.begin(), scene.spheres.end(), [](const Sphere& s) { return s.z > 0; });
    any_move(scene.to_view, random);
    for (std::size_t i = 0; i < scene.view.tile_count(); ++i) {
        const float min = random.magnitude(-3, 7), deep = min * random.magnitude(0, 4);
        scene.min.push_back(or_special(min, random));
        scene.max.push_back(or_special(deep, random));
    }
    return scene;
}

const Slices& slices() {
    static const Slices all = [] {
        const float boundaries[] = {0.5f, 1, 1.75f, 3, 5, 8, 13, 21, 34, 55, 89, 144};
        return *Slices::from_boundaries(boundaries);
    }();
    return all;
}

/// The floating-point settings of the calling thread and its worker threads.
const Setting* environment = nullptr;

template <class Call> auto in_environment(const Call& call) {
    if (environment == nullptr) return call();
    const Environment callers(*environment);
    return call();
}

/// The worst loop that a Parallel may be given: one thread does everything, from the end.
const auto backwards = [](std::size_t n, auto body) {
    in_environment([&] {
        while (n > 0)
            body(--n);
    });
};

template <class Id> void add_grid(Hash& hash, const LightGrid<Id>& grid) {
    hash.add(std::uint64_t{grid.light_counts().rejected});
    for (const ListRange range : grid.ranges())
        hash.add(range.offset | std::uint64_t{range.count} << 32);
    for (const Id id : grid.ids())
        hash.add(std::uint64_t{id});
    for (const std::uint32_t light : grid.ranks().order)
        hash.add(std::uint64_t{light});
    for (const BinRange bin : grid.ranks().bins)
        hash.add(bin.least | std::uint64_t{bin.greatest} << 32);
}

/// Adds the elements of this width that encode() writes to the hash.
template <class Element>
void add_encoded(Hash& hash, const LightGrid<std::uint32_t>& grid, const ListFormat& format) {
    std::vector<std::byte> bytes(
        static_cast<std::size_t>(encoded_bytes(format, grid.ranges().size(), grid.ids().size())));
    const auto encoded = encode(grid, format, bytes);
    hash.add(std::uint64_t{encoded.has_value()});
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(Element)) {
        Element element;
        std::memcpy(&element, bytes.data() + i, sizeof element);
        hash.add(std::uint64_t{element});
    }
}

/// Adds all encodings of a grid. Lists with an end mark leave the rest of their buffer as it was: 0.
void add_encodings(Hash& hash, const LightGrid<std::uint32_t>& grid) {
    add_encoded<std::uint8_t>(hash, grid,
                              {.encoding = ListEncoding::sentinel, .ids = IdWidth::u8, .capacity = 9});
    add_encoded<std::uint16_t>(hash, grid,
                               {.encoding = ListEncoding::sentinel, .ids = IdWidth::u16, .capacity = 5});
    add_encoded<std::uint16_t>(hash, grid, {.ids = IdWidth::u16});
}

/// One option on one instruction set.
template <Options options> class Builder {
public:
    explicit Builder(Isa isa) : isa_(isa) {}

    std::uint64_t hash(const Scene& scene, std::size_t number, const Parallel& parallel) {
        const auto to_sphere = [](const Lamp& lamp) { return bounding_sphere(lamp.spot); };
        const auto to_spot = [](const Lamp& lamp) { return lamp.spot; };
        // Products only: a compiler might fuse a product and a sum, on some platforms.
        const auto to_box = [](const Lamp& lamp) {
            const Spot& s = lamp.spot;
            const float r = s.radius, x = s.axis_x * r, y = s.axis_y * r, z = s.axis_z * r;
            return Box{s.x,       s.y,        s.z * 0.875f,
                       r,         s.x,        s.y * 0.9375f,
                       s.z,       {{x, y, z}, {-y * s.axis_z, x, 0}, {r * s.cos_half_angle, 0, r * 0.25f}},
                       s.axis_y * s.axis_y};
        };
        switch (number % 7) {
        case 0:
            return built(scene, scene.spheres, parallel);
        case 1:
            return built(scene, scene.spots, parallel);
        case 2:
            return built(scene, world_space(scene.spheres, scene.to_view), parallel);
        case 3:
            return built(scene, world_space(scene.lamps, scene.to_view, to_spot), parallel);
        case 4:
            return built(scene, view_space(scene.lamps, to_box), parallel);
        case 5:
            return built(scene, world_space(scene.lamps, scene.to_view, to_box), parallel);
        default:
            return built(scene, view_space(scene.lamps, to_sphere), parallel);
        }
    }

private:
    template <class Lights>
    std::uint64_t built(const Scene& scene, const Lights& lights, const Parallel& parallel) {
        const ZBounds bounds = {scene.min, scene.max};
        const auto inputs = inputs_for<options>(bounds, slices());
        Hash hash;
        const auto grid = binner_.bin(scene.view, lights, inputs, parallel);
        if (!grid) return 0;
        add_grid(hash, *grid);
        constexpr bool plain = options.ids == IdWidth::u32 && options.slicing == Slicing::none;
        if constexpr (plain && !options.depth_test) {
            add_encodings(hash, *grid);
            add_masks(hash, masks_.bin(scene.view, lights));
            add_masks(hash, masks_.bin(scene.view, lights, slices()));
        }
        if constexpr (plain && options.depth_test)
            add_coverage(hash, *grid, *coverage(scene.view, lights, parallel, isa_));
        return hash.value();
    }

    /// Adds what lights cover in the image, and a budget that prefers large lights: infinite sizes occur, and NaN for
    /// lights out of view.
    template <class Id>
    void add_coverage(Hash& hash, const LightGrid<Id>& grid, const std::vector<LightCoverage>& covered) {
        std::vector<float> weights(grid.light_counts().lights, std::numeric_limits<float>::quiet_NaN());
        for (const LightCoverage& light : covered) {
            hash.add(light.id | std::uint64_t{light.x0} << 32 | std::uint64_t{light.y0} << 48);
            hash.add(light.x1 | std::uint64_t{light.y1} << 32);
            hash.add(light.nearest);
            hash.add(light.farthest);
            hash.add(light.pixels);
            weights[light.id] = light.pixels;
        }
        const auto limited = budget_.limit(grid, weights, {.per_cell = 7, .per_frame = 900});
        hash.add(std::uint64_t{limited.has_value()});
        if (!limited) return;
        add_grid(hash, limited->grid);
        for (const std::uint32_t cut : limited->cut_in_cell)
            hash.add(std::uint64_t{cut});
    }

    static void add_masks(Hash& hash, const Result<LightMasks>& masks) {
        hash.add(std::uint64_t{masks.has_value()});
        if (!masks) return;
        hash.add(std::uint64_t{masks->light_counts().rejected});
        for (const std::uint32_t word : masks->words())
            hash.add(std::uint64_t{word});
    }

    Isa isa_;
    MaskBinner masks_{isa_};
    Binner<options> binner_{isa_};
    Budget<typename Binner<options>::Id> budget_;
};

int failures = 0;
Hash all;
bool prints = true;

void print(const char* name, const Hash& hash) {
    all.add(hash.value());
    if (prints) std::printf("%s: %016llx\n", name, static_cast<unsigned long long>(hash.value()));
}

template <Options options>
void compare_tier(const char* name, Builder<options>& builder, Isa isa, const Scene& scene, std::size_t number,
                  std::uint64_t expected) {
    if (machine_isa(isa) != isa) return;
    for (const std::size_t workers : {std::size_t{1}, 2 + number % 6})
        if (in_environment([&] { return builder.hash(scene, number, Parallel(workers, backwards)); }) !=
                expected &&
            failures++ < 10)
            std::printf("%s, scene %zu: %s with %zu workers differs\n", name, number, to_string(isa),
                        workers);
}

template <Options options> void check(const char* name, const std::vector<Scene>& scenes) {
    Hash hash;
    static Builder<options> scalar(Isa::scalar), simd128(Isa::simd128), avx2(Isa::avx2), avx512(Isa::avx512);
    for (std::size_t number = 0; number < scenes.size(); ++number) {
        const Scene& scene = scenes[number];
        const std::uint64_t expected = in_environment([&] { return scalar.hash(scene, number, {}); });
        hash.add(expected);
        compare_tier(name, scalar, Isa::scalar, scene, number, expected);
        compare_tier(name, simd128, Isa::simd128, scene, number, expected);
        compare_tier(name, avx2, Isa::avx2, scene, number, expected);
        compare_tier(name, avx512, Isa::avx512, scene, number, expected);
    }
    print(name, hash);
}

void check_views(const std::vector<Scene>& scenes) {
    Hash hash;
    for (const Scene& scene : scenes)
        for (const double depth : {0.0, 0.25, 0.8125, 1.0}) {
            const DepthInterval depths = scene.view.view_depths(depth, depth);
            hash.add(depths.min);
            hash.add(depths.max);
        }
    print("view depths", hash);
}

void check_depth(const std::vector<Scene>& scenes) {
    Random random(8);
    Hash hash;
    for (const Scene& scene : scenes) {
        const View& view = scene.view;
        const std::size_t tiles = view.tile_count();
        std::vector<float> depth, sides[2];
        for (int i = 0; i < view.viewport().width * view.viewport().height; ++i)
            depth.push_back(or_special(std::fabs(random.unit()), random));
        for (std::vector<float>& side : sides)
            side.resize(tiles);
        const DepthBuffer buffer = {.depth = depth, .skip_background = random.one_in(2)};
        const ZBoundsBuffers to = {sides[0], sides[1]};
        for (const Isa isa : {Isa::scalar, compiled_isa}) {
            const auto reduced = in_environment([&] { return reduce_depth(view, buffer, to, isa); });
            hash.add(std::uint64_t{reduced.has_value()});
            for (const std::vector<float>& side : sides)
                for (const float bound : side)
                    hash.add(bound);
        }
    }
    print("Z bounds", hash);
}

/// Checks texts that need functions of the C library, rounded to so few digits that they are the same everywhere.
void check_texts() {
    Hash hash;
    const Slices exponential = in_environment([] { return *Slices::exponential(24, 5, 200); }),
                 linear = in_environment([] { return *Slices::linear(100, 0.5f, 80); });
    for (const Slices* law : {&exponential, &linear})
        for (const float boundary : law->boundaries())
            hash.add(boundary);
    for (const ShaderLanguage language :
         {ShaderLanguage::glsl_330, ShaderLanguage::glsl_430, ShaderLanguage::hlsl_5_0}) {
        const ListStorage storage =
            language == ShaderLanguage::glsl_330 ? ListStorage::texel_buffer : ListStorage::storage_buffer;
        for (const Slicing slicing : {Slicing::none, Slicing::clusters, Slicing::z_bins}) {
            const auto shader =
                shader_snippet({.language = language, .storage = storage, .slicing = slicing});
            hash.add(std::uint64_t{shader.has_value()});
            for (const char letter : shader ? shader->text : std::string())
                hash.add(std::uint64_t{static_cast<unsigned char>(letter)});
        }
    }
    print("slices and shaders", hash);
}

void check_lists(const std::vector<Scene>& scenes) {
    check<Options{}>("rectangle, masks", scenes);
    check<Options{.ids = IdWidth::u16}>("rectangle, 16 bits", scenes);
    check<Options{.depth_test = true}>("depth test, coverage", scenes);
    check<Options{.ids = IdWidth::u16, .depth_test = true}>("depth test, 16 bits", scenes);
    check<Options{.slicing = Slicing::clusters}>("clusters", scenes);
    check<Options{.ids = IdWidth::u16, .slicing = Slicing::clusters}>("clusters, 16 bits", scenes);
    check<Options{.depth_test = true, .slicing = Slicing::clusters}>("depth test, clusters", scenes);
    check<Options{.slicing = Slicing::z_bins}>("z_bins", scenes);
    check<Options{.depth_test = true, .slicing = Slicing::z_bins}>("depth test, z_bins", scenes);
}

/// Returns the hash of the same scenes, views and slices under other floating-point settings.
std::uint64_t hash_in(const Setting* setting, std::vector<Scene> scenes) {
    environment = setting;
    all = {};
    for (Scene& scene : scenes)
        scene.view = in_environment([&] { return *scene.view.with_tile_size(scene.view.tile_size()); });
    check_depth(scenes);
    check_texts();
    check_lists(scenes);
    environment = nullptr;
    return all.value();
}

void check_environments(const std::vector<Scene>& scenes) {
    prints = false;
    const std::uint64_t expected = hash_in(nullptr, scenes);
    for (const Setting& setting : settings) {
        if (hash_in(&setting, scenes) == expected) continue;
        ++failures;
        std::printf("%s: the lists differ\n", setting.name);
        std::fflush(stdout);
    }
}

/// Returns the hash of what one Binner makes of the scenes, one after another.
template <Options options> std::uint64_t hash_of(const std::vector<Scene>& scenes, const Parallel& parallel) {
    Builder<options> builder(compiled_isa);
    Hash hash;
    for (std::size_t number = 0; number < scenes.size(); ++number)
        hash.add(builder.hash(scenes[number], number, parallel));
    return hash.value();
}

void check_threads(const std::vector<Scene>& scenes) {
    const auto on_threads = [](std::size_t n, auto body) {
        std::vector<std::thread> threads;
        for (std::size_t i = 0; i < n; ++i)
            threads.emplace_back([=] { body(i); });
        for (std::thread& thread : threads)
            thread.join();
    };
    std::uint64_t (*const jobs[])(const std::vector<Scene>&, const Parallel&) = {
        hash_of<Options{}>,
        hash_of<Options{.ids = IdWidth::u16}>,
        hash_of<Options{.depth_test = true}>,
        hash_of<Options{.depth_test = true, .slicing = Slicing::clusters}>,
        hash_of<Options{.depth_test = true, .slicing = Slicing::z_bins}>};
    constexpr std::size_t binners = 2 * std::size(jobs);
    std::uint64_t made[binners];
    on_threads(binners, [&](std::size_t i) {
        made[i] = jobs[i / 2](scenes, i % 2 == 0 ? Parallel() : Parallel(3, on_threads));
    });
    for (std::size_t i = 0; i < binners; ++i)
        if (made[i] != jobs[i / 2](scenes, {}) && failures++ < 10) std::printf("Binners at once differ\n");
}

}  // namespace

int main(int count, char** words) {
    const int wanted = count > 1 ? std::atoi(words[1]) : 60;
    Random random(7);
    std::vector<Scene> scenes;
    for (int i = 0; i < wanted; ++i)
        scenes.push_back(make_scene(random));
    check_views(scenes);
    check_depth(scenes);
    check_texts();
    check_lists(scenes);
    std::printf("tiers:");
    for (const Isa isa : {Isa::scalar, Isa::simd128, Isa::avx2, Isa::avx512})
        if (machine_isa(isa) == isa) std::printf(" %s", to_string(isa));
    std::printf("\nhash: %016llx\n", static_cast<unsigned long long>(all.value()));
    std::fflush(stdout);  // what traps ends the program
    scenes.resize((scenes.size() + 5) / 6, scenes.front());
    check_environments(scenes);
    if (count > 2) check_threads(scenes);
    return failures == 0 ? 0 : 1;
}
