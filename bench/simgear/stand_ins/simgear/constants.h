// SPDX-License-Identifier: MIT
// In the place of SimGear's header of this name.
#pragma once

#include <string>

const double SGD_PI_4 = 0.78539816339744830962, SG_DEGREES_TO_RADIANS = SGD_PI_4 / 45;
#define SG_LOG(what, level, text)
