// SPDX-License-Identifier: MIT
// Compiles every HLSL text: compile fxc|dxc PROFILES [PART PARTS] takes every PARTS-th text from PART on;
// PROFILES: 5_0, 5_1, 6_0, 6_6.
#include "dxc.hpp"
#include "fxc.hpp"

#include "../readers.hpp"

int main(int count, char** arguments) {
    if (count != 3 && count != 5) return 2;
    const std::string compiler = arguments[1], model = arguments[2];
    const std::size_t part = count == 5 ? std::stoul(arguments[3]) : 0;
    const std::size_t parts = count == 5 ? std::stoul(arguments[4]) : 1;

    const auto compiles = [&](const std::string& text, Stage stage, std::string& error) {
        const std::string profile = (stage == Stage::compute ? "cs_" : "ps_") + model;
        if (compiler == "fxc") {
            static const Fxc fxc;
            return !fxc(text, profile.c_str(), error).empty();
        }
        static const Dxc dxc;
        return dxc(text, std::wstring(profile.begin(), profile.end()).c_str(), error);
    };
    std::string error;
    if (compiles("uint main() : SV_Target { return x; }", Stage::fragment, error) || error.empty()) {
        std::printf("%s accepts what is wrong\n", compiler.c_str());
        return 1;
    }

    int texts = 0, refused = 0;
    const auto list = every_reader(model == "5_0" ? lightbin::ShaderLanguage::hlsl_5_0
                                                  : lightbin::ShaderLanguage::hlsl_5_1);
    for (std::size_t i = part; i < list.size(); i += parts)
        for (const Stage stage : {Stage::fragment, Stage::compute}) {
            ++texts;
            const auto snippet = lightbin::shader_snippet(list[i]);
            const std::string text = snippet ? reader_text(list[i], *snippet, stage, 100, 100) : "";
            if (snippet && compiles(text, stage, error)) continue;
            if (++refused <= 5)
                std::printf("%s is refused: %s\n%s\n", name_of(list[i]).c_str(), error.c_str(), text.c_str());
        }
    std::printf("%s %s: %d texts, %d refused\n", compiler.c_str(), model.c_str(), texts, refused);
    return texts == 0 || refused > 0;
}
