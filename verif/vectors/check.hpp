// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "vectors/pack.hpp"

namespace kage::vectors {

/// Whether all of a pack is verified, or what a capture is judged by: words, pixels and signatures.
enum class Check { all, answers };

/// Reads a pack and verifies it: every file of the manifest is there, as long as it says and with its SHA-256. With
/// Check::all the golden core is given the words once more: each frame ends as the manifest says, and each file but the
/// testbench and README.md is what the pack's words come to. Throws Error that names the file and what is wrong with
/// it. `wait` is called now and then, and may throw.
Pack checked_pack(const std::filesystem::path& folder, Check what, const std::function<void()>& wait);

}  // namespace kage::vectors
