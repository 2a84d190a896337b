// SPDX-License-Identifier: MIT
// A whole build, spheres in to lists out, against the flat baseline measured in turns in the same run, on rotating light
// sets; with clusters and z-bins; from world space and structs against view-space vec4s; of several views; spots against
// spheres. Says how many of the project's goals are met and which are missed by most, and writes binning.csv,
// binning_slices.csv, binning_sources.csv, binning_views.csv, binning_spots.csv and binning_goals.csv.
#include "console.hpp"
#include "flat.hpp"
#include "gains.hpp"
#include "glb_scenes.hpp"
#include "goals.hpp"
#include "lens.hpp"
#include "measure.hpp"
#include "memory.hpp"
#include "reference.hpp"
#include "several_views.hpp"
#include "slicing.hpp"
#include "sources.hpp"
#include "spots_time.hpp"
#include "tiers.hpp"
#include "world.hpp"

#include <lightbin/binner.hpp>

#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace {

using lightbin::DepthTest;
using lightbin::Footprint;
using lightbin::IdWidth;
using lightbin::Isa;
using lightbin::Options;
using lightbin::Slicing;

double seconds_a_case = 0.3;
std::vector<Result> results;
std::vector<SlicingResult> slicing_results;
std::vector<SourceResult> source_results;
std::vector<SeveralViewsResult> several_views_results;
std::vector<SpotTime> spot_times;

template <class Frame> using Make = std::function<std::vector<Frame>()>;

struct Case {
    std::string set;
    std::size_t lights;
    int tile_size;
    Make<Frame> frames;
    int threads = 1;
};

/// What `make` makes, kept while those who follow ask for the same.
template <class Frame>
const std::vector<Frame>& keep_frames(const std::string& key, const Make<Frame>& make) {
    static std::vector<Frame> frames;
    static std::string kept;
    if (kept != key) {
        frames.clear();
        frames = make();
        kept = key;
    }
    return frames;
}

const std::vector<Frame>& frames_of(const Case& which) {
    return keep_frames(which.set + "/" + std::to_string(which.lights), which.frames);
}

/// The frames of a case, ready to be built by lightbin and by the baseline.
template <Options options> class Builds {
public:
    using Id = typename lightbin::Binner<options>::Id;

    explicit Builds(const Case& which)
        : frames_(frames_of(which)), tile_size_(which.tile_size), made_(which.tile_size) {
        // One view for all frames that have it in common, as a program would: it stays in the cache.
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            if (i == 0 || !frames_[i].lens.same(frames_[i - 1].lens)) {
                views_.push_back(frames_[i].lens.view(tile_size_));
                flat_views_.push_back(frames_[i].lens.flat_view(tile_size_));
            }
            view_of_.push_back(views_.size() - 1);
        }
    }

    std::size_t count() const { return frames_.size(); }
    const Lights& lights(std::size_t frame) const { return frames_[frame].lights; }
    std::size_t table_bytes() const { return sizeof(lightbin::ListRange) * views_[0].tile_count(); }

    lightbin::LightGrid<Id> ours(const lightbin::Parallel& threads, std::size_t frame) {
        return *binner_.bin(views_[view_of_[frame]], frames_[frame].lights,
                            lightbin::inputs_for<options>(made_.bounds), threads);
    }
    /// The baseline, which has the depth test `interval` too.
    void theirs(std::size_t frame) {
        flat_.build<options.depth_test == DepthTest::interval>(
            flat_views_[view_of_[frame]], frames_[frame].lights, made_.min.data(), made_.max.data());
    }
    void verify_first(const lightbin::Parallel& threads) {
        verify(frames_[0], tile_size_, ours(threads, 0), options, made_.bounds);
    }

private:
    const std::vector<Frame>& frames_;
    int tile_size_;
    MadeBounds made_;
    std::vector<lightbin::View> views_;
    std::vector<FlatView> flat_views_;
    std::vector<std::size_t> view_of_;  ///< of each frame
    Flat<float> flat_;
    lightbin::Binner<options> binner_;
};

/// Seconds of each turn.
struct Times {
    std::vector<double> ours, theirs, stores, clears, reads, ratios;
    double entries = 0;        ///< that ours made in a turn, in the mean
    std::size_t together = 1;  ///< frames a turn
};

