// SPDX-License-Identifier: Apache-2.0
//
// Interface of every subcommand: it adds itself to the command line, and its action returns the exit code.
#pragma once

#include <functional>
#include <string>

#include "arguments.hpp"

namespace kage::cli {

/// Exit codes.
inline constexpr int kSame = 0;
inline constexpr int kDifferent = 1;
inline constexpr int kTrouble = 2;

/// A subcommand's work, called once the command line is parsed; returns the exit code.
using Action = std::function<int()>;

// One function per subcommand: adds it to `program`; when it is given, `action` becomes its work.
void add_cosim(Program& program, Action& action);
void add_render(Program& program, Action& action);
void add_stream(Program& program, Action& action);
void add_vectors(Program& program, Action& action);
void add_board(Program& program, Action& action);
void add_info(Program& program, Action& action);
void add_plan(Program& program, Action& action);
void add_area(Program& program, Action& action);
void add_sweep(Program& program, Action& action);
void add_explain(Program& program, Action& action);
void add_diff(Program& program, Action& action);
void add_merge(Program& program, Action& action);
void add_regress(Program& program, Action& action);
void add_model(Program& program, Action& action);
void add_order(Program& program, Action& action);
void add_cache(Program& program, Action& action);
void add_list(Program& program, Action& action);
void add_help(Program& program, Action& action);

/// "kage 0.1.0 (1234abc)": the version, and the commit that was built, ", changed" where files differ from it, if
/// known.
std::string build_name();

}  // namespace kage::cli
