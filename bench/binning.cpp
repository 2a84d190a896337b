// SPDX-License-Identifier: MIT
// A whole build, spheres in to lists out, against the flat baseline measured in turns in the same run, on
// rotating light sets. Prints Google Benchmark's table and writes binning.csv.
#include "flat.hpp"
#include "sets.hpp"

#include <lightbin/lightbin.hpp>

#include <benchmark/benchmark.h>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/mat4x4.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

using lightbin::DepthTest;
using lightbin::Isa;

constexpr lightbin::Extent screen = {1920, 1080};
const char* const tier_names[] = {"scalar", "sse2", "avx2", "avx512"};
std::FILE* csv = nullptr;

struct Case {
    std::string set;
    float median_radius;  ///< of the field sets; 0: the near set
    std::size_t lights;
    int tile_size;
};

/// Per tile a slab of depth on a plane that runs away from the viewer: what a ground with things on it gives.
void ground_bounds(const lightbin::View& view, std::vector<float>& min, std::vector<float>& max) {
    for (int y = 0; y < view.tiles_y(); ++y)
        for (int x = 0; x < view.tiles_x(); ++x) {
            const float depth =
                2.0f +
                150.0f * std::pow(static_cast<float>(y + 1) / static_cast<float>(view.tiles_y()), 3.0f);
            min.push_back(0.9f * depth);
            max.push_back(1.25f * depth + static_cast<float>(x * 7 % 11));
        }
}

