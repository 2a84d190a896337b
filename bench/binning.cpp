// SPDX-License-Identifier: MIT
// Times a whole build, lights in to lists out, against a plain loop (flat.hpp) that takes turns with it: with clusters
// and z-bins, from world space and from structs, of spots and boxes against spheres, and on several threads. Writes
// binning.csv.
#include "arguments.hpp"
#include "boxes_sets.hpp"
#include "builds.hpp"
#include "console.hpp"
#include "flat.hpp"
#include "glb_scenes.hpp"
#include "lens.hpp"
#include "memory.hpp"
#include "pool.hpp"
#include "sources.hpp"
#include "spots_sets.hpp"
#include "turns.hpp"
#include "world.hpp"

#include <lightbin/binner.hpp>
#include <lightbin/masks.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <regex>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using lightbin::Isa;
using lightbin::Options;
using lightbin::Slicing;

/// The time of one case on one instruction set, as a ratio to the time of other work that was timed in turns with it.
struct Timed {
    std::string name, tier;
    std::string to;  ///< name of the work that the ratio is to
    double ratio;    ///< of median times; for threads: how many times as fast as one thread
    double spread;   ///< from the 10th to the 90th percentile of the ratios of single turns
    double ns_per_light = 0, entries_per_light = 0;
};

double seconds_a_case = 0.3;
std::vector<Timed> results;

/// What is timed on one instruction set, and the name that a filter finds it by.
struct Case {
    std::string name;
    std::function<void()> time;
};
std::vector<Case> cases;

template <class AnyFrame> using Make = std::function<std::vector<AnyFrame>()>;

/// Frames with different lights, built in turns. They are made when they are first asked for.
template <class AnyFrame> struct Set {
    std::string name;
    std::size_t lights;
    Make<AnyFrame> make;

    std::string full_name() const { return name + "/" + std::to_string(lights); }

    /// Returns the frames, which `make` makes; they are kept until another set is asked for.
    const std::vector<AnyFrame>& frames() const {
        static std::vector<AnyFrame> frames;
        static std::string kept;
        if (kept != full_name()) {
            frames.clear();
            frames = make();
            kept = full_name();
        }
        return frames;
    }
};

/// Returns a set of frames with `count` lights each; make(seed) makes the lights of one frame.
template <class MakeLights>
Set<Frame> made_set(const std::string& name, std::size_t count, MakeLights make, Lens lens = {}) {
    return {
        name, count, [=] {
            return frames_in_turn(count, [&](std::uint32_t seed) { return Frame{lens, make(count, seed)}; });
        }};
}
Set<Frame> field_set(const std::string& name, float median, std::size_t count) {
    return made_set(name, count, [=](std::size_t n, std::uint32_t seed) { return field(n, median, seed); });
}

void add_result(const std::string& name, Isa isa, const char* to, const Turns& turns,
                std::size_t of, std::size_t other, std::size_t lights) {
    const double count = double(std::max<std::size_t>(lights, 1));
    results.push_back({name, to_string(isa), to, turns.ratio(of, other), turns.spread(of, other),
                       1e9 * turns.seconds_a_frame(of) / count, turns.made_a_frame(of) / count});
}

/// Ends the program if two builds that must make the same lists made lists of different total length.
void check_same_length(const std::string& name, std::size_t ours, std::size_t theirs) {
    if (std::abs(double(ours) - double(theirs)) > 0.01 * double(theirs) + 16)
        throw std::runtime_error(name +
                                 text(": %zu entries, and %zu of what it is held against", ours, theirs));
}

/// Adds a case for each instruction set of this machine, from `least` on; time(name, isa) does the timing.
template <class Time> void add_cases(const std::string& name, Time time, Isa least = Isa::scalar) {
    for (const Isa isa : {Isa::scalar, Isa::simd128, Isa::avx2, Isa::avx512})
        if (isa >= least && lightbin::machine_isa(isa) == isa)
            cases.push_back({name + "/" + to_string(isa), [=] { time(name, isa); }});
}

/// Returns the processor time in seconds that this thread needs for some work.
template <class Body> double own_seconds(Body body) {
    const auto now = [] {
        std::timespec time;
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
    };
    const double start = now();
    body();
    return now() - start;
}

/// Runs a step's parts one by one and adds up the processor time of each step's longest part.
struct Steps {
    explicit Steps(std::size_t threads) : pool(threads) {}

    Pool pool;
    double longest = 0;

    template <class Body> void operator()(std::size_t n, const Body& body) {
        std::vector<double> parts(n);
        pool(n, [&](std::size_t i) { parts[i] = own_seconds([&] { body(i); }); });
        longest += *std::ranges::max_element(parts);
    }
};

