// SPDX-License-Identifier: MIT
// Stability: settled.
// The version of the library. CMakeLists.txt reads it from this file.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#define LIGHTBIN_VERSION_MAJOR 0
#define LIGHTBIN_VERSION_MINOR 1
#define LIGHTBIN_VERSION_PATCH 0
