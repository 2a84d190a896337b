// SPDX-License-Identifier: MIT
// The texts that lightbin generates for shaders.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

// what  `snippet`, `reduce` or `build`. Returns the text and what it wants bound.
nlohmann::json shader_text(const std::string& what, const nlohmann::json& options);
