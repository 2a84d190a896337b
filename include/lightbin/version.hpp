// SPDX-License-Identifier: MIT
// The one place that holds the version; CMakeLists.txt reads it from here.
#pragma once

#include <lightbin/detail/base/abi_tag.hpp>

#define LIGHTBIN_VERSION_MAJOR 0
#define LIGHTBIN_VERSION_MINOR 1
#define LIGHTBIN_VERSION_PATCH 0