/// Times one case. In turns: the baseline, ours, storing the list once, clearing the tile table, and of a million lights
/// reading them. Each time a few frames together where one is too short for the clock. Whether ours comes first
/// alternates, as the second finds the lights in the cache; reading them comes where ours does not.
template <Options options>
Times time_in_turns(Builds<options>& builds, std::size_t lights, const lightbin::Parallel& parallel) {
    constexpr std::size_t id_size = sizeof(typename Builds<options>::Id);
    Times times;
    times.together = std::max<std::size_t>(1, 256 / std::max<std::size_t>(lights, 1));
    std::vector<char> list, table(builds.table_bytes());
    double spent = 0;
    std::size_t turn = 0;
    while (spent < seconds_a_case || times.ours.size() < 5) {
        const std::size_t first = turn++ * times.together;
        std::size_t written = 0;
        const auto each = [&](auto work) {
            for (std::size_t i = 0; i < times.together; ++i)
                work((first + i) % builds.count());
        };
        const auto time_ours = [&] {
            times.ours.push_back(seconds([&] {
                each([&](std::size_t frame) { written += builds.ours(parallel, frame).ids().size(); });
            }));
        };
        const auto time_reads = [&] {
            if (lights >= 1000000)
                times.reads.push_back(seconds([&] { read(builds.lights(first % builds.count())); }));
        };
        turn % 2 == 0 ? time_ours() : time_reads();
        times.theirs.push_back(seconds([&] { each([&](std::size_t frame) { builds.theirs(frame); }); }));
        turn % 2 == 1 ? time_ours() : time_reads();
        times.entries += double(written);
        written *= id_size;
        list.resize(std::max(list.size(), written));
        times.stores.push_back(seconds([&] {
            const std::size_t share = written / parallel.workers();
            parallel.run(parallel.workers(), [&](std::size_t i) { fill(list.data() + i * share, share); });
        }));
        times.clears.push_back(
            seconds([&] { each([&](std::size_t) { fill(table.data(), table.size()); }); }));
        times.ratios.push_back(times.ours.back() / times.theirs.back());
        spent += times.ours.back() + times.theirs.back() + times.stores.back();
    }
    times.entries /= double(turn);
    return times;
}

Result result_of(const Case& which, const Options& options, const Times& times) {
    const double lights = double(std::max<std::size_t>(which.lights, 1) * times.together),
                 ns = 1e9 * median(times.ours);
    return {.set = which.set,
            .lights = which.lights,
            .tile_size = which.tile_size,
            .footprint = to_string(options.footprint),
            .depth_test = to_string(options.depth_test),
            .tier = to_string(options.isa),
            .threads = which.threads,
            .ns_per_light = ns / lights,
            .ns_per_entry = ns / std::max(times.entries, 1.0),
            .ratio = ns / (1e9 * median(times.theirs)),
            .spread = percentile(times.ratios, 0.9) - percentile(times.ratios, 0.1),
            .entries_per_light = times.entries / lights,
            .store_ratio = ns / (1e9 * median(times.stores)),
            .clear_ratio = ns / (1e9 * median(times.clears)),
            .read_ratio = times.reads.empty() ? 0 : ns / (1e9 * median(times.reads)),
            .gains = {}};
}

/// lightbin's work on at most so many of oneTBB's threads.
class TbbLoop {
public:
    explicit TbbLoop(int threads) : arena_(threads) {}
    template <class Body> void operator()(std::size_t n, const Body& body) {
        arena_.execute([&] { tbb::parallel_for(std::size_t{0}, n, body); });
    }

private:
    tbb::task_arena arena_;
};

