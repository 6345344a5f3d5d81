// SPDX-License-Identifier: Apache-2.0
//
// Options for continuous integration.
#pragma once

#include <string>

#include "arguments.hpp"
#include "kage/cosim.hpp"

namespace kage::cli {

/// Where the verdict goes besides.
struct CiOptions {
  std::string junit;
  std::string annotate;  ///< "github", "none", or "": as the environment says
};

/// --shard; `what` is its help: what of the command the Ith of N parts is.
void option_shard(Command command, cosim::Shard& shard,
                  const std::string& what =
                      "run the Ith of N parts of the frames of all scenes: frame I - 1 and every "
                      "Nth after it. kage merge joins the reports");
void option_junit(Command command, std::string& path, const std::string& each = "frame");
void option_annotate(Command command, std::string& annotate);

}  // namespace kage::cli
