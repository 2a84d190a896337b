// SPDX-License-Identifier: MIT
// Is advise() right? For each scene every plan is measured (build time on rotating light sets, evaluations of
// the first one counted over the drawn pixels), and what the chosen one costs is held against the cheapest.
//
//   advise_plans.csv   a row a plan: predicted and measured build time and evaluations
//   advise.csv         a row for each scene, cost of an evaluation and error of the build model (factor): the
//                      choice, the best plan, and the regret, their ratio
//
// With --fit: fits the constants of detail/build_model.hpp on made scenes and light sets instead, and prints
// them.
#include "glb_scenes.hpp"
#include "ladder.hpp"

#include <cmath>
#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <span>

namespace {

using lightbin::Index;
using lightbin::Isa;
using lightbin::Plan;

constexpr Method methods[] = {
    {Footprint::rectangle, DepthTest::none},  {Footprint::rectangle, DepthTest::interval},
    {Footprint::rectangle, DepthTest::box},   {Footprint::rectangle, DepthTest::split_box},
    {Footprint::silhouette, DepthTest::none}, {Footprint::silhouette, DepthTest::interval},
    {Footprint::silhouette, DepthTest::box},  {Footprint::silhouette, DepthTest::split_box},
};
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
        const auto bin = std::make_shared<Bin<methods[method], index, isa>>();
        for (const int tile_size : tile_sizes)
            all.push_back({.plan = {.footprint = methods[method].footprint,
                                    .depth_test = methods[method].depth_test,
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
    (std::make_index_sequence<std::size(methods)>{});
    return all;
}

/// The views of all plans on a scene, by tile size.
class Views {
public:
    Views(const BenchScene& scene, const Picture& picture) : picture_(&picture) {
        for (const int tile_size : {8, 16, 32, 64, screen.width})
            views_.emplace_back(scene, picture, tile_size);
    }

    const TiledView& of(int tile_size) const {
        return *std::ranges::find_if(views_,
                                     [&](const TiledView& v) { return v.view.tile_size() == tile_size; });
    }

    /// Sum over the drawn pixels of their tiles' counts.
    double evaluations(const TiledView& view, std::span<const lightbin::Tile> tiles) const {
        double sum = 0;
        for (int y = 0; y < screen.height; ++y)
            for (int x = 0; x < screen.width; ++x) {
                const int t = view.view.tile_size(), tile = y / t * view.view.tiles_x() + x / t;
                if (picture_->triangle[static_cast<std::size_t>(y * screen.width + x)] != Picture::nothing)
                    sum += tiles[static_cast<std::size_t>(tile)].count;
            }
        return sum;
    }

private:
    const Picture* picture_;
    std::vector<TiledView> views_;
};

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

bool same(const Plan& a, const Plan& b) {
    return a.tiled == b.tiled && (!a.tiled || (a.footprint == b.footprint && a.depth_test == b.depth_test &&
                                               a.index == b.index && a.tile_size == b.tile_size));
}

struct Regrets {
    std::vector<double> by_factor[std::size(model_factors)];
    std::vector<double> asking;  ///< over the plain build at the view's tile size
};

void judge(const BenchScene& scene, std::FILE* plans_csv, std::FILE* csv, Regrets& regrets) {
    const Picture picture = rasterise(scene, screen);
    const Views views(scene, picture);
    std::vector<Lights> sets;
    for (std::uint32_t seed = 0; seed < turns; ++seed)
        sets.push_back(scene.lights(seed));

    std::vector<Candidate> sweep = candidates<lightbin::Options{}.isa>();
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
        candidate.evaluations = views.evaluations(view, candidate.build(view, sets[0]));
    }
    const std::vector<lightbin::Tile> one(1, {0, static_cast<std::uint32_t>(sets[0].size())});
    sweep.push_back({{.tiled = false}, {}, 0, views.evaluations(views.of(screen.width), one)});

    const TiledView& finest = views.of(tile_sizes[0]);
    std::vector<double> asking;
    for (std::size_t turn = 0; turn < turns + 1; ++turn) {
        const auto ask = [&] {
            if (!lightbin::advise(finest.view, sets[turn % turns], {}, finest.bounds())) std::abort();
        };
        const double time = seconds(ask);
        if (turn > 0) asking.push_back(time);
    }
    const double ask_us = 1e6 * median(asking);
    const auto measured = [&](const Plan& plan) -> const Candidate& {
        const auto found =
            std::ranges::find_if(sweep, [&](const Candidate& c) { return same(c.plan, plan); });
        if (found == sweep.end())
            std::fprintf(stderr, "advise: no such plan: %s\n", words(plan).c_str()), std::abort();
        return *found;
    };
    const double plain_us = measured({.index = Index::u32, .tile_size = tile_sizes[0]}).build_us;
    regrets.asking.push_back(ask_us / plain_us);
    std::printf("\n%s: %zu lights; asking %.1f us, %.2f of the plain build of %.1f us\n", scene.name.c_str(),
                sets[0].size(), ask_us, ask_us / plain_us, plain_us);

    for (const double cost : evaluation_costs)
        for (const double factor : model_factors) {
            const auto advice = *lightbin::advise(
                finest.view, sets[0], {.evaluation_ns = cost, .machine = factor}, finest.bounds());
            const Candidate& choice = measured(advice.best());
            const Candidate& best = *std::ranges::min_element(
                sweep, {}, [&](const Candidate& candidate) { return candidate.total_us(cost); });
            const double regret = choice.total_us(cost) / best.total_us(cost);
            regrets.by_factor[std::ranges::find(model_factors, factor) - model_factors].push_back(regret);
            std::fprintf(csv, "%s,%g,%g,%s,%.2f,%s,%.2f,%.4f,%.2f,%.2f\n", scene.name.c_str(), cost, factor,
                         words(choice.plan).c_str(), choice.total_us(cost), words(best.plan).c_str(),
                         best.total_us(cost), regret, ask_us, choice.build_us);
            if (factor != 1) continue;
            std::printf("  %5g ns: %-28s %9.1f us  best %-28s %9.1f us  %.3f%s\n", cost,
                        words(choice.plan).c_str(), choice.total_us(cost), words(best.plan).c_str(),
                        best.total_us(cost), regret, regret > 1.15 ? "  OVER 1.15" : "");
            if (cost != evaluation_costs[0]) continue;
            for (const Plan& plan : advice.plans()) {
                const Candidate& c = measured(plan);
                std::fprintf(plans_csv, "%s,%s,%.2f,%.2f,%.0f,%.0f\n", scene.name.c_str(),
                             words(plan).c_str(), plan.build_ns * 1e-3, c.build_us, plan.evaluations,
                             c.evaluations);
            }
        }
    std::fflush(stdout);
}

/// Least squares of the relative error with no constant below zero, one constant after the other.
lightbin::detail::BuildTerms fit(const std::vector<lightbin::detail::BuildTerms>& rows,
                                 const std::vector<double>& times) {
    lightbin::detail::BuildTerms constants = {};
    std::vector<double> rest(rows.size(), 1);
    for (int round = 0; round < 20000; ++round)
        for (std::size_t k = 0; k < constants.size(); ++k) {
            double product = 0, square = 0;
            for (std::size_t i = 0; i < rows.size(); ++i) {
                const double part = rows[i][k] / times[i];
                product += part * rest[i];
                square += part * part;
            }
            if (square == 0) continue;
            const double better = std::max(0.0, constants[k] + product / square);
            for (std::size_t i = 0; i < rows.size(); ++i)
                rest[i] -= (better - constants[k]) * rows[i][k] / times[i];
            constants[k] = better;
        }
    return constants;
}

/// A scene to learn from.
struct Lesson {
    std::shared_ptr<const Picture> picture;
    std::shared_ptr<const Views> views;
    std::vector<Lights> sets;

    Lesson(const BenchScene& scene, const Lesson* same_depth = nullptr) {
        if (same_depth != nullptr) {
            picture = same_depth->picture;
            views = same_depth->views;
        } else {
            picture = std::make_shared<Picture>(rasterise(scene, screen));
            views = std::make_shared<Views>(scene, *picture);
        }
        for (std::uint32_t seed = 0; seed < turns; ++seed)
            sets.push_back(scene.lights(seed));
    }
};

/// The made scenes, and light sets of several sizes and densities over the depth of one of them.
std::vector<Lesson> lessons() {
    std::vector<Lesson> all;
    for (const BenchScene& scene : scene_kinds())
        all.emplace_back(scene);
    BenchScene set = scenes::field_with_depth();
    const Lesson ground(set);
    for (const std::size_t count : {1u, 16u, 100u, 400u, 1500u, 6000u})
        for (const float radius : {field4_median, field20_median, field200_median, 0.0f}) {
            set.lights = [=](std::uint32_t seed) {
                return radius > 0 ? field(count, radius, seed) : near_eye(count, seed);
            };
            all.emplace_back(set, &ground);
        }
    return all;
}

template <Isa isa> void fit_tier(const std::vector<Lesson>& lessons) {
    if (lightbin::detail::machine_isa(isa) != isa) return;
    std::vector<lightbin::detail::BuildTerms> rows;
    std::vector<double> times;
    for (const Lesson& lesson : lessons) {
        const Views& views = *lesson.views;
        const std::vector<Lights>& sets = lesson.sets;
        std::vector<Candidate> sweep = candidates<isa>();
        std::erase_if(sweep, [](const Candidate& c) { return c.plan.index == Index::u32; });
        time(sweep, views, sets);
        const TiledView& finest = views.of(tile_sizes[0]);
        const auto survey = lightbin::detail::survey(isa, finest.view, lightbin::view_space(sets[0]),
                                                     finest.bounds(), sets[0].size(), 8192);
        for (const Candidate& candidate : sweep)
            for (const auto& grid : std::span(survey.grids).first(survey.grid_count))
                for (const auto& rung : std::span(grid.rungs).first(grid.rung_count))
                    if (grid.tile_size == candidate.plan.tile_size &&
                        rung.footprint == candidate.plan.footprint &&
                        rung.depth_test == candidate.plan.depth_test) {
                        rows.push_back(lightbin::detail::build_terms(survey, grid, rung));
                        times.push_back(1e3 * candidate.build_us);
                    }
    }
    const lightbin::detail::BuildTerms constants = fit(rows, times);
    std::vector<double> ratios;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        double predicted = 0;
        for (std::size_t k = 0; k < constants.size(); ++k)
            predicted += rows[i][k] * constants[k];
        ratios.push_back(predicted / times[i]);
    }
    std::ranges::sort(ratios);
    std::printf("    {");
    for (std::size_t k = 0; k < constants.size(); ++k)
        std::printf("%s%.3g", k == 0 ? "" : ", ", constants[k]);
    const auto at = [&](double share) {
        return ratios[static_cast<std::size_t>(share * double(ratios.size() - 1))];
    };
    std::printf("},  // %zu builds: predicted over measured %.2f (5 %%), %.2f (median), %.2f (95 %%)\n",
                rows.size(), at(0.05), at(0.5), at(0.95));
    std::fflush(stdout);
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

}  // namespace

int main(int argc, char** argv) try {
    std::vector<std::string> files;
    bool fitting = false;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--quick") == 0)
            turns = 5;
        else if (std::strcmp(argv[i], "--fit") == 0)
            fitting = true;
        else
            files.emplace_back(argv[i]);
    }
    if (fitting) {
        const std::vector<Lesson> all = lessons();
        fit_tier<Isa::scalar>(all);
        fit_tier<Isa::sse2>(all);
        fit_tier<Isa::avx2>(all);
        fit_tier<Isa::avx512>(all);
        return EXIT_SUCCESS;
    }
    if (files.empty()) files = {LIGHTBIN_FIXTURES "/nova.glb", LIGHTBIN_FIXTURES "/darkness.glb"};
    std::vector<BenchScene> all = scene_kinds();
    for (const std::string& file : files)
        for (BenchScene& scene : glb_scenes(file))
            all.push_back(std::move(scene));

    std::FILE* const plans_csv =
        open_report("advise_plans.csv", "scene,plan,predicted_us,us,predicted_evaluations,evaluations");
    std::FILE* const csv =
        open_report("advise.csv", "scene,evaluation_ns,model_factor,choice,choice_us,best,best_us,"
                                  "regret,asking_us,choice_build_us");
    Regrets regrets;
    for (const BenchScene& scene : all)
        judge(scene, plans_csv, csv, regrets);
    print(regrets);
    std::fclose(plans_csv);
    std::fclose(csv);
} catch (const std::exception& problem) {
    std::fprintf(stderr, "advise: %s\n", problem.what());
    return EXIT_FAILURE;
}
