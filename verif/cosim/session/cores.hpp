// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "cosim/compare.hpp"
#include "cosim/core.hpp"
#include "cosim/model/model.hpp"
#include "cosim/model/rtl.hpp"
#include "cosim/model/rtl_identity.hpp"
#include "kage/config.hpp"
#include "kage/cosim.hpp"

namespace kage::cosim {

/// Where a run has the cores from that it holds against the golden one: models of the RTL; in tests any. Called by
/// several threads.
class Cores {
 public:
  Cores() = default;
  virtual ~Cores() = default;
  Cores(const Cores&) = delete;
  Cores& operator=(const Cores&) = delete;

  /// The model that core() needs, built where it is not there.
  virtual Model model(const NamedConfig& config, const RtlRun& rtl, Host& host) = 0;

  /// The identity on which its kept verdicts hang.
  virtual RtlIdentity identity(const NamedConfig& config, Host& host) = 0;

  /// A new core.
  virtual std::unique_ptr<Core> core(const Model& model, const Config& config, const RtlOptions& options) = 0;

  /// The first wrong register of a new core, if one is (random_registers.hpp). `wait` as of wrong_register().
  virtual std::optional<Difference> registers(const Model& model, const Config& config, const RtlOptions& options,
                                              const std::function<void()>& wait) = 0;
};

/// Models of the RTL.
Cores& rtl_cores();

}  // namespace kage::cosim