/// The views of frames. Equal views are stored once, so that a view stays in the cache as in a program.
struct FrameViews {
    FrameViews(const std::vector<Frame>& frames, int tile_size) : first(frames.data()) {
        for (std::size_t i = 0; i < frames.size(); ++i) {
            if (i == 0 || !frames[i].lens.same(frames[i - 1].lens)) {
                views.push_back(frames[i].lens.view(tile_size));
                flat_views.push_back(frames[i].lens.flat_view(tile_size));
            }
            view_of.push_back(views.size() - 1);
        }
    }
    const lightbin::View& view(const Frame& frame) const { return views[at(frame)]; }
    const FlatView& flat_view(const Frame& frame) const { return flat_views[at(frame)]; }
    std::size_t at(const Frame& frame) const { return view_of[static_cast<std::size_t>(&frame - first)]; }

    const Frame* first;
    std::vector<lightbin::View> views;
    std::vector<FlatView> flat_views;
    std::vector<std::size_t> view_of;
};

/// Times a build against the plain loop, which tests no depths; also against clearing the table of tiles and, for a
/// million lights, against reading the lights.
template <Options options> void time_build(const std::string& name, Isa isa, const Set<Frame>& set, int tile_size) {
    const std::vector<Frame>& frames = set.frames();
    const FrameViews views(frames, tile_size);
    Build<options> build(tile_size, isa);
    Flat<float> flat;
    std::vector<char> table(sizeof(lightbin::ListRange) * views.views[0].tile_count());
    std::vector<Work<Frame>> works = {
        [&](const Frame& frame) { return build(views.view(frame), frame.lights); },
        [&](const Frame& frame) {
            flat.build<false>(views.flat_view(frame), frame.lights, nullptr, nullptr);
            return flat.indices.size();
        },
        [&](const Frame&) {
            fill(table.data(), table.size());
            return std::size_t{0};
        }};
    if (set.lights >= 1000000)
        works.push_back([](const Frame& frame) {
            read(frame.lights);
            return std::size_t{0};
        });
    if (!options.depth_test) check_same_length(name, works[0](frames[0]), works[1](frames[0]));
    const Turns turns = take_turns(frames, seconds_a_case, works);
    add_result(name, isa, "flat", turns, 0, 1, set.lights);
    add_result(name, isa, "clearing", turns, 0, 2, set.lights);
    if (works.size() > 3) add_result(name, isa, "reading", turns, 0, 3, set.lights);
}

/// Measures how many times as fast several threads are as one, by their processor time, so that waiting for a core does
/// not count.
template <Options options>
void time_threads(const std::string& name, Isa isa, const Set<Frame>& set, std::size_t threads) {
    const std::vector<Frame>& frames = set.frames();
    const lightbin::View view = Lens().view(usual_tile_size(options));
    Build<options> build(usual_tile_size(options), isa);
    Steps steps(threads);
    std::vector<double> alone, together;
    const double end = time_now() + seconds_a_case;
    for (std::size_t turn = 0; turn < 4 * frames.size() || time_now() < end; ++turn) {
        const Lights& lights = frames[turn % frames.size()].lights;
        const bool several = turn / frames.size() % 2 == 1;
        steps.longest = 0;
        const double own = own_seconds([&] {
            build(view, lights, several ? lightbin::Parallel(threads, steps) : lightbin::Parallel());
        });
        (several ? together : alone).push_back(own + steps.longest);
    }
    results.push_back({name, to_string(isa), "one", median(alone) / median(together), 0});
}

/// Times a build with clusters beside the baseline, and one with z-bins beside the same build without them.
template <Options options> void time_slices(const std::string& name, Isa isa, const Set<Frame>& set) {
    constexpr bool clusters = options.slicing == Slicing::clusters;
    constexpr Options without = [] {
        Options plain = options;
        plain.slicing = Slicing::none;
        return plain;
    }();
    const std::vector<Frame>& frames = set.frames();
    const lightbin::View view = Lens().view(usual_tile_size(options));
    const FlatView flat_view = Lens().flat_view(32);
    Build<options> build(usual_tile_size(options), isa);
    Build<without> plain(usual_tile_size(options), isa);
    Flat<float> flat;
    const Work<Frame> ours = [&](const Frame&frame) { return build(view, frame.lights); },
                      theirs = [&](const Frame&frame) {
                          if (!clusters) return plain(view, frame.lights);
                          flat.build<false>(flat_view, frame.lights, nullptr, nullptr);
                          return flat.indices.size();
                      };
    add_result(name, isa, clusters ? "flat" : "none", take_turns(frames, seconds_a_case, {ours, theirs}),
               0, 1, set.lights);
}

