// SPDX-License-Identifier: Apache-2.0
// kage board --port PORT PACK: a pack played on a board, and the verdict.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "board/connection.hpp"
#include "board/pack_run.hpp"
#include "board/record.hpp"
#include "board/sim_board.hpp"
#include "command.hpp"
#include "command_lines.hpp"
#include "cosim/report/report_lock.hpp"
#include "cosim_print.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "pack_history.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "terminal.hpp"
#include "text.hpp"
#include "vectors/check.hpp"

namespace kage::cli {
namespace {

/// Without progress for so long a core hangs. A board in simulation takes minutes for a second of its own.
constexpr double kDeviceSeconds = 10;
constexpr double kSimulatedSeconds = 0.1;
/// More than the board's slots take at the lowest rate, with escapes, and at that of a board in simulation.
constexpr std::uint64_t kLinkTimeout = 250'000;
constexpr std::uint64_t kSimulatedLinkTimeout = 10'000;

struct BoardCommand : Options {
  std::string port;
  std::optional<int> baud;
  std::optional<double> timeout;
  std::optional<double> loop;
  bool leave = false;
  const CLI::App* command = nullptr;

  [[nodiscard]] bool simulated() const { return port.starts_with(board::kSimulated); }
};

std::uint64_t microseconds(double seconds) { return static_cast<std::uint64_t>(std::llround(seconds * 1e6)); }

std::string screen_text(const report::BoardScreenRecord& s) {
  return fmt::format("{} shown, {} without a frame in time, {} with lines too late, {} of them",
                     counted(s.shown, "frame"), counted(s.late, "screen"),
                     s.underrun_frames - std::min(s.late, s.underrun_frames), counted(s.underrun_lines, "line"));
}

/// Prints a board's results that kage cosim does not have.
void print_board(const report::BoardRecord& b) {
  fmt::print(
      "board {} at {}: {} played{}; link: {} sent, {} of them again, {} came damaged\n", b.name, b.port,
      counted(b.runs, "list"),
      b.direct == 0 ? "" : fmt::format(", {} of them from the link, as a frame larger than the memory", b.direct),
      counted(b.link.sent, "packet"), b.link.resent, b.link.damaged + b.link.bad);
  if (b.screen.shown != 0) fmt::print("screen: {}\n", screen_text(b.screen));
  if (!b.loop) return;
  const report::BoardLoopRecord& l = *b.loop;
  fmt::print("over and over: {} {} times in {:.3f} s, {} of {} different{}\n", counted(l.frames, "frame"),
             l.repetitions, l.seconds, l.mismatches, counted(l.lines, "line"), l.left ? "; the board goes on" : "");
  if (l.screen.shown != 0) fmt::print("screen meanwhile: {}\n", screen_text(l.screen));
}

void check_options(const BoardCommand& o) {
  if (o.port == board::kSimulated) throw Error("--port: sim: needs a board's name behind it, as sim:NAME");
  if (o.simulated() && o.baud) throw Error("--baud: a board in simulation has no rate to be given");
  if (o.simulated()) {
    const std::vector<std::string> boards = board::sim_boards();
    if (std::find(boards.begin(), boards.end(), o.port.substr(board::kSimulated.size())) == boards.end())
      throw Error(fmt::format("{}: no board with a simulation; there are {}", o.port, fmt::join(boards, ", ")));
  }
  if (o.leave && !o.loop) throw Error("--leave: only frames that are played over and over can be left: --loop");
}

board::PackVerdict play(const BoardCommand& o, const vectors::Pack& pack) {
  Progress progress;
  bool enough = false;
  board::PackRunOptions options;
  options.timeout = microseconds(o.timeout.value_or(o.simulated() ? kSimulatedSeconds : kDeviceSeconds));
  if (o.loop) options.loop = microseconds(*o.loop);
  options.leave = o.leave;
  // Ctrl-C ends a loop with its verdict, and all else without.
  options.wait = [&] {
    if (!enough) check_interrupt();
  };
  options.enough = [&] { return enough = enough || interrupted(); };
  options.progress = [&](const std::string& doing) { progress.show(fmt::format("{}: {}", o.port, doing)); };
  options.not_idle = [&] {
    progress.clear();
    fmt::print(stderr, "{}: the board could not be left idle: reset it\n", o.port);
  };
  board::ConnectOptions connect;
  connect.baud = o.baud.value_or(board::kDefaultBaud);
  connect.link.timeout = o.simulated() ? kSimulatedLinkTimeout : kLinkTimeout;
  connect.link.patience = options.timeout;
  connect.wait = check_interrupt;
  const board::Connection board = board::connect(o.port, connect);
  return board::play_pack(*board.link, *board.line, o.port, o.input, pack, options);
}

int run(const BoardCommand& o) {
  check_options(o);
  const vectors::Pack pack = vectors::checked_pack(o.input, vectors::Check::answers, check_interrupt);
  reads_files(vectors::files_of(o.input, pack));
  check_json(o, o.json);
  std::optional<OutFolder> folder;
  std::optional<report::ReportLock> lock;
  if (!o.out.empty()) {
    folder.emplace(o.out);
    lock.emplace(o.out);
    refuse_twice({file_named(o.json), (std::filesystem::path(o.out) / "report.html").string()});
  }
  const board::PackVerdict verdict = play(o, pack);
  TempFiles files;
  const report::RunRecord record = board::record_of(
      {pack, o.input, o.port, verdict, command_line(*o.command), "kage " KAGE_VERSION}, o.out, files, terminal());
  const report::SceneRecord& scene = record.scenes.front();
  try {
    write_json(o.json, record, files);
  } catch (const Error&) {
    // No file of the run appears, but what it found is told.
    if (!json_only(o.json)) print_finding(scene, "");
    throw;
  }
  for (const std::string& note : scene.notes)
    fmt::print(json_only(o.json) ? stderr : stdout, "{}: {}\n", scene.scene, note);
  if (!json_only(o.json)) {
    print_report(scene, "", o.out);
    print_board(*scene.board);
    if (verdict.first && verdict.first->x >= 0)
      fmt::print("{}", history_of(pack, o.input, static_cast<std::uint64_t>(verdict.first->frame), verdict.first->x,
                                  verdict.first->line));
  }
  return verdict.same() ? kSame : kDifferent;
}

}  // namespace

void add_board(CLI::App& app, Action& action) {
  CLI::App* c = add_command(
      app, "board", "Play a pack on a board, or on one in simulation, and compare every line and register",
      "  kage vectors courtyard --size 64x48 --frames 2 --config ulx3s.yaml --out pack   (the board's core)\n"
      "  kage board --port /dev/ttyUSB0 pack\n"
      "  verif/board/sim/build_board.py --core ulx3s_25f >sim.yaml   (a board in simulation has a smaller core)\n"
      "  kage vectors courtyard --size 48x24 --frames 2 --config sim.yaml --out sim-pack\n"
      "  kage board --port sim:ulx3s_25f sim-pack   (or another of constraints/boards)\n"
      "  kage board --port /dev/ttyUSB0 --loop 3600 --out hour pack\n"
      "  kage board --port /dev/ttyUSB0 --loop 10 --leave pack   (and the screen goes on)\n"
      "The board signs each line, and a signature that is not the pack's has it play the frame again and send that\n"
      "line's pixels: x and channel of the first difference, and the pixel's history. The board is left idle.\n"
      "Exit code 0: the same. 1: different, or the core hangs. 2: trouble, in one line that says what to do.\n"
      "docs/boards.md says more.");
  const auto o = std::make_shared<BoardCommand>();
  c->add_option("PACK", o->input, "folder that kage vectors wrote")->required();
  c->add_option("--port", o->port, "the serial device of the board, as /dev/ttyUSB0, or sim:NAME")
      ->required()
      ->type_name("PORT");
  c->add_option("--baud", o->baud, fmt::format("bits per second of the serial device, default {}", board::kDefaultBaud))
      ->check(whole_number(1, 100'000'000))
      ->type_name("N");
  c->add_option("--timeout", o->timeout,
                fmt::format("for how long no line may come before the core is said to hang, by the board's clock; "
                            "default {} and {} in simulation",
                            kDeviceSeconds, kSimulatedSeconds))
      ->check(real_number(0.001, 86400))
      ->type_name("SECONDS");
  c->add_option("--loop", o->loop,
                "once all was right, play the frames over and over for so long, compared by the board itself; 0: until "
                "Ctrl-C")
      ->check(real_number(0, 1e7))
      ->type_name("SECONDS");
  c->add_flag("--leave", o->leave, "leave the board at that, LED 2 on for right and LED 3 for wrong");
  c->add_option("--out", o->out, "folder for pictures, the frames as a stream file, and report.html; default none")
      ->type_name("DIR");
  option_json(*c, o->json);
  o->command = c;
  c->callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
