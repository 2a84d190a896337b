// SPDX-License-Identifier: MIT
// What a build takes by what the lights are: vec4s or structs, in view space or world space; and what it takes a user who
// moves them in a loop of the program's own.
#pragma once

#include "goals.hpp"
#include "measure.hpp"
#include "reference.hpp"
#include "world.hpp"

#include <lightbin/binner.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <iterator>
#include <string>
#include <vector>

enum Source { view_vec4s, world_vec4s, view_structs, world_structs, loop_vec4s, loop_structs };
inline constexpr const char* source_names[] = {"view_vec4s",    "world_vec4s", "view_structs",
                                               "world_structs", "loop_vec4s",  "loop_structs"};
inline constexpr std::size_t source_count = std::size(source_names);

struct SourceResult {
    std::string set;
    std::size_t lights;
    int tile_size;
    std::string depth_test, tier;
    double seconds[source_count];  ///< a build, in the median; 0 where there was none

    double ratio(Source source, Source to = view_vec4s) const { return seconds[source] / seconds[to]; }
};

inline glm::vec4 centre_of(const glm::vec4& light) {
    return glm::vec4(light.x, light.y, light.z, 1);
}
inline glm::vec4 centre_of(const UserLight& light) {
    return glm::vec4(light.position, 1);
}
inline float radius_of(const glm::vec4& light) {
    return light.w;
}
inline float radius_of(const UserLight& light) {
    return light.radius;
}

/// The loop a user would write: GLM moves the centres, radii stay. Not inlined, and the matrix a copy that no store can
/// change: as quick as compilers make it.
template <class Light>
[[gnu::noinline]] void move_lights(const std::vector<Light>& lights, const glm::mat4 view_matrix,
                                   Lights& moved) {
    moved.resize(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        glm::vec4 light = view_matrix * centre_of(lights[i]);
        light.w = radius_of(lights[i]);
        moved[i] = light;
    }
}

/// Builds one frame's lists from each form of its lights.
template <lightbin::Options options> class SourceBuilds {
public:
    SourceBuilds(const Lens& lens, int tile_size)
        : tile_size_(tile_size), view_(lens.view(tile_size)), made_(tile_size) {}

    using Grid = lightbin::LightGrid<typename lightbin::Binner<options>::Id>;

    Grid build(Source source, const WorldFrame& frame) {
        const auto bin = [&](const auto& lights) {
            return *binner_.bin(view_, lights, lightbin::inputs_for<options>(made_.bounds));
        };
        switch (source) {
        case view_vec4s:
            return bin(frame.view.lights);
        case world_vec4s:
            return bin(lightbin::world_space(frame.lights, frame.view_matrix));
        case view_structs:
            return bin(lightbin::view_space(frame.view_structs, sphere_of));
        case world_structs:
            return bin(lightbin::world_space(frame.structs, frame.view_matrix, sphere_of));
        case loop_vec4s:
            move_lights(frame.lights, frame.view_matrix, moved_);
            break;
        case loop_structs:
            move_lights(frame.structs, frame.view_matrix, moved_);
            break;
        }
        return bin(moved_);
    }
    /// The user's own loop rounds either way, so what comes of that is held to nothing.
    void verify_frame(Source source, const WorldFrame& frame) {
        if (source != loop_vec4s && source != loop_structs)
            verify(frame.view, tile_size_, build(source, frame), options, made_.bounds);
    }

private:
    int tile_size_;
    lightbin::View view_;
    MadeBounds made_;
    lightbin::Binner<options> binner_;
    Lights moved_;
};

/// Times each source in turns. In a turn they take different frames, so that none finds its lights where another one left
/// them in the cache; all take every frame.
template <lightbin::Options options>
SourceResult time_sources(const std::string& set, int tile_size, const std::vector<WorldFrame>& frames,
                          double seconds_a_source) {
    SourceBuilds<options> builds(frames[0].view.lens, tile_size);
    std::vector<Source> sources = {view_vec4s, world_vec4s, loop_vec4s};
    if (!frames[0].structs.empty())
        sources.insert(sources.end(), {view_structs, world_structs, loop_structs});
    for (const Source source : sources)
        builds.verify_frame(source, frames[0]);
    std::vector<double> times[source_count];
    const double end = time_now() + seconds_a_source * double(sources.size());
    for (std::size_t turn = 0; time_now() < end || turn < 5; ++turn)
        for (std::size_t i = 0; i < sources.size(); ++i) {
            const Source source = sources[(turn + i) % sources.size()];
            const WorldFrame& frame = frames[(turn + source) % frames.size()];
            times[source].push_back(seconds([&] { builds.build(source, frame); }));
        }
    SourceResult result = {
        set, frames[0].lights.size(), tile_size, to_string(options.depth_test), to_string(options.isa), {}};
    for (const Source source : sources)
        result.seconds[source] = median(times[source]);
    return result;
}

inline void write_sources_csv(const std::vector<SourceResult>& results, const char* path) {
    std::FILE* const csv =
        open_report(path, "set,n,tile_px,depth_test,tier,source,ns_per_light,ratio_to_view_vec4s");
    for (const SourceResult& r : results)
        for (std::size_t i = 0; i < source_count; ++i)
            if (r.seconds[i] > 0)
                std::fprintf(csv, "%s,%zu,%d,%s,%s,%s,%.3f,%.4f\n", r.set.c_str(), r.lights, r.tile_size,
                             r.depth_test.c_str(), r.tier.c_str(), source_names[i],
                             1e9 * r.seconds[i] / double(r.lights), r.ratio(Source(i)));
    std::fclose(csv);
}

inline void add_source_goals(const std::vector<SourceResult>& results, Goals& goals) {
    for (const char* const tier : goal_tiers) {
        const auto add = [&](const char* what, bool many, Source source, Source to, double must, double aim) {
            double worst = 0;
            for (const SourceResult& r : results)
                if (r.tier == tier && (r.set == "many_lights") == many)
                    worst = std::max(worst, r.ratio(source, to));
            goals.add("what the lights are", what, tier, {must, aim}, worst);
        };
        add("10,000 world-space vec4s", false, world_vec4s, view_vec4s, 1.15, 1.05);
        add("10,000 structs of 64 bytes, view space", false, view_structs, view_vec4s, 1.15, 1.05);
        add("10,000 structs of 64 bytes, world space", false, world_structs, view_vec4s, 1.25, 1.1);
        add("many_lights, world-space vec4s", true, world_vec4s, view_vec4s, 1.5, 1.2);
        add("10,000 world-space vec4s, to a loop of one's own", false, world_vec4s, loop_vec4s, 1, 1);
        add("10,000 structs, world space, to a loop of one's own", false, world_structs, loop_structs, 1, 1);
        add("many_lights, world-space vec4s, to a loop", true, world_vec4s, loop_vec4s, 1, 1);
    }
}
