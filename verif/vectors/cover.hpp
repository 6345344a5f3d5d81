// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kage/pipeline.hpp"
#include "vectors/budget.hpp"

namespace kage::vectors {

/// Few frames that reach what many reach.
struct Cover {
  std::vector<ChosenFrame> frames;  ///< whole ones, in the order of the source
  std::vector<std::string>
      reached;  ///< lines and branches of the RTL that they reach in a row, "token_reader.sv:120 else"
  std::vector<std::string> unreached;  ///< the others; sorted, as those are
  std::uint64_t points = 0;            ///< of stimulus/coverage.hpp: kinds of tokens and errors that are reached
};

/// A few frames of a source that reach as much as all of them do: lines and branches of the RTL, kinds of tokens, and
/// errors. Time after time the frame that reaches most for its words is chosen; then frames that the others make
/// needless are dropped. Each is tried alone, then all chosen ones in a row, on a core out of reset whose streams stop
/// in a quarter of the clocks, by `seed`. `library` is a model of the source's configuration that counts lines. Throws
/// as FrameSource::frame().
Cover cover(FrameSource& source, const std::filesystem::path& library, std::uint64_t seed,
            const std::function<void(int frame)>& progress);

}  // namespace kage::vectors
