// SPDX-License-Identifier: Apache-2.0
//
// Models of the RTL, which are built where they are not there, and how a run drives them.
#pragma once

#include <cstdint>
#include <string>

#include "cosim/diverge/divergence.hpp"
#include "cosim/model/model.hpp"
#include "cosim/model/rtl.hpp"
#include "kage/config.hpp"
#include "kage/cosim.hpp"

namespace kage::cosim {

/// How such a run drives the RTL: its stalls, its mutant and, by the seed, when it stalls.
RtlOptions rtl_options(const RtlRun& rtl, std::uint64_t seed);

/// The use of a model besides pixels. kSearch: the search for a divergence and then its waveform, by one model, which
/// takes less time to build than two.
enum class ModelFor { kPixels, kMonitors, kWaveforms, kSearch, kLines };

/// The model of a configuration; says how long it takes where it has to be built. Says too, once in the program's life,
/// if the current folder is of a tree with another rtl/ than the model's. `ports`: ModelOptions::ports.
Model model_of(const NamedConfig& config, const RtlRun& rtl, Host& host, ModelFor what = ModelFor::kPixels,
               const std::string& ports = {});

/// Where the RTL is that models are built of.
std::string rtl_directory();

/// To run it again by such a model, driven as `options` say. Assertions are not looked at: what differs comes before
/// what they say of it. `host` must outlive the result.
ReplayOptions replay(const NamedConfig& config, const RtlRun& rtl, const RtlOptions& options, ModelFor what,
                     Host& host);

}  // namespace kage::cosim
