// SPDX-License-Identifier: MIT
// The rows as tables, and as a file.
#pragma once

#include "runner.hpp"

#include <string>
#include <vector>

/// Prints a line a technique: means over the views, in brackets the least and the most. Of one view, those of its frames.
void print_techniques(const std::string& title, const std::vector<Row>& rows);

/// Prints a line for each number of lights and samples, a column a technique, as Pettineo has them.
void print_samples(const std::string& title, std::vector<Row> rows);

/// Writes NAME.csv, a line a row. Throws std::runtime_error if the file can't be written.
void write_csv(const std::string& name, const std::vector<Row>& rows);

/// The same of the evaluations and times along cameras' paths, for the plots.
void write_paths(const std::string& name, const std::vector<Row>& rows);
