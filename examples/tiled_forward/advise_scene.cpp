// SPDX-License-Identifier: MIT
#include "advise_scene.hpp"

#include "binned_lights.hpp"
#include "draw_times.hpp"
#include "projection.hpp"
#include "value_of.hpp"
#include "way_costs.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

using lightbin::Slicing;
using lightbin::AdviceVerdict;

namespace {

// A part that saves less than a hundredth of the frame is not worth its lines, nor can the clock tell.
constexpr double least_gain = 0.01;

__attribute__((format(printf, 1, 2))) std::string text(const char* format, ...) {
    char line[400];
    va_list values;
    va_start(values, format);
    std::vsnprintf(line, sizeof line, format, values);
    va_end(values);
    return line;
}

// A part of a way, and another way that differs in it.
struct Part {
    AdviceVerdict verdict;
    Way other;
    bool by_itself = false;  // nothing else differs but the tile size, so what gains little is left out
    double gain = 0;         // what a frame takes less by the other, nanoseconds
};

Way with(Way way, bool Way::*part, bool value) {
    way.*part = value;
    return way;
}

// Every part of a way.
std::vector<Part> parts_of(const Way& way, const lightbin::Advice& advice, const WayCosts& costs) {
    std::vector<Part> parts;
    const auto add_switch = [&](const char* name, bool Way::*part, const std::string& on, const char* off) {
        parts.push_back({{.part = name, .keep = way.*part, .instead = way.*part ? off : on},
                         with(way, part, !(way.*part)),
                         true});
    };
    for (const AdviceVerdict& verdict : advice.verdicts(way.plan)) {
        if (verdict.part == "masks") continue;  // see WayCosts::advise()
        Part part = {verdict, way};
        const auto take = [&](const lightbin::AdvicePlan& plan) {
            part.other.plan = plan;
            part.verdict.instead = to_string(plan);
            part.by_itself = plan.tiled && (plan.depth_test != way.plan.depth_test) !=
                                               (plan.slicing != way.plan.slicing);
        };
        if (!verdict.instead.empty()) take(verdict.other);
        if (!way.plan.has_z_bounds()) part.other.minimum = part.other.maximum = true;
        parts.push_back(part);
        if (verdict.part != "pre-pass") continue;

        const Way without = way.plan.has_z_bounds() ? part.other : way;
        for (const bool minimum : {true, false}) {
            bool Way::*const side = minimum ? &Way::minimum : &Way::maximum;
            bool Way::*const other_side = minimum ? &Way::maximum : &Way::minimum;
            const std::string name = minimum ? "minimum" : "maximum", rest = minimum ? "maximum" : "minimum";
            if (!way.plan.has_z_bounds())
                parts.push_back({{.part = name, .instead = "a pre-pass and the " + name + " alone"},
                                 with(part.other, other_side, false)});
            else if (way.*side && !(way.*other_side))
                parts.push_back({{.part = name, .keep = true, .instead = part.verdict.instead}, without});
            else
                add_switch(name.c_str(), side, "both", ("the " + rest + " alone").c_str());
        }
    }
    if (costs.light_count() <= 65536) add_switch("16-bit ids", &Way::narrow_ids, "16 bits", "32 bits");
    add_switch("threads", &Way::threads, std::to_string(costs.workers()) + " threads", "one thread");
    if (costs.has_cones())
        add_switch("cones", &Way::cones, "spots as spots", "spots as the least spheres around them");
    return parts;
}

// What was found: a way, what each part of it saves, and ways that are no good idea beside it.
struct Found {
    Way way;
    std::vector<Part> parts;
    WayCost cost, plain, untiled, everything;
    lightbin::AdvicePlan plain_plan, everything_plan;
};

// Begins with the cheapest plan, and goes on to the best of the ways that differ in one part as long as that gains, so
// that in the end each part was measured beside all others as they are advised.
Found find(WayCosts& costs) {
    const lightbin::Advice advice = costs.advise();
    Found found;
    found.way.plan = advice.best();
    const auto plain =
        std::find_if(advice.plans().begin(), advice.plans().end(), [](const lightbin::AdvicePlan& plan) {
            return plan.tiled && !plan.depth_test && plan.slicing == Slicing::none;
        });
    found.plain_plan = *plain;
    for (int round = 1;; ++round) {
        found.parts = parts_of(found.way, advice, costs);
        found.everything_plan = {
            .depth_test = true, .tile_size = found.way.plan.tiled ? found.way.plan.tile_size : plain->tile_size};
        std::vector<Way> ways = {
            found.way,
            {.plan = found.plain_plan},
            {.plan = {.tiled = false}},
            {.plan = found.everything_plan, .narrow_ids = costs.light_count() <= 65536, .threads = true}};
        for (const Part& part : found.parts)
            ways.push_back(part.other);
        const std::vector<WayCost> measured = costs.measure(ways);
        found.cost = measured[0];
        found.plain = measured[1];
        found.untiled = measured[2];
        found.everything = measured[3];
        const double total = found.cost.total();
        for (std::size_t i = 0; i < found.parts.size(); ++i) {
            Part& part = found.parts[i];
            part.gain = total - measured[4 + i].total();
            part.verdict.saved_ns = -part.gain;
        }
        const Part* best = nullptr;
        double most = 0;
        for (const Part& part : found.parts) {
            const bool removes = part.by_itself && part.verdict.keep;
            const double worth = part.gain + (removes ? least_gain : -least_gain) * total;
            if (worth > most && !part.verdict.instead.empty()) most = worth, best = &part;
        }
        if (best == nullptr || round == 8) return found;
        found.way = Way(best->other);
    }
}

// The lines of C++ that do as is advised.
std::string code(const Found& found, WayCosts& costs) {
    const Way& way = found.way;
    const lightbin::AdvicePlan& plan = way.plan;
    if (!plan.tiled) return "// No lists: the shader goes through all lights.\n";
    const auto [width, height] = costs.view().viewport();
    std::string lines =
        text("auto view = lightbin::View::from_projection(projection, {%d, %d}, {.tile_size = %d});\n", width,
             height, plan.tile_size);
    std::vector<std::string> options;
    if (way.narrow_ids) options.push_back(".ids = lightbin::IdWidth::u16");
    if (plan.depth_test) options.push_back(".depth_test = true");
    if (plan.slicing != Slicing::none)
        options.push_back(".slicing = lightbin::Slicing::" + std::string(to_string(plan.slicing)));
    std::string all;
    for (const std::string& option : options)
        all += (all.empty() ? "lightbin::Options{" : ",\n                                   ") + option;
    lines += "lightbin::Binner<" + all + (all.empty() ? "" : "}") + "> binner;  // once\n";

    std::string inputs = "{}";
    if (plan.slicing != Slicing::none) {
        lines += "auto slices = lightbin::Slices::" + costs.slices_in_words(plan.slicing) + ";\n";
        inputs = "{.slices = *slices}";
    } else if (plan.has_z_bounds()) {
        std::vector<std::string> sides;
        if (way.minimum) sides.push_back("min");
        if (way.maximum) sides.push_back("max");
        std::string vectors, spans;
        for (const std::string& side : sides) {
            vectors += (vectors.empty() ? "" : ", ") + side +
                       (vectors.empty() ? "(view->tile_count())" : "(" + sides[0] + ")");
            spans += (spans.empty() ? "." : ", .") + side + " = " + side;
        }
        lines += "std::vector<float> " + vectors + ";";
        inputs = "{.bounds = *bounds}";
        if (costs.reduces_on_gpu(way)) {
            lines += "  // as lightbin::reduce_shader() writes them\n";
            inputs = "{.bounds = {" + spans + "}}";
        } else {
            lines += "\nauto bounds = lightbin::reduce_depth(\n"
                     "    *view, {.depth = depth_buffer, .skip_background = true},\n"
                     "    {" +
                     spans + "});\n";
        }
    }
    const std::string next =
        inputs.size() > 60 ? ",\n                       " : ", ";  // lines of 100 columns at most
    std::string arguments = "*view, lights";
    if (way.threads || inputs != "{}") arguments += next + inputs;
    if (way.threads) arguments += next + "lightbin::Parallel(pool.size(), run)";
    const std::string lamps = std::string("lightbin::world_space(lamps, view_matrix, ") +
                              (costs.has_cones() && way.cones ? "to_spot)" : "to_sphere)");
    lines += "auto lights = " +
             (costs.has_boxes() ? "lightbin::lights(" + lamps +
                                      ",\n                               "
                                      "lightbin::world_space(decals, view_matrix, to_box))"
                                : lamps) +
             ";\n";
    lines += "auto grid = binner.bin(" + arguments + ");\n";
    lines += "auto shader = lightbin::shader_snippet({.format = decltype(binner)::list_format";
    if (plan.slicing != Slicing::none)
        lines += std::string(",\n                                        .slicing = lightbin::Slicing::") +
                 to_string(plan.slicing);
    return lines + text(", .tile_size = %d});\n", plan.tile_size);
}

// The view of the file, or of the one that is asked for, whose plain tiles shade most.
std::unique_ptr<WayCosts> worst_view(const Scene& scene, const AdviseSettings& settings, std::size_t& at,
                                     double& evaluations) {
    std::unique_ptr<WayCosts> worst;
    const double aspect = static_cast<double>(settings.width) / settings.height;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (settings.view >= 0 && i != static_cast<std::size_t>(settings.view)) continue;
        const Camera& camera = scene.cameras[i];
        const glm::dmat4 world_to_view = glm::inverse(camera.to_world);
        const glm::mat4 projection = projection_of(camera, aspect);
        const lightbin::View view = value_of(
            lightbin::View::from_projection(projection, {settings.width, settings.height}, {.tile_size = 8}));
        BinnedLights lights(scene);
        lights.place(world_to_view);
        auto costs = std::make_unique<WayCosts>(
            view, projection, lights,
            draw_depth_on_cpu(scene, glm::dmat4(projection) * world_to_view, view.viewport()));
        costs->set({.evaluation_ns = 1});
        const Way plain = {.plan = {.tile_size = 16}};
        const double count = costs->measure({&plain, 1})[0].shade;
        if (worst != nullptr && count <= evaluations) continue;
        worst = std::move(costs);
        at = i;
        evaluations = count;
    }
    return worst;
}

