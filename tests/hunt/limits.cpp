// SPDX-License-Identifier: MIT
#include "round.hpp"

namespace hunt {
void hunt_limits(Report&, bool) {}
}  // namespace hunt
