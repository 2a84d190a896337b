// SPDX-License-Identifier: MIT
// The file in C++20. It leaves out what light_lists.hpp does not ask for: docs/c.md has a table of what that saves.
#define LIGHTBIN_NO_BOXES
#define LIGHTBIN_NO_U16
#define LIGHTBIN_NO_Z_BINS
#define LIGHTBIN_NO_SHADERS
#define LIGHTBIN_IMPLEMENTATION
#include <lightbin/lightbin.h>
