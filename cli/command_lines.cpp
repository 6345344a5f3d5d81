// SPDX-License-Identifier: Apache-2.0
#include "command_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include "file/shown.hpp"
#include "rtl_options.hpp"

namespace kage::cli {
namespace {

/// Options that the command was given and that are to be kept, each behind a blank.
std::string options_of(const Command& command, const std::function<bool(const Option&)>& keep) {
  std::string line;
  for (const Option& o : command.options()) {
    if (o.count() == 0 || o.positional() || !keep(o)) continue;
    const auto values = o.values();
    if (o.flag())
      line += " " + o.long_name();
    else  // the last one that is given counts, but for those of which all do
      for (std::size_t i = o.takes_all() ? 0 : values.size() - 1; i < values.size(); ++i)
        line += fmt::format(" {} {}", o.long_name(), kage::quoted(values[i]));
  }
  return line;
}

/// Without the first blank.
std::string alone(const std::string& options) { return options.empty() ? options : options.substr(1); }

/// The options on the RTL, in the order in which people think of them.
std::string rtl_options(const Command& command) {
  std::string line;
  for (const char* name : kRtlOptions)
    if (const Option o = command.option(name); o.count() != 0)
      line += fmt::format(" {} {}", name, kage::quoted(o.values().back()));
  return alone(line);
}

/// The options that kage explain has too, but for those of which its line has its own.
std::string explain_options(const Command& command) {
  std::set<std::string> own{"--json", "--out", "--frame", "--pixel", "--rtl", "--changes", "--threads"};
  own.insert(kRtlOptions.begin(), kRtlOptions.end());
  const Command explain = command.sibling("explain");
  return alone(options_of(command, [&](const Option& o) { return own.count(o.name()) == 0 && explain.has(o.name()); }));
}

}  // namespace

std::string command_line(const Command& command, const std::vector<std::string>& leave_out) {
  std::string line = "kage " + command.name();
  for (const Option& o : command.options())
    if (o.positional())
      for (const std::string& input : o.values()) line += " " + kage::quoted(input);
  return line + options_of(command, [&](const Option& o) {
           return std::find(leave_out.begin(), leave_out.end(), o.name()) == leave_out.end();
         });
}

cosim::CommandLines command_lines(const Command& command) {
  return {.again = command_line(command, {"--cache-verdicts", "--no-cache-verdicts"}),
          .in_place = command_line(command, {"--cache-verdicts", "--no-cache-verdicts", "--frame", "--shard", "--jobs",
                                             "--out", "--json", "--junit", "--coverage"}),
          .rtl = rtl_options(command),
          .explain = explain_options(command)};
}

}  // namespace kage::cli
