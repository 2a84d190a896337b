// SPDX-License-Identifier: MIT
// web [--quick]: a whole build, lights in to lists out, as a ratio to the flat loop that is timed in turns with it, on
// rotating light sets. A line a case: set, instruction set, ratio, its spread. bench/web.sh builds it for WebAssembly and
// for this machine, and sets the two beside each other.
#include "builds.hpp"
#include "spots_sets.hpp"
#include "tiers.hpp"
#include "turns.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string_view>
#include <vector>

namespace {

using lightbin::Isa;
using lightbin::Options;

constexpr int tile_size = 32;
double seconds_a_case = 1;

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

/// The spheres are those of the spots' whole ranges.
std::vector<SpotFrame> spot_frames(std::size_t count, float median_range) {
    return frames_in_turn(count, [=](std::uint32_t seed) {
        const Spots spots = spot_field(count, median_range, seed);
        return SpotFrame{spots, whole_spheres(spots)};
    });
}

/// Times and prints a case, once the code that runs often has been compiled for speed, as browsers do.
template <Options options, class AnyFrame>
void time_builds(const char* set, const std::vector<AnyFrame>& frames) {
    const lightbin::View view = Lens().view(tile_size);
    const FlatView flat_view = Lens().flat_view(tile_size);
    Build<options> build(tile_size);
    Flat<float> flat;
    const std::vector<Work<AnyFrame>> works = {
        [&](const AnyFrame& frame) { return build(view, frame.lights); },
        [&](const AnyFrame& frame) {
            flat.build<false>(flat_view, spheres_of(frame), nullptr, nullptr);
            return flat.indices.size();
        }};
    take_turns(frames, seconds_a_case / 2, works);
    const Turns turns = take_turns(frames, seconds_a_case, works);
    std::printf("%s %s %.3f %.3f\n", set, to_string(options.isa), turns.ratio(0, 1), turns.spread(0, 1));
    std::fflush(stdout);
}

/// On the instruction sets that WebAssembly has, too.
template <bool depth_test = false, class AnyFrame>
void time_tiers(const char* set, const std::vector<AnyFrame>& frames) {
    const auto time = [&]<Options one>() { time_builds<one>(set, frames); };
    visit_tier<Options{.depth_test = depth_test, .isa = Isa::scalar}>(time);
    visit_tier<Options{.depth_test = depth_test, .isa = Isa::simd128}>(time);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == "--quick") seconds_a_case = 0.2;
    time_tiers("field4/4096", field_frames(4096, field4_median));
    const std::vector<Frame> field20 = field_frames(4096, field20_median);
    time_tiers("field20/4096", field20);
    time_tiers<true>("field20/4096/box", field20);
    time_tiers("field20/256", field_frames(256, field20_median));
    time_tiers("spots20/4096", spot_frames(4096, spots20_median));
}