// What this machine's OpenGL takes, or without one what is assumed of it, in words, too.
Prices prices_of(const Scene& scene, const Camera& camera, const AdviseSettings& settings,
                 std::string& words) {
    Prices prices;
    try {
        const DrawTimes times = draw_times(scene, camera, settings.width, settings.height, settings.glsl);
        const bool told = times.evaluation_ns > 0, reads_back = times.glsl >= 330;
        if (told) prices.evaluation_ns = times.evaluation_ns;
        if (times.upload_byte_ns > 0) prices.upload_byte_ns = times.upload_byte_ns;
        prices.depth_pass_ns = times.depth_pass_ns;
        prices.read_back_ns = reads_back ? times.read_back_ns : HUGE_VAL;
        prices.gpu_reduction_ns = times.gpu_reduction_ns;
        words = text("OpenGL       %.60s, GLSL %d\n", times.renderer.c_str(), times.glsl);
        words += text("costs        %.4g ns a light evaluation%s %.3g ns a byte of the lists;\n",
                      prices.evaluation_ns,
                      told ? "," : " (assumed: there are too few to time),\n            ",
                      prices.upload_byte_ns);
        words += text("             the pre-pass %.3f ms; its Z bounds %.3f ms by a shader",
                      1e-6 * times.depth_pass_ns, 1e-6 * times.gpu_reduction_ns);
        words +=
            reads_back ? text("; to read it back %.3f ms\n", 1e-6 * times.read_back_ns) : std::string("\n");
    } catch (const std::runtime_error& problem) {
        words = text("OpenGL       none: %.80s\n", problem.what());
        words += text(
            "costs        assumed: %.4g ns a light evaluation, as on a GPU, %.3g ns a byte of the lists;\n"
            "             the draw of the pre-pass is left out\n",
            prices.evaluation_ns, prices.upload_byte_ns);
    }
    return prices;
}

}  // namespace

