// SPDX-License-Identifier: MIT
// Measures formulas for the screen bounds of spheres under one condition, such as a kind of camera: errors against exact
// bounds, tiles missed, extra tiles, times.
#pragma once

#include "../exact/screen_bounds.hpp"
#include "../measure.hpp"
#include "conditions.hpp"
#include "formulas.hpp"
#include "ours.hpp"

#include "../../tests/oracle/library_view.hpp"
#include "../../tests/platforms/environments.hpp"

#include <lightbin/binner.hpp>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace stability {

/// Results of one formula in one precision under one condition. Errors are in pixels, or for depth in slices.
struct Tally {
    std::string formula, precision;
    std::uint64_t lights = 0;       ///< lights tested: most formulas allow none that the near plane cuts
    double error = 0;               ///< largest error of a bound within the picture
    std::uint64_t exact = 0;        ///< tiles, or slices, that lights truly need
    std::uint64_t missed_bare = 0;  ///< of those, missed without a margin
    std::uint64_t missed_same = 0;  ///< of those, missed with the library's margin
    std::uint64_t extra = 0;        ///< tiles not needed: ours with a margin, others without
    double ns = 0;                  ///< a light

    bool used() const { return lights > 0; }
    double excess() const { return exact > 0 ? double(extra) / double(exact) : 0; }
};

struct Result {
    std::vector<Tally> textbooks;
    Tally ours;
    std::uint64_t checked = 0;  ///< exact bounds that were checked by rational arithmetic
    std::uint64_t denied = 0;   ///< exact bounds that this check refuted
    std::uint64_t unlike = 0;   ///< lights whose rectangle is not the one that behind() computes

    std::vector<const Tally*> all() const {
        std::vector<const Tally*> list;
        for (const Tally& tally : textbooks)
            list.push_back(&tally);
        list.push_back(&ours);
        return list;
    }
};

/// How much is asked of a condition.
struct Effort {
    std::size_t scenes, lights;  ///< lights a scene
    std::size_t check_every;     ///< one light in this many is checked by rational numbers
    std::size_t lights_in_turn;  ///< number of lights that are timed
    double seconds;              ///< least duration of each timing
};

/// The bounds that a formula computes, in pixels along both image axes. They may lie outside of the image or be NaN.
struct Bounds {
    double low[2], high[2];
};

/// The nearest and the farthest slice of a light, or its depths as fractional slices.
struct SliceRange {
    int first, last;
};
struct SlicePlaces {
    double first, last;
};

/// A light in the camera's axes.
template <class Real> struct InCamera { Real c[2], z, r; };

/// Moves a light to the camera's axes, computing in Real. Inlined as in a renderer's loop, because it is timed.
template <class Real>
[[gnu::always_inline]] inline InCamera<Real> in_camera(const Scene& scene, std::size_t i) {
    const Light& light = scene.lights[i];
    Real p[3] = {Real(light.x), Real(light.y), Real(light.z)};
    if (scene.world) {
        Real moved[3];
        for (int row = 0; row < 3; ++row) {
            const auto m = [&](int column) { return static_cast<Real>((*scene.world)[column][row]); };
            moved[row] = m(0) * p[0] + m(1) * p[1] + m(2) * p[2] + m(3);
        }
        std::copy(moved, moved + 3, p);
    }
    return {{p[0], p[1]}, -p[2], Real(light.w)};  // all cameras here look down -z
}
/// A formula from a textbook in one precision, for the bounds of lights or for slices.
struct ScreenFormula {
    const char *name, *precision;
    bool knows_near_plane;
    /// The bounds of light i.
    Bounds (*bounds)(const Scene&, std::size_t i, const oracle::ScreenBounds&);
    /// Computes the bounds of all lights along both axes by a formula, and returns their sum.
    double (*sum)(const Scene&);
};
struct SliceFormula {
    const char *name, *precision;
    SlicePlaces (*places)(const DepthScene&, const Light&);
};

/// Calls use(axis, slopes) for both axes of light i.
template <class Formula, class Real, class Use>
void with_slopes(const Scene& scene, std::size_t i, Real n, Use use) {
    const InCamera<Real> light = in_camera<Real>(scene, i);
    for (const int axis : {0, 1})
        use(axis, Formula::slopes(light.c[axis], light.z, light.r, n));
}

