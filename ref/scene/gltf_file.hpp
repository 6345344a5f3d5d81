// SPDX-License-Identifier: Apache-2.0
//
// A glTF 2.0 file (.gltf or .glb): its JSON with checked access, its buffers and accessors. Everything that does not
// hold what the format demands is an Error that names file and place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace kage::scene {

class GltfFile {
 public:
  using Json = nlohmann::json;

  /// Whether the file's name ends in .gltf or .glb.
  static bool recognises(const std::filesystem::path& path);

  /// Read the JSON part; buffers are read when first used. `name` is how messages call the file.
  GltfFile(const std::filesystem::path& path, std::string name);

  /// False for glTF 1, whose further content is not looked at.
  [[nodiscard]] bool is_version_2() const { return version_2_; }

  [[nodiscard]] const Json& root() const { return root_; }

  [[noreturn]] void fail(const std::string& place, const std::string& cause) const;

  /// Number of elements of a top-level array such as "meshes".
  [[nodiscard]] std::size_t count(const char* array) const;
  /// Element of a top-level array, an object. `place` is who asks.
  [[nodiscard]] const Json& item(const char* array, std::uint64_t index, const std::string& place) const;

  // Members of an object. What is absent is the default; what is of another type is an Error.
  [[nodiscard]] std::optional<std::uint64_t> integer(const Json& object, const char* key,
                                                     const std::string& place) const;
  [[nodiscard]] std::optional<double> number(const Json& object, const char* key, const std::string& place) const;
  [[nodiscard]] std::string text(const Json& object, const char* key) const;
  /// `size` numbers, or none where the key is absent.
  [[nodiscard]] std::vector<double> numbers(const Json& object, const char* key, std::size_t size,
                                            const std::string& place) const;
  /// An array or object, or an empty one where the key is absent.
  [[nodiscard]] const Json& array(const Json& object, const char* key, const std::string& place) const;
  [[nodiscard]] const Json& object(const Json& parent, const char* key) const;

  /// Values of an accessor as floats, normalised integers mapped as glTF says. It has `least` to `most` components:
  /// 1 (SCALAR) to 4 (VEC4).
  struct Floats {
    std::vector<float> values;
    std::size_t components = 0;
  };
  Floats floats(std::uint64_t index, std::size_t least, std::size_t most, const std::string& place);
  std::vector<std::uint32_t> indices(std::uint64_t index, const std::string& place);

 private:
  struct View;
  struct Accessor;
  View view(std::uint64_t index, const std::string& place);
  Accessor accessor(std::uint64_t index, const std::string& place);
  const std::vector<std::uint8_t>& buffer(std::uint64_t index, const std::string& place);
  template <typename T>
  void elements(const Accessor& a, std::vector<T>& out, const std::string& place);
  template <typename T>
  void copy(const View& view, std::uint64_t offset, std::uint64_t count, std::uint64_t stride, int type,
            std::size_t components, bool normalized, T* out, const std::string& place) const;

  std::filesystem::path path_;
  std::string name_;
  Json root_;
  bool version_2_ = true;
  std::vector<std::uint8_t> binary_;  // the BIN chunk of a .glb
  std::vector<std::optional<std::vector<std::uint8_t>>> buffers_;
};

}  // namespace kage::scene
