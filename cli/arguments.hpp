// SPDX-License-Identifier: Apache-2.0
//
// The command line: commands, their options, and their values. arguments.cpp alone knows the library that parses it,
// CLI11, whose headers take three seconds of each file that includes them.
//
// Option and Command are names for what the Program holds: copy them, and keep none beyond it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kage/error.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace kage::cli {

/// Kind of value of an option or an argument, for completions.
enum class ValueKind { none, text, words, file, folder, scene, config, fault, command };

/// The definition of an option as plain words, for texts that are made of it: man page and completions.
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

/// Likewise of a command.
struct CommandWords {
  std::string name;
  std::string about;
  std::string footer;  ///< examples, as they stand
  std::vector<OptionWords> options;
};

/// A condition on an option's value.
struct Check {
  std::function<std::string(const std::string&)> fault;  ///< one line on a wrong value; empty for a right one
  std::string shown{};                                   ///< the values that it allows, for help: "{ice40,ecp5}"
};

/// An option's value is refused: the message is one line, OPTION: FAULT.
class ValueError : public Error {
 public:
  ValueError(const std::string& option, const std::string& fault);
};

/// An option or a positional argument of a command.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  // Definition. Each returns the option.
  Option required(bool required = true);
  Option type_name(const std::string& type);    ///< of the value, in help: "WxH"
  Option option_text(const std::string& text);  ///< all that help shows behind the name, in place of type and values
  Option description(const std::string& text);
  Option check(const Check& check);
  Option excludes(Option other);
  Option needs(Option other);
  Option expected(int values);   ///< so many values behind one name
  Option one_value_each();       ///< a list takes one value behind each name, not all words that follow
  Option take_all();             ///< all values count where it is given several times; else the last
  Option in_order_of_parsing();  ///< a flag's function is called as the flag is read
  Option hidden();               ///< help leaves it out

  // Its place in the command line that was given.
  std::size_t count() const;
  std::vector<std::string> values() const;
  std::string name() const;       ///< "--size", "SCENE"
  std::string long_name() const;  ///< "--size", else name()
  bool positional() const;
  bool flag() const;  ///< it has no value
  bool takes_all() const;

 private:
  CLI::Option* option_;
};

/// A command of the program.
class Command {
 public:
  Command() = default;
  explicit Command(CLI::App* app) : app_(app) {}

  /// An option "--name", or a positional argument "NAME", whose value becomes `value`: a text or a number, an optional
  /// one, or a list. arguments.cpp has the types.
  template <typename T>
  Option add_option(const std::string& name, T& value, const std::string& about);
  /// Its value, a text, int or std::uint64_t, is given to `take`, which may throw ValueError.
  template <typename T>
  Option add_option_function(const std::string& name, const std::function<void(const T&)>& take,
                             const std::string& about = {});
  Option add_flag(const std::string& name, bool& value, const std::string& about);
  /// A flag that may have a value: --name=VALUE.
  Option add_flag(const std::string& name, std::string& value, const std::string& about);
  Option add_flag_function(const std::string& name, const std::function<void()>& take, const std::string& about);
  /// `done` is called when this command was given, once its options have been read. It may throw ValueError.
  void callback(const std::function<void()>& done);

  std::string name() const;
  std::vector<Option> options() const;
  /// An option that the command has, by its name; Error if there is none.
  Option option(const std::string& name) const;
  bool has(const std::string& option) const;
  /// Another command of the same program.
  Command sibling(const std::string& name) const;

 private:
  CLI::App* app_ = nullptr;
};

/// The program's command line.
class Program {
 public:
  Program(const std::string& about, const std::string& version, const std::string& footer);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Adds a command whose help ends with `examples`.
  Command add(const std::string& name, const std::string& what, const std::string& examples);

  /// Text that a person asked for by --help or --version; nothing once a command was read. Throws Error, one line with
  /// the help to read, for a faulty command line, for an empty value, and for - where it means no standard output.
  std::optional<std::string> parse(int argc, const char* const* argv);

  std::string about() const;
  std::vector<CommandWords> commands() const;  ///< in the order of the help
  std::vector<OptionWords> options() const;    ///< of the program itself
  /// Help of a command, or of all in short for an empty name; Error names the command that was probably meant.
  std::string help(const std::string& command) const;

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace kage::cli
