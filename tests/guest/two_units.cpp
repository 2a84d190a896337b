// use_everything.cpp twice in one program, with different flags: it links, it runs, and both get the same
// bytes.
#include <cinttypes>
#include <cstdint>
#include <cstdio>

std::uint64_t plain_unit();
std::uint64_t tuned_unit();

int main() {
    const std::uint64_t plain = plain_unit(), tuned = tuned_unit();
    std::printf("%016" PRIx64 " %016" PRIx64 "\n", plain, tuned);
    return plain == tuned ? 0 : 1;
}
