// SPDX-License-Identifier: MIT
// campaign LIGHTS_A_FAMILY [flush]: proves that no light is missed in families of stiff and extreme inputs, with and
// without depth test, on every instruction set. Prints a line a family: cases, proofs, those of them in rationals,
// misses, complaints. `flush` sets FTZ and DAZ. campaign LIGHTS whole: one scene of a 16384 x 16384 viewport at
// one-pixel tiles, which takes 8 GB. ctest runs this program, and tests/campaign.sh builds it in many ways. Where
// LIGHTBIN_TEST_SHARE is set, as for emulators, a family has at most 1,000 lights.
#include "judge.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

using namespace oracle;

/// Whether the judge's own filter agrees with rationals, and answers often enough.
[[maybe_unused]] void prove_filter(const Family& family, std::uint64_t scenes, Verdicts& verdicts) {
    std::uint64_t wrong = 0, answered = 0;
    for (std::uint64_t seed = 0; seed < scenes; ++seed)
        answered += test_filter(family, seed, 150, wrong);
    if (wrong > 0 || answered <= 10 * scenes)
        verdicts.reports.push_back(family.name + ": the filter answers " + std::to_string(answered) + " questions, " +
                                   std::to_string(wrong) + " of them wrongly");
}

}  // namespace

int main(int count, char** words) {
    double lights = count > 1 ? std::atof(words[1]) : 0;
    if (lights < 1) return 2;
    if (std::getenv("LIGHTBIN_TEST_SHARE") != nullptr) lights = std::min(lights, 1000.0);
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
        if (count == 2) {
            if (static_cast<double>(verdicts.cases) < lights * static_cast<double>(all_rungs().size()) ||
                static_cast<double>(verdicts.proven) < lights / 10)
                verdicts.reports.push_back(family.name + ": too few cases or proofs");
#if !defined(ORACLE_WITHOUT_GMP)
            prove_filter(family, lights < 100000 ? 2 : 10, verdicts);
#endif
        }
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
