// SPDX-License-Identifier: Apache-2.0
//
// Inputs that a command does not take, and what is told of a source.
#pragma once

#include <string>
#include <vector>

#include "cosim/session/source.hpp"

namespace kage::cli {

/// Throws Error if a folder is a pack of test vectors: kage board plays it.
void refuse_pack(const std::string& input);

/// Throws Error if `input` asks for random frames: only kage cosim and kage explain take them.
void refuse_random(const std::string& input);

/// Throws Error if a scene is named twice, where scenes are told apart by their names or counted together.
void refuse_repeated(const std::vector<std::string>& inputs);

/// The notes, a line each. They are told once the work is done: a failure says one line and nothing else.
std::string notes_text(const cosim::Source& source);
void print_notes(const cosim::Source& source, const std::string& json);  // where --json leaves room for them

}  // namespace kage::cli
