// SPDX-License-Identifier: MIT
// What every tier includes: the types and the standard headers that its kernels' text, the .inl files, works with.
#pragma once

#include <lightbin/detail/footprint.hpp>
#include <lightbin/detail/platform.hpp>
#include <lightbin/detail/scatter.hpp>
#include <lightbin/detail/scratch.hpp>
#include <lightbin/detail/supertile.hpp>
#include <lightbin/lights.hpp>
#include <lightbin/view.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
