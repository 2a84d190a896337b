// SPDX-License-Identifier: MIT
// For editors and language servers, which open a kernel's file (.inl) alone: declares the scalar tier's vector class, so that
// the file reads as the scalar tier's. No build includes it.
#pragma once

#define LIGHTBIN_IN_EDITOR
#include <lightbin/detail/tiers/scalar.hpp>
