// SPDX-License-Identifier: Apache-2.0
// Messages on a faulty command line, in one line.
#include "usage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "file/meant.hpp"
#include "options.hpp"

namespace kage::cli {
namespace {

std::vector<std::string> commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

std::vector<std::string> options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  return names;
}

/// Options of other commands that a command does by other means.
constexpr struct {
  std::string_view command;
  std::string_view option;
  std::string_view instead;
} kInstead[] = {
    {"model", "config", "a configuration is an argument"},
    {"stream", "front-end", "--level polygons makes the stream that a front end takes"},
};

/// Nobody asked for it: a mistyped command or option, or an argument too many.
std::string unexpected(const CLI::App& app, const CLI::App* command) {
  const std::vector<std::string> before = app.remaining(false);
  const std::vector<std::string> all = app.remaining(true);
  const std::string text = all.empty() ? std::string() : all.front();
  if (text.size() > 1 && text.front() == '-') {
    const std::size_t dashes = text.rfind("--", 0) == 0 ? 2 : 1;
    const std::string name = text.substr(dashes, text.find('=') - dashes);
    const std::vector<std::string> known = options(command != nullptr ? *command : app);
    if (command != nullptr && !before.empty() && std::find(known.begin(), known.end(), name) != known.end())
      return fmt::format("{}: options come after the command", text);
    for (const auto& [of, option, instead] : kInstead)
      if (command != nullptr && command->get_name() == of && name == option)
        return fmt::format("{}: no option of kage {}: {}", text, of, instead);
    const std::string near = nearest(name, known);
    return fmt::format("{}: no such option{}", text, meant(near.empty() ? "" : "--" + near));
  }
  if (command == nullptr) return no_such_command(app, text);
  return fmt::format("{}: an argument too many", text);
}

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    constexpr std::size_t kColumns = 100;
    const std::string indent(get_column_width(), ' ');
    std::istringstream help(CLI::Formatter::make_help(app, std::move(name), mode));
    std::string text;
    for (std::string line; std::getline(help, line); text.append(line).append("\n"))
      while (line.size() > kColumns && line.front() == ' ') {
        const std::size_t blank = line.rfind(' ', kColumns);
        if (blank <= indent.size()) break;
        text.append(line, 0, blank).append("\n");
        line.replace(0, blank + 1, indent);
      }
    return text;
  }
};

}  // namespace

/// Whether the value of an option is a file or a folder, and never standard output.
static bool names_file(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto has = [&](std::string_view word) { return type.find(word) != std::string::npos; };
  return !option.get_positional() && (has("FILE") || has("DIR")) && !has(kOrStandardOutput);
}

std::string no_such_command(const CLI::App& app, const std::string& name) {
  return fmt::format("{}: no such command{}", name, meant(nearest(name, commands(app))));
}

std::shared_ptr<CLI::Formatter> help_formatter() { return std::make_shared<HelpFormatter>(); }

std::string senseless_value(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands())
    for (const CLI::Option* option : command->get_options())
      for (const std::string& value : option->results()) {
        if (value.empty() && option->get_expected_max() > 0)
          return fmt::format("{}: its value is empty; see kage {} --help", option->get_name(), command->get_name());
        if (is_standard_output(value) && names_file(*option))
          return fmt::format("{}: - is no file's name here, ./- is one; see kage {} --help", option->get_name(),
                             command->get_name());
      }
  return {};
}

std::string explain(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  const CLI::App* const command = parsed.empty() ? nullptr : parsed.front();
  std::string text = error.what();
  // CLI11 tells of an option that is missing before one that there is not: the second may be the first's wrong name.
  const std::vector<std::string> extras = app.remaining(true);
  const bool mistyped = !extras.empty() && extras.front().size() > 1 && extras.front().front() == '-' &&
                        dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  if (mistyped || dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    text = unexpected(app, command);
  } else if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr && text.rfind("--", 0) == 0) {
    text = text.substr(0, text.find(':')) + ": its value is missing";
  } else if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr &&
             text.find(" is required") != std::string::npos) {
    text = text.substr(0, text.find(" is required")) + " is missing";
  }
  return fmt::format("{}; see kage {}--help", text, command == nullptr ? "" : command->get_name() + " ");
}

}  // namespace kage::cli
