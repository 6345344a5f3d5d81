// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cosim/run.hpp"
#include "file/temp_file.hpp"

namespace kage::cosim {

/// File suffix of a kept random frame: the one that differs, or the one right ahead of it.
inline const char* kept_ending(const Difference& d) { return d.ahead ? "_ahead.kage" : ".kage"; }

/// With the new files' coming, removes what an earlier run into the folder left of frames that this one has compared: a
/// difference that is no more, or was another. Random frames leave a picture, and the frame itself, only where they
/// differ.
void remove_old_evidence(TempFiles& files, const std::string& folder, const std::string& name, bool random,
                         FrameSteps steps, const Report& r);

}  // namespace kage::cosim