template <class Formula, class Real> ScreenFormula screen_formula() {
    return {Formula::name, std::is_same_v<Real, float> ? "float" : "double", Formula::knows_near_plane,
            [](const Scene& scene, std::size_t i, const oracle::ScreenBounds& exact) {
                Bounds bounds;
                with_slopes<Formula>(scene, i, exact.near_depth().convert_to<Real>(),
                                     [&](int axis, const textbook::Slopes<Real>& slopes) {
                                         const Real scale = static_cast<Real>(exact.scale(axis)),
                                                    offset = static_cast<Real>(exact.offset(axis));
                                         bounds.low[axis] = static_cast<double>(slopes.low * scale + offset);
                                         bounds.high[axis] =
                                             static_cast<double>(slopes.high * scale + offset);
                                     });
                return bounds;
            },
            [](const Scene& scene) {
                const Real near_depth = static_cast<Real>(std::abs(scene.camera.m[3][2]) / 2);
                Real sum = 0;
                for (std::size_t i = 0; i < scene.lights.size(); ++i)
                    with_slopes<Formula>(scene, i, near_depth,
                                         [&](int, const auto& slopes) { sum += slopes.low + slopes.high; });
                return static_cast<double>(sum);
            }};
}

inline SliceRange within(const DepthScene& scene, const SlicePlaces& places) {
    const auto slice = [&](double place) {
        return static_cast<int>(std::clamp(std::floor(place), 0.0, scene.slices - 1.0));
    };
    return {slice(places.first), slice(places.last)};
}

template <class Formula, class Real> SliceFormula slice_formula() {
    static constexpr auto places = [](const DepthScene& scene, const Light& light) -> SlicePlaces {
        const Real z = -Real(light.z), r = Real(light.w);
        const auto place = [&](Real depth) {
            return static_cast<double>(
                Formula::slice(depth, Real(scene.near_depth), Real(scene.last), scene.slices));
        };
        return {place(z - r), place(z + r)};
    };
    return {Formula::name, std::is_same_v<Real, float> ? "float" : "double", places};
}

class Measure {
public:
    Measure(const Family& family, const Condition& condition, const Effort& effort)
        : family_(family), value_(condition.value), effort_(effort),
          random_(oracle::seed_of(family.name + condition.label)) {}

    Result run() {
        if (family_.make_depths)
            depths();
        else
            screens();
        return result_;
    }

private:
    //--------------------------------------------------------------------------------------------------------
    // Screen bounds.

    void screens() {
        result_.ours.formula = "lightbin", result_.ours.precision = "mixed";
        using namespace textbook;
        formulas_ = {screen_formula<MaraMcGuire, float>(),      screen_formula<MaraMcGuire, double>(),
                     screen_formula<Quadratic, float>(),        screen_formula<Quadratic, double>(),
                     screen_formula<LengyelLauritzen, float>(), screen_formula<LengyelLauritzen, double>()};
        name_tallies(formulas_);
        std::vector<Scene> scenes, turns;
        for (std::size_t i = 0; i < effort_.scenes; ++i)
            scenes.push_back(family_.make(random_, value_, effort_.lights));
        // Many different lights take turns, so that the branch predictor does not learn them.
        for (std::size_t i = 0; i < 16; ++i)
            turns.push_back(family_.make(random_, value_, effort_.lights_in_turn / 16));
        // The exact numbers are made of integers, so flushing denormal floats does not change them.
        const Environment flushing({.name = "flushing", .flushes = family_.flush});
        for (const Scene& scene : scenes)
            screen(scene);
        time_all(turns);
    }

    static lightbin::View view_of(const Scene& scene) {
        const auto view = oracle::library_view(scene.camera);
        if (!view) throw std::logic_error("the camera was refused: " + std::string(view.error().message()));
        return *view;
    }

    /// Returns a light in view space, exactly. If a matrix of doubles is not quite a rotation, the radius is reduced by
    /// that error, so that no more is asked for than the library promises.
    static oracle::CameraBall exact_ball(const oracle::Oracle& oracle, const Scene& scene,
                                         const Light& light) {
        oracle::Ball ball = oracle::exact_ball(light.x, light.y, light.z, light.w);
        if (scene.world) {
            oracle::Rational moved[3];
            for (int row = 0; row < 3; ++row) {
                moved[row] = oracle::exact((*scene.world)[3][row]);
                const oracle::Rational* const from[] = {&ball.centre.x, &ball.centre.y, &ball.centre.z};
                for (int column = 0; column < 3; ++column)
                    moved[row] += oracle::exact((*scene.world)[column][row]) * *from[column];
            }
            ball.centre = {moved[0], moved[1], moved[2]};
            ball.radius *= 1 - oracle::exact(0x1p-46);
        }
        return oracle.in_camera(ball);
    }

