// SPDX-License-Identifier: MIT
// In the place of SimGear's header of this name.
#pragma once

#include <stdexcept>

struct sg_range_exception : std::range_error {
    using range_error::range_error;
};
