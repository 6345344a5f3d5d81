// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace kage::cli {

/// kage(1), in man's macros, made of the help texts.
std::string man_page(const CLI::App& app);

}  // namespace kage::cli
