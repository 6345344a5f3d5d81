// SPDX-License-Identifier: Apache-2.0
//
// The definitions of commands and options as plain words, for texts that are made of them: man page and completions.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace kage::cli {

/// Kind of value of an option or an argument.
enum class ValueKind { none, text, words, file, folder, scene, config, fault, command };

struct OptionWords {
  std::vector<std::string> names;  ///< "--size"; of an argument its name in capitals, "SCENE"
  bool argument = false;           ///< no option: its place tells it
  bool several = false;            ///< may be given more than once
  bool required = false;
  std::string type;  ///< "WxH"; empty for a flag
  ValueKind kind = ValueKind::none;
  std::vector<std::string> values;  ///< of ValueKind::words
  std::string about;
};

struct CommandWords {
  std::string name;
  std::string about;
  std::string footer;  ///< examples, as they stand
  std::vector<OptionWords> options;
};

/// The commands, in the order of the help.
std::vector<CommandWords> commands_of(const CLI::App& app);

/// The options of the program itself.
std::vector<OptionWords> options_of(const CLI::App& app);

}  // namespace kage::cli
