// Runs use_everything.cpp compiled with two sets of flags in one program. Without an argument only the unit with plain
// flags runs, as on any machine; with an argument both run and must get the same bytes.
#include <cinttypes>
#include <cstdint>
#include <cstdio>

std::uint64_t plain_unit();
std::uint64_t tuned_unit();

int main(int argc, char**) {
    const std::uint64_t plain = plain_unit(), tuned = argc > 1 ? tuned_unit() : plain;
    std::printf("%016" PRIx64 " %016" PRIx64 "\n", plain, tuned);
    return plain == tuned ? 0 : 1;
}
