// SPDX-License-Identifier: Apache-2.0
// libFuzzer's functions: $KAGE_FUZZ names the target (tools/fuzz).
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "fuzz/target.hpp"

namespace {

const kage::fuzz::Target& target() {
  static const kage::fuzz::Target& chosen = [&]() -> const kage::fuzz::Target& {
    const char* const name = std::getenv("KAGE_FUZZ");
    try {
      return kage::fuzz::target_named(name == nullptr ? "" : name);
    } catch (const std::exception& e) {
      (void)std::fprintf(stderr, "KAGE_FUZZ: %s\n", e.what());
      std::exit(2);
    }
  }();
  return chosen;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kage::fuzz::run(target(), {data, size});
  return 0;
}
