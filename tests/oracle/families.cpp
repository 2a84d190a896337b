// SPDX-License-Identifier: MIT
// No miss in families of stiff and extreme inputs, in any rung and tier.
#include "judge.hpp"

#include <doctest/doctest.h>

using namespace oracle;

namespace {

constexpr std::size_t lights_a_family = 100000;

void prove(const Family& family) {
    std::uint64_t wrong = 0, answered = 0;
    for (std::uint64_t seed = 0; seed < 10; ++seed)
        answered += test_filter(family, seed, 150, wrong);
    CHECK(wrong == 0);
    CHECK(answered > 100);

    Verdicts verdicts;
    for (std::uint64_t seed = 0; seed * family.lights < lights_a_family; ++seed)
        run_scene(family, seed, family.lights, Engine(), verdicts);
    MESSAGE(family.name << ": " << verdicts.cases << " cases, " << verdicts.proven << " proofs, "
                        << verdicts.exact << " of them in rationals");
    for (const std::string& report : verdicts.reports)
        FAIL_CHECK(report);
    CHECK(verdicts.misses == 0);
    CHECK(verdicts.strays == 0);
    CHECK(verdicts.cases >= lights_a_family * all_rungs().size());
    CHECK(verdicts.proven >= lights_a_family / 10);
}

}  // namespace

#define PROVE_FAMILY(name, lights)                                                                           \
    TEST_CASE("family: " #name) {                                                                            \
        prove({#name, families::name, lights});                                                              \
    }
ORACLE_FAMILIES(PROVE_FAMILY)
