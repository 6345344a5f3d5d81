// SPDX-License-Identifier: Apache-2.0
// kage help [COMMAND], and the texts that are made of the same definitions: a man page, completions for bash and zsh.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "command.hpp"
#include "completion.hpp"
#include "kage/error.hpp"
#include "man_page.hpp"
#include "results.hpp"
#include "usage.hpp"

namespace kage::cli {
namespace {

struct HelpCommand {
  std::string command;
  bool man = false;
  bool bash = false;
  bool zsh = false;
};

int run(const HelpCommand& o, const CLI::App& app) {
  const auto named = [&o](const CLI::App* command) { return command->get_name() == o.command; };
  if (!o.command.empty() && app.get_subcommands(named).empty())
    throw Error(no_such_command(app, o.command) + "; see kage --help");
  std::string text;
  if (o.man)
    text = man_page(app);
  else if (o.bash)
    text = bash_completion(app);
  else if (o.zsh)
    text = zsh_completion(app);
  else
    text = app.get_formatter()->make_help(o.command.empty() ? &app : app.get_subcommand(o.command),
                                          o.command.empty() ? "kage" : "kage " + o.command, CLI::AppFormatMode::Normal);
  print_whole(text);
  return kSame;
}

}  // namespace

void add_help(CLI::App& app, Action& action) {
  CLI::App* c = add_command(app, "help", "Explain a command, as its --help does; or print a man page or completions",
                            "  kage help cosim\n"
                            "  kage help --man | man -l -\n"
                            "  source <(kage help --bash)\n"
                            "  kage help --zsh >~/.zfunc/_kage      # a folder of $fpath");
  const auto o = std::make_shared<HelpCommand>();
  c->add_option("COMMAND", o->command, "the command to explain, default: all in short")->type_name("");
  auto* const man = c->add_flag("--man", o->man, "print a man page of all commands");
  auto* const bash = c->add_flag("--bash", o->bash, "print completions for bash");
  auto* const zsh = c->add_flag("--zsh", o->zsh, "print completions for zsh");
  man->excludes(bash)->excludes(zsh);
  bash->excludes(zsh);
  c->callback([o, &app, &action] { action = [o, &app] { return run(*o, app); }; });
}

}  // namespace kage::cli
