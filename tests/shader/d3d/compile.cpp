// SPDX-License-Identifier: MIT
// Compiles every HLSL text: compile fxc|dxc MODEL [FIRST COUNT] takes a share of them. MODEL: 5_0, 5_1, 6_0 ...
#include "dxc.hpp"
#include "fxc.hpp"

#include "../cull.hpp"
#include "../run_jobs.hpp"

namespace {

template <class Compiler> int compile_all(const std::string& model, const Share& share) {
    const Compiler compiler;
    int texts = 0, refused = 0;
    const auto compiles = [&](const std::string& name, const std::string& text, Stage stage) {
        ++texts;
        try {
            compiler(text, (stage == Stage::compute ? "cs_" : "ps_") + model);
        } catch (const std::runtime_error& error) {
            if (++refused <= 3)
                std::printf("%s is refused: %s\n%s\n", name.c_str(), error.what(), text.c_str());
        }
    };
    std::printf("to be refused:\n");
    compiles("a wrong text", "uint main() : SV_Target { return x; }", Stage::fragment);
    if (refused != 1) {
        std::printf("a wrong text is not refused\n");
        return 1;
    }
    texts = refused = 0;

    const auto language =
        model == "5_0" ? lightbin::ShaderLanguage::hlsl_5_0 : lightbin::ShaderLanguage::hlsl_5_1;
    const auto readers = every_reader(language);
    for (std::size_t i = share.first; i < readers.size(); i += share.count) {
        if (readers[i].wave_loop && model < "6") continue;
        for (const Stage stage : {Stage::fragment, Stage::compute}) {
            const auto snippet = lightbin::shader_snippet(readers[i]);
            compiles(name_of(readers[i]), snippet ? reader_text(readers[i], *snippet, stage, 100, 100) : "",
                     stage);
        }
    }
    // From model 6.1 on, SV_ViewID is the number of a view. In older models a view is a layer of the target.
    const auto multiview = multiview_runs(language);
    for (std::size_t i = share.first; i < multiview.size(); i += share.count) {
        const Job job = multiview[i].job();
        compiles(job.name, model >= "6_1" ? job.text : with_layers(job.text), Stage::fragment);
    }
    for (std::size_t i = share.first; const auto& options : every_reduction(language))
        if (i++ % share.count == 0) {
            const auto shader = lightbin::reduce_shader(options);
            compiles("a reduction", shader->text,
                     options.stage == lightbin::ShaderStage::compute ? Stage::compute : Stage::fragment);
        }
    for (std::size_t i = share.first; const CullText& text : every_cull(language))
        if (i++ % share.count == 0)
            compiles(std::string("the pass ") + to_string(text.pass), text.shader().text, Stage::compute);
    std::printf("%d texts, %d refused\n", texts, refused);
    return texts == 0 || refused > 0;
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 3) return 2;
    const Share share = share_of(count - 2, arguments + 2);
    return std::string(arguments[1]) == "fxc" ? compile_all<Fxc>(arguments[2], share)
                                              : compile_all<Dxc>(arguments[2], share);
}
