// SPDX-License-Identifier: MIT
// families LIGHTS: proves that no light is missed in families of stiff and extreme inputs, so many lights each: in
// lists with and without depth test, and in masks, on every instruction set. Prints a line a family: lights, proofs,
// those of them in rationals, misses, complaints.
#include "judge.hpp"

#include <cstdlib>

using namespace oracle;

int main(int count, char** words) {
    const std::uint64_t lights = count > 1 ? std::strtoull(words[1], nullptr, 10) : 4000;
    std::size_t wrong = 0;
    for (const Family& family : all_families()) {
        Verdicts verdicts;
        // Scenes of 500 lights, to have many cameras and many lights; then scenes of 1 to 70, about as many as a vector
        // or a word of bits has.
        const std::uint64_t large = (lights + 499) / 500;
        for (std::uint64_t seed = 0; seed < large + 70; ++seed) {
            Random random(seed_of(family.name) + seed * 0x9e3779b97f4a7c15u);
            const Scene scene = family.make(random, seed < large ? 500 : seed - large + 1);
            const std::size_t before = verdicts.reports.size();
            if (const auto view = library_view(scene.camera))
                judge_scene(scene, *view, verdicts);
            else
                verdicts.reports.push_back("the camera was refused: " + std::string(view.error().message()));
            for (std::size_t i = before; i < verdicts.reports.size(); ++i)
                verdicts.reports[i] += ", of seed " + std::to_string(seed);
        }
        if (verdicts.proven < lights) verdicts.reports.push_back("too few proofs");
        wrong += verdicts.reports.size();
        std::printf("%s %llu %llu %llu %llu %zu\n", family.name.c_str(), static_cast<unsigned long long>(lights),
                    static_cast<unsigned long long>(verdicts.proven), static_cast<unsigned long long>(verdicts.exact),
                    static_cast<unsigned long long>(verdicts.misses), verdicts.reports.size());
        std::fflush(stdout);
        for (const std::string& report : verdicts.reports)
            std::fprintf(stderr, "%s: %s\n", family.name.c_str(), report.c_str());
    }
    return wrong == 0 ? 0 : 1;
}
