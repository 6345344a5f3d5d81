// SPDX-License-Identifier: Apache-2.0
//
// The import process's side of a question (child.hpp): it does its work within limits, and answers by a pipe.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "child.hpp"

namespace kage::scene {

/// The number by which the process has the pipe's writing end.
inline constexpr int kAnswerPipe = 3;

// The answer's first byte; a message or a packed scene follows, and a last byte, which says that nothing is missing.
inline constexpr std::uint8_t kScene = 'S';
inline constexpr std::uint8_t kError = 'E';
inline constexpr std::uint8_t kNoMemory = 'M';
inline constexpr std::uint8_t kDone = '.';

/// The exit code of an importer that is of another kage than who asks.
inline constexpr int kOtherVersion = 4;

/// Does `work` within the limits, writes its result, or the cause of its failure, and ends the process. `parent` is the
/// process that asked: when it dies, this one dies too. The text of an exception that is no Error follows `name`.
[[noreturn]] void answer(int parent, const std::string& name, const ImportLimits& limits,
                         const std::function<std::vector<std::uint8_t>()>& work);

}  // namespace kage::scene
