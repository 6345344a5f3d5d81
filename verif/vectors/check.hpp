// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "vectors/pack.hpp"

namespace kage::vectors {

/// Reads a pack and verifies it: every file of the manifest is there, as long as it says and with its SHA-256; words
/// and pixels are as many as its frames have; and the golden core, given the words, draws the pixels, ends each frame
/// as the manifest says, and so do the registers. Throws Error that names the file and what is wrong with it.
Pack checked_pack(const std::filesystem::path& folder);

}  // namespace kage::vectors
