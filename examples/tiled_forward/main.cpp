// SPDX-License-Identifier: MIT
// Draws a scene lit by hundreds of lights: as a PNG file, then in a window where there is a display.
#include "advise_scene.hpp"
#include "gl_context.hpp"
#include "renderer.hpp"
#include "window.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

struct Options {
    std::string file;  // empty: a made scene
    std::string scene = "city";
    std::string output = "tiled_forward.png";
    bool headless = false;
    bool check = false;
    bool check_in_shader = false;
    bool stale_size = false;
    bool heat_map = false;
    bool advise = false;
    int view = 0;
    int lights = 0;
    int glsl = 0;
    float cutoff = 0.05f;
    float stops = 0;
    FrameSettings frame;
};

// Fills in the options. Returns false when the program has nothing more to do.
bool parse(int argc, char** argv, Options& options, int& exit_code) {
    CLI::App app("Tiled forward shading with lightbin: a scene lit by hundreds of lights.");
    CLI::Option* const file = app.add_option(
        "file", options.file, "A .glb file with KHR_lights_punctual lights (default: a made scene)");
    app.add_option("--scene", options.scene,
                   "Which made scene: a city with as many lights as you like, or a street with lamps")
        ->check(CLI::IsMember({"city", "street"}))
        ->capture_default_str()
        ->excludes(file);
    app.add_option("--lights", options.lights,
                   "Lights of the city (default: 1024), or the most to take from another scene")
        ->check(CLI::Range(1, 1000000));
    app.add_option("--cutoff", options.cutoff, "Lux at which a light without a range ends; 0: never")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    const CLI::Option* const view = app.add_option("--view", options.view, "Which camera")
                                        ->check(CLI::NonNegativeNumber)
                                        ->capture_default_str();
    app.add_option("--tile", options.frame.tile_size, "Side of a tile in pixels")
        ->check(CLI::Range(1, 32768))
        ->capture_default_str();
    std::string depth = "pre-pass";
    app.add_option("--depth", depth,
                   "What keeps a light from what is at other depths: none; a depth pre-pass; or without one "
                   "z-bins or "
                   "clusters")
        ->check(CLI::IsMember({"none", "pre-pass", "z-bins", "clusters"}))
        ->capture_default_str();
    std::string z_bounds = "both";
    const CLI::Option* const bounds_option =
        app.add_option("--z-bounds", z_bounds, "Depth bounds of a tile, from the pre-pass: none, max or both")
            ->check(CLI::IsMember({"none", "max", "both"}))
            ->capture_default_str();
    app.add_flag("--gpu-z-bounds", options.frame.gpu_reduction,
                 "Reduce depth to Z bounds on the GPU (OpenGL ES does in any case)");
    std::string build = "cpu";
    app.add_option("--build", build,
                   "Where lists are made: by a Binner on the CPU, or by compute shaders on the GPU, which "
                   "takes OpenGL 4.3 "
                   "or ES 3.1 and makes no z-bins")
        ->check(CLI::IsMember({"cpu", "gpu"}))
        ->capture_default_str();
    app.add_option("--glsl", options.glsl,
                   "Lists in 330: texture buffers, 430: storage buffers; OpenGL ES, 300: textures, 310: "
                   "storage buffers (default: 430, or else 330)")
        ->check(CLI::IsMember({330, 430, 300, 310}));
    app.add_option("--exposure", options.stops, "Stops brighter (+) or darker (-) than the light meter says")
        ->check(CLI::Range(-20.0, 20.0));
    std::string size;
    app.add_option("--size", size, "Width and height in pixels")->type_name("WxH")->default_str("1280x720");
    app.add_option("--msaa", options.frame.samples, "Samples a pixel")
        ->check(CLI::IsMember({1, 2, 4, 8}))
        ->capture_default_str();
    app.add_flag("--shade-samples", options.frame.shade_samples,
                 "Light each of them, as is always done with Z bounds, and not each pixel once");
    app.add_flag("--heat-map", options.heat_map, "Lay the length of each tile's list over the picture");
    app.add_option("-o,--output", options.output, "The PNG file to write")->capture_default_str();
    app.add_flag("--headless", options.headless, "No window, although there is a display");
    app.add_flag("--check", options.check,
                 "Draw again with every light in every fragment and compare; no window");
    app.add_flag(
        "--check-in-shader", options.check_in_shader,
        "Draw in grey, and magenta where a fragment is not where the View has it, or its list lacks a "
        "light that reaches it; no window");
    app.add_flag("--stale-size", options.stale_size,
                 "Make the lists for a picture of half the size, to see --check-in-shader fail");
    app.add_flag(
           "--advise", options.advise,
           "No picture: measure what each part of binning saves a frame of this scene on this machine, and "
           "say what to leave out, with the code; of --view, or else of the view that shades most")
        ->excludes(app.get_option("--check"))
        ->excludes(app.get_option("--check-in-shader"))
        ->excludes(app.get_option("--heat-map"))
        ->excludes(app.get_option("--msaa"));
    app.add_option("--drop-light", options.frame.dropped_light,
                   "Leave this light out of the lists (boxes follow the lights), to see --check and "
                   "--check-in-shader fail")
        ->check(CLI::NonNegativeNumber);

    exit_code = 0;
    try {
        app.parse(argc, argv);
        options.frame.depth = depth == "none"       ? DepthUse::none
                              : depth == "z-bins"   ? DepthUse::z_bins
                              : depth == "clusters" ? DepthUse::clusters
                                                    : DepthUse::pre_pass;
        options.frame.z_bounds = z_bounds == "none"  ? ZBoundsUse::none
                                 : z_bounds == "max" ? ZBoundsUse::max
                                                     : ZBoundsUse::both;
        if (bounds_option->count() > 0 && options.frame.depth != DepthUse::pre_pass)
            throw CLI::ValidationError("--z-bounds",
                                       "they come from the pre-pass, so not with --depth " + depth);
        options.frame.gpu_build = build == "gpu";
        if (options.frame.gpu_build && options.frame.depth == DepthUse::z_bins)
            throw CLI::ValidationError("--build",
                                       "z-bins are made on the CPU here, so not with --depth z-bins");
        if (options.advise && view->count() == 0) options.view = -1;
        int end = -1;
        if (!size.empty() &&
            (std::sscanf(size.c_str(), "%5dx%5d%n", &options.frame.width, &options.frame.height, &end) != 2 ||
             end != static_cast<int>(size.size()) || options.frame.width < 1 || options.frame.height < 1))
            throw CLI::ValidationError("--size", "'" + size + "' is not a size like 1280x720");
        return true;
    } catch (const CLI::CallForHelp&) {
        std::fputs(app.help().c_str(), stdout);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "tiled_forward: %s (--help lists the options)\n", error.what());
        exit_code = 2;
    }
    return false;
}

