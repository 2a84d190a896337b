// SPDX-License-Identifier: MIT
// No miss in families of stiff and extreme inputs, in any rung and tier.
#include "judge.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>

using namespace oracle;

namespace {

/// LIGHTBIN_TEST_SHARE: the tests in emulators ask for fewer.
std::size_t lights_a_family() {
    const char* const share = std::getenv("LIGHTBIN_TEST_SHARE");
    return share ? 1000 : 100000;
}

void prove(const Family& family) {
    const std::size_t wanted = lights_a_family();
    std::uint64_t wrong = 0, answered = 0;
    // Beside the library, so an emulator has nothing to add.
    const std::uint64_t scenes = wanted < 100000 ? 2 : 10;
    for (std::uint64_t seed = 0; seed < scenes; ++seed)
        answered += test_filter(family, seed, 150, wrong);
    CHECK(wrong == 0);
    CHECK(answered > 10 * scenes);

    Verdicts verdicts;
    const std::size_t a_scene = std::min(family.lights, wanted);
    for (std::uint64_t seed = 0; seed * a_scene < wanted; ++seed)
        run_scene(family, seed, a_scene, Engine(), verdicts);
    MESSAGE(family.name << ": " << verdicts.cases << " cases, " << verdicts.proven << " proofs, "
                        << verdicts.exact << " of them in rationals");
    for (const std::string& report : verdicts.reports)
        FAIL_CHECK(report);
    CHECK(verdicts.misses == 0);
    CHECK(verdicts.strays == 0);
    CHECK(verdicts.cases >= wanted * all_rungs().size());
    CHECK(verdicts.proven >= wanted / 10);
}

}  // namespace

#define PROVE_FAMILY(name, lights)                                                                           \
    TEST_CASE("family: " #name) {                                                                            \
        prove({#name, families::name, lights});                                                              \
    }
ORACLE_FAMILIES(PROVE_FAMILY)
