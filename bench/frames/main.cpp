// SPDX-License-Identifier: MIT
// frames [--quick] [--counts] [SCENE.glb ...]: whole frames by every technique of the papers, on the made scene
// and on the named ones, or those of bench/scenes.
#include "plan.hpp"
#include "report.hpp"
#include "runner.hpp"

#include "../arguments.hpp"
#include "../console.hpp"

#include <gl_context.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

namespace {

std::vector<Row> draw_all(std::vector<SceneJobs> plan, const RunSettings& run, LeftOut& left_out) {
    Progress progress;
    std::vector<Row> rows;
    for (SceneJobs& jobs : plan) {
        const OffscreenContext context(0);  // each scene's goes with all that is in it
        Runner runner(jobs.scene, run, context.glsl(), left_out);
        for (const Job& job : jobs.jobs) {
            progress(jobs.scene.name + ", " + job.table + ", " + job.camera.name);
            if (!job.lights.empty()) jobs.scene.lights = job.lights;
            const std::vector<Row> made = runner.run(job.table, job.camera, job.techniques, job.settings);
            rows.insert(rows.end(), made.begin(), made.end());
        }
        write_csv(rows);  // what there is, if the run is broken off
    }
    return rows;
}

bool pictures_are_as_stated(const std::vector<Row>& rows) {
    for (const Row& row : rows)
        if (!row.as_stated)
            std::printf("%s, %s, %s: %s DIFFERS from every light, by up to %d of 255, more than it may\n",
                        row.scene.c_str(), row.table.c_str(), row.view.c_str(), row.technique.c_str(),
                        row.difference);
    return std::ranges::all_of(rows, &Row::as_stated);
}

int run(Arguments arguments) {
    const bool quick = arguments.take("--quick"), only_counts = arguments.take("--counts");
    RunSettings run;
    {
        const OffscreenContext context(0);
        const bool software = is_software_renderer();
        // Fewer pixels have smaller tiles, so that a tile covers the same share of the picture as 32 pixels of 1920:
        // the range of depth in a tile depends on that.
        run.width = !software ? 1920 : quick ? 240 : 480;
        run.height = run.width * 9 / 16;
        run.tile_size = run.width / 60;
        run.timed_frames = only_counts ? 0 : software ? 3 : quick ? 9 : 25;
        std::printf(
            "OpenGL: %s, GLSL %d; %d x %d pixels, tiles of %d: a sixtieth of the width, as 32 are of 1920\n",
            reinterpret_cast<const char*>(glGetString(GL_RENDERER)), context.glsl(), run.width, run.height,
            run.tile_size);
        if (software)
            std::printf(
                "This OpenGL draws on the CPU: its times say little about a GPU's. Compare evaluations and "
                "bytes.\n");
        if (context.glsl() < 430) std::printf("Evaluations are not counted: that needs OpenGL 4.3.\n");
        std::fflush(stdout);
    }
    const std::vector<SceneJobs> plan = make_plan(arguments.scenes_or_fixtures(), quick);
    write_csv({});  // or a folder that can't be written to is noticed in the end
    LeftOut left_out;
    const std::vector<Row> rows = draw_all(plan, run, left_out);
    print_rows(rows);
    print_price_of_words(rows);
    if (!left_out.lines().empty()) std::printf("\n");
    for (const std::string& line : left_out.lines())
        std::printf("%s\n", line.c_str());
    write_csv(rows);
    return pictures_are_as_stated(rows) ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int count, char** words) {
    try {
        return run(Arguments(count, words));
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "frames: %s\n", problem.what());
        return EXIT_FAILURE;
    }
}
