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
std::string options_of(const CLI::App& command, const std::function<bool(const CLI::Option&)>& keep) {
  std::string line;
  for (const CLI::Option* o : command.get_options()) {
    if (o->count() == 0 || o->get_positional() || !keep(*o)) continue;
    const std::string option = o->get_lnames().empty() ? o->get_name() : "--" + o->get_lnames().front();
    // The last one that is given counts, but for those of which all do.
    const bool all = o->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
    const auto& values = o->results();
    if (o->get_expected_max() == 0)
      line += " " + option;
    else
      for (std::size_t i = all ? 0 : values.size() - 1; i < values.size(); ++i)
        line += fmt::format(" {} {}", option, quoted(values[i]));
  }
  return line;
}

/// Without the first blank.
std::string alone(const std::string& options) { return options.empty() ? options : options.substr(1); }

/// The options on the RTL, in the order in which people think of them.
std::string rtl_options(const CLI::App& command) {
  std::string line;
  for (const char* name : kRtlOptions)
    if (const CLI::Option* o = command.get_option(name); o->count() != 0)
      line += fmt::format(" {} {}", name, quoted(o->results().back()));
  return alone(line);
}

/// The options that kage explain has too, but for those of which its line has its own.
std::string explain_options(const CLI::App& command) {
  std::set<std::string> own{"--json", "--out", "--frame", "--pixel", "--rtl", "--changes", "--threads"};
  own.insert(kRtlOptions.begin(), kRtlOptions.end());
  const CLI::App* explain = command.get_parent()->get_subcommand("explain");
  return alone(options_of(command, [&](const CLI::Option& o) {
    return own.count(o.get_name()) == 0 && explain->get_option_no_throw(o.get_name()) != nullptr;
  }));
}

}  // namespace

std::string command_line(const CLI::App& command, const std::vector<std::string>& leave_out) {
  std::string line = "kage " + command.get_name();
  for (const CLI::Option* o : command.get_options())
    if (o->get_positional())
      for (const std::string& input : o->results()) line += " " + quoted(input);
  return line + options_of(command, [&](const CLI::Option& o) {
           return std::find(leave_out.begin(), leave_out.end(), o.get_name()) == leave_out.end();
         });
}

cosim::CommandLines command_lines(const CLI::App& command) {
  return {.again = command_line(command, {"--cache-verdicts", "--no-cache-verdicts"}),
          .in_place = command_line(command, {"--cache-verdicts", "--no-cache-verdicts", "--frame", "--shard", "--jobs",
                                             "--out", "--json", "--junit", "--coverage"}),
          .rtl = rtl_options(command),
          .explain = explain_options(command)};
}

}  // namespace kage::cli
