// SPDX-License-Identifier: MIT
// Compiles every HLSL text: compile fxc|dxc MODEL [FIRST COUNT] takes a share of them. MODEL: 5_0, 5_1, 6_0 ...
#include "dxc.hpp"
#include "fxc.hpp"

#include "../run_jobs.hpp"
#include "../texts.hpp"

namespace {

template <class Compiler> int compile_all(const std::string& model, const Share& share) {
    const Compiler compiler;
    Tally tally, of_wrong;
    const auto compile = [&](Tally& counts, const Job& job, const std::string& text) {
        counts.count(job, [&] {
            compiler(text, (job.stage == Stage::compute ? "cs_" : "ps_") + model);
            return true;
        });
    };
    Job wrong;
    wrong.name = "a wrong text, as it must be,";
    wrong.stage = Stage::fragment;
    compile(of_wrong, wrong, "uint main() : SV_Target { return x; }");
    each_text(model == "5_0" ? lightbin::ShaderLanguage::hlsl_5_0 : lightbin::ShaderLanguage::hlsl_5_1, share,
              [&](const Job& job) {
                  if (model < "6" && job.text.find("WaveActiveMin") != job.text.npos) return;
                  // From model 6.1 on, SV_ViewID is a view's number. In older models each view is drawn to a layer of
                  // the target.
                  compile(tally, job, job.views > 1 && model < "6_1" ? with_layers(job.text) : job.text);
              });
    std::printf("%s\n", tally.text("texts").c_str());
    return !tally.good() || of_wrong.refused != 1;
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 3) return 2;
    const Share share = share_of(count - 2, arguments + 2);
    return std::string(arguments[1]) == "fxc" ? compile_all<Fxc>(arguments[2], share)
                                              : compile_all<Dxc>(arguments[2], share);
}
