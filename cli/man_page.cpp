// SPDX-License-Identifier: Apache-2.0
#include "man_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "options.hpp"

namespace kage::cli {
namespace {

/// `text` as roff shows it: backslashes and hyphens are literal, and no line begins with a request.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string option_text(const OptionWords& option) {
  std::string heading;
  for (const std::string& name : option.names)
    heading += fmt::format("{}\\fB{}\\fR", heading.empty() ? "" : ", ", roff(name));
  if (!option.argument && option.kind != ValueKind::none)
    heading += fmt::format(
        " \\fI{}\\fR",
        roff(option.kind == ValueKind::words ? fmt::format("{}", fmt::join(option.values, "|")) : option.type));
  return fmt::format(".TP\n{}\n{}\n", heading, roff(option.about));
}

std::string synopsis(const CommandWords& command) {
  std::string text = fmt::format("\\fBkage {}\\fR", roff(command.name));
  for (const OptionWords& option : command.options)
    if (option.argument) {
      const std::string name = fmt::format("\\fI{}\\fR{}", roff(option.names.front()), option.several ? " ..." : "");
      text += option.required ? " " + name : " [" + name + "]";
    }
  return text + " [\\fIoptions\\fR]\n";
}

/// Examples, as they stand: the lines of the help's end.
std::string examples(const std::string& footer) { return fmt::format(".PP\n.nf\n{}\n.fi\n", roff(footer)); }

}  // namespace

std::string man_page(const Program& program) {
  const std::vector<CommandWords> commands = program.commands();
  std::string text = fmt::format(".TH KAGE 1 \"\" \"kage {}\" \"User Commands\"\n.SH NAME\nkage \\- {}\n.SH SYNOPSIS\n",
                                 roff(KAGE_VERSION),
                                 roff("a span-stream rendering core, its golden model and its "
                                      "co-simulation"));
  for (const CommandWords& command : commands)
    text += (&command == &commands.front() ? "" : ".br\n") + synopsis(command);
  text += ".SH DESCRIPTION\n";
  text += roff(program.about()) + "\n.SH OPTIONS\n";
  for (const OptionWords& option : program.options()) text += option_text(option);
  text += ".SH COMMANDS\n";
  for (const CommandWords& command : commands) {
    text += fmt::format(".SS kage {}\n{}.\n", roff(command.name), roff(command.about));
    for (const OptionWords& option : command.options) text += option_text(option);
    text += examples(command.footer);
  }
  text +=
      ".SH EXIT STATUS\n"
      ".TP\n.B 0\nsame or done\n.TP\n.B 1\ndifferent\n.TP\n.B 2\ntrouble: one line on standard error names file, place "
      "and cause\n"
      ".TP\n.B 129, 130, 143\nended by SIGHUP, SIGINT, SIGTERM; what was there before is there still\n";
  text += ".SH ENVIRONMENT\n";
  const auto variable = [&](const char* name, const char* about) {
    text += fmt::format(".TP\n.B {}\n{}\n", roff(name), roff(about));
  };
  variable("XDG_CACHE_HOME", "RTL models are kept in kage/models below it, default ~/.cache; see kage cache");
  variable(
      "KAGE_DATA_DIR",
      "the folder with rtl/, scenes/ and verif/, default: share/kage of the prefix that the program is installed in, "
      "or the source tree that it was built from");
  variable("KAGE_PLUGIN_DIR",
           "the folder with the plugins for pictures and meshes, default: lib/kage of that prefix, or where they were "
           "built");
  variable("KAGE_SIMD",
           "the instruction set of the loops in vectors, such as avx2, default: the best that the CPU has");
  variable("KAGE_PROGRESS", "seconds between lines of progress where there is no terminal, default 10; 0 is none");
  variable("KAGE_IMPORT_SECONDS, KAGE_IMPORT_MIB", "limits for reading one scene file");
  variable("VERILATOR, CXX", "the tools that RTL models are built with");
  return text;
}

}  // namespace kage::cli
