// SPDX-License-Identifier: Apache-2.0
// kage help [COMMAND], and the texts that are made of the same definitions: a man page, completions for bash and zsh.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "command.hpp"
#include "completion.hpp"
#include "man_page.hpp"
#include "results.hpp"

namespace kage::cli {
namespace {

struct HelpCommand {
  std::string command;
  bool man = false;
  bool bash = false;
  bool zsh = false;
};

int run(const HelpCommand& o, const Program& program) {
  std::string text;
  if (o.man)
    text = man_page(program);
  else if (o.bash)
    text = bash_completion(program);
  else if (o.zsh)
    text = zsh_completion(program);
  else
    text = program.help(o.command);
  print_whole(text);
  return kSame;
}

}  // namespace

void add_help(Program& program, Action& action) {
  Command c = program.add("help", "Explain a command, as its --help does; or print a man page or completions",
                          "  kage help cosim\n"
                          "  kage help --man | man -l -\n"
                          "  source <(kage help --bash)\n"
                          "  kage help --zsh >~/.zfunc/_kage      # a folder of $fpath");
  const auto o = std::make_shared<HelpCommand>();
  c.add_option("COMMAND", o->command, "the command to explain, default: all in short").type_name("");
  Option man = c.add_flag("--man", o->man, "print a man page of all commands");
  Option bash = c.add_flag("--bash", o->bash, "print completions for bash");
  Option zsh = c.add_flag("--zsh", o->zsh, "print completions for zsh");
  man.excludes(bash).excludes(zsh);
  bash.excludes(zsh);
  c.callback([o, &program, &action] { action = [o, &program] { return run(*o, program); }; });
}

}  // namespace kage::cli
