// SPDX-License-Identifier: MIT
// The adapter's one C++20 file. It leaves out what light_lists.hpp does not use: docs/c.md says what that saves.
#define LIGHTBIN_NO_BOXES
#define LIGHTBIN_NO_U16
#define LIGHTBIN_NO_SHADERS
#define LIGHTBIN_IMPLEMENTATION
#include <lightbin/lightbin.h>
