// SPDX-License-Identifier: MIT
// Hunts for a light that the lists of the GPU miss, in random scenes: the passes of lightbin/shader_cull.hpp make lists
// in OpenGL 4.3, a Binner makes them of the same input, and exact arithmetic decides wherever they differ.
//
// cull_hunt SCENES [FIRST STEP]   every STEP-th scene below SCENES, from FIRST on. Scenes are made from their numbers:
//                                 `cull_hunt 8 7 1` makes scene 7 alone.
//
// An entry of the Binner that the GPU lacks must be one of a light that does not reach the cell. Of the entries that
// only the GPU has, up to 100 a scene are asked about: a light that reaches the cell was missed by the Binner. Prints a
// table, whose columns are the members of HuntTally; the exit status is 1 if there are faults.
#include "cull_cases.hpp"

#include "../../bench/exact/truth.hpp"
#include "../../bench/gpu/device.hpp"
#include "../oracle/boxes.hpp"
#include "../oracle/families.hpp"
#include "../oracle/library_view.hpp"

#include <cstdlib>
#include <optional>

namespace {

using namespace oracle;
using lightbin::CullKind;
using lightbin::Slicing;

/// A scene for both the Binner and the passes.
struct HuntScene {
    Camera camera;
    CullCase made;
    std::vector<SpotLight> lights;  ///< spheres, of which the ball alone counts, and behind them spots
    std::size_t spheres = 0;
    std::vector<BoxLight> boxes;  ///< ids go on with these
    std::optional<ViewMatrix> matrix;
    std::array<std::vector<float>, 2> bounds;
    lightbin::Slices slices;

