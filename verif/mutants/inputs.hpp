// SPDX-License-Identifier: Apache-2.0
//
// Inputs for mutants: small configurations that between them have everything, and frames for each.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cosim/model/rtl.hpp"
#include "cosim/register_check.hpp"
#include "kage/config.hpp"

namespace kage::verif {

/// Frames that one core takes one after the other.
struct Sequence {
  cosim::RtlOptions rtl;  ///< stalls and seed
  std::vector<cosim::KnownFrame> frames;
  std::vector<std::vector<std::vector<std::uint8_t>>> lines;  ///< of each frame, as the golden core has them
};

struct Inputs {
  std::string name;
  Config config;
  std::vector<Sequence> sequences;
};

/// Names and parameters alone.
std::vector<Inputs> trial_configurations();

/// Adds the frames: valid and damaged ones, with input always there and output always taken, and with stalls.
void make_frames(Inputs& inputs, std::uint64_t seed);

}  // namespace kage::verif
