// SPDX-License-Identifier: MIT
// The library for C, for those who link a library in place of a file of their own with these two lines.
#define LIGHTBIN_IMPLEMENTATION
#include <lightbin/lightbin.h>
