// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "kage/defs.hpp"

namespace kage::cosim {

/// An RTL model: a shared library that Verilator and the C++ compiler made of rtl/ for one configuration.
struct Model {
  std::filesystem::path library;
  double build_seconds = 0;  ///< 0: it was there
};

/// Called while a model is being built, several times a second, with the seconds so far; may throw, which ends the
/// build.
using BuildProgress = std::function<void(double seconds)>;

/// The model of `config` from the cache (${XDG_CACHE_HOME:-~/.cache}/kage/models), built first if it is not there. Its
/// key is the SHA-256 of all sources under rtl/ and verif/rtl_model/, the parameters, `fault`, and the versions of
/// Verilator and compiler, so that a changed source is another model. Two programs that want the same one build it
/// once. `fault` names a deliberate defect (verif/rtl_model), empty for none. Throws Error that names the log when the
/// build fails.
Model find_model(const Config& config, const std::string& fault = {}, const BuildProgress& progress = {});

}  // namespace kage::cosim
