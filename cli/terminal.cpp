// SPDX-License-Identifier: Apache-2.0
#include "terminal.hpp"

#include "mapped.hpp"
#include "progress.hpp"
#include "signals.hpp"
#include "standard_files.hpp"

namespace kage::cli {
namespace {

class Terminal final : public cosim::Host {
 public:
  void check() override {
    check_interrupt();
    check_mapped();
  }
  [[nodiscard]] bool interrupted() override { return cli::interrupted(); }
  void say(const std::string& text) override { cli::say(text); }
  std::unique_ptr<cosim::Progress> progress() override { return std::make_unique<Progress>(); }
  void maps(const std::string& path) override { guard_mapped(path); }
};

}  // namespace

cosim::Host& terminal() {
  static Terminal host;
  return host;
}

}  // namespace kage::cli
