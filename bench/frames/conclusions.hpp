// SPDX-License-Identifier: MIT
// What the papers say of their techniques, in this run's numbers.
#pragma once

#include "runner.hpp"

#include <vector>

/// Prints a few lines a scene: ratios of evaluations, and where frames were timed, of times.
void print_conclusions(const std::vector<Row>& rows);
