// SPDX-License-Identifier: MIT
// campaign LIGHTS_A_FAMILY [flush]: the families at length, a line each; campaign LIGHTS whole: one scene of a
// 16384 x 16384 viewport at one-pixel tiles, which takes 8 GB. tests/campaign.sh builds it in many ways.
#include "judge.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

int main(int count, char** words) {
    using namespace oracle;
    const double lights = count > 1 ? std::atof(words[1]) : 0;
    if (lights < 1) return 2;
    const auto asked = [&](const char* word) { return count > 2 && std::strcmp(words[2], word) == 0; };
    const Engine engine(asked("flush"));
    const std::vector<Family> whole = {
        {"whole_16k_by_16k", families::whole_16k, static_cast<std::size_t>(lights)}};
    std::uint64_t wrong = 0;
    for (const Family& family : asked("whole") ? whole : all_families()) {
        Verdicts verdicts;
        const std::size_t a_scene = std::min(family.lights, static_cast<std::size_t>(lights));
        for (std::uint64_t seed = 0; static_cast<double>(seed * a_scene) < lights; ++seed)
            run_scene(family, seed, a_scene, engine, verdicts);
        wrong += verdicts.reports.size();
        std::printf("%s %llu %llu %llu %llu %zu\n", family.name.c_str(),
                    static_cast<unsigned long long>(verdicts.cases),
                    static_cast<unsigned long long>(verdicts.proven),
                    static_cast<unsigned long long>(verdicts.exact),
                    static_cast<unsigned long long>(verdicts.misses), verdicts.reports.size());
        std::fflush(stdout);
        for (const std::string& report : verdicts.reports)
            std::fprintf(stderr, "%s\n", report.c_str());
    }
    return wrong == 0 ? 0 : 1;
}
