// SPDX-License-Identifier: Apache-2.0
#include "notes.hpp"

namespace kage::scene {

std::string cause_of(std::string_view message) {
  std::string line = one_line(message);
  if (line.size() >= 3 && line.compare(line.size() - 3, 3, "...") == 0) return line;  // that is where it was cut
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  return line;
}

}  // namespace kage::scene
