// SPDX-License-Identifier: Apache-2.0
#include "completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "options.hpp"
#include "words.hpp"

namespace kage::cli {
namespace {

std::vector<std::string> names_of(const std::vector<CommandWords>& commands) {
  std::vector<std::string> names;
  names.reserve(commands.size());
  for (const CommandWords& command : commands) names.push_back(command.name);
  return names;
}

std::vector<std::string> option_names(const std::vector<OptionWords>& options) {
  std::vector<std::string> names;
  for (const OptionWords& option : options)
    if (!option.argument) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

/// The words that bash is to offer for a value. `kage list` knows the names.
std::string bash_values(const OptionWords& option, const std::vector<CommandWords>& commands) {
  switch (option.kind) {
    case ValueKind::words:
      return fmt::format("words '{}'", fmt::join(option.values, " "));
    case ValueKind::scene:
      return "names scenes; files";
    case ValueKind::config:
      return "names configs; files";
    case ValueKind::fault:
      return "names faults";
    case ValueKind::command:
      return fmt::format("words '{}'", fmt::join(names_of(commands), " "));
    case ValueKind::file:
      return "files";
    case ValueKind::folder:
      return "folders";
    default:
      return ":";
  }
}

std::string bash_command(const CommandWords& command, const std::vector<CommandWords>& commands) {
  std::string text = fmt::format("    {})\n      case $previous in\n", command.name);
  for (const OptionWords& option : command.options)
    if (!option.argument && option.kind != ValueKind::none)
      text += fmt::format("        {}) {}; return ;;\n", fmt::join(option.names, " | "), bash_values(option, commands));
  text += "      esac\n";
  text += fmt::format("      if [[ $current == -* ]]; then words '{}'; return; fi\n",
                      fmt::join(option_names(command.options), " "));
  for (const OptionWords& option : command.options)
    if (option.argument) text += fmt::format("      {}\n", bash_values(option, commands));
  return text + "      ;;\n";
}

/// `text` within single quotes in an _arguments specification.
std::string zsh_quoted(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else if (c == '[' || c == ']' || c == ':' || c == '\\')
      out += std::string("\\") + c;
    else
      out += c;
  }
  return out;
}

std::string zsh_values(const OptionWords& option, const std::vector<CommandWords>& commands) {
  switch (option.kind) {
    case ValueKind::words:
      return fmt::format("({})", fmt::join(option.values, " "));
    case ValueKind::scene:
      return "_kage_names scenes files";
    case ValueKind::config:
      return "_kage_names configs files";
    case ValueKind::fault:
      return "_kage_names faults";
    case ValueKind::command:
      return fmt::format("({})", fmt::join(names_of(commands), " "));
    case ValueKind::file:
      return "_files";
    case ValueKind::folder:
      return "_files -/";
    default:
      return " ";
  }
}

std::string zsh_option(const OptionWords& option, const std::vector<CommandWords>& commands) {
  const std::string value = option.kind == ValueKind::none
                                ? ""
                                : fmt::format(":{}:{}", zsh_quoted(option.type), zsh_values(option, commands));
  if (option.argument)
    return fmt::format("        '{}{}'\n", option.several ? "*" : option.required ? "1" : ":", value);
  std::string text;
  for (const std::string& name : option.names)
    text += fmt::format("        '{}[{}]{}'\n", name, zsh_quoted(option.about), value);
  return text;
}

std::string zsh_command(const CommandWords& command, const std::vector<CommandWords>& commands) {
  std::string text = fmt::format("    {})\n      _arguments \\\n", command.name);
  std::string specs;
  for (const OptionWords& option : command.options) specs += zsh_option(option, commands);
  std::string joined;
  for (const char c : specs) joined += c == '\n' ? " \\\n" : std::string(1, c);
  joined.erase(joined.size() - 3);  // no backslash behind the last
  return text + joined + "\n      ;;\n";
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  const std::vector<CommandWords> commands = commands_of(app);
  std::string text =
      "# bash completion for kage, made by kage help --bash\n"
      "_kage() {\n"
      "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
      "  COMPREPLY=()\n"
      "  local IFS=$' \\t\\n'\n"
      "  words() { COMPREPLY+=($(compgen -W \"$1\" -- \"$current\")); }\n"
      "  names() { words \"$(\"${COMP_WORDS[0]}\" list \"$1\" 2>/dev/null)\"; }\n"
      "  files() { compopt -o filenames; local IFS=$'\\n'; COMPREPLY+=($(compgen -f -- \"$current\")); }\n"
      "  folders() { compopt -o filenames; local IFS=$'\\n'; COMPREPLY+=($(compgen -d -- \"$current\")); }\n";
  text += fmt::format("  if [[ $COMP_CWORD == 1 ]]; then words '{} {}'; return; fi\n",
                      fmt::join(names_of(commands), " "), fmt::join(option_names(options_of(app)), " "));
  text += "  case ${COMP_WORDS[1]} in\n";
  for (const CommandWords& command : commands) text += bash_command(command, commands);
  return text + "  esac\n}\ncomplete -F _kage kage\n";
}

std::string zsh_completion(const CLI::App& app) {
  const std::vector<CommandWords> commands = commands_of(app);
  std::string text =
      "#compdef kage\n"
      "# zsh completion for kage, made by kage help --zsh\n"
      "_kage_names() {\n"
      "  local -a names\n"
      "  names=(${(f)\"$(${words_of_kage:-kage} list $1 2>/dev/null)\"})\n"
      "  compadd -a names\n"
      "  [[ $2 != files ]] || _files\n"
      "}\n"
      "_kage() {\n"
      "  local words_of_kage=$words[1]\n"
      "  if (( CURRENT == 2 )); then\n"
      "    local -a commands\n"
      "    commands=(\n";
  for (const CommandWords& command : commands)
    text += fmt::format("      '{}:{}'\n", command.name, zsh_quoted(command.about));
  text += "    )\n    _describe command commands\n    return\n  fi\n";
  text += "  local command=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $command in\n";
  for (const CommandWords& command : commands) text += zsh_command(command, commands);
  return text +
         "  esac\n}\nif [[ $zsh_eval_context[-1] == loadautofunc ]]; then _kage \"$@\"; else compdef _kage kage; fi\n";
}

}  // namespace kage::cli
