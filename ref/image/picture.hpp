// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace kage {

/// Type of a channel's value, as the file has it.
enum class Sample { kU8, kI8, kU16, kI16, kU32, kI32, kU64, kI64, kHalf, kFloat, kDouble };

/// Any picture file, its values untouched.
struct Picture {
  int x = 0;  ///< of the first pixel: files may have an origin
  int y = 0;
  int width = 0;
  int height = 0;
  int channels = 0;
  std::string channel_names;  ///< joined by commas
  Sample sample = Sample::kU8;
  std::vector<std::byte> data;
};

/// Bytes of a value.
std::size_t size_of(Sample sample);

/// Name for messages: "uint8", "half".
const char* name_of(Sample sample);

/// Read a file of one flat picture; alpha is taken as stored. Throws Error.
Picture load_picture(const std::filesystem::path& path);

}  // namespace kage
