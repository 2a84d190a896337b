// SPDX-License-Identifier: MIT
#include "texts.hpp"

#include "binned_lights.hpp"

#include <lightbin/shader.hpp>
#include <lightbin/shader_build.hpp>

#include <nlohmann/json.hpp>

#include <stdexcept>
#include <string_view>

namespace {

using nlohmann::json;

// The value of an enum that has a name among the options; its first value where there is none.
template <class Enum> Enum named(const json& options, const char* key) {
    const std::string name = options.value(key, to_string(Enum{}));
    for (int place = 0; to_string(static_cast<Enum>(place)) != std::string_view("?"); ++place)
        if (to_string(static_cast<Enum>(place)) == name) return static_cast<Enum>(place);
    throw std::runtime_error(std::string("there is no ") + key + " '" + name + "'");
}

bool flag(const json& options, const char* key) {
    return options.value(key, false);
}

lightbin::ShaderText snippet(const json& from) {
    lightbin::ShaderOptions options;
    options.language = named<lightbin::ShaderLanguage>(from, "language");
    options.storage = options.language == lightbin::ShaderLanguage::essl_300
                          ? lightbin::ListStorage::texture_2d
                          : lightbin::ListStorage::storage_buffer;
    options.slicing = named<lightbin::Slicing>(from, "slicing");
    options.heat_map = flag(from, "heat_map");
    options.view_check = flag(from, "view_check");
    options.list_check = flag(from, "list_check");
    return value_of(lightbin::shader_snippet(options));
}

lightbin::ShaderText reduce(const json& from) {
    lightbin::ReduceShaderOptions options;
    options.language = named<lightbin::ShaderLanguage>(from, "language");
    options.stage = named<lightbin::ShaderStage>(from, "stage");
    options.orthographic = flag(from, "orthographic");
    options.skip_background = flag(from, "skip_background");
    return value_of(lightbin::reduce_shader(options));
}

lightbin::ShaderText build(const json& from) {
    lightbin::BuildShaderOptions options;
    options.language = named<lightbin::ShaderLanguage>(from, "language");
    options.pass = named<lightbin::BuildPass>(from, "pass");
    options.depth_test = named<lightbin::DepthTest>(from, "depth_test");
    options.slicing = named<lightbin::Slicing>(from, "slicing");
    options.max_only = flag(from, "max_only");
    options.orthographic = flag(from, "orthographic");
    return value_of(lightbin::build_shader(options));
}

}  // namespace

json shader_text(const std::string& what, const json& options) {
    const lightbin::ShaderText text = what == "snippet"  ? snippet(options)
                                      : what == "reduce" ? reduce(options)
                                      : what == "build"
                                          ? build(options)
                                          : throw std::runtime_error("there is no text '" + what + "'");
    json bindings = json::array();
    for (const lightbin::ShaderBinding& binding : text.bindings)
        bindings.push_back({{"name", binding.name},
                            {"resource", to_string(binding.resource)},
                            {"set", binding.slot.set},
                            {"binding", binding.slot.binding},
                            {"format", to_string(binding.format)},
                            {"stride", binding.stride},
                            {"bytes", binding.bytes},
                            {"width", binding.width}});
    return {{"text", text.text}, {"bindings", bindings}};
}