template <class Work> double seconds(Work work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double percentile(std::vector<double>& values, double share) {
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

/// Stops the run unless the lists hold what the baseline in double precision finds, give or take the lights
/// that it decides by a hair, and little more.
template <class Grid>
void verify(const FlatView& flat_view, const Lights& lights, const Grid& grid, const float* min,
            const float* max, bool with_depth) {
    Flat<double> flat;
    with_depth ? flat.build<true>(flat_view, lights, min, max)
               : flat.build<false>(flat_view, lights, min, max);
    std::size_t missing = 0, extra = 0, common = 0;
    for (std::size_t tile = 0; tile < grid.tiles().size(); ++tile) {
        const auto ours = grid.indices().subspan(grid.tiles()[tile].offset, grid.tiles()[tile].count);
        const auto theirs =
            std::span(flat.indices).subspan(flat.offsets[tile], flat.offsets[tile + 1] - flat.offsets[tile]);
        std::vector<std::uint32_t> shared;
        std::set_intersection(ours.begin(), ours.end(), theirs.begin(), theirs.end(),
                              std::back_inserter(shared));
        missing += theirs.size() - shared.size();
        extra += ours.size() - shared.size();
        common += shared.size();
    }
    if (missing * 100000 <= common && extra * 500 <= common + 1000) return;
    std::fprintf(stderr, "binning: wrong lists: %zu entries are missing, %zu are extra, %zu are right\n",
                 missing, extra, common);
    std::exit(EXIT_FAILURE);
}

template <DepthTest depth_test, Isa isa> void build(benchmark::State& state, const Case& which) {
    constexpr bool with_depth = depth_test != DepthTest::none;
    const glm::mat4 projection = glm::perspectiveRH_NO(2 * std::atan(tan_half_fov), aspect, 0.1f, 1000.0f);
    const lightbin::View view =
        *lightbin::View::from_projection(projection, screen, {.tile_size = which.tile_size});
    const double tile = which.tile_size;
    const FlatView flat_view = {.tiles_x = view.tiles_x(),
                                .tiles_y = view.tiles_y(),
                                .width = screen.width / tile,
                                .height = screen.height / tile,
                                .scale = 0.5 * screen.height / tan_half_fov / tile,
                                .near_depth = 0.1,
                                .far_depth = 1000};
    std::vector<float> min, max;
    ground_bounds(view, min, max);

    // A set that is met again and again is learnt by the branch predictor.
    const std::size_t rotation = std::max<std::size_t>(48, 50000 / which.lights);
    std::vector<Lights> sets;
    for (std::uint32_t seed = 0; seed < (which.lights > 20000 ? 4 : rotation); ++seed)
        sets.push_back(which.median_radius > 0 ? field(which.lights, which.median_radius, seed)
                                               : near_eye(which.lights, seed));

    Flat<float> flat;
    lightbin::Binner<lightbin::Options{.depth_test = depth_test, .isa = isa}> binner;
    const auto bin = [&](const Lights& lights) {
        if constexpr (with_depth)
            return binner.bin(view, lights, {min, max});
        else
            return binner.bin(view, lights);
    };
    verify(flat_view, sets[0], *bin(sets[0]), min.data(), max.data(), with_depth);

    std::vector<double> ours, theirs, ratios;
    double entries = 0;
    std::size_t turn = 0;
    for (auto _ : state) {
        const Lights& lights = sets[turn++ % sets.size()];
        const double baseline =
            seconds([&] { flat.build<with_depth>(flat_view, lights, min.data(), max.data()); });
        const double time = seconds([&] { entries += static_cast<double>(bin(lights)->indices().size()); });
        state.SetIterationTime(time);
        ours.push_back(time);
        theirs.push_back(baseline);
        ratios.push_back(time / baseline);
    }
    const double n = static_cast<double>(which.lights), time = percentile(ours, 0.5);
    entries /= static_cast<double>(ours.size());
    const double ratio = time / percentile(theirs, 0.5);
    const double spread =
        percentile(ratios, 0.9) - percentile(ratios, 0.1);  // of single builds, in the ratio's unit
    state.counters["ratio"] = ratio;
    state.counters["spread"] = spread;
    state.counters["ns/light"] = 1e9 * time / n;
    std::fprintf(csv, "%s,%zu,%d,%.1f,%s,%s,1,%.2f,%.3f,%.3f,%.3f\n", which.set.c_str(), which.lights,
                 which.tile_size, entries / n, with_depth ? "interval" : "none",
                 tier_names[static_cast<int>(isa)], 1e9 * time / n, 1e9 * time / entries, ratio, spread);
}

template <DepthTest depth_test, Isa isa> void add(const Case& which) {
    if (lightbin::detail::machine_isa(isa) != isa) return;  // not on this machine
    const std::string name =
        which.set + "/" + std::to_string(which.lights) + "/" + std::to_string(which.tile_size) + "px/" +
        (depth_test == DepthTest::none ? "none/" : "interval/") + tier_names[static_cast<int>(isa)];
    benchmark::RegisterBenchmark(name.c_str(), build<depth_test, isa>, which)
        ->UseManualTime()
        ->Unit(benchmark::kMicrosecond);
}

template <DepthTest depth_test> void add_tiers(const Case& which) {
    add<depth_test, Isa::scalar>(which);
    add<depth_test, Isa::sse2>(which);
    add<depth_test, Isa::avx2>(which);
    add<depth_test, Isa::avx512>(which);
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
    std::string minimum_time = quick ? "--benchmark_min_time=0.01" : "--benchmark_min_time=0.1";
    char* arguments[] = {argv[0], minimum_time.data(), nullptr};
    int count = 2;
    benchmark::Initialize(&count, arguments);
    csv = std::fopen("binning.csv", "w");
    if (csv == nullptr) return std::perror("binning: binning.csv"), EXIT_FAILURE;
    std::fputs(
        "set,n,tile_px,footprint,depth_test,tier,threads,ns_per_light,ns_per_entry,ratio_to_flat,spread\n",
        csv);

    const std::vector<std::size_t> numbers = quick ? std::vector<std::size_t>{256, 4096}
                                                   : std::vector<std::size_t>{256, 1000, 4096, 10000, 100000};
    for (const auto& [set, median] : {std::pair("field4", 2.0f), std::pair("field20", 6.1154f),
                                      std::pair("field200", 24.0f), std::pair("near", 0.0f)})
        for (const int tile : {32, 16})
            for (const std::size_t lights : numbers) {
                if (lights > 10000 && (tile == 16 || median == 0 || median > 10))
                    continue;  // gigabytes of lists
                add_tiers<DepthTest::none>({set, median, lights, tile});
                if (!quick || tile == 16) add_tiers<DepthTest::interval>({set, median, lights, tile});
            }
    benchmark::RunSpecifiedBenchmarks();
    std::fclose(csv);
}
