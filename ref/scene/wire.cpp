// SPDX-License-Identifier: Apache-2.0
#include "wire.hpp"

#include <cstring>
#include <type_traits>

#include "kage/error.hpp"

namespace kage::scene {
namespace {

// One description of what a scene consists of serves both directions: `fields` calls the archive with every member.
class Writer {
 public:
  template <typename... T>
  void operator()(const T&... values) {
    (write(values), ...);
  }
  std::vector<std::uint8_t> bytes;

 private:
  template <typename T>
  void write(const T& value);
  template <typename T>
  void write(const std::vector<T>& values);
  void write(const std::string& text) { write(std::vector<char>(text.begin(), text.end())); }
  template <typename T>
  void write(const std::optional<T>& value) {
    write(value.has_value());
    if (value) write(*value);
  }
  void raw(const void* data, std::size_t size) {
    const std::size_t old = bytes.size();
    bytes.resize(old + size);
    if (size > 0) std::memcpy(bytes.data() + old, data, size);
  }
};

class Reader {
 public:
  explicit Reader(const std::vector<std::uint8_t>& bytes) : at_(bytes.data()), left_(bytes.size()) {}
  template <typename... T>
  void operator()(T&... values) {
    (read(values), ...);
  }
  [[nodiscard]] bool at_end() const { return left_ == 0; }

 private:
  template <typename T>
  void read(T& value);
  template <typename T>
  void read(std::vector<T>& values);
  void read(std::string& text) {
    std::vector<char> chars;
    read(chars);
    text.assign(chars.begin(), chars.end());
  }
  template <typename T>
  void read(std::optional<T>& value) {
    bool present = false;
    read(present);
    if (present) read(value.emplace());
  }
  void raw(void* data, std::size_t size) {
    if (size > left_) throw Error("the importer's answer is cut off");
    if (size > 0) std::memcpy(data, at_, size);
    at_ += size;
    left_ -= size;
  }

  const std::uint8_t* at_;
  std::size_t left_;
};

template <typename Archive, typename P>
void fields(Archive& ar, P& v) {
  using T = std::remove_const_t<P>;
  if constexpr (std::is_same_v<T, RawPrimitive>)
    ar(v.color, v.alpha, v.unlit, v.double_sided, v.positions, v.normals, v.colors, v.corners, v.faces, v.face_count,
       v.joints, v.weights, v.targets);
  else if constexpr (std::is_same_v<T, RawTarget>)
    ar(v.positions, v.normals);
  else if constexpr (std::is_same_v<T, RawSkin>)
    ar(v.joints, v.inverse);
  else if constexpr (std::is_same_v<T, RawMesh>)
    ar(v.name, v.primitives);
  else if constexpr (std::is_same_v<T, RawNode>)
    ar(v.name, v.parent, v.mesh, v.skin, v.weights, v.fixed, v.matrix, v.translation, v.rotation, v.scale);
  else if constexpr (std::is_same_v<T, RawTrack>)
    ar(v.node, v.path, v.interpolation, v.times, v.values, v.targets);
  else
    ar(v.meshes, v.skins, v.nodes, v.tracks, v.start_time, v.camera, v.lights, v.frames, v.contents, v.notes, v.files);
}

// Types of fixed size without pointers: their bytes are their value.
template <typename T>
constexpr bool kFlat = std::is_trivially_copyable_v<T>;

template <typename T>
void Writer::write(const T& value) {
  if constexpr (kFlat<T>)
    raw(&value, sizeof value);
  else
    fields(*this, value);
}

template <typename T>
void Writer::write(const std::vector<T>& values) {
  write(static_cast<std::uint64_t>(values.size()));
  if constexpr (kFlat<T>)
    raw(values.data(), values.size() * sizeof(T));
  else
    for (const T& v : values) write(v);
}

template <typename T>
void Reader::read(T& value) {
  if constexpr (kFlat<T>)
    raw(&value, sizeof value);
  else
    fields(*this, value);
}

template <typename T>
void Reader::read(std::vector<T>& values) {
  std::uint64_t size = 0;
  read(size);
  // An element takes at least a byte: a damaged size cannot make us allocate more than we were sent.
  if (size > left_) throw Error("the importer's answer is damaged");
  if constexpr (kFlat<T>) {
    if (size > left_ / sizeof(T)) throw Error("the importer's answer is damaged");
    values.resize(static_cast<std::size_t>(size));
    raw(values.data(), values.size() * sizeof(T));
  } else {
    for (std::uint64_t i = 0; i < size; ++i) read(values.emplace_back());
  }
}

}  // namespace

std::vector<std::uint8_t> packed(const RawScene& scene) {
  Writer w;
  w(scene);
  return std::move(w.bytes);
}

RawScene unpacked(const std::vector<std::uint8_t>& bytes) {
  Reader r(bytes);
  RawScene scene;
  r(scene);
  if (!r.at_end()) throw Error("the importer's answer is too long");
  return scene;
}

}  // namespace kage::scene
