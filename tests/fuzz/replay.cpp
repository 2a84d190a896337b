// SPDX-License-Identifier: MIT
// PROGRAM CORPUS: runs the fuzz target on every input in a file. Each input follows its length in two bytes, low byte
// first.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int count, char** words) {
    if (count != 2) return 2;
    std::ifstream file(words[1], std::ios::binary);
    const std::vector<char> all{std::istreambuf_iterator<char>(file), {}};
    int inputs = 0;
    for (std::size_t at = 0; at + 2 <= all.size(); ++inputs) {
        const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(all[i])); };
        const std::size_t size = byte(at) + 256 * byte(at + 1);
        at += 2;
        if (at + size > all.size()) return 1;
        // A copy of exactly the input's size, so that a sanitizer notices reads beyond its end.
        const std::vector<std::uint8_t> input(all.data() + at, all.data() + at + size);
        LLVMFuzzerTestOneInput(input.data(), size);
        at += size;
    }
    std::printf("%d inputs\n", inputs);
    return inputs > 0 ? 0 : 1;
}