Scene open_scene(const Options& options) {
    const bool made = options.file.empty();
    if (made && options.scene == "city") return make_scene(options.lights > 0 ? options.lights : 1024);
    Scene scene = made ? make_street() : load_glb(options.file, options.cutoff);
    if (const auto most = static_cast<std::size_t>(options.lights); most > 0 && scene.lights.size() > most) {
        scene.notes.push_back("only the first " + std::to_string(most) + " of " +
                              std::to_string(scene.lights.size()) + " lights are taken (--lights)");
        scene.lights.resize(most);
    }
    return scene;
}

std::string and_boxes(const Scene& scene) {
    return scene.boxes.empty() ? "" : " and " + std::to_string(scene.boxes.size()) + " boxes";
}

void print(const Scene& scene, const FrameSettings& frame, const Camera& camera, const FrameReport& report) {
    const auto unsigned_long = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    const double every = static_cast<double>(scene.lights.size() + scene.boxes.size());
    const bool many = frame.samples > 1;
    const char* const shaded = frame.shades_samples() ? "sample" : "pixel";
    std::printf("view         \"%s\", %d x %d pixels%s in %d x %d tiles of %d\n", camera.name.c_str(),
                frame.width, frame.height,
                many ? (" of " + std::to_string(frame.samples) + " samples").c_str() : "", report.tiles_x,
                report.tiles_y, frame.tile_size);
    std::printf("lights       %llu in view of %zu%s", unsigned_long(report.lights_in_view),
                scene.lights.size(), and_boxes(scene).c_str());
    if (report.rejected > 0) std::printf(", %llu rejected as bad input", unsigned_long(report.rejected));
    std::printf("\nlists        %llu entries, the longest has %u", unsigned_long(report.entries),
                report.longest_list);
    if (report.transparent_entries > 0)
        std::printf("; %llu entries for glass", unsigned_long(report.transparent_entries));
    std::printf("\nevaluations  %.2f lights a %s", report.evaluations_per_pixel, shaded);
    if (report.evaluations_per_pixel > 0)
        std::printf("; every light for every %s would be %.1f times as many", shaded,
                    every / report.evaluations_per_pixel);
    const auto& ms = report.milliseconds;
    std::printf("\ntime         %8.2f ms  depth pre-pass and read-back\n", ms.pre_pass);
    std::printf("             %8.2f ms  reduce to Z bounds\n", ms.reduce);
    std::printf("             %8.2f ms  bin\n", ms.bin);
    std::printf("             %8.2f ms  upload\n", ms.upload);
    std::printf("             %8.2f ms  draw\n", ms.draw);
}

