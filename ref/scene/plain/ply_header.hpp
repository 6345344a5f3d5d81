// SPDX-License-Identifier: Apache-2.0
// The header of a PLY file: which elements it has, and of which properties.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/plain/text_lines.hpp"

namespace kage::scene {

enum class PlyType : std::uint8_t { kNone, kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

/// Bytes of a value in a binary file.
std::size_t size_of(PlyType type);
inline bool is_integer(PlyType type) { return type < PlyType::kFloat; }

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kNone;   ///< of the value, or of each in a list
  PlyType count = PlyType::kNone;  ///< of the list's length; kNone: it is no list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Bytes of one in a binary file, where all its lists are empty.
  [[nodiscard]] std::size_t least_size() const;
};

struct PlyHeader {
  enum class Form : std::uint8_t { kAscii, kLittle, kBig };
  Form form = Form::kAscii;
  std::vector<PlyElement> elements;
  std::vector<std::string> ignored;   ///< lines of a text file that are none of the format's, as sentences
  std::vector<std::string> textures;  ///< files that comments name, as MeshLab writes them
};

/// Reads from the first line to the one after "end_header", at which `lines` stands then. Throws Error with the line.
PlyHeader read_ply_header(TextLines& lines);

}  // namespace kage::scene
