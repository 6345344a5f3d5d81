// SPDX-License-Identifier: Apache-2.0
//
// A glTF 2.0 file (.gltf or .glb): its JSON (gltf_json.hpp), its buffers and accessors. Everything that does not hold
// what the format demands is an Error that names file and place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gltf_json.hpp"
#include "gltf_uses.hpp"
#include "side_files.hpp"
#include "transform.hpp"

namespace kage::scene {

/// A vector from the numbers that GltfJson::numbers() gives.
inline glm::dvec3 vec3(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

class GltfFile : public GltfJson {
 public:
  /// Whether the file's name ends in .gltf or .glb.
  static bool recognises(const std::filesystem::path& path);

  /// Read the JSON part; buffers are read when first used. `name` is how messages call the file. `allow_outside`: files
  /// of buffers may lie anywhere (side_files.hpp).
  GltfFile(const std::filesystem::path& path, std::string name, bool allow_outside = false);

  /// False for glTF 1, whose further content is not looked at.
  [[nodiscard]] bool is_version_2() const { return version_2_; }
  [[nodiscard]] bool is_binary() const { return is_binary_; }

  /// Values of an accessor as floats, normalised integers mapped as glTF says. Components and types are those that the
  /// use has (gltf_uses.hpp); others are an Error.
  struct Floats {
    std::vector<float> values;
    std::size_t components = 0;
  };
  Floats floats(std::uint64_t index, GltfUse use, const std::string& place);
  /// Unsigned integers: joints, four to an element, or indices.
  std::vector<std::uint32_t> indices(std::uint64_t index, GltfUse use, const std::string& place);
  /// Matrices (MAT4) that are maps. Throws Error where one is projective.
  std::vector<Affine> affine_maps(std::uint64_t index, const std::string& place);
  /// The map of a matrix, 16 numbers by columns. Throws Error where it is projective, with `what`.
  [[nodiscard]] Affine affine_map(const double* by_columns, const char* what, const std::string& place) const;
  /// Whether an accessor has values of its own, not zeros alone.
  bool has_data(std::uint64_t index, const std::string& place) const;
  /// Sentences on what the format does not allow and is drawn all the same, of what was read so far.
  void note(std::vector<std::string>& notes) const { remarks_.note(notes); }
  /// The files of buffers that were read, and of images, which are not.
  [[nodiscard]] std::vector<std::string> files() const;

 private:
  struct View;
  struct Accessor;
  void read_chunks(std::vector<std::uint8_t>& text);
  View view(std::uint64_t index, const std::string& place);
  Accessor accessor(std::uint64_t index, GltfUse use, const std::string& place);
  void check_stride(const View& view, std::uint64_t element, bool of_vertices, const std::string& place) const;
  const std::vector<std::uint8_t>& buffer(std::uint64_t index, const std::string& place);
  template <typename T>
  void elements(const Accessor& a, std::vector<T>& out, const std::string& place);
  template <typename T>
  void copy(const View& view, std::uint64_t offset, std::uint64_t count, std::uint64_t stride, int type,
            std::size_t components, bool normalized, T* out, const std::string& place) const;

  SideFiles side_files_;
  GltfRemarks remarks_;
  bool version_2_ = true;
  bool is_binary_ = false;
  std::vector<std::uint8_t> binary_;  // the BIN chunk of a .glb
  std::vector<std::optional<std::vector<std::uint8_t>>> buffers_;
};

}  // namespace kage::scene
