// SPDX-License-Identifier: Apache-2.0
// A process that answers as kage-import does, or ends as it may: import_answers WORK PARENT SECONDS MIB
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>

#include "kage/error.hpp"
#include "scene/answer.hpp"

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes large() {
  Bytes all(5'000'000);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i * 7);
  return all;
}

Bytes busy() {
  volatile int on = 1;
  while (on != 0) {
  }
  return {};
}

Bytes work(const std::string& name) {
  if (name == "large") return large();
  if (name == "error") throw kage::Error("x: no good");
  if (name == "bare") throw std::runtime_error("bare");
  if (name == "killed") raise(SIGKILL);
  if (name == "code") _exit(7);
  if (name == "abort") abort();
  if (name == "busy") return busy();
  if (name == "100 MiB") return Bytes(100 << 20);
  if (name == "300 MiB") return Bytes(std::size_t{300} << 20);
  if (name == "all memory") return Bytes(static_cast<std::size_t>(-1) / 2);
  while (name == "pause") pause();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const std::string name = argv[1];
  kage::scene::answer(std::atoi(argv[2]), "x", {std::atoi(argv[3]), std::atoll(argv[4])}, [&] { return work(name); });
}
