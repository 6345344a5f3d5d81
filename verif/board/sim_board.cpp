// SPDX-License-Identifier: Apache-2.0
#include "board/sim_board.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <sstream>
#include <thread>

#include "board/dvi_receiver.hpp"
#include "board/sim/board_model.h"
#include "board/vga_receiver.hpp"
#include "cosim/model/process.hpp"
#include "cosim/model/trust.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage::board {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMicrosecond = 1'000'000;  // in picoseconds

/// Lines that build_board.py printed.
std::vector<std::string> lines_of_script(std::vector<std::string> arguments) {
  const fs::path script = data_directory() / "verif/board/sim/build_board.py";
  if (!fs::exists(script)) throw Error(fmt::format("{}: no such file: this kage has no boards", script.string()));
  arguments.insert(arguments.begin(), script.string());
  cosim::Process process(arguments);
  bool ok = false;
  while (!process.ended(ok)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  std::vector<std::string> lines;
  std::istringstream said(process.said());
  for (std::string line; std::getline(said, line);)
    if (!line.empty()) lines.push_back(line);
  if (!ok) throw Error(lines.empty() ? "build_board.py failed" : lines.back());
  return lines;
}

/// The socket that a screen is plugged into.
enum class Socket : std::uint8_t { none, dvi, vga };

class LoadedBoard : public SimBoard {
 public:
  LoadedBoard(const fs::path& library, Socket socket, const VideoMode& mode, unsigned baud)
      : vga_(mode), screen_(mode) {
    { library_ = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL); }
    if (library_ == nullptr) throw Error(fmt::format("{}: {}", library.string(), dlerror()));
    // POSIX has it that a symbol's address is a function's where it names one.
    const auto function = reinterpret_cast<const kage_board_functions* (*)()>(dlsym(library_, "kage_board_model"));
    if (function == nullptr || function()->abi != KAGE_BOARD_ABI)
      throw Error(fmt::format("{}: not a board of this kage", library.string()));
    functions_ = function();
    board_ = functions_->open(1, baud);
    if (socket == Socket::dvi) functions_->video(board_, &LoadedBoard::take_bits, this);
    if (socket == Socket::vga) functions_->video(board_, &LoadedBoard::take_pixel, this);
  }
  ~LoadedBoard() override {
    if (board_ != nullptr) functions_->close(board_);
  }

  void write(std::span<const std::uint8_t> bytes) override { functions_->send(board_, bytes.data(), bytes.size()); }

  std::size_t read(std::span<std::uint8_t> bytes, std::uint64_t deadline) override {
    const std::size_t count = functions_->receive(board_, bytes.data(), bytes.size(),
                                                  std::max(deadline * kMicrosecond, functions_->now(board_)));
    if (count == 0 && *functions_->stopped(board_) != '\0')
      throw Error(fmt::format("the board in simulation stopped: {}", functions_->stopped(board_)));
    return count;
  }

  std::uint64_t now() override { return functions_->now(board_) / kMicrosecond; }

  SimBoardState state() override {
    SimBoardState state{
        .microseconds = now(), .leds = static_cast<std::uint8_t>(functions_->leds(board_)), .fault = {}};
    if (*functions_->stopped(board_) != '\0')
      state.fault = functions_->stopped(board_);
    else if (!receiver_.fault().empty())
      state.fault = "DVI: " + receiver_.fault();
    else if (!vga_.fault().empty())
      state.fault = "VGA: " + vga_.fault();
    else if (!screen_.fault().empty())
      state.fault = "screen: " + screen_.fault();
    return state;
  }

  std::vector<ShownFrame> take_frames() override { return screen_.take_frames(); }

  void press_reset(bool pressed) override { functions_->button(board_, pressed ? 1 : 0); }
  void tap_reset(std::uint64_t picoseconds) override { functions_->tap(board_, picoseconds); }

 private:
  static void take_bits(void* self, unsigned wires) {
    auto& board = *static_cast<LoadedBoard*>(self);
    if (const auto pixel = board.receiver_.put((wires & 1) != 0, (wires & 2) != 0, (wires & 4) != 0, (wires & 8) != 0))
      board.screen_.put(*pixel);
  }
  static void take_pixel(void* self, unsigned wires) {
    auto& board = *static_cast<LoadedBoard*>(self);
    if (const auto pixel = board.vga_.put((wires & 64) != 0, (wires & 128) != 0, wires & 63)) board.screen_.put(*pixel);
  }

  void* library_ = nullptr;  // stays open: threads of Verilator's may still be ending
  const kage_board_functions* functions_ = nullptr;
  kage_board* board_ = nullptr;
  DviReceiver receiver_;
  VgaReceiver vga_;
  Screen screen_;
};

}  // namespace

std::vector<std::string> sim_boards() { return lines_of_script({"--list"}); }

std::string sim_core(const std::string& board) {
  const std::vector<std::string> said = lines_of_script({"--core", board});
  if (said.empty()) throw Error(fmt::format("{}: build_board.py did not say which core it has", board));
  return said.back();
}

std::unique_ptr<SimBoard> open_sim_board(const std::string& board, const SimBoardOptions& options) {
  std::vector<std::string> arguments{board, cosim::cache_folder("boards").string()};
  if (!options.fault.empty()) arguments.insert(arguments.end(), {"--fault", options.fault});
  const std::vector<std::string> said = lines_of_script(arguments);
  if (said.size() < 2) throw Error(fmt::format("{}: build_board.py did not say where the library is", board));
  // Its screen: the socket, then the mode, horizontal and vertical, as VideoMode has them.
  std::istringstream numbers(said[said.size() - 2]);
  std::string socket;
  VideoMode mode{.name = "rehearsal", .mhz = 0};
  int h_positive = 0, v_positive = 0;
  numbers >> socket >> mode.h_active >> mode.h_front >> mode.h_sync >> mode.h_back >> mode.v_active >> mode.v_front >>
      mode.v_sync >> mode.v_back >> h_positive >> v_positive;
  if (!numbers || (socket != "dvi" && socket != "vga" && socket != "none"))
    throw Error(fmt::format("{}: build_board.py did not say which mode the screen has", board));
  mode.h_positive = h_positive != 0;
  mode.v_positive = v_positive != 0;
  return std::make_unique<LoadedBoard>(said.back(),
                                       socket == "dvi"   ? Socket::dvi
                                       : socket == "vga" ? Socket::vga
                                                         : Socket::none,
                                       mode, options.other_baud.value_or(0));
}

}  // namespace kage::board
