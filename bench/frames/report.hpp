// SPDX-License-Identifier: MIT
// The rows as tables, and as files.
#pragma once

#include "runner.hpp"

#include <vector>

/// Prints a table for each scene and kind of view.
void print_rows(const std::vector<Row>& rows);
/// Prints what a word of masks takes beside a light evaluation: the report's price of a word is from here.
void print_price_of_words(const std::vector<Row>& rows);

/// Writes frames.csv, a line a row.
void write_csv(const std::vector<Row>& rows);

/// Writes frames_paths.csv, the evaluations and times along cameras' paths, for the plots.
void write_paths(const std::vector<Row>& rows);
