// SPDX-License-Identifier: MIT
// campaign LIGHTS_A_FAMILY [flush]: the families at length, a line each. tests/campaign.sh builds it in many ways.
#include "judge.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

int main(int count, char** words) {
    using namespace oracle;
    const double lights = count > 1 ? std::atof(words[1]) : 0;
    if (lights < 1) return 2;
    const Engine engine(count > 2 && std::strcmp(words[2], "flush") == 0);
    std::uint64_t wrong = 0;
    for (const Family& family : all_families()) {
        Verdicts verdicts;
        for (std::uint64_t seed = 0; static_cast<double>(seed * family.lights) < lights; ++seed)
            run_scene(family, seed, family.lights, engine, verdicts);
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
