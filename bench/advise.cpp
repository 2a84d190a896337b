// SPDX-License-Identifier: MIT
// Is advise() right? For each scene every plan is measured (build time on rotating light sets, evaluations of
// the first one counted over the drawn pixels), and what the chosen one costs is held against the cheapest: with
// Z bounds, and without any against those that need none.
//
//   advise_plans.csv   a row a plan: predicted and measured build time and evaluations
//   advise.csv         a row for each scene, cost of an evaluation and error of the build model (factor): the
//                      choice, the best plan, and the regret, their ratio
//
// With --fit: fits the constants of detail/build_model.hpp on made scenes and light sets instead, and prints
// its lines.
#include "arguments.hpp"
#include "glb_scenes.hpp"
#include "ladder.hpp"

#include <cmath>
#include <exception>
#include <functional>
#include <memory>
#include <span>

namespace {

using lightbin::Index;
using lightbin::Isa;
using lightbin::Plan;

constexpr int tile_sizes[] = {8, 16, 32, 64};
constexpr double evaluation_costs[] = {0.005, 0.02, 0.05, 0.2, 1};  ///< ns
constexpr double model_factors[] = {1, 0.5, 0.67, 1.5, 2};
std::size_t turns = 15;

/// A plan and how to build it: returns the grid's tiles.
struct Candidate {
    Plan plan;
    std::function<std::span<const lightbin::Tile>(const TiledView&, const Lights&)> build;
    double build_us = 0, evaluations = 0;

    double total_us(double evaluation_ns) const { return build_us + evaluations * evaluation_ns * 1e-3; }
};

/// Every method, id width and tile size.
template <Isa isa> std::vector<Candidate> candidates() {
    std::vector<Candidate> all;
    const auto add = [&]<std::size_t method, Index index> {
        const auto bin = std::make_shared<Bin<ladder[method], index, isa>>();
        for (const int tile_size : tile_sizes)
            all.push_back({.plan = {.footprint = ladder[method].footprint,
                                    .depth_test = ladder[method].depth_test,
                                    .index = index,
                                    .tile_size = tile_size},
                           .build = [bin](const TiledView& view, const Lights& lights) {
                               return (*bin)(view, lights).tiles();
                           }});
    };
    [&]<std::size_t... method>(std::index_sequence<method...>) {
        (add.template operator()<method, Index::u16>(), ...);
        (add.template operator()<method, Index::u32>(), ...);
    }
    (std::make_index_sequence<std::size(ladder)>{});
    return all;
}

/// Times all candidates in turns, each turn with another light set.
void time(std::vector<Candidate>& candidates, const Views& views, std::span<const Lights> sets) {
    std::vector<std::vector<double>> times(candidates.size());
    std::vector<int> together(candidates.size(), 1);  // builds too short for the clock
    for (std::size_t turn = 0; turn < turns + 1; ++turn)
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            const TiledView& view = views.of(candidates[i].plan.tile_size);
            const auto build = [&] {
                for (int again = 0; again < together[i]; ++again)
                    candidates[i].build(view, sets[turn % sets.size()]);
            };
            if (turn == 0) build();  // finds no memory
            const double time = seconds(build);
            if (turn == 0)
                together[i] = static_cast<int>(std::clamp(20e-6 / time, 1.0, 16.0));
            else
                times[i].push_back(time / together[i]);
        }
    for (std::size_t i = 0; i < candidates.size(); ++i)
        candidates[i].build_us = 1e6 * median(times[i]);
}

std::string words(const Plan& plan) {
    if (!plan.tiled) return "no tiling";
    return std::to_string(plan.tile_size) + " px " + name_of(plan.footprint) + " " +
           name_of(plan.depth_test) + (plan.index == Index::u16 ? " u16" : " u32");
}

struct Regrets {
    std::vector<double> by_factor[std::size(model_factors)];
    std::vector<double> asking;  ///< over the plain build at the view's tile size
};