/// Times masks of columns and rows against the plain loop and lists, and masks with z-bins against those without.
void time_masks(const std::string& name, Isa isa, const Set<Frame>& set, int tile_size) {
    const std::vector<Frame>& frames = set.frames();
    const lightbin::View view = Lens().view(tile_size);
    const FlatView flat_view = Lens().flat_view(tile_size);
    const lightbin::Slices slices = z_bin_slices();
    lightbin::MaskBinner masks(isa), with_bins(isa);
    Build<Options{}> build(tile_size, isa);
    Flat<float> flat;
    const std::vector<Work<Frame>> works = {
        [&](const Frame& frame) { return masks.bin(view, frame.lights)->words().size(); },
        [&](const Frame& frame) { return with_bins.bin(view, frame.lights, slices)->words().size(); },
        [&](const Frame& frame) { return build(view, frame.lights); },
        [&](const Frame& frame) {
            flat.build<false>(flat_view, frame.lights, nullptr, nullptr);
            return flat.indices.size();
        }};
    const Turns turns = take_turns(frames, 2 * seconds_a_case, works);
    add_result(name, isa, "flat", turns, 0, 3, set.lights);
    add_result(name, isa, "lists", turns, 0, 2, set.lights);
    add_result(name + "/z_bins", isa, "masks", turns, 1, 0, set.lights);
}

/// Times builds from each form of the lights against view-space vec4s, and against a hand-written loop. Within a turn
/// each takes another frame, so that none finds its lights in the cache.
void time_sources(const std::string& name, Isa isa, const Set<WorldFrame>& set) {
    const std::vector<WorldFrame>& frames = set.frames();
    SourceBuilds builds(frames[0].view.lens, 32, isa);
    std::vector<Work<WorldFrame>> works;
    const int sources = frames[0].structs.empty() ? view_structs : world_structs + 1;
    for (int i = 0; i < sources; ++i) {
        const Source source = Source(i);
        works.push_back([&builds, source](const WorldFrame& frame) { return builds(source, frame); });
        check_same_length(name, works.back()(frames[0]), works[0](frames[0]));
    }
    const Turns turns = take_turns(frames, seconds_a_case * sources, works, true);
    const auto add = [&](std::size_t of, std::size_t to) {
        add_result(name + "/" + source_names[of], isa, source_names[to], turns, of, to, set.lights);
    };
    for (std::size_t source = 0; source < works.size(); ++source)
        add(source, view_vec4s);
    add(world_vec4s, loop_vec4s);
}

/// Times spots or boxes against spheres scaled until their lists are as long, and boxes against such spots.
template <Options options, class Light>
void time_kind(const std::string& name, Isa isa, const Set<KindFrame<Light>>& set) {
    using OneFrame = KindFrame<Light>;
    const lightbin::View view = Lens().view(usual_tile_size(options));
    const std::vector<OneFrame>& frames = set.frames();
    Build<options> build(usual_tile_size(options), isa);
    const auto of = [&](auto member) {
        return [&, member](const OneFrame& frame) { return build(view, frame.*member); };
    };
    std::vector<Work<OneFrame>> works = {of(&OneFrame::lights), of(&OneFrame::spheres)};
    if (!frames[0].spots.empty()) works.push_back(of(&OneFrame::spots));
    const Turns turns = take_turns(frames, seconds_a_case, works);
    add_result(name, isa, "spheres", turns, 0, 1, set.lights);
    if (works.size() > 2) add_result(name, isa, "spots", turns, 0, 2, set.lights);
}

constexpr const char* name_of(bool depth_test) {
    return depth_test ? "box" : "none";
}

template <Options options = Options{}> void add_builds(const Set<Frame>& set, int tile_size) {
    add_cases(set.full_name() + text("/%dpx/", tile_size) + name_of(options.depth_test),
              [=](const std::string& name, Isa isa) { time_build<options>(name, isa, set, tile_size); });
}

/// With AVX2 and wider.
template <Options options = Options{}> void add_threads(const Set<Frame>& set) {
    for (const std::size_t threads : {2u, 4u, 8u, 16u}) {
        const std::string name = set.full_name() + "/" + to_string(options.slicing) + "/" +
                                 name_of(options.depth_test) + text("/%zu threads", threads);
        add_cases(name, [=](const std::string& one, Isa isa) { time_threads<options>(one, isa, set, threads); },
                  Isa::avx2);
    }
}