    bool clusters() const { return made.options.slicing == Slicing::clusters; }
    bool has_bounds() const { return clusters() ? made.options.bounded : made.options.depth_test; }
    std::string text_of(std::size_t light) const {
        return light < lights.size() ? text(lights[light]) : text(boxes[light - lights.size()]);
    }
};

/// Returns a viewport of 1 to 1919 by 1 to 1079 pixels, small ones as often as large ones.
Screen random_screen(Random& random, int most_tiles) {
    const auto side = [&](int most) {
        return random.chance(0.1) ? most : static_cast<int>(std::exp(random.uniform(0, std::log(most + 0.9))));
    };
    constexpr int sizes[] = {1, 2, 7, 8, 16, 32, 57, 64, 256};
    Screen screen{side(1919), side(1079), sizes[random.integer(0, 8)], random.chance(0.5)};
    const auto tiles = [&](int pixels) { return (pixels + screen.tile - 1) / screen.tile; };
    while (tiles(screen.width) * tiles(screen.height) > most_tiles)
        screen.tile *= 2;
    return screen;
}

Camera random_camera(Random& random, int most_tiles) {
    const Screen screen = random_screen(random, most_tiles);
    const auto& kinds = camera_kinds();
    const auto& kind = kinds[static_cast<std::size_t>(random.integer(0, static_cast<int>(kinds.size()) - 1))];
    Camera camera = camera_of("", random.chance(0.3) ? kind.lens_of(aspect_of(screen))
                                                     : families::any_lens(aspect_of(screen), random),
                              screen);
    if (random.chance(0.2)) camera.columns = random.integer(1, 20), camera.rows = random.integer(1, 13);
    camera.turned = random.chance(0.2);
    return camera;
}

/// Returns lights of one of the oracle's sets, or of all of them.
template <class Set>
auto random_lights(const std::vector<Set>& sets, const Aim& aim, std::size_t count, Random& random) {
    const auto one = [&] { return sets[static_cast<std::size_t>(random.bits() % sets.size())].one; };
    const bool mixed = random.chance(0.5);
    auto make_light = one();
    std::vector<decltype(make_light(aim, random))> lights;
    while (lights.size() < count) {
        if (mixed) make_light = one();
        lights.push_back(make_light(aim, random));
    }
    return lights;
}

lightbin::Slices random_slices(const Aim& aim, const std::vector<Light>& balls, Random& random) {
    const int count = random.integer(1, 20);
    const float least = static_cast<float>(aim.unit), most = least * static_cast<float>(random.power_of_two(1, 12));
    if (random.chance(0.3)) return *lightbin::Slices::exponential(count, least, most);
    if (random.chance(0.2)) return *lightbin::Slices::linear(count, 0, most);
    return slices_at_ends(aim, balls, random);
}

HuntScene random_scene(std::uint64_t number) {
    Random random(seed_of("cull_hunt") + number * 0x9e3779b97f4a7c15u);
    lightbin::CullOptions options;
    const bool many = random.chance(0.05);  // more than a step of 1,024 lights
    if (random.chance(0.5)) options.slicing = Slicing::clusters;
    const bool clusters = options.slicing == Slicing::clusters;
    const Camera camera = random_camera(random, many ? 20 : clusters ? 250 : 2500);
    const lightbin::View view = *library_view(camera);
    options.kind = static_cast<CullKind>(random.integer(0, 3));
    options.depth_test = random.chance(0.7);
    options.bounded = clusters && random.chance(0.4);
    options.max_only = !clusters && options.depth_test && random.chance(0.2);
    options.orthographic = view.orthographic();
    options.world_space = random.chance(0.4);
    options.ids = random.chance(0.5) ? lightbin::IdWidth::u16 : lightbin::IdWidth::u32;
    options.lights_at.stride = options.kind == CullKind::box ? 17 : sizeof(SpotLight) / 4;
    // How many spheres, spots and boxes; 0 of the kinds that the options exclude.
    const auto count_of = [&](CullKind kind) {
        const int count = many ? random.integer(400, 2500) : random.integer(1, 40);
        return options.kind == kind || options.kind == CullKind::mixed ? static_cast<std::size_t>(count) : 0;
    };
    const std::size_t spheres = count_of(CullKind::sphere), spots = count_of(CullKind::spot);
    const Aim aim(camera);
    std::vector<SpotLight> lights;
    for (const Light& ball : random_lights(sphere_sets(), aim, spheres, random))
        lights.push_back({ball, 0, 0, 0, -1});
    constexpr float cosines[] = {0.999994f, 0, -0.0f, -1, 1, -0.75f, 0.70710678f, 0x1p-20f};
    for (SpotLight& spot : random_lights(spot_sets(), aim, spots, random)) {
        if (random.chance(0.1)) spot.cosine = cosines[random.integer(0, 7)];
        lights.push_back(spot);
    }
    std::vector<BoxLight> boxes = random_lights(box_sets(), aim, count_of(CullKind::box), random);

    Scene depths{camera, {}, {}, {}};
    for (const SpotLight& light : lights)
        depths.lights.push_back(light.ball);
    for (const BoxLight& box : boxes)
        depths.lights.push_back({box.x, box.y, box.z, box.radius});
    families::set_bounds(depths, aim, random, random.chance(0.2) ? 0.5 : 0.02);
    for (std::size_t tile = 0; tile < depths.min.size(); ++tile)
        if (random.chance(0.03)) depths.max[tile] = -(depths.min[tile] = -HUGE_VALF);
    const auto count = static_cast<std::uint32_t>(depths.lights.size());
    HuntScene scene{camera, {"", view, options, {}, count}, {}, spheres, {}, {}, {depths.min, depths.max},
                    random_slices(aim, depths.lights, random)};
    if (options.kind == CullKind::mixed) {
        scene.made.spots = static_cast<std::uint32_t>(spots);
        scene.made.boxes = static_cast<std::uint32_t>(boxes.size());
    }
    if (clusters) scene.made.slices = scene.slices;
    if (options.world_space) {
        const std::vector<ViewMatrix> matrices = view_matrices(random);
        do  // cull_shader() takes rotations with a scale
            scene.matrix = matrices[static_cast<std::size_t>(random.bits() % matrices.size())];
        while (scene.matrix->stretch == 0 || scene.matrix->large);
        lights = into_world(lights, *scene.matrix);
        boxes = into_world(boxes, *scene.matrix);
        scene.made.to_view = lightbin::detail::to_matrix(scene.matrix->m);
    }
    scene.made.lights = lights.empty() ? words_of(boxes) : words_of(lights);
    if (options.kind == CullKind::mixed) {
        const std::vector<std::uint32_t> words = words_of(boxes);
        scene.made.lights.insert(scene.made.lights.end(), words.begin(), words.end());
    }
    scene.made.room = static_cast<std::uint32_t>(count * view.tile_count()) *
                      static_cast<std::uint32_t>(clusters ? scene.slices.count() : 1);
    scene.made.z_bounds = CullTests::cull_depths({view, {}, scene.slices}, scene.bounds, options.depth_test,
                                                 options.slicing, options.bounded);
    scene.lights = std::move(lights);
    scene.boxes = std::move(boxes);
    return scene;
}

/// Makes the lists by the passes, whose programs the device keeps.
CulledGrid gpu_lists(GpuDevice& device, const HuntScene& scene, const lightbin::CullPlan& plan) {
    const auto put = [&](const char* name, const auto& elements) {
        const auto bytes = std::as_bytes(std::span(elements));
        device.make_buffer(name, std::max(bytes.size(), std::size_t{16}));
        if (!bytes.empty()) device.write(name, bytes);
    };
    put("grid", std::span(&plan.constants, 1));
    put("lights", scene.made.lights);
    put("z_bounds", scene.made.z_bounds);
    if (scene.clusters()) put("slices", lightbin::shader_slices(scene.slices));
    for (const auto& [name, blank] : blank_buffers(plan))
        put(name.c_str(), blank);
    std::vector<ComputePass> passes;
    for (const lightbin::CullPass pass : lightbin::cull_passes)
        passes.push_back({to_string(pass), *cull_shader(pass, scene.made.options), plan.groups_of(pass).x,
                          plan.groups_of(pass).y});
    device.set_passes(passes);
    device.run(false);
    CulledGrid grid;
    grid.narrow = scene.made.options.ids == lightbin::IdWidth::u16;
    const auto read = [&](const char* name, std::uint64_t bytes) {
        return device.read(name, static_cast<std::size_t>(bytes / 4));
    };
    std::memcpy(&grid.totals, read("scratch", sizeof grid.totals).data(), sizeof grid.totals);
    grid.tiles.resize(static_cast<std::size_t>(plan.bytes.tiles / 8));
    std::memcpy(grid.tiles.data(), read("tiles", plan.bytes.tiles).data(), grid.tiles.size() * 8);
    grid.lists = read("lists", plan.bytes.lists);
    return grid;
}

/// Makes the lists by a Binner.
BuiltLists binner_lists(const HuntScene& scene, lightbin::LightCounts& counts) {
    BuiltScene built{scene.made.view, {}, scene.slices};
    if (scene.has_bounds()) built.bounds.max = scene.bounds[1];
    if (scene.has_bounds() && !scene.made.options.max_only) built.bounds.min = scene.bounds[0];
    const auto of = [&](const auto& lights, const auto& to_light) {
        auto source = lightbin::world_space(lights, scene.matrix ? scene.matrix->m : identity, to_light);
        if (!scene.matrix) source.to_view.reset();
        return source;
    };
    const std::span<const SpotLight> lights(scene.lights);
    const auto source = lightbin::lights(
        of(lights.first(scene.spheres),
           [](const SpotLight& s) {
               return lightbin::Sphere{s.ball.x, s.ball.y, s.ball.z, s.ball.w};
           }),
        of(lights.subspan(scene.spheres),
           [](const SpotLight& s) {
               return lightbin::Spot{s.ball.x, s.ball.y, s.ball.z, s.ball.w, s.axis_x, s.axis_y, s.axis_z, s.cosine};
           }),
        of(scene.boxes, [](const BoxLight& b) {
            lightbin::Box box = {b.x, b.y, b.z, b.radius, b.centre[0], b.centre[1], b.centre[2], {}, b.taper};
            std::copy(&b.half_axes[0][0], &b.half_axes[0][0] + 9, &box.half_axes[0][0]);
            return box;
        }));
    using lightbin::Options;
    constexpr Options clusters{.slicing = Slicing::clusters}, tested{.depth_test = true},
        both{.depth_test = true, .slicing = Slicing::clusters};
    const bool depth_test = scene.made.options.depth_test;
    if (scene.clusters())
        return depth_test ? binned<both, true>(built, source, counts) : binned<clusters, true>(built, source, counts);
    return depth_test ? binned<tested>(built, source, counts) : binned<Options{}>(built, source, counts);
}

/// Decides by exact arithmetic whether a scene's lights reach its cells.
class Referee {
public:
    explicit Referee(const HuntScene& scene)
        : scene_(scene), truth_(scene.camera), planes_(truth_.oracle, scene.matrix ? &*scene.matrix : nullptr) {
        std::optional<AroundImage> around;
        std::optional<ExactView> view;
        if (scene.matrix) around.emplace(truth_.oracle, *scene.matrix), view.emplace(*scene.matrix);
        const auto add_ball = [&](bool bad, const Light& ball) {
            if (bad || around) {
                balls_.push_back(bad ? FlatBall{} : (*around)(ball));
                return;
            }
            const CameraBall seen = truth_.oracle.in_camera(exact_ball(ball.x, ball.y, ball.z, ball.w));
            balls_.push_back({nearly(seen.x), nearly(seen.y), nearly(seen.depth),
                              seen.all ? HUGE_VAL : nearly(seen.radius)});
        };
        for (const SpotLight& light : scene.lights) {
            const bool bad = is_bad(light);
            exact_.push_back(exact_spot(bad ? SpotLight{{}, 0, 0, 1, 1} : light));
            add_ball(bad, light.ball);
        }
        const auto to_camera = [&](const Vector& at) { return truth_.oracle.in_camera({view ? (*view)(at) : at, 0}); };
        for (const BoxLight& box : scene.boxes) {
            const bool bad = is_bad(box);
            boxes_.push_back(bad ? FlatBox{} : flat_box(box, to_camera));
            add_ball(bad, {box.x, box.y, box.z, box.radius});
        }
    }

