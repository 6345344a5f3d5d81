// SPDX-License-Identifier: Apache-2.0
#include "command.hpp"

#include <string>

namespace kage::cli {

CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& what, const std::string& examples) {
  CLI::App* command = app.add_subcommand(name, what);
  command->footer("Examples:\n" + examples);
  return command;
}

}  // namespace kage::cli