    static float flushed(float value) {
        return std::abs(value) < FLT_MIN ? std::copysign(0.0f, value) : value;
    }

    void screen(Scene scene) {
        if (family_.flush)
            for (Light& light : scene.lights)
                light = {flushed(light.x), flushed(light.y), flushed(light.z), flushed(light.w)};
        const lightbin::View view = view_of(scene);
        const auto& constants = lightbin::detail::camera_of(view);
        const oracle::Oracle oracle(scene.camera);
        const oracle::ScreenBounds bounds(oracle);
        const Projected projected = project(view, scene);
        const double tile = scene.camera.tile;
        const double margins[] = {static_cast<double>(constants.x.margin) * tile,
                                  static_cast<double>(constants.y.margin) * tile};
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            const oracle::CameraBall ball = exact_ball(oracle, scene, scene.lights[i]);
            oracle::AxisExtent truth[2];
            for (const int axis : {0, 1}) {
                truth[axis] = bounds.extent(axis, ball);
                if (asked_ % effort_.check_every == 0) {
                    ++result_.checked;
                    result_.denied += !bounds.agrees(axis, truth[axis], ball);
                }
            }
            ++asked_;
            const bool beyond = ball.depth + ball.radius < *oracle.range().min ||
                                (oracle.range().max && ball.depth - ball.radius > *oracle.range().max);
            const bool in_view = truth[0].first <= truth[0].last && truth[1].first <= truth[1].last;
            count_ours(scene, truth, in_view, projected.rects[i], behind(constants, projected.in_view[i]));
            if (beyond) continue;
            const bool cut = ball.depth - ball.radius <= *oracle.range().min;
            for (std::size_t k = 0; k < formulas_.size(); ++k)
                if (!cut || formulas_[k].knows_near_plane)
                    add_textbook(result_.textbooks[k], scene.camera, formulas_[k].bounds(scene, i, bounds),
                                 truth, in_view, margins);
        }
    }

    /// Adds the distance between two bounds within the picture; for a bound that is NaN, the picture's size.
    static void add_error(Tally& tally, const Camera& camera, const oracle::AxisExtent* truth,
                          const Bounds& bounds) {
        const int sides[] = {camera.width, camera.height};
        for (const int axis : {0, 1}) {
            const double side = sides[axis], low = bounds.low[axis], high = bounds.high[axis];
            add_error(tally, std::isnan(low) ? side : std::clamp(low, 0.0, side) - truth[axis].low,
                      std::isnan(high) ? side : truth[axis].high - std::clamp(high, 0.0, side));
        }
    }
    /// Adds how far the two ends of a range lie too far inward.
    static void add_error(Tally& tally, double low_inward, double high_inward) {
        tally.error = std::max({tally.error, std::abs(low_inward), std::abs(high_inward)});
    }

    /// The tiles of bounds, in the viewport.
    static TileRect tiles(const Camera& camera, const Bounds& bounds, const double* margins) {
        TileRect rect;
        const int sides[] = {camera.width, camera.height};
        for (const int axis : {0, 1}) {
            const double margin = margins ? margins[axis] : 0, last = (sides[axis] - 1) / camera.tile;
            const double low = bounds.low[axis] - margin, high = bounds.high[axis] + margin;
            if (!(high >= 0 && low <= sides[axis])) return {};
            rect.first[axis] = static_cast<int>(std::clamp(std::floor(low / camera.tile), 0.0, last));
            rect.last[axis] = static_cast<int>(std::clamp(std::floor(high / camera.tile), 0.0, last));
        }
        return rect;
    }

    static std::uint64_t area(const TileRect& rect) {
        std::uint64_t product = 1;
        for (const int axis : {0, 1})
            product *= static_cast<std::uint64_t>(std::max(0, rect.last[axis] - rect.first[axis] + 1));
        return product;
    }
    static TileRect common(const TileRect& a, const TileRect& b) {
        TileRect both;
        for (const int axis : {0, 1}) {
            both.first[axis] = std::max(a.first[axis], b.first[axis]);
            both.last[axis] = std::min(a.last[axis], b.last[axis]);
        }
        return both;
    }
    static TileRect rect_of(const oracle::AxisExtent* truth, bool in_view) {
        if (!in_view) return {};
        return {{truth[0].first, truth[1].first}, {truth[0].last, truth[1].last}};
    }

    /// Counts a light's tiles: the exact ones, those found without and with the library's margin, and those listed.
    static void add_tiles(Tally& tally, const TileRect& exact, const TileRect& bare, const TileRect& same,
                          const TileRect& listed) {
        const std::uint64_t whole = area(exact);
        ++tally.lights;
        tally.exact += whole;
        tally.missed_bare += whole - area(common(exact, bare));
        tally.missed_same += whole - area(common(exact, same));
        tally.extra += area(listed) - area(common(exact, listed));
    }

    void count_ours(const Scene& scene, const oracle::AxisExtent* truth, bool in_view,
                    const TileRect& emitted, const Behind& reason) {
        Tally& tally = result_.ours;
        const TileRect exact = rect_of(truth, in_view);
        Bounds bare;
        for (const int axis : {0, 1}) {
            bare.low[axis] = reason.low[axis] * scene.camera.tile;
            bare.high[axis] = reason.high[axis] * scene.camera.tile;
        }
        add_tiles(tally, exact, tiles(scene.camera, bare, nullptr), emitted, emitted);
        result_.unlike += !(reason.rect == emitted);
        if (in_view) add_error(tally, scene.camera, truth, bare);
    }

    template <class Formula> void name_tallies(const std::vector<Formula>& formulas) {
        for (const Formula& formula : formulas) {
            Tally& tally = result_.textbooks.emplace_back();
            tally.formula = formula.name, tally.precision = formula.precision;
        }
    }

    static void add_textbook(Tally& tally, const Camera& camera, const Bounds& bounds,
                             const oracle::AxisExtent* truth, bool in_view, const double* margins) {
        const TileRect bare = tiles(camera, bounds, nullptr);
        add_tiles(tally, rect_of(truth, in_view), bare, tiles(camera, bounds, margins), bare);
        if (in_view) add_error(tally, camera, truth, bounds);
    }

    //--------------------------------------------------------------------------------------------------------
    // Times.

    /// Returns nanoseconds for each light: visits the scenes in turn until the effort's time is used up.
    template <class Visit> double time(const std::vector<Scene>& scenes, Visit visit) const {
        std::vector<double> rounds;
        const double end = time_now() + effort_.seconds;
        do
            rounds.push_back(seconds([&] {
                for (const Scene& scene : scenes)
                    visit(scene);
            }));
        while (time_now() < end || rounds.size() < effort_.lights_in_turn / 4096);
        return median(rounds) / double(scenes.size() * scenes[0].lights.size()) * 1e9;
    }

    void time_all(const std::vector<Scene>& scenes) {
        for (std::size_t k = 0; k < formulas_.size(); ++k)
            if (Tally& tally = result_.textbooks[k]; tally.used())
                tally.ns = time(scenes, [&](const Scene& scene) {
                    volatile double kept = formulas_[k].sum(scene);
                    static_cast<void>(kept);
                });
        std::vector<lightbin::View> views;
        for (const Scene& scene : scenes)
            views.push_back(view_of(scene));
        lightbin::detail::Footprints footprints;
        result_.ours.ns = time(scenes, [&](const Scene& scene) {
            with_lights(scene, [&](const auto& lights) {
                footprints.project(lightbin::machine_isa(),
                                   views[static_cast<std::size_t>(&scene - scenes.data())], lights, {});
            });
        });
    }

    //--------------------------------------------------------------------------------------------------------
    // Slices.

    void depths() {
        result_.ours.formula = "lightbin", result_.ours.precision = "float";
        using namespace textbook;
        slice_formulas_ = {slice_formula<LogScaleBias, float>(), slice_formula<LogScaleBias, double>(),
                           slice_formula<LogRatio, float>(), slice_formula<LogRatio, double>()};
        name_tallies(slice_formulas_);
        for (std::size_t i = 0; i < effort_.scenes; ++i)
            depth_scene(family_.make_depths(random_, value_, effort_.lights));
    }

    using Clusters = lightbin::Binner<lightbin::Options{.slicing = lightbin::Slicing::clusters}>;

    static lightbin::View depth_view(const DepthScene& scene) {
        Lens lens = oracle::symmetric_lens(1, 60);
        lens.near_plane = static_cast<double>(scene.near_depth) / 2, lens.far_plane = scene.far_plane;
        lens.doubles = true;
        return view_of(scene_of(lens, {64, 64, 64, false}));
    }
    /// Returns slices with the textbooks' boundaries as floats, which define the cells.
    static lightbin::Slices slices_of(const DepthScene& scene) {
        const double ratio = static_cast<double>(scene.last) / static_cast<double>(scene.near_depth);
        const auto slices = lightbin::Slices::exponential(
            scene.slices,
            static_cast<float>(static_cast<double>(scene.near_depth) * std::pow(ratio, 1.0 / scene.slices)),
            scene.last);
        if (!slices)
            throw std::logic_error("the slices were refused: " + std::string(slices.error().message()));
        return *slices;
    }

    /// `needed` are the slices of the light's depths if a boundary belongs to the slice behind it, as for a shader;
    /// `touched` also counts the slice that a light just reaches. Both answers are right.
    static void add_slices(Tally& tally, const SliceRange& needed, const SliceRange& touched,
                           const SliceRange& found) {
        const auto size = [](const SliceRange& range) {
            return static_cast<std::uint64_t>(std::max(0, range.last - range.first + 1));
        };
        const auto common = [&](const SliceRange& other) {
            return size({std::max(found.first, other.first), std::min(found.last, other.last)});
        };
        ++tally.lights;
        tally.exact += size(needed);
        const std::uint64_t missed = size(needed) - common(needed);
        tally.missed_bare += missed;
        tally.missed_same += missed;
        tally.extra += size(found) - common(touched);
    }
    /// Returns the exact place of a depth in fractional slices, with 64 bits; log(1 + x) keeps all digits of a small x.
    static double exact_place(const DepthScene& scene, double depth) {
        const double near_depth = static_cast<double>(scene.near_depth);
        using Long = long double;
        return static_cast<double>(
            std::log1p(Long(depth - near_depth) / Long(near_depth)) /
            std::log1p(Long(static_cast<double>(scene.last) - near_depth) / Long(near_depth)) * scene.slices);
    }

    void depth_scene(const DepthScene& scene) {
        const lightbin::Slices slices = slices_of(scene);
        Clusters clusters;
        const auto grid = clusters.bin(depth_view(scene), scene.lights, {.slices = slices});
        if (!grid) throw std::logic_error("lights were refused");
        std::vector<SliceRange> found(scene.lights.size(), {scene.slices, -1});
        for (int slice = 0; slice < scene.slices; ++slice)
            for (const std::uint32_t id : grid->lights_in(0, 0, slice)) {
                const bool gap = found[id].last >= 0 && found[id].last != slice - 1;
                result_.ours.missed_same += gap;
                found[id] = {std::min(found[id].first, slice), slice};
            }
        const std::span<const float> boundaries = slices.boundaries();
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            // Exact in double: neither float is 2^29 times as large as the other.
            const double z = -static_cast<double>(scene.lights[i].z),
                         r = static_cast<double>(scene.lights[i].w);
            const auto before = [&](double depth, bool itself) {
                const auto place =
                    std::partition_point(boundaries.begin(), boundaries.end(), [&](float boundary) {
                        return itself ? static_cast<double>(boundary) <= depth
                                      : static_cast<double>(boundary) < depth;
                    });
                return static_cast<int>(place - boundaries.begin());
            };
            // Our slices are compared with boundaries in float, the textbooks' with the exact formula.
            const SliceRange needed = {before(z - r, true), before(z + r, true)},
                             touched = {before(z - r, false), needed.last};
            add_slices(result_.ours, needed, touched, found[i]);
            const int beside = touched.first - found[i].first;  // nothing, between the two
            add_error(result_.ours, beside > 0 ? -beside : std::max(0, found[i].first - needed.first),
                      needed.last - found[i].last);
            if (std::isinf(scene.far_plane)) continue;  // there is no such law
            const SlicePlaces exact = {exact_place(scene, z - r), exact_place(scene, z + r)};
            for (std::size_t k = 0; k < slice_formulas_.size(); ++k) {
                const SlicePlaces places = slice_formulas_[k].places(scene, scene.lights[i]);
                Tally& tally = result_.textbooks[k];
                add_slices(tally, within(scene, exact), within(scene, exact), within(scene, places));
                add_error(tally, places.first - exact.first, exact.last - places.last);
            }
        }
    }

    const Family& family_;
    double value_;
    Effort effort_;
    Random random_;
    std::uint64_t asked_ = 0;
    std::vector<ScreenFormula> formulas_;
    std::vector<SliceFormula> slice_formulas_;
    Result result_;
};

}  // namespace stability