    /// Returns whether a light reaches a cell; nothing if neither is proven.
    std::optional<bool> reaches(std::size_t cell, std::size_t light) {
        const std::size_t tiles = scene_.made.view.tile_count(), tile = cell % tiles, slice = cell / tiles;
        const float low = bound(0, tile), high = bound(1, tile);
        if (low > high || low == HUGE_VALF || high == -HUGE_VALF) return false;
        float min = low, max = high;
        if (scene_.clusters()) {  // the cell is that of the slice, or nothing if the slice does not meet the bounds
            const auto boundaries = scene_.slices.boundaries();
            min = slice > 0 ? boundaries[slice - 1] : -HUGE_VALF;
            max = slice < boundaries.size() ? boundaries[slice] : HUGE_VALF;
            if (min > high || max < low) return false;
        }
        const FlatDepths flat = {std::max(static_cast<double>(min), truth_.range.min),
                                 std::min(static_cast<double>(max), truth_.range.max)};
        const int x = static_cast<int>(tile) % scene_.made.view.tiles_x(),
                  y = static_cast<int>(tile) / scene_.made.view.tiles_x();
        if (flat.surely_empty() || truth_.filter.apart(x, x + 1, y, y + 1, flat, balls_[light])) return false;
        const bool box = light >= exact_.size();
        if (box && oracle::apart(truth_.filter, x, x + 1, y, y + 1, flat, boxes_[light - exact_.size()])) return false;
        const Depths depths = truth_.oracle.depths(min, max);
        if (depths.contains_none()) return false;
        const std::vector<HalfSpace> planes = planes_({x, x + 1, y, y + 1}, depths);
        if (box) return oracle::meets(planes, ExactBox(scene_.boxes[light - exact_.size()]));
        const ExactSpot& spot = exact_[light];
        for (const HalfSpace& plane : planes) {
            const Rational at = plane.at(spot.ball.centre);
            if (!spot.ball.all && at < 0 && square(at) > square(spot.ball.radius) * dot(plane.a, plane.a)) return false;
        }
        return oracle::meets(planes, spot);
    }

private:
    /// A tile's minimum or maximum, infinite where there is none.
    float bound(std::size_t side, std::size_t tile) const {
        const bool given = scene_.has_bounds() && (side == 1 || !scene_.made.options.max_only);
        const float bound = given ? scene_.bounds[side][tile] : std::nanf("");
        return !std::isnan(bound) ? bound : side == 0 ? -HUGE_VALF : HUGE_VALF;
    }