// Says whether the tiled picture is that of every light in every fragment.
bool check(Renderer& renderer, const Scene& scene, const Camera& camera, const FrameSettings& frame,
           const Picture& tiled) {
    renderer.draw_every_light(camera, frame);
    const Difference difference = compare(tiled, renderer.read_picture());
    if (difference.pixels == 0) {
        std::printf(
            "check        identical: %d x %d pixels, each lit by its tile's list and by all %zu lights%s\n",
            frame.width, frame.height, scene.lights.size(), and_boxes(scene).c_str());
        return true;
    }
    std::printf("check        DIFFERENT: %zu of %d x %d pixels, by up to %d of 255; the first is x %d, y %d "
                "from the top, in tile (%d, %d)\n",
                difference.pixels, frame.width, frame.height, difference.largest, difference.x,
                frame.height - 1 - difference.y, difference.x / frame.tile_size,
                difference.y / frame.tile_size);
    return false;
}

// Draws with the checks of the shader text, and says how many pixels each makes magenta. Returns whether none.
bool check_in_shader(Renderer& renderer, const Camera& camera, FrameSettings frame) {
    const auto magenta = [&](ShaderChecks checks) {
        frame.checks = checks;
        renderer.draw(camera, frame);
        const std::vector<std::uint8_t> rgb = renderer.read_picture().rgb;
        std::size_t pixels = 0;
        for (std::size_t i = 0; i < rgb.size(); i += 3)
            pixels += rgb[i] != rgb[i + 1];  // all else is grey
        return pixels;
    };
    const std::size_t misplaced = magenta({.view = true}), unlit = magenta({.lists = true});
    magenta({.view = true, .lists = true});  // the picture that is written
    if (misplaced > 0)
        std::printf(
            "view check   MAGENTA: in %zu of %d x %d pixels something is not where the View has it, or "
            "before its near plane: is the View made of the projection, size and origin that are drawn "
            "with?\n",
            misplaced, frame.width, frame.height);
    else
        std::printf("view check   right: all that is drawn is where the View has it\n");
    if (unlit > 0)
        std::printf(
            "list check   MAGENTA: in %zu of %d x %d pixels a light is missing that reaches them: "
            "have Binner and shader the same lights, in the same order, space and range, and ids as wide?\n",
            unlit, frame.width, frame.height);
    else
        std::printf("list check   right: no list lacks a light that reaches a pixel\n");
    if (misplaced + unlit > 0) std::printf("             docs/troubleshooting.md has the usual mistakes\n");
    return misplaced + unlit == 0;
}

