// SPDX-License-Identifier: Apache-2.0
//
// The rows of kage sweep as a table and as CSV.
#pragma once

#include <string>
#include <vector>

#include "results.hpp"

namespace kage::cli {

/// A line for each row, under a heading for each scene. A star marks a row that no other beats.
std::string sweep_table(const std::vector<Json>& rows);

/// A line for each row, under one with the columns' names: keys of the JSON, joined by dots.
std::string sweep_csv(const std::vector<Json>& rows);

}  // namespace kage::cli
