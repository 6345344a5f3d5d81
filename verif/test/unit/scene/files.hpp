// SPDX-License-Identifier: Apache-2.0
//
// Files for the tests of scenes: made in a directory that goes away, or found among Debian's packages.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "kage/error.hpp"
#include "kage/scene.hpp"
#include "test/support/temp_directory.hpp"

namespace kage::test {

/// The message that loading throws; "loaded" if it does not.
inline std::string refusal(const std::string& name) {
  try {
    (void)Scene::load(name);
  } catch (const Error& e) {
    return e.what();
  }
  return "loaded";
}

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The bytes of numbers, as a buffer of a glTF file holds them.
template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  std::string s(values.size() * sizeof(T), '\0');
  if (!values.empty()) std::memcpy(s.data(), values.data(), s.size());
  return s;
}

inline std::string base64(std::string_view data) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < data.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < data.size() ? static_cast<unsigned char>(data[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= data.size() - i ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

/// A glTF file of one buffer: `members` are the JSON's further members, `data` the buffer.
inline std::string gltf(const std::string& members, std::string_view data) {
  return R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": )" + std::to_string(data.size()) +
         R"(, "uri": "data:application/octet-stream;base64,)" + base64(data) + "\"}]" + (members.empty() ? "" : ", ") +
         members + "}";
}

/// One triangle (0 0 0), (1 0 0), (0 1 0) in bufferView 0 and accessor 0, mesh 0 that draws it, and what else is given.
inline std::string triangle_gltf(const std::string& members) {
  const std::vector<float> p{0, 0, 0, 1, 0, 0, 0, 1, 0};
  return gltf(R"("bufferViews": [{"buffer": 0, "byteLength": 36}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], )" +
                  members,
              bytes_of(p));
}

inline bool has_note(const Scene& scene, std::string_view part) {
  for (const std::string& note : scene.notes())
    if (note.find(part) != std::string::npos) return true;
  return false;
}

}  // namespace kage::test
