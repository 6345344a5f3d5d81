// SPDX-License-Identifier: Apache-2.0
//
// Help, and what is wrong with a command line, in one line.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

namespace kage::cli {

/// The formatter of --help: lines that are too long go on below the place where their text began.
std::shared_ptr<CLI::Formatter> help_formatter();

/// The fault of a command line that `app` refused, and the help to read: one line.
std::string explain(const CLI::App& app, const CLI::ParseError& error);

/// One line that names an argument or option with a senseless value; empty if there is none. An empty text is
/// senseless: a script's variable that is not set gives it. So is - for an option where it means no standard output.
std::string senseless_value(const CLI::App& app);

/// "rendr: no such command (did you mean render?)".
std::string no_such_command(const CLI::App& app, const std::string& name);

}  // namespace kage::cli
