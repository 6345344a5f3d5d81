// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "cosim/session/cores.hpp"
#include "test/support/wrong_core.hpp"

namespace kage::test {

/// Golden cores in place of the RTL, which may have a frame wrong.
class FakeCores final : public cosim::Cores {
 public:
  int wrong = -1;                     ///< the frame of each scene
  std::function<void()> before_core;  ///< may throw
  std::atomic<int> cores{0};          ///< made so far
  std::atomic<int> models{0};         ///< asked for so far
  std::atomic<int> registers_read{0};

  cosim::Model model(const NamedConfig& /*config*/, const cosim::RtlRun& /*rtl*/, cosim::Host& /*host*/) override {
    ++models;
    return {.library = "fake.so"};
  }
  cosim::RtlIdentity identity(const NamedConfig& config, cosim::Host& /*host*/) override {
    return {.model_key = "fake", .behaviour = config.name};
  }
  std::unique_ptr<cosim::Core> core(const cosim::Model& /*model*/, const Config& config,
                                    const cosim::RtlOptions& /*options*/) override {
    if (before_core) before_core();
    ++cores;
    return std::make_unique<verif::WrongCore>(config, wrong);
  }
  std::optional<cosim::Difference> registers(const cosim::Model& /*model*/, const Config& /*config*/,
                                             const cosim::RtlOptions& /*options*/,
                                             const std::function<void()>& /*wait*/) override {
    ++registers_read;
    return std::nullopt;
  }
};

}  // namespace kage::test