/// Verifies one case, times it, and where it has threads measures what they gain.
template <Options options> void build(benchmark::State& state, const Case& which) {
    TbbLoop loop(which.threads);
    const lightbin::Parallel parallel =
        which.threads > 1 ? lightbin::Parallel(std::size_t(which.threads), loop) : lightbin::Parallel();
    Builds<options> builds(which);
    builds.verify_first(parallel);
    Times times;
    for (auto _ : state) {
        times = time_in_turns(builds, which.lights, parallel);
        state.SetIterationTime(median(times.ours) / double(times.together));
    }
    Result result = result_of(which, options, times);
    if (which.threads > 1)
        result.gains =
            measure_gains(parallel, seconds_a_case, [&](const lightbin::Parallel& threads, std::size_t turn) {
                return builds.ours(threads, turn % builds.count()).ids().size_bytes();
            });
    results.push_back(result);
}

template <Options options> void build_slices(benchmark::State& state, const Case& which) {
    const std::vector<Frame>& frames = frames_of(which);
    for (auto _ : state) {
        if constexpr (options.slicing == Slicing::clusters)
            slicing_results.push_back(time_clusters<options>(which.set, frames, seconds_a_case));
        else
            slicing_results.push_back(time_z_bins<options>(which.set, frames, seconds_a_case));
        state.SetIterationTime(1e-9 * slicing_results.back().ns_per_light * double(which.lights));
    }
}

/// The same set in world space and in structs.
struct SourceCase {
    std::string set;
    Make<WorldFrame> frames;
};

template <Options options> void build_sources(benchmark::State& state, const SourceCase& which) {
    const std::vector<WorldFrame>& frames = keep_frames(which.set, which.frames);
    for (auto _ : state) {
        source_results.push_back(time_sources<options>(which.set, 32, frames, seconds_a_case));
        state.SetIterationTime(source_results.back().seconds[world_vec4s]);
    }
}

template <Options options> void build_views(benchmark::State& state, const SourceCase& which) {
    const std::vector<WorldFrame>& frames = keep_frames(which.set, which.frames);
    for (auto _ : state) {
        for (const SeveralViews& views : {two_eyes(frames[0].view.lens), cube_faces()})
            several_views_results.push_back(
                time_several_views<options>(views, which.set, 32, frames, seconds_a_case));
        state.SetIterationTime(several_views_results.back().all);
    }
}

void build_spots(benchmark::State& state, const SpotTimeCase& which) {
    for (auto _ : state) {
        spot_times.push_back(which.time(seconds_a_case));
        state.SetIterationTime(1e-9 * spot_times.back().ns_per_spot * double(spot_times.back().lights));
    }
}

/// Google Benchmark's lines: the case that was measured last, as progress.
class Names : public benchmark::BenchmarkReporter {
public:
    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override { progress_(runs.back().run_name.function_name); }

private:
    Progress progress_;
};

/// What the usual build takes, of each made set: 4,096 lights, 32-pixel tiles, no depth test.
std::string usual_ratios() {
    std::string all;
    for (const Result& r : results)
        if (!r.set.ends_with("-u16") && r.lights == 4096 && r.tile_size == 32 && r.depth_test == "none" &&
            r.footprint == "rectangle" && r.threads == 1 && r.tier == to_string(lightbin::machine_isa()))
            all += text("%s %s %.2f (%.2f)", all.empty() ? "" : ",", r.set.c_str(), r.ratio, r.spread);
    return all;
}

void print_verdict() {
    Goals goals;
    add_goals(results, goals);
    add_scale_goals(results, goals);
    add_slicing_goals(slicing_results, goals);
    add_source_goals(source_results, goals);
    add_spot_time_goals(spot_times, goals);
    goals.write_csv("binning_goals.csv");
    goals.print();
    std::vector<std::string> verdict;
    const std::string ratios = usual_ratios();
    if (!ratios.empty())
        verdict.push_back(std::string("A build as a ratio to the flat loop, by ") +
                          to_string(lightbin::machine_isa()) + ", in brackets the spread:" + ratios + ".");
    if (!goals.empty()) verdict.push_back(goals.sentence());
    if (!results.empty()) verdict.push_back(slower_tiers(results));
    if (const std::string gains = gains_of_threads(results); !gains.empty()) verdict.push_back(gains);
    conclude(verdict, {"binning.csv", "binning_slices.csv", "binning_sources.csv", "binning_views.csv",
                       "binning_spots.csv", "binning_goals.csv"});
}

