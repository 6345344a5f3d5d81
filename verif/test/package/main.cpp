// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <kage/config.hpp>

int main() {
  try {
    const kage::NamedConfig tiny = kage::load_config("tiny");
    std::printf("tiny has parameters %08x:\n%s", kage::param_hash(tiny.config), kage::to_yaml(tiny.config).c_str());
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