    const HuntScene& scene_;
    Truth truth_;
    CellPlanes planes_;
    std::vector<ExactSpot> exact_;
    std::vector<FlatBox> boxes_;
    std::vector<FlatBall> balls_;
};

/// Returns whether the passes list a light everywhere, as one of its numbers is beyond 2^40.
bool is_everywhere(const HuntScene& scene, const lightbin::CullConstants& constants, std::size_t id) {
    Light light;
    if (id < scene.lights.size()) {
        light = scene.lights[id].ball;
    } else {
        const BoxLight& box = scene.boxes[id - scene.lights.size()];
        light = {box.x, box.y, box.z, box.radius};
        const auto beyond = [](float number) { return std::abs(number) > 0x1p40f; };
        if (std::any_of(box.centre, box.centre + 3, beyond)) return true;
        for (const auto& half_axis : box.half_axes)
            if (std::any_of(half_axis, half_axis + 3, beyond)) return true;
    }
    const double limit = 0x1p40, at[] = {light.x, light.y, light.z};
    bool far_away = static_cast<double>(light.w) > limit;
    for (const double each : at)
        far_away |= std::abs(each) > limit;
    if (!scene.matrix) return far_away;
    double distance = 0;
    for (int row = 0; row < 3; ++row) {
        const auto m = [&](int column) { return static_cast<double>(scene.matrix->m[column][row]); };
        far_away |= std::abs(m(0) * at[0] + m(1) * at[1] + m(2) * at[2] + m(3)) > limit;
        distance += std::abs(at[row] - static_cast<double>(constants.origin[row]));
    }
    return far_away || static_cast<double>(light.w * constants.stretch) > limit ||
           distance > static_cast<double>(constants.max_distance);
}

struct HuntTally {
    std::size_t scenes = 0, entries = 0;
    std::size_t missed = 0;      ///< entries of the Binner that the GPU has not, although the light reaches the cell
    std::size_t lacked = 0;      ///< those of lights that do not reach the cell
    std::size_t lacking = 0;     ///< scenes with such an entry
    std::size_t more = 0;        ///< entries that only the GPU has
    std::size_t everywhere = 0;  ///< those of lights that it lists everywhere; they are not counted in `more`
    std::size_t asked = 0;       ///< entries of which exact arithmetic was asked whether the light reaches the cell
    std::size_t reach = 0;       ///< entries that only the GPU has although the light reaches: the Binner misses it
    std::size_t open = 0;        ///< entries of which exact arithmetic left open whether the light reaches the cell
    std::size_t faults = 0;      ///< missed entries, open ones of the Binner, and grids with wrong ranges or totals