/// `name` is what a filter finds it by.
template <class Which>
void add(const std::string& name, void (*run)(benchmark::State&, const Which&), const Which& which) {
    benchmark::RegisterBenchmark(name.c_str(), run, which)->Iterations(1)->UseManualTime();
}

template <Options options> void add_build(const Case& which) {
    visit_tier<options>([&]<Options one>() {
        add(which.set + "/" + std::to_string(which.lights) + "/" + std::to_string(which.tile_size) + "px/" +
                to_string(one.footprint) + "/" + to_string(one.depth_test) + "/" + to_string(one.isa) + "/" +
                std::to_string(which.threads),
            build<one>, which);
    });
}

template <DepthTest depth_test = DepthTest::none, Footprint footprint = Footprint::rectangle,
          IdWidth ids = IdWidth::u32>
void add_tiers(const Case& which) {
    each_tier<{.ids = ids, .footprint = footprint, .depth_test = depth_test}>(
        [&]<Options one>() { add_build<one>(which); });
}

template <DepthTest depth_test = DepthTest::none> void add_sources(const SourceCase& which) {
    each_tier<{.depth_test = depth_test}>([&]<Options one>() {
        add("sources/" + which.set + "/" + to_string(depth_test) + "/" + to_string(one.isa),
            build_sources<one>, which);
    });
}

template <Slicing slicing, DepthTest depth_test = DepthTest::none> void add_slices(const Case& which) {
    each_tier<{.depth_test = depth_test, .slicing = slicing}>([&]<Options one>() {
        add("slices/" + which.set + "/" + std::to_string(which.lights) + "/" + to_string(slicing) + "/" +
                to_string(depth_test) + "/" + to_string(one.isa),
            build_slices<one>, which);
    });
}

void add_views(const SourceCase& which) {
    each_tier<{}>([&]<Options one>() {
        add("views/" + which.set + "/" + to_string(one.isa), build_views<one>, which);
    });
}

void add_rungs(const Case& which) {
    add_tiers<DepthTest::interval>(which);
    add_tiers<DepthTest::box>(which);
    add_tiers<DepthTest::split_box>(which);
    add_tiers<DepthTest::none, Footprint::silhouette>(which);
    add_tiers<DepthTest::box, Footprint::silhouette>(which);
}

/// 2, 4, ... threads, as far as the machine has them.
void add_threads(Case which) {
    const int most = int(std::thread::hardware_concurrency());
    for (which.threads = 2; which.threads <= most; which.threads *= 2) {
#if defined(LIGHTBIN_X86)
        add_build<Options{.isa = Isa::avx2}>(which);
#endif
        add_build<Options{}>(which);
    }
}

/// Frames of `count` lights each of one of the made sets.
template <class MakeLights> Make<Frame> made_frames(std::size_t count, Lens lens, MakeLights make) {
    return [=] {
        return frames_in_turn(count, [&](std::uint32_t seed) { return Frame{lens, make(count, seed)}; });
    };
}

/// All that is timed of one of the made sets. median 0: the near set.
void add_set(const std::string& set, float median, double footprint, bool quick) {
    const auto make = [median](std::size_t count, std::uint32_t seed) {
        return median > 0 ? field(count, median, seed) : near_eye(count, seed);
    };
    const auto add_number = [&](std::size_t n, bool in_goals) {
        for (const int tile : {8, 16, 32, 64}) {
            const bool often = tile == 16 || tile == 32;
            if (tile != 32 && (!in_goals || (quick && !often))) continue;
            if (footprint * double(n) * 1024 / (tile * tile) > 6e7) continue;  // gigabytes of lists
            const Case which = {set, n, tile, made_frames(n, {}, make)};
            add_tiers(which);
            if (in_goals && often && (median == field20_median || (n == 4096 && tile == 32)))
                add_rungs(which);
            if (tile == 32 && n == 10000)
                add_tiers<DepthTest::none, Footprint::rectangle, IdWidth::u16>(
                    {set + "-u16", n, tile, which.frames});
            if (tile == 32 && (n == 256 || n >= 10000)) add_threads(which);
        }
        Lens uhd;
        uhd.screen = {3840, 2160};
        if (footprint <= 20 && (n == 256 || n == 10000))
            add_tiers({set + "-4k", n, 16, made_frames(n, uhd, make)});
    };
    for (const std::size_t n : {256u, 1000u, 4096u, 10000u})
        if (!quick || n == 256 || n == 4096) add_number(n, true);
    for (const std::size_t n : {0u, 1u, 100000u, 1000000u})
        if (!quick || n <= 1) add_number(n, false);
}

