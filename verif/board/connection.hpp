// SPDX-License-Identifier: Apache-2.0
//
// The way to a board by its name, greeted; or a line that says why there is none.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "board/link.hpp"
#include "board/transport.hpp"

namespace kage::board {

/// Prefix of the port of a board in simulation: "sim:ulx3s".
inline constexpr std::string_view kSimulated = "sim:";
/// The rate of a board's line unless another is named.
inline constexpr int kDefaultBaud = 3'000'000;

/// Opens the line at a rate. Throws Error of one line that names it.
using OpenLine = std::function<std::unique_ptr<Transport>(int baud)>;

/// A line with a link that has been greeted.
struct Connection {
  std::unique_ptr<Transport> line;
  std::unique_ptr<Link> link;
  int baud = 0;  ///< 0: of a board in simulation
};

struct ConnectOptions {
  int baud = kDefaultBaud;
  LinkOptions link;                 ///< of the session
  std::function<void()> wait = {};  ///< called between two rates; may throw
};

/// Opens a serial line and greets the board. If it does not answer the other usual rates are tried, shortly. Throws
/// Error that says which of them the board answers at, or that it answers at none.
Connection connect(const std::string& port, const OpenLine& open, const ConnectOptions& options);

/// The same of a device, as /dev/ttyUSB1, or of a board in simulation, as sim:ulx3s, which has no rate to be given.
Connection connect(const std::string& port, const ConnectOptions& options);

}  // namespace kage::board
