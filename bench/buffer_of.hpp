// SPDX-License-Identifier: MIT
// Which buffer a shader's binding is for.
#pragma once

#include <lightbin/shader_text.hpp>

#include <string>

/// Returns a binding's name without the prefix `lightbin_` and the ending `_block`.
inline std::string buffer_of(const lightbin::ShaderBinding& binding) {
    std::string name = binding.name;
    const std::string prefix = "lightbin_", end = "_block";
    if (name.starts_with(prefix)) name.erase(0, prefix.size());
    if (name.ends_with(end)) name.erase(name.size() - end.size());
    return name;
}