/// Adds all cases of one generated light set. `median` is the median radius; 0 stands for the set around the eye.
void add_set(const std::string& name, float median, bool quick) {
    const auto make = [median](std::size_t count, std::uint32_t seed) {
        return median > 0 ? field(count, median, seed) : near_eye(count, seed);
    };
    const bool few_tiles = median == field4_median || median == field20_median;
    for (const std::size_t n : {0u, 1u, 256u, 1000u, 4096u, 10000u, 1000000u}) {
        if ((quick && (n == 1000 || n >= 10000)) || (n == 1000000 && median != field4_median)) continue;
        const Set<Frame> set = made_set(name, n, make);
        add_builds(set, 32);
        if (n < 256 || n > 10000) continue;
        add_builds(set, 16);
        if (median == field20_median) add_builds<Options{.depth_test = true}>(set, 32);
        Lens uhd;
        uhd.screen = {3840, 2160};
        if (n == 256 && few_tiles) add_builds(made_set(name + "-4k", n, make, uhd), 16);
    }
}

void add_all_threads() {
    const Set<Frame> many = field_set("field20", field20_median, 100000);
    add_threads(field_set("field20", field20_median, 10000));
    add_threads(many);
    add_threads<Options{.depth_test = true}>(many);
    add_threads<Options{.depth_test = true, .slicing = Slicing::clusters}>(many);
}

void add_scene(const std::string& path) {
    const std::vector<BenchScene> views = glb_scenes(path);
    const std::size_t lights = views[0].lights(0).size();
    add_builds(Set<Frame>{views[0].name.substr(0, views[0].name.rfind(':')), lights,
                          [=] { return scene_frames(views, lights); }},
               32);
}

/// Clusters and z-bins of the field sets.
template <Slicing slicing, bool depth_test = false> void add_slices(const Set<Frame>& set) {
    constexpr Options options = {.depth_test = depth_test, .slicing = slicing};
    add_cases("slices/" + set.full_name() + "/" + to_string(slicing) + "/" + name_of(depth_test),
              [=](const std::string& name, Isa isa) { time_slices<options>(name, isa, set); });
}

void add_all_slices(bool quick) {
    const auto add_clusters = [](const Set<Frame>& set) {
        add_slices<Slicing::clusters>(set);
        add_slices<Slicing::clusters, true>(set);
    };
    for (const std::size_t n : {256u, 1000u, 4096u, 10000u}) {
        const Set<Frame> set = field_set("field20", field20_median, n);
        const bool round = n == 1000 || n == 10000;
        if (!quick || round) add_clusters(set);
        if (round) add_slices<Slicing::z_bins>(set);
    }
}

void add_masks() {
    for (const std::size_t n : {64u, 256u, 1000u, 2000u, 10000u})
        for (const int tile_size : {32, 16}) {
            const Set<Frame> set = field_set("field20", field20_median, n);
            add_cases("masks/" + set.full_name() + text("/%dpx", tile_size),
                      [=](const std::string& name, Isa isa) { time_masks(name, isa, set, tile_size); });
        }
}

void add_sources(const Set<WorldFrame>& set) {
    add_cases("sources/" + set.name,
              [=](const std::string& name, Isa isa) { time_sources(name, isa, set); });
}

/// A set of spots or boxes, and the function that makes one of its frames from a seed.
template <class Light> struct KindSet {
    std::string name;
    std::size_t lights;
    std::function<KindFrame<Light>(std::uint32_t seed)> make;
};

template <Options options, class Light> void add_kind(const KindSet<Light>& kind) {
    const std::string name = kind.name + text("/%zu/", kind.lights) + name_of(options.depth_test) + "/" +
                             to_string(options.slicing);
    // The lists have the same lengths on every instruction set.
    const Set<KindFrame<Light>> set = {name, kind.lights, [=] {
                                           constexpr int tile_size = usual_tile_size(options);
                                           const lightbin::View view = Lens().view(tile_size);
                                           Build<options> build(tile_size);
                                           return matched_frames(
                                               frames_in_turn(kind.lights, kind.make),
                                               [&](const auto& lights) { return build(view, lights); });
                                       }};
    add_cases(name, [=](const std::string& full_name, Isa isa) { time_kind<options>(full_name, isa, set); });
}

void add_all_spots(bool quick) {
    for (const auto& [name, median_range] : {std::pair("spots20", spots20_median), {"spots4", spots4_median}})
        for (const std::size_t count : {256u, 10000u}) {
            if (quick && (count == 256 || median_range == spots4_median)) continue;
            const KindSet<lightbin::Spot> set = {
                std::string("spots/") + name, count, [=, median = median_range](std::uint32_t seed) {
                    return SpotFrame{spot_field(count, median, seed), field(count, median, seed)};
                }};
            add_kind<Options{}>(set);
            add_kind<Options{.depth_test = true}>(set);
            add_kind<Options{.slicing = Slicing::clusters}>(set);
            add_kind<Options{.depth_test = true, .slicing = Slicing::clusters}>(set);
            add_kind<Options{.slicing = Slicing::z_bins}>(set);
        }
}

