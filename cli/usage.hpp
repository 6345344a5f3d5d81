// SPDX-License-Identifier: Apache-2.0
//
// Help, and what is wrong with a command line, in one line.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

namespace kage::cli {

/// What writes --help: lines that are too long go on under where their text began.
std::shared_ptr<CLI::Formatter> help_formatter();

/// What is wrong with a command line that `app` refused, and the help to read: one line.
std::string explain(const CLI::App& app, const CLI::ParseError& error);

/// An argument or option of the command that was given as an empty text, as a script's variable that is not set makes
/// it, or an option that is given - where it means no standard output: one line that names it. Empty if there is none.
std::string senseless_value(const CLI::App& app);

/// "rendr: no such command (did you mean render?)".
std::string no_such_command(const CLI::App& app, const std::string& name);

}  // namespace kage::cli