/// Times asking and the plain build at the view's tile size in turns: both find what the other left in the
/// caches.
template <Isa isa> void time_asking(const TiledView& finest, std::span<const Lights> sets, Regrets& regrets) {
    Bin<ladder[0], Index::u32, isa> bin;
    std::vector<double> asking, building;
    for (std::size_t turn = 0; turn < 20 * turns; ++turn) {
        const Lights& lights = sets[turn % sets.size()];
        building.push_back(seconds([&] { bin(finest, lights); }));
        asking.push_back(seconds([&] {
            if (!lightbin::advise(finest.view, lights, {.isa = isa}, finest.bounds())) std::abort();
        }));
    }
    const double ask = 1e6 * median(asking), build = 1e6 * median(building);
    regrets.asking.push_back(ask / build);
    std::printf("asking %.1f us, %.2f of the plain build of %.1f us\n", ask, ask / build, build);
}

template <Isa isa>
void judge(const BenchScene& scene, std::FILE* plans_csv, std::FILE* csv, Regrets& regrets) {
    const Views views(scene, rasterise(scene, screen));
    std::vector<Lights> sets;
    for (std::uint32_t seed = 0; seed < turns; ++seed)
        sets.push_back(scene.lights(seed));

    std::vector<Candidate> sweep = candidates<isa>();
    for (const Index index : {Index::u16, Index::u32}) {  // one list for the whole screen
        Candidate whole = *std::ranges::find_if(sweep, [&](const Candidate& c) {
            return c.plan.index == index && c.plan.depth_test == DepthTest::none &&
                   c.plan.footprint == Footprint::rectangle;
        });
        whole.plan.tile_size = screen.width;
        sweep.push_back(whole);
    }
    time(sweep, views, sets);
    for (Candidate& candidate : sweep) {
        const TiledView& view = views.of(candidate.plan.tile_size);
        candidate.evaluations = view.all_evaluations(candidate.build(view, sets[0]));
    }
    const std::vector<lightbin::Tile> one(1, {0, static_cast<std::uint32_t>(sets[0].size())});
    sweep.push_back({{.tiled = false}, {}, 0, views.of(screen.width).all_evaluations(one)});
    const auto measured = [&](const Plan& plan) -> const Candidate& {
        const auto found =
            std::ranges::find_if(sweep, [&](const Candidate& c) { return words(c.plan) == words(plan); });
        if (found == sweep.end())
            std::fprintf(stderr, "advise: no such plan: %s\n", words(plan).c_str()), std::abort();
        return *found;
    };

    std::printf("\n%s: %zu lights; ", scene.name.c_str(), sets[0].size());
    const TiledView& finest = views.of(tile_sizes[0]);
    time_asking<isa>(finest, sets, regrets);
    for (const bool with_depth : {true, false})
        for (const double cost : evaluation_costs)
            for (const double factor : model_factors) {
                const auto advice = *lightbin::advise(finest.view, sets[0],
                                                      {.evaluation_ns = cost, .machine = factor, .isa = isa},
                                                      with_depth ? finest.bounds() : lightbin::ZBounds{});
                const Candidate& choice = measured(advice.best());
                const Candidate& best = *std::ranges::min_element(sweep, {}, [&](const Candidate& candidate) {
                    const bool allowed = with_depth || candidate.plan.depth_test == DepthTest::none;
                    return allowed ? candidate.total_us(cost) : HUGE_VAL;
                });
                const double regret = choice.total_us(cost) / best.total_us(cost);
                regrets.by_factor[std::ranges::find(model_factors, factor) - model_factors].push_back(regret);
                std::fprintf(csv, "%s,%s,%g,%g,%s,%.2f,%s,%.2f,%.4f\n", scene.name.c_str(),
                             with_depth ? "both" : "none", cost, factor, words(choice.plan).c_str(),
                             choice.total_us(cost), words(best.plan).c_str(), best.total_us(cost), regret);
                if (factor != 1) continue;
                std::printf("  %5g ns%s: %-28s %9.1f us  best %-28s %9.1f us  %.3f%s\n", cost,
                            with_depth ? "      " : ", no Z", words(choice.plan).c_str(),
                            choice.total_us(cost), words(best.plan).c_str(), best.total_us(cost), regret,
                            regret > 1.15 ? "  OVER 1.15" : "");
                if (cost != evaluation_costs[0]) continue;
                for (const Plan& plan : advice.plans()) {
                    const Candidate& c = measured(plan);
                    std::fprintf(plans_csv, "%s,%s,%s,%.2f,%.2f,%.0f,%.0f\n", scene.name.c_str(),
                                 with_depth ? "both" : "none", words(plan).c_str(), plan.build_ns * 1e-3,
                                 c.build_us, plan.evaluations, c.evaluations);
                }
            }
    std::fflush(stdout);
}

