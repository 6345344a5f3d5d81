// SPDX-License-Identifier: Apache-2.0
//
// Readers of foreign files, as functions of bytes: for coverage-guided fuzzing (fuzz.cpp) and for running again the
// inputs that it has found (replay.cpp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kage::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// A reader. It takes any bytes: kage::Error is an answer, and any other exception, signal, sanitizer's report or wait
/// is a defect.
struct Target {
  const char* name;
  const char* about;
  /// May throw kage::Error.
  void (*run)(Bytes bytes);
  /// Sound inputs, small, made of built-in things: a campaign begins with them.
  std::vector<std::string> (*seeds)();
};

/// All of them.
std::span<const Target> targets();

/// Throws Error, with the names that there are.
const Target& target_named(const std::string& name);

/// Runs the target; kage::Error is an answer. Its message must be one line.
void run(const Target& target, Bytes bytes);

/// A file of this process that holds the bytes, in memory where that can be; the next call with this name writes over
/// it.
std::filesystem::path file_of(const std::string& name, Bytes bytes);

/// Ends the program where `holds` is false, which a fuzzer takes for a finding.
void require(bool holds, const char* what);

std::string_view text_of(Bytes bytes);
Bytes bytes_of(std::string_view text);

// The targets of each file.
std::span<const Target> frame_targets();
std::span<const Target> scene_targets();
std::span<const Target> text_targets();
std::span<const Target> store_targets();
std::span<const Target> picture_targets();

}  // namespace kage::fuzz
