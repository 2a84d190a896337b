// SPDX-License-Identifier: MIT
#include "conclusions.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

namespace {

// What is asked of a run, as sums over the views of a table.
class Measured {
public:
    explicit Measured(const std::vector<Row>& rows) : rows_(rows) {}

    struct Of {
        double ms = 0, least_ms = 0, most_ms = 0, million = 0, megabytes = 0, reduce_ms = 0;
        int views = 0;
    };
    Of of(const std::string& scene, const std::string& table, const std::string& technique,
          std::size_t lights = 0, int samples = 1) const {
        Of sum;
        for (const Row& row : rows_) {
            if (row.computed || row.scene != scene || row.table != table || row.technique != technique ||
                row.samples != samples || (lights != 0 && row.lights != lights))
                continue;
            const double ms = row.frame.median;
            sum.least_ms = sum.views == 0 ? ms : std::min(sum.least_ms, ms);
            sum.most_ms = std::max(sum.most_ms, ms);
            sum.ms += ms;
            sum.million += static_cast<double>(row.evaluations) * 1e-6;
            sum.megabytes = std::max(sum.megabytes, static_cast<double>(row.bytes) * 1e-6);
            for (const auto& [pass, times] : row.passes)
                if (pass == "reduce") sum.reduce_ms += times.median;
            ++sum.views;
        }
        return sum;
    }

private:
    const std::vector<Row>& rows_;
};

// The techniques' names, as their rows have them.
namespace name {
const char* const plain = "TiledForward";
const char* const pre_z = "TiledForward-PreZ";
const char* const both = "TiledForward-PreZ both (GPU)";
const char* const box = "TiledForward-PreZ box (GPU)";
const char* const clusters = "ClusteredForward";
const char* const indexed = "LightIndexed 16 bit";
const char* const tiled = "TiledDeferred 16 bit";
const char* const kernel = "TiledDeferred in one kernel 16 bit";
const char* const planes = "TiledDeferred six planes 16 bit";
const char* const deferred = "Deferred 16 bit";
const char* const stencil = "DeferredStencil 16 bit";
}  // namespace name

void of_evaluations(const Measured& measured, const std::string& scene, const std::string& within) {
    const auto more = [&](const std::string& table, const char* technique) {
        return measured.of(scene, table, technique).million / measured.of(scene, table, name::both).million;
    };
    if (!(more(within, name::plain) > 0)) return;  // they were not counted
    std::printf("%s, evaluations over those of pre-Z and both bounds: plain %.1f, pre-Z %.1f, box %.2f, ",
                scene.c_str(), more(within, name::plain), more(within, name::pre_z), more(within, name::box));
    std::printf("clusters %.2f, six planes %.3f", more(within, name::clusters), more(within, name::planes));
    if (more("from above", name::plain) > 0)
        std::printf("; from above: plain %.1f, clusters %.2f", more("from above", name::plain),
                    more("from above", name::clusters));
    std::printf("\n");
}

void of_times(const Measured& measured, const std::string& scene) {
    const auto path = [&](const std::string& technique) { return measured.of(scene, "path", technique); };
    if (path(name::tiled).ms > 0) {
        std::printf("%s, ms of the cheapest and of the dearest view:", scene.c_str());
        for (const char* technique : {name::tiled, name::deferred, name::stencil, name::plain, name::both})
            std::printf("%s %s %.0f to %.0f", technique == name::tiled ? "" : ",", technique,
                        path(technique).least_ms, path(technique).most_ms);
        std::printf("\n%s, ms of all views: TiledDeferred %.0f %% below pre-Z with both bounds; ",
                    scene.c_str(), 100 - 100 * path(name::tiled).ms / path(name::both).ms);
        std::printf("with 32 bits instead of 16 Deferred takes %.2f times as long, TiledDeferred %.2f\n",
                    path("Deferred 32 bit").ms / path(name::deferred).ms,
                    path("TiledDeferred 32 bit").ms / path(name::tiled).ms);
    }
    const auto one = [&](const char* technique) { return measured.of(scene, "one shader", technique).ms; };
    const auto three = [&](const char* technique) {
        return measured.of(scene, "three shaders", technique).ms;
    };
    if (one(name::both) > 0 && one(name::tiled) > 0)
        std::printf(
            "%s, three shaders instead of one: forward %+.1f ms (of %.1f), deferred %+.1f ms (of %.1f)\n",
            scene.c_str(), three(name::both) - one(name::both), one(name::both),
            three(name::tiled) - one(name::tiled), one(name::tiled));
}

void of_samples(const Measured& measured, const std::string& scene, std::size_t lights) {
    for (const char* technique : {name::indexed, name::box, name::kernel}) {
        const Measured::Of one = measured.of(scene, "MSAA", technique, lights, 1),
                           four = measured.of(scene, "MSAA", technique, lights, 4);
        if (one.views == 0 || four.views == 0) continue;
        std::printf("%s, %zu lights, 4 samples instead of one, %s: ", scene.c_str(), lights, technique);
        if (one.million > 0) std::printf("evaluations %.2f times, ", four.million / one.million);
        std::printf("memory %.1f times", four.megabytes / one.megabytes);
        if (one.ms > 0) std::printf(", time %.1f times (%.1f to %.1f ms)", four.ms / one.ms, one.ms, four.ms);
        if (one.reduce_ms > 0) std::printf(", Z bounds %.2f to %.2f ms", one.reduce_ms, four.reduce_ms);
        std::printf("\n");
    }
}

}  // namespace

void print_conclusions(const std::vector<Row>& rows) {
    const Measured measured(rows);
    std::vector<std::string> scenes;
    std::size_t most_lights = 0;
    for (const Row& row : rows) {
        if (std::ranges::find(scenes, row.scene) == scenes.end()) scenes.push_back(row.scene);
        if (row.table == "MSAA") most_lights = std::max(most_lights, row.lights);
    }
    std::printf("\nWhat the papers' sentences are here\n");
    for (const std::string& scene : scenes) {
        of_evaluations(measured, scene,
                       measured.of(scene, "path", name::plain).views > 0 ? "path" : "from within");
        of_times(measured, scene);
    }
    for (const std::string& scene : scenes)
        of_samples(measured, scene, most_lights);
}
