// SPDX-License-Identifier: Apache-2.0
//
// Interface of every subcommand: it adds itself to the command line, and its action returns the exit code.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace kage::cli {

/// Exit codes.
inline constexpr int kSame = 0;
inline constexpr int kDifferent = 1;
inline constexpr int kTrouble = 2;

/// A subcommand's work, called once the command line is parsed; returns the exit code.
using Action = std::function<int()>;

// One function per subcommand: adds it to `app`; when it is given, `action` becomes its work.
void add_cosim(CLI::App& app, Action& action);
void add_render(CLI::App& app, Action& action);
void add_stream(CLI::App& app, Action& action);
void add_vectors(CLI::App& app, Action& action);
void add_board(CLI::App& app, Action& action);
void add_info(CLI::App& app, Action& action);
void add_plan(CLI::App& app, Action& action);
void add_area(CLI::App& app, Action& action);
void add_sweep(CLI::App& app, Action& action);
void add_explain(CLI::App& app, Action& action);
void add_diff(CLI::App& app, Action& action);
void add_merge(CLI::App& app, Action& action);
void add_regress(CLI::App& app, Action& action);
void add_model(CLI::App& app, Action& action);
void add_order(CLI::App& app, Action& action);
void add_cache(CLI::App& app, Action& action);
void add_list(CLI::App& app, Action& action);
void add_help(CLI::App& app, Action& action);

/// "kage 0.1.0 (1234abc)": the version, and the commit that was built, ", changed" where files differ from it, if
/// known.
std::string build_name();

/// Adds a subcommand whose help ends with `examples`.
CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& what, const std::string& examples);

}  // namespace kage::cli