using lightbin::detail::BuildTerms, lightbin::detail::predicted_ns;

/// Least squares of the ratios' logarithms, as far as (p - t)^2 / (p t) is that, with no constant below zero:
/// one constant after the other.
BuildTerms fit(const std::vector<BuildTerms>& rows, const std::vector<double>& times) {
    BuildTerms constants = {};
    std::vector<double> scales = times, rest(rows.size());
    for (int pass = 0; pass < 50; ++pass) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const double now = predicted_ns(rows[i], constants);
            if (pass > 0) scales[i] = std::sqrt(times[i] * std::max(now, 1e-3 * times[i]));
            rest[i] = (times[i] - now) / scales[i];
        }
        for (int round = 0; round < 500; ++round)
            for (std::size_t k = 0; k < constants.size(); ++k) {
                double product = 0, square = 0;
                for (std::size_t i = 0; i < rows.size(); ++i) {
                    const double part = rows[i][k] / scales[i];
                    product += part * rest[i];
                    square += part * part;
                }
                const double better = square == 0 ? 0 : std::max(0.0, constants[k] + product / square);
                for (std::size_t i = 0; i < rows.size(); ++i)
                    rest[i] -= (better - constants[k]) * rows[i][k] / scales[i];
                constants[k] = better;
            }
    }
    return constants;
}

/// A scene to learn from.
struct Lesson {
    std::shared_ptr<const Views> views;
    std::vector<Lights> sets;

    Lesson(const BenchScene& scene, std::shared_ptr<const Views> seen) : views(std::move(seen)) {
        for (std::uint32_t seed = 0; seed < turns; ++seed)
            sets.push_back(scene.lights(seed));
    }
};

/// The made scenes, and over the depth of each in turn light sets of several sizes and densities.
std::vector<Lesson> lessons() {
    std::vector<Lesson> all;
    const std::vector<BenchScene> kinds = scene_kinds();
    for (const BenchScene& scene : kinds)
        all.emplace_back(scene, std::make_shared<Views>(scene, rasterise(scene, screen)));
    std::size_t kind = 0;
    for (const std::size_t count : {1u, 16u, 100u, 400u, 1500u, 6000u})
        for (const float radius : {field4_median, field20_median, field200_median, 0.0f}) {
            BenchScene scene = kinds[kind];
            scene.lights = [=](std::uint32_t seed) {
                return radius > 0 ? field(count, radius, seed) : near_eye(count, seed);
            };
            all.emplace_back(scene, all[kind].views);
            kind = (kind + 3) % kinds.size();
        }
    return all;
}

/// Returns the tier's line of the build models.
template <Isa isa> std::string fit_tier(const std::vector<Lesson>& lessons) {
    std::vector<BuildTerms> rows;
    std::vector<double> times;
    for (const Lesson& lesson : lessons) {
        std::vector<Candidate> sweep = candidates<isa>();
        std::erase_if(sweep, [](const Candidate& c) { return c.plan.index == Index::u32; });
        time(sweep, *lesson.views, lesson.sets);
        const TiledView& finest = lesson.views->of(tile_sizes[0]);
        const auto lights = lightbin::view_space(lesson.sets[0]);
        lightbin::detail::Survey survey = lightbin::detail::survey_rectangles(
            isa, finest.view, lights, finest.bounds(), lesson.sets[0].size());
        lightbin::detail::survey_blocks(isa, finest.view, lights, finest.bounds(), 2048, survey);
        for (const Candidate& candidate : sweep)
            for (const auto& grid : survey.grids)
                for (std::size_t rung = 0; rung < std::size(lightbin::detail::rungs); ++rung)
                    if (grid.tile_size == candidate.plan.tile_size &&
                        lightbin::detail::rungs[rung].footprint == candidate.plan.footprint &&
                        lightbin::detail::rungs[rung].depth_test == candidate.plan.depth_test) {
                        rows.push_back(lightbin::detail::build_terms(survey, grid, rung));
                        times.push_back(1e3 * candidate.build_us);
                    }
    }
    const BuildTerms constants = fit(rows, times);
    std::vector<double> ratios;
    for (std::size_t i = 0; i < rows.size(); ++i)
        ratios.push_back(predicted_ns(rows[i], constants) / times[i]);
    std::ranges::sort(ratios);
    const auto at = [&](double share) {
        return ratios[static_cast<std::size_t>(share * double(ratios.size() - 1))];
    };
    std::fprintf(stderr, "%s: %zu builds, predicted over measured %.2f (5 %%), %.2f (median), %.2f (95 %%)\n",
                 name_of(isa), rows.size(), at(0.05), at(0.5), at(0.95));
    std::string line;
    for (const double constant : constants) {
        char text[32];
        std::snprintf(text, sizeof text, "%s%.3g", line.empty() ? "    {" : ", ", constant);
        line += text;
    }
    return line + "},\n";
}

