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

const std::string plain = "TiledForward", pre_z = "TiledForward-PreZ", both = "TiledForward-PreZ both (GPU)",
                  box = "TiledForward-PreZ box (GPU)", clusters = "ClusteredForward",
                  indexed = "LightIndexed 16 bit", kernel = "TiledDeferred in one kernel 16 bit",
                  tiled = "TiledDeferred 16 bit", stencil = "DeferredStencil 16 bit";

void of_scene(const Measured& measured, const std::string& scene) {
    const bool is_path = measured.of(scene, "path", plain).views > 0;
    const std::string within = is_path ? "path" : "from within";
    const auto million = [&](const std::string& table, const std::string& technique) {
        return measured.of(scene, table, technique).million;
    };
    if (million(within, both) > 0) {
        std::printf("%s, evaluations over those of pre-Z and both bounds: plain %.1f, pre-Z %.1f, box %.2f, "
                    "clusters %.2f, six "
                    "planes %.3f",
                    scene.c_str(), million(within, plain) / million(within, both),
                    million(within, pre_z) / million(within, both),
                    million(within, box) / million(within, both),
                    million(within, clusters) / million(within, both),
                    million(within, "TiledDeferred six planes 16 bit") / million(within, both));
        if (million("from above", both) > 0)
            std::printf("; from above: plain %.1f, clusters %.2f",
                        million("from above", plain) / million("from above", both),
                        million("from above", clusters) / million("from above", both));
        std::printf("\n");
    }
    if (is_path && measured.of(scene, "path", tiled).ms > 0) {
        std::printf("%s, ms of the cheapest and of the dearest view:", scene.c_str());
        for (const std::string& technique : {tiled, std::string("Deferred 16 bit"), stencil, plain, both}) {
            const Measured::Of its = measured.of(scene, "path", technique);
            std::printf(" %s %.0f to %.0f%s", technique.c_str(), its.least_ms, its.most_ms,
                        technique == both ? "\n" : ",");
        }
        std::printf("%s, times of all views: TiledDeferred is %.0f %% below pre-Z with both bounds; with 32 "
                    "bits instead of 16, "
                    "Deferred takes %.2f times as long, TiledDeferred %.2f\n",
                    scene.c_str(),
                    100 - 100 * measured.of(scene, "path", tiled).ms / measured.of(scene, "path", both).ms,
                    measured.of(scene, "path", "Deferred 32 bit").ms /
                        measured.of(scene, "path", "Deferred 16 bit").ms,
                    measured.of(scene, "path", "TiledDeferred 32 bit").ms /
                        measured.of(scene, "path", tiled).ms);
    }
    const Measured::Of one_forward = measured.of(scene, "one shader", both),
                       one_deferred = measured.of(scene, "one shader", tiled);
    if (one_forward.ms > 0 && one_deferred.ms > 0)
        std::printf(
            "%s, three shaders instead of one: forward %+.1f ms (of %.1f), deferred %+.1f ms (of %.1f)\n",
            scene.c_str(), measured.of(scene, "three shaders", both).ms - one_forward.ms, one_forward.ms,
            measured.of(scene, "three shaders", tiled).ms - one_deferred.ms, one_deferred.ms);
}

void of_samples(const Measured& measured, const std::string& scene, std::size_t lights) {
    for (const std::string& technique : {indexed, box, kernel}) {
        const Measured::Of one = measured.of(scene, "MSAA", technique, lights, 1),
                           four = measured.of(scene, "MSAA", technique, lights, 4);
        if (one.views == 0 || four.views == 0) continue;
        std::printf("%s, %zu lights, 4 samples instead of one, %s: ", scene.c_str(), lights,
                    technique.c_str());
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
    for (const std::string& scene : scenes)
        of_scene(measured, scene);
    for (const std::string& scene : scenes)
        of_samples(measured, scene, most_lights);
}
