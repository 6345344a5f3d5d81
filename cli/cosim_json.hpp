// SPDX-License-Identifier: Apache-2.0
//
// What kage cosim reports of a scene, as JSON.
#pragma once

#include <optional>

#include "cosim/diverge/divergence.hpp"
#include "cosim/run.hpp"
#include "cosim_run.hpp"
#include "results.hpp"

namespace kage::cli {

/// What decides words and clocks besides scene, size, configuration and seed.
Json options_of(const CosimCommand& o);

/// The first difference of the pixels, and the stage that it came of where one was looked for and found.
Json to_json(const std::optional<cosim::Difference>& d, const std::optional<cosim::Divergence>& by, bool searched);
Json to_json(const cosim::Stalls& stalls);

/// The frames that were compared, the first so many and the one that is different.
Json to_json(const std::vector<cosim::FrameResult>& frames, const std::optional<cosim::Difference>& difference);

}  // namespace kage::cli
