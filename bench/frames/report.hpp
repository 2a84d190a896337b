// SPDX-License-Identifier: MIT
// The rows as tables, and as files.
#pragma once

#include "runner.hpp"

#include <vector>

/// Prints a table for each scene and kind of view.
void print_rows(const std::vector<Row>& rows);
/// Prints how long a shader takes for one word of masks, in light evaluations. bench/report.cpp uses that price.
void print_price_of_words(const std::vector<Row>& rows);

/// Writes frames.csv, a line a row.
void write_csv(const std::vector<Row>& rows);