void print(const Regrets& regrets) {
    std::printf("\nregret over all scenes and costs, by an error of the build model\n");
    for (std::size_t i = 0; i < std::size(model_factors); ++i) {
        const std::vector<double>& values = regrets.by_factor[i];
        const auto within = [&](double limit) {
            return std::ranges::count_if(values, [&](double regret) { return regret <= limit; });
        };
        std::printf("  times %-4g median %.3f  worst %.3f  within 1.05: %td, within 1.15: %td of %zu\n",
                    model_factors[i], median(values), *std::ranges::max_element(values), within(1.05),
                    within(1.15), values.size());
    }
    std::printf("asking over a plain build: median %.2f, worst %.2f\n", median(regrets.asking),
                *std::ranges::max_element(regrets.asking));
}

/// Calls visit.operator()<isa>() for one of the instruction sets with a build model.
template <class Visit> void with_isa(Isa isa, Visit visit) {
    switch (isa) {
    case Isa::avx512:
        return visit.template operator()<Isa::avx512>();
    case Isa::avx2:
        return visit.template operator()<Isa::avx2>();
    case Isa::sse2:
        return visit.template operator()<Isa::sse2>();
    default:
        return visit.template operator()<Isa::scalar>();
    }
}

}  // namespace

int main(int argc, char** argv) try {
    Arguments arguments(argc, argv);
    if (arguments.take("--quick")) turns = 5;
    if (arguments.take("--fit")) {
        const std::vector<Lesson> all = lessons();
        std::string lines;
        for (const Isa isa : {Isa::scalar, Isa::sse2, Isa::avx2, Isa::avx512})
            with_isa(isa, [&]<Isa tier> {
                if (lightbin::detail::machine_isa(tier) == tier) lines += fit_tier<tier>(all);
            });
        std::fputs(lines.c_str(), stdout);
        return EXIT_SUCCESS;
    }
    Isa isa = lightbin::detail::machine_isa(lightbin::Options{}.isa);
    for (const Isa named : {Isa::scalar, Isa::sse2, Isa::avx2})
        if (arguments.take(std::string("--") + name_of(named))) isa = lightbin::detail::machine_isa(named);

    std::vector<BenchScene> all = scene_kinds();
    for (const std::string& file : arguments.scenes_or_fixtures())
        for (BenchScene& scene : glb_scenes(file))
            all.push_back(std::move(scene));
    std::FILE* const plans_csv = open_report(
        "advise_plans.csv", "scene,bounds,plan,predicted_us,us,predicted_evaluations,evaluations");
    std::FILE* const csv = open_report(
        "advise.csv", "scene,bounds,evaluation_ns,model_factor,choice,choice_us,best,best_us,regret");
    Regrets regrets;
    for (const BenchScene& scene : all)
        with_isa(isa, [&]<Isa tier> { judge<tier>(scene, plans_csv, csv, regrets); });
    print(regrets);
    std::fclose(plans_csv);
    std::fclose(csv);
} catch (const std::exception& problem) {
    std::fprintf(stderr, "advise: %s\n", problem.what());
    return EXIT_FAILURE;
}
