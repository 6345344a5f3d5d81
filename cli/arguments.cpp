// SPDX-License-Identifier: Apache-2.0
// The one file that knows CLI11.
#include "arguments.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <sstream>
#include <utility>

#include "file/meant.hpp"
#include "help_groups.hpp"
#include "kage/error.hpp"
#include "options.hpp"

namespace kage::cli {
namespace {

constexpr auto kAny = [](const CLI::App*) { return true; };

// ---- words of the definitions ----

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

ValueKind kind_of(const std::string& name, const std::string& type) {
  if (name == "--fault") return ValueKind::fault;
  if (name == "--config" || name == "CONFIG") return ValueKind::config;
  if (name.find("SCENE") != std::string::npos) return ValueKind::scene;
  if (name == "COMMAND") return ValueKind::command;
  if (type == "DIR") return ValueKind::folder;
  const bool capitals = name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789") == std::string::npos;
  return type.find("FILE") != std::string::npos || capitals ? ValueKind::file : ValueKind::text;
}

OptionWords words_of(const CLI::Option& option) {
  OptionWords words;
  for (const std::string& name : option.get_snames()) words.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) words.names.push_back("--" + name);
  words.argument = words.names.empty();
  if (words.argument) words.names.push_back(option.get_name(true));
  words.required = option.get_required();
  words.several = option.get_expected_max() > 1;
  words.about = option.get_description();
  if (option.get_expected_max() == 0) return words;
  // CLI11 appends what a check allows: "WAY:{exact,centroid}", and the names of kage's own.
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  words.type = type.substr(0, type.find(':'));
  if (open != std::string::npos && type.find('}', open) != std::string::npos) {
    words.kind = ValueKind::words;
    words.values = split(type.substr(open + 1, type.find('}', open) - open - 1), ',');
    if (words.type.empty() || open == 0) words.type = words.argument ? words.names.front() : "WORD";
  } else {
    words.kind = kind_of(words.names.back(), words.type);
  }
  if (words.type.empty()) words.type = words.names.front();
  return words;
}

std::vector<OptionWords> words_of(const CLI::App& app) {
  std::vector<OptionWords> options;
  for (const CLI::Option* option : app.get_options()) options.push_back(words_of(*option));
  return options;
}

// ---- help ----

/// The options in the groups of help_groups.hpp and in their order. Lines that are too long go on below the place where
/// their text began.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    constexpr std::size_t kColumns = 100;
    const std::string indent(get_column_width(), ' ');
    std::istringstream help(make_description(app) + make_usage(app, std::move(name)) + make_positionals(app) +
                            in_groups(app) + make_subcommands(app, mode) + "\n" + make_footer(app));
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

 private:
  std::string in_groups(const CLI::App* app) const {
    std::string text;
    for (const std::string& group : help_groups())
      if (const auto options =
              app->get_options([&](const CLI::Option* o) { return o->get_group() == group && o->nonpositional(); });
          !options.empty())
        text += make_group(group, false, options);
    return text;
  }
};

// ---- faults ----

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(kAny)) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> names_of_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  return names;
}

std::string no_such_command(const CLI::App& app, const std::string& name) {
  return fmt::format("{}: no such command{}", name, meant(nearest(name, names_of_commands(app))));
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
    const std::vector<std::string> known = names_of_options(command != nullptr ? *command : app);
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

/// Whether the value of an option is a file or a folder, and never standard output.
bool names_file(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto has = [&](std::string_view word) { return type.find(word) != std::string::npos; };
  return !option.get_positional() && (has("FILE") || has("DIR")) && !has(kOrStandardOutput);
}

/// An empty text is senseless: a script's variable that is not set gives it. So is - for an option where it means no
/// standard output.
void refuse_senseless_values(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands())
    for (const CLI::Option* option : command->get_options())
      for (const std::string& value : option->results()) {
        if (value.empty() && option->get_expected_max() > 0)
          throw Error(
              fmt::format("{}: its value is empty; see kage {} --help", option->get_name(), command->get_name()));
        if (is_standard_output(value) && names_file(*option))
          throw Error(fmt::format("{}: - is no file's name here, ./- is one; see kage {} --help", option->get_name(),
                                  command->get_name()));
      }
}

/// CLI11's own exception in place of kage's, so that its parser takes the message as one of its own.
template <typename F>
auto told(const F& take) {
  return [take](auto&&... values) {
    try {
      return take(values...);
    } catch (const ValueError& e) {
      throw CLI::ValidationError(e.what());
    }
  };
}

Option grouped(CLI::Option* option) {
  option->group(help_group(option->get_name()));
  return Option(option);
}

}  // namespace

ValueError::ValueError(const std::string& option, const std::string& fault) : Error(option + ": " + fault) {}

// ---- options ----

Option Option::required(bool required) { return option_->required(required), *this; }
Option Option::type_name(const std::string& type) { return option_->type_name(type), *this; }
Option Option::option_text(const std::string& text) { return option_->option_text(text), *this; }
Option Option::description(const std::string& text) { return option_->description(text), *this; }
Option Option::excludes(Option other) { return option_->excludes(other.option_), *this; }
Option Option::needs(Option other) { return option_->needs(other.option_), *this; }
Option Option::expected(int values) { return option_->expected(values), *this; }
Option Option::one_value_each() { return option_->allow_extra_args(false), *this; }
Option Option::take_all() { return option_->multi_option_policy(CLI::MultiOptionPolicy::TakeAll), *this; }
Option Option::in_order_of_parsing() { return option_->trigger_on_parse(), *this; }
Option Option::hidden() { return option_->group(""), *this; }