// Draws the picture, writes it, and checks it if asked to. Returns the exit code.
int draw_picture(const Options& options, const Scene& scene) {
    const OffscreenContext context(options.glsl);
    std::printf("OpenGL       %s, GLSL %d\n", reinterpret_cast<const char*>(glGetString(GL_RENDERER)),
                context.glsl());
    Renderer renderer(scene, context.glsl());
    const Camera& camera = scene.cameras[static_cast<std::size_t>(options.view)];
    FrameSettings frame = options.frame;
    frame.exposure = renderer.meter(camera, frame) * std::exp2(options.stops);
    renderer.draw(camera, frame);  // waits for shader compilers and memory; the times are the second frame's
    frame.count_evaluations = true;
    const FrameReport report = renderer.draw(camera, frame);
    print(scene, frame, camera, report);

    const Picture tiled = renderer.read_picture();
    if (options.heat_map) renderer.draw_heat_map(report, frame);
    frame.count_evaluations = false;
    frame.stale_size = options.stale_size;
    const bool right = !options.check_in_shader || check_in_shader(renderer, camera, frame);
    write_png(renderer.read_picture(), options.output);
    std::printf("picture      %s\n", options.output.c_str());
    std::fflush(stdout);
    const bool same = !options.check || check(renderer, scene, camera, frame, tiled);
    return right && same ? EXIT_SUCCESS : EXIT_FAILURE;
}

int run(const Options& options) {
    Scene scene = open_scene(options);
    if (options.view >= static_cast<int>(scene.cameras.size()))
        throw std::runtime_error("there is no view " + std::to_string(options.view) + ": the scene has " +
                                 counted(scene.cameras.size(), "view") + ", numbered from 0");
    const std::string glass =
        scene.transparent.empty() ? "" : " and " + std::to_string(scene.transparent.size() / 3) + " of glass";
    const auto spots =
        std::count_if(scene.lights.begin(), scene.lights.end(), [](const Light& l) { return l.spot; });
    const std::string of_spots = spots == 0 ? "" : ", " + std::to_string(spots) + " of them with a cone";
    const std::string boxes = scene.boxes.empty() ? ""
                                                  : "             and " + std::to_string(scene.boxes.size()) +
                                                        " boxes of decals, probes and projectors\n";
    std::printf("scene        %s: %s%s, %s%s, %s\n%s", scene.name.c_str(),
                counted(scene.triangles.size() / 3, "triangle").c_str(), glass.c_str(),
                counted(scene.lights.size(), "light").c_str(), of_spots.c_str(),
                counted(scene.cameras.size(), "view").c_str(), boxes.c_str());
    for (const std::string& note : scene.notes)
        std::printf("note         %s\n", note.c_str());
    std::fflush(stdout);

    if (options.advise) {
        const FrameSettings& frame = options.frame;
        const AdviseSettings settings = {
            .width = frame.width, .height = frame.height, .glsl = options.glsl, .view = options.view};
        std::fputs(advise_scene(scene, settings).c_str(), stdout);
        return EXIT_SUCCESS;
    }
    const int exit_code = draw_picture(options, scene);
    if (!options.headless && !options.check && !options.check_in_shader)
        show_in_window(std::move(scene), options.glsl, options.view, options.frame, options.stops,
                       options.heat_map);
    return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    int exit_code = 0;
    if (!parse(argc, argv, options, exit_code)) return exit_code;
    try {
        return run(options);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "tiled_forward: %s\n", problem.what());
        return EXIT_FAILURE;
    }
}