    void add(const HuntTally& other) {
        using Tally = HuntTally;
        for (const auto member : {&Tally::scenes, &Tally::entries, &Tally::missed, &Tally::lacked, &Tally::lacking,
                                  &Tally::more, &Tally::everywhere, &Tally::asked, &Tally::reach, &Tally::open,
                                  &Tally::faults})
            this->*member += other.*member;
    }
    void print(const std::string& name) const {
        const double percent = entries == 0 ? 0 : 100.0 * static_cast<double>(more) / static_cast<double>(entries);
        std::printf("%-19s %6zu %9zu %6zu %7zu %7zu %8zu %7.3f %10zu %7zu %5zu %4zu %6zu\n", name.c_str(), scenes,
                    entries, missed, lacked, lacking, more, percent, everywhere, asked, reach, open, faults);
    }
};

/// Compares the lists of one scene.
HuntTally hunt(GpuDevice& device, const HuntScene& scene, const std::string& name) {
    const lightbin::CullPlan plan = plan_of(scene.made);
    const CulledGrid grid = gpu_lists(device, scene, plan);
    lightbin::LightCounts counts;
    const BuiltLists expected = binner_lists(scene, counts);
    HuntTally tally{.scenes = 1, .entries = expected.ids.size()};
    const auto fault = [&](const std::string& what) {
        if (++tally.faults == 1) std::printf("%s: %s\n", name.c_str(), what.c_str());
    };
    if (compare_lists(grid, expected).wrong > 0 || grid.totals.rejected != counts.rejected) {
        fault("ranges, the order of ids or totals are wrong");
        return tally;
    }
    Referee referee(scene);
    // Asks about an entry that one side alone has; those of lights that reach the cell are counted in `missed`.
    const auto ask = [&](std::size_t cell, std::size_t light, bool gpu_has, std::size_t& missed) {
        const std::optional<bool> reaches = referee.reaches(cell, light);
        ++tally.asked;
        tally.open += !reaches;
        missed += reaches == true;
        if (reaches == false || (!reaches && gpu_has)) return;
        fault("cell " + std::to_string(cell) + ", light " + std::to_string(light) + " " + scene.text_of(light) +
              (reaches ? " reaches, but is only in the list of the " : " is open, and only in the list of the ") +
              (gpu_has ? "GPU" : "Binner"));
    };
    struct Pair {
        std::size_t cell, light;
    };
    std::vector<Pair> lacked, more;
    for (std::size_t cell = 0; cell < expected.tiles.size(); ++cell) {
        std::vector<std::uint32_t> own, others;
        for (std::uint32_t i = 0; i < grid.tiles[cell].count; ++i)
            own.push_back(grid.id(grid.tiles[cell].offset + i));
        const auto wanted = expected.of(cell);
        std::ranges::set_difference(wanted, own, std::back_inserter(others));
        for (const std::uint32_t light : others)
            lacked.push_back({cell, light});
        others.clear();
        std::ranges::set_difference(own, wanted, std::back_inserter(others));
        for (const std::uint32_t light : others)
            if (is_everywhere(scene, plan.constants, light))
                ++tally.everywhere;
            else
                more.push_back({cell, light});
    }
    for (const Pair& pair : lacked)
        ask(pair.cell, pair.light, false, tally.missed);
    for (std::size_t i = 0; i < more.size(); i += more.size() / 100 + 1)
        ask(more[i].cell, more[i].light, true, tally.reach);
    tally.lacked = lacked.size() - tally.missed;
    tally.lacking = tally.lacked > 0;
    tally.more = more.size();
    return tally;
}

}  // namespace

