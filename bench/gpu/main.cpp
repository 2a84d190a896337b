// SPDX-License-Identifier: MIT
// gpu [--quick]: builds by shader_cull on this machine's GPU beside builds on the CPU with their upload, of 1,000 to
// 100,000 lights; their lists are compared.
#include "measure.hpp"

#include "../arguments.hpp"

#include <lightbin/lightbin.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using lightbin::Options;
using lightbin::Slicing;

class Measuring {
public:
    explicit Measuring(bool quick) : quick_(quick) {
        turns_ =
            device_.is_software() ? TurnsOf{quick ? 1 : 3, 0} : TurnsOf{quick ? 15 : 101, quick ? 20 : 60};
        std::printf("%s\n", device_.name().c_str());
        if (device_.is_software())
            std::printf("This device is the CPU: its times say little about a GPU's. Compare lists and "
                        "bytes.\n");
        std::fflush(stdout);
    }

    std::vector<GpuRow> rows() {
        for (const std::size_t lights : {1000u, 10000u, 100000u})
            if (!quick_ || lights < 100000 || !device_.is_software())
                measure_source(field_source(lights, field20_median, "field, 20 tiles a light"), true);
        measure_tiles(field_source(10000, field11_median, "field, 11 tiles a light"));
        measure_tiles(field_source(10000, 0.01f, "field, a tile or two a light"));
        measure_source(many_lights_source(), false);
        return rows_;
    }

private:
    void measure_tiles(const LightSource& source) {
        measure_one<Options{}>(source, "tiles, 32 px", 32);
        measure_one<Options{}, true>(source, "masks, 32 px", 32);
    }

    void measure_source(LightSource source, bool with_bounds) {
        // Where a single build takes seconds, one frame is enough.
        if (device_.is_software() && source.frames.front().lights.size() >= 100000) source.frames.resize(1);
        measure_tiles(source);
        constexpr Options tested = {.depth_test = true, .slicing = Slicing::clusters};
        if (with_bounds) measure_one<Options{.depth_test = true}>(source, "box, 16 px", 16, tiles_16_.bounds);
        measure_one<Options{.slicing = Slicing::clusters}>(source, "clusters, 64 px", 64);
        measure_one<tested>(source, "clusters+box, 64 px", 64);
        if (with_bounds) measure_one<tested>(source, "clusters+box, 64 px, Z bounds", 64, tiles_64_.bounds);
    }

    template <Options options, bool masks = false>
    void measure_one(const LightSource& source, const std::string& method, int tile_size,
                     const lightbin::ZBounds& bounds = {}) {
        progress_(text("%s, %zu lights, %s", source.name.c_str(), source.frames.front().lights.size(),
                       method.c_str()));
        rows_.push_back(measure<options, masks>(device_, source, tile_size, turns_,
                                                cluster_slices(source.reach), bounds));
        rows_.back().method = method;
    }

    bool quick_;
    GpuDevice device_;
    TurnsOf turns_ = {};
    MadeBounds tiles_16_{16}, tiles_64_{64};
    std::vector<GpuRow> rows_;
    Progress progress_;
};

double excess_percent(const Difference& difference) {
    return 100 * double(difference.more) / double(std::max<std::size_t>(difference.entries, 1));
}

std::string passes_of(const GpuRow& row) {
    std::string passes;
    for (const auto& [name, ms] : row.passes)
        passes += text("%s%s %.4f", passes.empty() ? "" : "; ", name.c_str(), ms);
    return passes;
}

void print_rows(const std::vector<GpuRow>& rows) {
    std::vector<TableRow> table = {
        {"lights", "", "method", "CPU ms", "its upload", "GPU ms", "its upload", "bytes a light", "tests a light",
         "idle groups", "more"}};
    for (const GpuRow& row : rows)
        table.push_back({row.source, text("%7zu", row.lights), row.method, text("%.3f", row.cpu_ms),
                         text("%.3f", row.cpu_upload_ms), text("%.3f", row.gpu_ms),
                         text("%.3f", row.gpu_upload_ms),
                         text("%.0f", double(row.scratch) / double(row.lights)),
                         row.work.groups > 0 ? text("%.1f", row.work.tests_a_light) : "",
                         row.work.groups > 0 ? text("%zu of %zu", row.work.idle, row.work.groups) : "",
                         text("%.3f %%", excess_percent(row.difference))});
    print_table(table);
}

void write_csv(const std::vector<GpuRow>& rows) {
    std::FILE* const csv = open_report(
        "gpu.csv", "device,source,method,lights,in_view,cpu_ms,cpu_upload_ms,gpu_ms,gpu_upload_ms,"
                   "scratch_bytes,tests_a_light,groups,idle,entries,missed,more,unordered,passes");
    for (const GpuRow& row : rows)
        std::fprintf(csv,
                     "\"%s\",\"%s\",\"%s\",%zu,%zu,%.4f,%.4f,%.4f,%.4f,%zu,%.1f,%zu,%zu,%zu,%zu,%zu,%zu,%s\n",
                     row.device.c_str(), row.source.c_str(), row.method.c_str(), row.lights, row.in_view,
                     row.cpu_ms, row.cpu_upload_ms, row.gpu_ms, row.gpu_upload_ms, row.scratch,
                     row.work.tests_a_light, row.work.groups, row.work.idle, row.difference.entries,
                     row.difference.missed, row.difference.more, row.difference.unordered,
                     passes_of(row).c_str());
    std::fclose(csv);
}

int run(Arguments arguments) {
    const bool quick = arguments.take("--quick");
    if (!arguments.scenes().empty()) throw std::runtime_error("cannot do '" + arguments.scenes()[0] + "'");
    const std::vector<GpuRow> rows = Measuring(quick).rows();
    write_csv(rows);
    print_rows(rows);
    Difference all;
    std::vector<std::string> said;
    for (const GpuRow& row : rows) {
        all += row.difference;
        if (!row.difference.right())
            said.push_back(text("%s, %s, %zu lights: WRONG, %zu missed, %zu out of order", row.source.c_str(),
                                row.method.c_str(), row.lights, row.difference.missed,
                                row.difference.unordered));
    }
    said.push_back(text("Lists: %zu of the Binner's %zu entries are missed by the GPU, %zu ids are out of "
                        "order, %.3f %% are more.",
                        all.missed, all.entries, all.unordered, excess_percent(all)));
    conclude(said, {"gpu.csv"});
    return all.right() ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int count, char** words) try {
    return run(Arguments(count, words));
} catch (const std::exception& problem) {
    std::fprintf(stderr, "gpu: %s\n", problem.what());
    return EXIT_FAILURE;
}
