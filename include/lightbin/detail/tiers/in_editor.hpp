// SPDX-License-Identifier: MIT
// What a kernel's file (.inl) includes when an editor's language server opens it alone: the vector class of the scalar
// tier, so that the file is understood as the scalar tier's text. No build of a program includes it.
#pragma once

#define LIGHTBIN_IN_EDITOR
#include <lightbin/detail/tiers/scalar.hpp>
