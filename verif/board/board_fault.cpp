// SPDX-License-Identifier: Apache-2.0
#include "board/board_fault.hpp"

#include <fmt/format.h>

namespace kage::board {

std::string advice(LinkFailure failure, const std::string& port, const std::string& doing) {
  switch (failure) {
    case LinkFailure::reset_in_the_middle:
      return fmt::format("{}: the board was reset while it {}: press no button, check its supply, and run again", port,
                         doing);
    case LinkFailure::bus_error:
      return fmt::format(
          "{}: the board refused an address while it {}: its bitstream is not of this kage's rtl, or the core "
          "does not answer: load it anew",
          port, doing);
    case LinkFailure::overrun:
      return fmt::format(
          "{}: the board got more than it has room for while it {}: close what else writes to the port, and "
          "run again",
          port, doing);
    case LinkFailure::stalled:
      return fmt::format("{}: the board answers, and has executed nothing while it {}: reset it, and run again", port,
                         doing);
    case LinkFailure::no_answer:
      break;
  }
  return fmt::format("{}: the board no longer answers while it {}: check cable and supply, and run again", port, doing);
}

}  // namespace kage::board