void add_boxes(const char* name, float median, std::span<const BoxFamily> families) {
    for (const std::size_t count : {1000u, 10000u}) {
        const KindSet<lightbin::Box> set = {
            std::string("boxes/") + name, count, [=](std::uint32_t seed) {
                return KindFrame<lightbin::Box>{box_field(count, median, seed, families),
                                                field(count, median, seed), spot_field(count, median, seed)};
            }};
        add_kind<Options{}>(set);
        add_kind<Options{.depth_test = true}>(set);
        add_kind<Options{.depth_test = true, .slicing = Slicing::clusters}>(set);
    }
}

/// Returns lights of which 99 % are out of view: behind the eye, or to the side.
Lights away(std::size_t count, std::uint32_t seed) {
    Lights lights = field(count, field4_median, seed);
    for (std::size_t i = 0; i < count; ++i)
        if (i % 100 != 0) (i % 2 == 0 ? lights[i].z : lights[i].x) += 600;
    return lights;
}

/// Adds cases that compare the time for each light among a million small lights and among ten thousand.
void add_scale() {
    const auto of = [](const Timed& row, const char* number) {
        return row.to == "flat" && row.name == std::string("field4/") + number + "/32px/none";
    };
    const std::vector<Timed> all = results;
    for (const Timed& million : all)
        for (const Timed& few : all)
            if (of(million, "1000000") && of(few, "10000") && million.tier == few.tier)
                results.push_back({million.name, million.tier, "10,000 lights",
                                   million.ns_per_light / few.ns_per_light, 0});
}

void write_csv() {
    std::FILE* const csv =
        open_report("binning.csv", "case,tier,to,ratio,spread,ns_per_light,entries_per_light");
    for (const Timed& t : results)
        std::fprintf(csv, "%s,%s,%s,%.4f,%.4f,%.4f,%.3f\n", t.name.c_str(), t.tier.c_str(), t.to.c_str(),
                     t.ratio, t.spread, t.ns_per_light, t.entries_per_light);
    std::fclose(csv);
}

/// Prints the results whose names match the regular expression.
void print_rows(const std::string& filter) {
    const std::regex wanted(filter);
    std::vector<TableRow> table = {{"case", "tier", "to", "ratio", "spread"}};
    for (const Timed& r : results)
        if (std::regex_search(r.name, wanted))
            table.push_back({r.name, r.tier, r.to, text("%.2f", r.ratio), text("%.2f", r.spread)});
    print_table(table);
}

}  // namespace

int main(int argc, char** argv) try {
    Arguments arguments(argc, argv);
    const bool quick = arguments.take("--quick");
    const std::string filter = arguments.take("--filter", "");
    if (quick) seconds_a_case = 0.04;

    add_set("field4", field4_median, quick);
    add_set("field20", field20_median, quick);
    add_set("field200", field200_median, quick);
    add_set("near", 0, quick);
    add_scene(LIGHTBIN_SCENES "/nova.glb");
    add_all_slices(quick);
    add_masks();
    if (!quick) add_all_threads();
    add_builds(made_set("away", 1000000, away), 32);
    const Set<WorldFrame> field4 = {"field4", 10000, [] { return world_frames(10000, field4_median); }},
                          field20 = {"field20", 10000, [] { return world_frames(10000, field20_median); }},
                          many_lights = {"many_lights", 100000, many_lights_frames};
    add_sources(field4);
    add_sources(field20);
    add_sources(many_lights);
    add_all_spots(quick);
    add_boxes("boxes20", boxes20_median, timed_boxes());
    add_boxes("clipped20", clipped20_median, timed_clipped());
    {
        const std::regex wanted(filter);
        std::erase_if(cases, [&](const Case& which) { return !std::regex_search(which.name, wanted); });
        if (cases.empty()) throw std::runtime_error("no case has such a name");
        for (Progress progress; const Case& which : cases) {
            progress(which.name);
            which.time();
        }
    }
    add_scale();
    write_csv();
    print_rows(filter.empty() ? "/4096/32px/" : filter);
    conclude({}, {"binning.csv"});
    return EXIT_SUCCESS;
} catch (const std::exception& problem) {
    std::fprintf(stderr, "binning: %s\n", problem.what());
    return EXIT_FAILURE;
}