std::string advise_scene(const Scene& scene, const AdviseSettings& settings) {
    std::size_t view = 0;
    double evaluations = 0;
    const std::unique_ptr<WayCosts> costs = worst_view(scene, settings, view, evaluations);
    const Camera& camera = scene.cameras[view];
    std::string words;
    costs->set(prices_of(scene, camera, settings, words));
    const Found found = find(*costs);

    std::string page =
        text("view         %zu, \"%.40s\", %d x %d pixels%s\n", view, camera.name.c_str(), settings.width,
             settings.height, settings.view < 0 ? ", the one that shades most" : "");
    page += words;
    page += text(
        "overdraw     %.2f: without a pre-pass so many fragments are shaded for each pixel that is seen;\n"
        "             plain tiles of 16 px evaluate %.1f lights%s a pixel\n",
        costs->overdraw(), evaluations / settings.width / settings.height,
        costs->has_boxes() ? " and boxes" : "");
    if (!scene.transparent.empty())
        page +=
            "             glass is left out; with Z bounds it needs lists of its own, by the maximum alone\n";
    const auto ms = [](double ns) { return 1e-6 * ns; };
    page +=
        text("frame        %.3f ms as advised: depth %.3f, build %.3f, upload %.3f, light evaluations %.3f\n",
             ms(found.cost.total()), ms(found.cost.depth), ms(found.cost.build), ms(found.cost.upload),
             ms(found.cost.shade));
    page += text("             %.3f ms by plain tiles (%d px); %.3f ms by every light in every pixel;\n"
                 "             %.3f ms by all parts that combine, those that save little, too\n",
                 ms(found.plain.total()), found.plain_plan.tile_size, ms(found.untiled.total()),
                 ms(found.everything.total()));
    page += text("             %.3f ms by %s, as advise() weighs it\n", ms(costs->masks().total_ns),
                 to_string(costs->masks()).c_str());
    page += "advised      " + to_string(found.way.plan) + "\n";
    for (const Part& part : found.parts)
        page += to_string(part.verdict);
    if (costs->light_count() > 65536) page += "16-bit ids   leave out: there are more than 65,536 lights\n";
    if (!costs->has_cones()) page += "cones        leave out: no light has one\n";
    return page + "code\n" + code(found, *costs);
}
