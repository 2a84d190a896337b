// SPDX-License-Identifier: MIT
// A corpus in one file: each input after its length in two bytes, low one first.
//   PROGRAM CORPUS             runs the fuzz target on every input
//   PROGRAM --unpack CORPUS DIRECTORY,  --pack DIRECTORY CORPUS
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#if defined(NO_TARGET)  // only to pack and unpack
static int LLVMFuzzerTestOneInput(const std::uint8_t*, std::size_t) {
    return 0;
}
#else
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
#endif

namespace {

using Input = std::vector<char>;

Input read_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<Input> unpacked(const std::filesystem::path& corpus) {
    const Input all = read_file(corpus);
    std::vector<Input> inputs;
    for (std::size_t at = 0; at + 2 <= all.size();) {
        const auto size = static_cast<std::size_t>(static_cast<unsigned char>(all[at]) +
                                                   256 * static_cast<unsigned char>(all[at + 1]));
        at += 2;
        if (at + size > all.size()) return {};
        inputs.emplace_back(all.data() + at, all.data() + at + size);
        at += size;
    }
    return inputs;
}

}  // namespace

int main(int count, char** words) {
    const std::vector<std::string> arguments(words + 1, words + count);
    if (arguments.size() == 3 && arguments[0] == "--pack") {
        std::ofstream out(arguments[2], std::ios::binary);
        for (const auto& entry : std::filesystem::directory_iterator(arguments[1])) {
            const Input input = read_file(entry.path());
            if (input.size() > 0xffff) continue;
            out.put(static_cast<char>(input.size() & 0xff)).put(static_cast<char>(input.size() >> 8));
            out.write(input.data(), static_cast<std::streamsize>(input.size()));
        }
        return out.flush() ? 0 : 1;
    }
    const bool unpack = arguments.size() == 3 && arguments[0] == "--unpack";
    if (!unpack && arguments.size() != 1) return 2;
    const std::vector<Input> inputs = unpacked(arguments[unpack ? 1 : 0]);
    if (inputs.empty()) {
        std::fprintf(stderr, "no corpus in %s\n", arguments[unpack ? 1 : 0].c_str());
        return 1;
    }
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Input& input = inputs[i];
        if (unpack)
            std::ofstream(std::filesystem::path(arguments[2]) / std::to_string(i), std::ios::binary)
                .write(input.data(), static_cast<std::streamsize>(input.size()));
        else
            LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
    }
    std::printf("%zu inputs\n", inputs.size());
    return 0;
}