int main(int count, char** arguments) {
    const std::uint64_t scenes = std::strtoull(arguments[1], nullptr, 10);
    const Share share = share_of(count, arguments);
    GpuDevice device;
    HuntTally tallies[8], all;
    for (std::uint64_t number = share.first; number < scenes; number += share.count) {
        const HuntScene scene = random_scene(number);
        const HuntTally tally = hunt(device, scene, "scene " + std::to_string(number));
        tallies[2 * static_cast<std::size_t>(scene.made.options.kind) + scene.made.options.depth_test].add(tally);
        all.add(tally);
    }
    std::printf("%-19s %6s %9s %6s %7s %7s %8s %7s %10s %7s %5s %4s %6s\n", "", "scenes", "entries", "missed", "lacked",
                "lacking", "more", "%", "everywhere", "asked", "reach", "open", "faults");
    for (unsigned kind = 0; kind < 8; ++kind)
        tallies[kind].print(to_string(static_cast<CullKind>(kind / 2)) + std::string(kind & 1 ? ", depth test" : ""));
    all.print("all");
    std::printf("%zu scenes, %zu entries of the Binner, %zu missed, %zu faults\n", all.scenes, all.entries, all.missed,
                all.faults);
    return all.scenes > 0 && all.faults == 0 ? 0 : 1;
}