Option Option::check(const Check& check) {
  option_->check(CLI::Validator([fault = check.fault](std::string& text) { return fault(text); }, check.shown, ""));
  return *this;
}

std::size_t Option::count() const { return option_->count(); }
std::vector<std::string> Option::values() const { return option_->results(); }
std::string Option::name() const { return option_->get_name(); }
std::string Option::long_name() const {
  return option_->get_lnames().empty() ? name() : "--" + option_->get_lnames().front();
}
bool Option::positional() const { return option_->get_positional(); }
bool Option::flag() const { return option_->get_expected_max() == 0; }
bool Option::takes_all() const { return option_->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll; }

// ---- commands ----

template <typename T>
Option Command::add_option(const std::string& name, T& value, const std::string& about) {
  return grouped(app_->add_option(name, value, about));
}

template <typename T>
Option Command::add_option_function(const std::string& name, const std::function<void(const T&)>& take,
                                    const std::string& about) {
  return grouped(app_->add_option_function<T>(name, told(take), about));
}

Option Command::add_flag(const std::string& name, bool& value, const std::string& about) {
  return grouped(app_->add_flag(name, value, about));
}

Option Command::add_flag(const std::string& name, std::string& value, const std::string& about) {
  return grouped(app_->add_flag(name, value, about));
}

Option Command::add_flag_function(const std::string& name, const std::function<void()>& take,
                                  const std::string& about) {
  return grouped(app_->add_flag_callback(name, told(take), about));
}

void Command::callback(const std::function<void()>& done) { app_->callback(told(done)); }
std::string Command::name() const { return app_->get_name(); }

std::vector<Option> Command::options() const {
  std::vector<Option> options;
  for (CLI::Option* option : app_->get_options(nullptr)) options.emplace_back(option);
  return options;
}

Option Command::option(const std::string& name) const {
  if (!has(name)) throw Error(fmt::format("kage {} has no option {}", app_->get_name(), name));
  return Option(app_->get_option(name));
}

bool Command::has(const std::string& option) const { return app_->get_option_no_throw(option) != nullptr; }
Command Command::sibling(const std::string& name) const { return Command(app_->get_parent()->get_subcommand(name)); }

using Name = const std::string&;
template Option Command::add_option(Name, std::string&, Name);
template Option Command::add_option(Name, int&, Name);
template Option Command::add_option(Name, std::uint64_t&, Name);
template Option Command::add_option(Name, double&, Name);
template Option Command::add_option(Name, std::optional<int>&, Name);
template Option Command::add_option(Name, std::optional<std::uint64_t>&, Name);
template Option Command::add_option(Name, std::optional<double>&, Name);
template Option Command::add_option(Name, std::vector<std::string>&, Name);
template Option Command::add_option_function(Name, const std::function<void(const std::string&)>&, Name);
template Option Command::add_option_function(Name, const std::function<void(const int&)>&, Name);
template Option Command::add_option_function(Name, const std::function<void(const std::uint64_t&)>&, Name);

// ---- the program ----

Program::Program(const std::string& about, const std::string& version, const std::string& footer)
    : app_(std::make_unique<CLI::App>(about, "kage")) {
  app_->formatter(std::make_shared<HelpFormatter>());
  app_->set_version_flag("-V,--version", version)->group(help_group("--version"));
  app_->get_help_ptr()->group(help_group("--help"));
  app_->footer(footer);
  app_->require_subcommand(0, 1);
  app_->option_defaults()->multi_option_policy(
      CLI::MultiOptionPolicy::TakeLast);  // scripts set defaults that a person overrides
}

Program::~Program() = default;

Command Program::add(const std::string& name, const std::string& what, const std::string& examples) {
  CLI::App* const command = app_->add_subcommand(name, what);
  command->get_help_ptr()->group(help_group("--help"));
  command->footer("Examples:\n" + examples);
  return Command(command);
}

std::optional<std::string> Program::parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) throw Error(explain(*app_, e));
    std::ostringstream text;
    app_->exit(e, text, text);
    return text.str();
  }
  refuse_senseless_values(*app_);
  return {};
}

std::string Program::about() const { return app_->get_description(); }

std::vector<CommandWords> Program::commands() const {
  std::vector<CommandWords> commands;
  for (const CLI::App* c : app_->get_subcommands(kAny))
    commands.push_back({c->get_name(), c->get_description(), c->get_footer(), words_of(*c)});
  return commands;
}

std::vector<OptionWords> Program::options() const { return words_of(*app_); }

std::string Program::help(const std::string& command) const {
  const auto named = [&](const CLI::App* c) { return c->get_name() == command; };
  if (!command.empty() && app_->get_subcommands(named).empty())
    throw Error(no_such_command(*app_, command) + "; see kage --help");
  return app_->get_formatter()->make_help(command.empty() ? app_.get() : app_->get_subcommand(command),
                                          command.empty() ? "kage" : "kage " + command, CLI::AppFormatMode::Normal);
}

}  // namespace kage::cli
