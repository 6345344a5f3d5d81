// SPDX-License-Identifier: Apache-2.0
#include "board/connection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <utility>
#include <vector>

#include "board/board_fault.hpp"
#include "board/serial_port.hpp"
#include "board/sim_board.hpp"
#include "kage/error.hpp"

namespace kage::board {
namespace {

constexpr std::array kUsualRates{115200, 230400, 460800, 921600, 1000000, 2000000, 3000000};

/// A HELLO and its answer are 20 bytes, and take 2 ms at 115,200 baud; a USB bridge may add 16. Three in a row are lost
/// by nobody's chance.
constexpr std::uint64_t kShortTimeout = 60'000;
constexpr int kShortTries = 4;

bool answers(Transport& line) {
  LinkOptions brief;
  brief.timeout = kShortTimeout;
  brief.tries = kShortTries;
  brief.patience = kShortTries * kShortTimeout;
  try {
    Link(line, brief).hello();
  } catch (const LinkError& e) {
    return e.failure == LinkFailure::stalled;  // it does answer, and is busy
  }
  return true;
}

}  // namespace

Connection connect(const std::string& port, const OpenLine& open, const ConnectOptions& options) {
  Connection c;
  c.baud = options.baud;
  c.line = open(options.baud);
  if (answers(*c.line)) {
    c.link = std::make_unique<Link>(*c.line, options.link);
    try {
      c.link->hello();
    } catch (const LinkError& e) {
      throw Error(advice(e.failure, port, "was greeted"));
    }
    return c;
  }
  c.line.reset();
  std::vector<int> tried;
  for (const int baud : kUsualRates) {
    if (baud == options.baud) continue;
    if (options.wait) options.wait();
    std::unique_ptr<Transport> line;
    try {
      line = open(baud);
    } catch (const Error&) {
      continue;  // a rate that this port does not have is none that a board could be at
    }
    if (answers(*line)) throw Error(fmt::format("{}: the board answers at {} baud; give --baud {}", port, baud, baud));
    tried.push_back(baud);
  }
  throw Error(fmt::format("{}: no kage board answers at {} baud{}: is it powered and loaded (tools/fpga prints how)?",
                          port, options.baud, tried.empty() ? "" : fmt::format(", nor at {}", fmt::join(tried, ", "))));
}

Connection connect(const std::string& port, const ConnectOptions& options) {
  if (!port.starts_with(kSimulated))
    return connect(
        port, [&](int baud) { return std::make_unique<SerialPort>(port, baud); }, options);
  Connection c;
  c.line = open_sim_board(port.substr(kSimulated.size()));
  c.link = std::make_unique<Link>(*c.line, options.link);
  try {
    c.link->hello();
  } catch (const LinkError& e) {
    throw Error(advice(e.failure, port, "was greeted"));
  }
  return c;
}

}  // namespace kage::board
