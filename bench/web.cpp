// SPDX-License-Identifier: MIT
// web [--quick] [threads]: a whole build, lights in to lists out, as a ratio to the flat loop that is timed in turns with
// it, on rotating light sets. A line a case: set, instruction set, ratio, its spread. Or what two threads gain, coming from
// other work or from sleep, and what they gain at mere arithmetic. bench/web.sh builds it for WebAssembly and for this
// machine, and sets the two beside each other.
#include "gains.hpp"
#include "lens.hpp"
#include "pool.hpp"
#include "spots_sets.hpp"
#include "tiers.hpp"
#include "turns.hpp"

#include <lightbin/lightbin.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using lightbin::DepthTest;
using lightbin::Isa;
using lightbin::Options;

constexpr int tile_size = 32;
double seconds_a_case = 1;

struct SpotFrame {
    Spots lights;
    Lights spheres;  ///< of their whole ranges
};

/// What the flat loop, which knows no spots, makes lists of.
const Lights& spheres_of(const Frame& frame) {
    return frame.lights;
}
const Lights& spheres_of(const SpotFrame& frame) {
    return frame.spheres;
}

std::vector<Frame> field_frames(std::size_t count, float median_radius) {
    return frames_in_turn(count, [=](std::uint32_t seed) {
        return Frame{{}, field(count, median_radius, seed)};
    });
}

std::vector<SpotFrame> spot_frames(std::size_t count, float median_range) {
    return frames_in_turn(count, [=](std::uint32_t seed) {
        const Spots spots = spot_field(count, median_range, seed);
        return SpotFrame{spots, whole_spheres(spots)};
    });
}

/// Times and prints a case, once the code that runs often has been compiled for speed, as browsers do.
template <Options options, class AnyFrame>
void time_builds(const char* set, const std::vector<AnyFrame>& frames) {
    static const MadeBounds made(tile_size);
    const lightbin::View view = Lens().view(tile_size);
    const FlatView flat_view = Lens().flat_view(tile_size);
    lightbin::Binner<options> binner;
    Flat<float> flat;
    const auto time = [&](double seconds) {
        return take_turns(
            frames, seconds,
            [&](const AnyFrame& frame) {
                static_cast<void>(
                    *binner.bin(view, frame.lights, lightbin::inputs_for<options>(made.bounds)));
            },
            [&](const AnyFrame& frame) {
                flat.build<false>(flat_view, spheres_of(frame), nullptr, nullptr);
            });
    };
    time(seconds_a_case / 2);
    const Turns turns = time(seconds_a_case);
    std::printf("%s %s %.3f %.3f\n", set, to_string(options.isa), turns.ratio(), turns.spread());
    std::fflush(stdout);
}

/// On the instruction sets that WebAssembly has, too.
template <DepthTest depth_test = DepthTest::none, class AnyFrame>
void time_tiers(const char* set, const std::vector<AnyFrame>& frames) {
    visit_tier<Options{.depth_test = depth_test, .isa = Isa::scalar}>(
        [&]<Options one>() { time_builds<one>(set, frames); });
    visit_tier<Options{.depth_test = depth_test, .isa = Isa::sse2}>(
        [&]<Options one>() { time_builds<one>(set, frames); });
}

void time_threads() {
    constexpr Options options = {.isa = Isa::sse2};
    const std::vector<Frame> frames = field_frames(100000, field20_median);
    const lightbin::View view = Lens().view(tile_size);
    Pool pool(2);
    lightbin::Binner<options> binner;
    const Gains gains = measure_gains(
        {2, pool}, 4 * seconds_a_case, [&](const lightbin::Parallel& threads, std::size_t turn) {
            return binner.bin(view, frames[turn % frames.size()].lights, {}, threads)->ids().size_bytes();
        });
    std::printf("%.2f %.2f %.2f\n", gains.awake, gains.asleep, gains.sums);
}

}  // namespace

int main(int argc, char** argv) {
    bool threads = false;
    for (const std::string& word : std::vector<std::string>(argv + 1, argv + argc)) {
        if (word == "--quick") seconds_a_case = 0.2;
        threads = threads || word == "threads";
    }
    if (threads) {
        time_threads();
        return 0;
    }
    time_tiers("field4/4096", field_frames(4096, field4_median));
    const std::vector<Frame> field20 = field_frames(4096, field20_median);
    time_tiers("field20/4096", field20);
    time_tiers<DepthTest::box>("field20/4096/box", field20);
    time_tiers("field20/256", field_frames(256, field20_median));
    time_tiers("spots20/4096", spot_frames(4096, spots20_median));
}
