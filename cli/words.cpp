// SPDX-License-Identifier: Apache-2.0
#include "words.hpp"

#include <cstddef>

namespace kage::cli {
namespace {

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
  // CLI11 appends what a validator allows: "WAY:{exact,centroid}", and the names of kage's own.
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

}  // namespace

std::vector<OptionWords> options_of(const CLI::App& app) {
  std::vector<OptionWords> options;
  for (const CLI::Option* option : app.get_options()) options.push_back(words_of(*option));
  return options;
}

std::vector<CommandWords> commands_of(const CLI::App& app) {
  std::vector<CommandWords> commands;
  for (const CLI::App* c : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back({c->get_name(), c->get_description(), c->get_footer(), options_of(*c)});
  return commands;
}

}  // namespace kage::cli