/// Clusters and z-bins of the field sets.
void add_all_slices(bool quick) {
    const auto set = [](const char* name, float median, std::size_t n) {
        const auto make = [median](std::size_t count, std::uint32_t seed) {
            return field(count, median, seed);
        };
        return Case{name, n, 0, made_frames(n, {}, make)};
    };
    const auto add_clusters = [](const Case& which) {
        add_slices<Slicing::clusters>(which);
        add_slices<Slicing::clusters, DepthTest::box>(which);
    };
    for (const std::size_t n : {256u, 1000u, 4096u, 10000u}) {
        const Case which = set("field20", field20_median, n);
        const bool round = n == 1000 || n == 10000;
        if (!quick || round) add_clusters(which);
        if (round) add_slices<Slicing::z_bins>(which);
    }
    if (quick) return;
    add_clusters(set("field4", field4_median, 4096));
    add_clusters(set("field200", field200_median, 4096));
    add_slices<Slicing::z_bins>(set("field4", field4_median, 10000));
}

/// Lights 99 % of which are out of view: behind the eye, or to the side.
Lights away(std::size_t count, std::uint32_t seed) {
    Lights lights = field(count, field4_median, seed);
    for (std::size_t i = 0; i < count; ++i)
        if (i % 100 != 0) (i % 2 == 0 ? lights[i].z : lights[i].x) += 600;
    return lights;
}

int run(int argc, char** argv) {
    bool quick = false;
    std::vector<std::string> paths = {LIGHTBIN_SCENES "/nova.glb", LIGHTBIN_SCENES "/darkness.glb"};
    std::vector<char*> rest = {argv[0]};
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--quick")
            quick = true;
        else if (word.size() > 4 && word.ends_with(".glb"))
            paths.push_back(word);
        else
            rest.push_back(argv[i]);
    }
    int count = int(rest.size());
    rest.push_back(nullptr);
    benchmark::Initialize(&count, rest.data());
    if (benchmark::ReportUnrecognizedArguments(count, rest.data())) return 2;
    if (quick) seconds_a_case = 0.04;

    add_set("field4", field4_median, 4, quick);
    add_set("field20", field20_median, 20, quick);
    add_set("field200", field200_median, 200, quick);
    add_set("near", 0, 200, quick);
    for (const std::string& path : paths) {
        const std::vector<BenchScene> views = glb_scenes(path);
        const std::string set = views[0].name.substr(0, views[0].name.rfind(':'));
        const std::size_t lights = views[0].lights(0).size();
        for (const int tile : {8, 16, 32, 64})
            if (!quick || tile == 32)
                add_tiers({set, lights, tile, [=] { return scene_frames(views, lights); }});
    }
    add_all_slices(quick);
    add_tiers({"away", 1000000, 32, made_frames(1000000, {}, away)});
    const SourceCase field4 = {"field4", [] { return world_frames(10000, field4_median); }},
                     field20 = {"field20", [] { return world_frames(10000, field20_median); }},
                     many_lights = {"many_lights", many_lights_frames};
    add_sources(field4);
    add_sources(field20);
    add_sources<DepthTest::box>(field20);
    add_sources(many_lights);
    add_views(many_lights);
    add_views(field20);
    for (const SpotTimeCase& which : spot_time_cases(quick))
        add(which.name, build_spots, which);
    {
        Names names;
        benchmark::RunSpecifiedBenchmarks(&names);
    }
    write_csv(results, "binning.csv");
    write_slicing_csv(slicing_results, "binning_slices.csv");
    write_sources_csv(source_results, "binning_sources.csv");
    write_several_views_csv(several_views_results, "binning_views.csv");
    write_spot_times(spot_times, "binning_spots.csv");
    print_verdict();
    return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "binning: %s\n", problem.what());
        return EXIT_FAILURE;
    }
}
