// SPDX-License-Identifier: Apache-2.0
#include "gltf_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>

#include "file/base64.hpp"
#include "file/extension.hpp"
#include "json/foreign_json.hpp"
#include "kage/error.hpp"
#include "notes.hpp"
#include "number/counted.hpp"

namespace kage::scene {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

// Four times the corners that the largest scene has. No sum or product of sizes up to it overflows 64 bits.
constexpr std::uint64_t kMostElements = std::uint64_t{1} << 27;

std::uint32_t little(const std::uint8_t* p) {
  return p[0] | static_cast<std::uint32_t>(p[1]) << 8 | static_cast<std::uint32_t>(p[2]) << 16 |
         static_cast<std::uint32_t>(p[3]) << 24;
}

Bytes read_bytes(const std::filesystem::path& path, std::uint64_t most) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path.string() + ": cannot be read: " + std::strerror(errno));
  Bytes bytes;
  constexpr std::size_t kChunk = std::size_t{1} << 20;
  while (in && bytes.size() < most) {
    const std::size_t want = static_cast<std::size_t>(std::min<std::uint64_t>(kChunk, most - bytes.size()));
    const std::size_t old = bytes.size();
    bytes.resize(old + want);
    in.read(reinterpret_cast<char*>(bytes.data() + old), static_cast<std::streamsize>(want));
    bytes.resize(old + static_cast<std::size_t>(in.gcount()));
  }
  return bytes;
}

std::string percent_decoded(const std::string& uri) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
      out += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

std::size_t component_size(std::uint64_t type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

std::size_t component_count(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  if (type == "MAT4") return 16;
  return 0;
}

template <typename T, typename Source>
T converted(const std::uint8_t* p, bool normalized) {
  Source s;
  std::memcpy(&s, p, sizeof s);
  if constexpr (std::is_integral_v<Source> && std::is_floating_point_v<T>) {
    if (normalized) return std::max(static_cast<T>(s) / static_cast<T>(std::numeric_limits<Source>::max()), T{-1});
  }
  return static_cast<T>(s);
}

}  // namespace

struct GltfFile::View {
  const std::uint8_t* data = nullptr;  // null: zeros
  std::uint64_t length = 0;
  std::uint64_t stride = 0;  // 0: elements lie next to each other
  std::uint64_t number = 0;
};

struct GltfFile::Accessor {
  View view;
  std::uint64_t offset = 0;
  std::uint64_t count = 0;
  std::size_t components = 0;
  int type = 0;
  bool normalized = false;
  const Json* sparse = nullptr;
};

bool GltfFile::recognises(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".gltf" || extension == ".glb";
}

GltfFile::GltfFile(const std::filesystem::path& path, std::string name, bool allow_outside)
    : GltfJson(std::move(name)), side_files_(path, allow_outside) {
  Bytes text = read_bytes(path, std::numeric_limits<std::uint64_t>::max());
  if (text.size() >= 4 && std::memcmp(text.data(), "glTF", 4) == 0) {
    read_chunks(text);
    if (!version_2_) return;
  }
  // Buffers may be in the text, so its size is limited as that of any scene: by the reader's memory.
  set_root(parse_json<Json>({reinterpret_cast<const char*>(text.data()), text.size()}, this->name(),
                            std::numeric_limits<std::size_t>::max()));
  if (!root().is_object()) fail("JSON", "the outermost value is not an object");
  const Json& asset = object(root(), "asset", "JSON");
  const std::string version = this->text(asset, "version", "asset");
  version_2_ = version.substr(0, 2) != "1.";
  if (!version_2_) return;
  if (version.substr(0, 2) != "2.")
    fail("asset", version.empty() ? "no version: not glTF" : "version " + one_line(version, 20) + " is not 2.x");
  const std::string least = this->text(asset, "minVersion", "asset");
  if (!least.empty() && least != "2.0") fail("asset", "minVersion " + one_line(least, 20) + " is above 2.0");
  buffers_.resize(count("buffers"));
}

/// For a binary file: takes its buffer out of `text`, and leaves the JSON there.
void GltfFile::read_chunks(Bytes& text) {
  is_binary_ = true;
  if (text.size() < 20) fail("header", "the file ends within it");
  version_2_ = little(text.data() + 4) != 1;
  if (!version_2_) return;
  if (little(text.data() + 4) != 2) fail("header", "version " + std::to_string(little(text.data() + 4)) + " is not 2");
  const std::uint64_t whole = little(text.data() + 8);
  if (whole > text.size())
    fail("header", "says " + std::to_string(whole) + " bytes, the file has " + std::to_string(text.size()));
  const std::uint64_t json_bytes = little(text.data() + 12);
  if (little(text.data() + 16) != 0x4e4f534a || 20 + json_bytes > text.size()) fail("JSON chunk", "missing or cut off");
  const std::uint64_t next = 20 + json_bytes;
  std::uint64_t end = next;
  if (next + 8 <= text.size() && little(text.data() + next + 4) == 0x004e4942) {
    const std::uint64_t bytes = little(text.data() + next);
    if (next + 8 + bytes > text.size()) fail("BIN chunk", "cut off");
    end = next + 8 + bytes;
    const auto begin = text.begin() + static_cast<std::ptrdiff_t>(next + 8);
    binary_.assign(begin, begin + static_cast<std::ptrdiff_t>(bytes));
  }
  if (whole < end) fail("header", "says " + std::to_string(whole) + " bytes, its chunks end at " + std::to_string(end));
  if (whole < text.size())
    remarks_.add(counted(text.size() - whole, "byte") + " behind the length that the header says " +
                 (text.size() - whole == 1 ? "is" : "are") + " ignored");
  text = Bytes(text.begin() + 20, text.begin() + static_cast<std::ptrdiff_t>(next));
}

std::vector<std::string> GltfFile::files() const {
  const auto images = root().find("images");
  if (images != root().end() && images->is_array())
    for (const Json& image : *images)
      if (const auto uri = image.is_object() ? image.find("uri") : image.end(); uri != image.end() && uri->is_string())
        (void)side_files_.find_named(percent_decoded(uri->get<std::string>()));
  return side_files_.files();
}

const Bytes& GltfFile::buffer(std::uint64_t index, const std::string& place) {
  const Json& json = item("buffers", index, place);
  std::optional<Bytes>& slot = buffers_[static_cast<std::size_t>(index)];
  if (slot) return *slot;
  const std::string here = "buffer " + std::to_string(index);
  const std::uint64_t bytes = integer(json, "byteLength", here).value_or(0);
  const std::string uri = text(json, "uri", here);
  if (uri.empty()) {
    if (index != 0 || binary_.empty()) fail(here, "no data");
    slot = std::move(binary_);
  } else if (uri.rfind("data:", 0) == 0) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || uri.substr(0, comma).find(";base64") == std::string::npos)
      fail(here, "its data URI is not base64");
    slot = base64_decode(std::string_view(uri).substr(comma + 1));
    if (!slot) fail(here, "its base64 is damaged");
  } else {
    if (uri.find("://") != std::string::npos) fail(here, "lies at another place: " + one_line(uri, 80));
    const SideFiles::Found file = side_files_.find_named(percent_decoded(uri));
    if (file.refused) fail(here, SideFiles::refusal(uri));
    if (!file.exists) fail(here, "no file " + one_line(uri, 80));
    slot = read_bytes(file.path, bytes);
  }
  if (slot->size() < bytes) fail(here, "says " + std::to_string(bytes) + " bytes, has " + std::to_string(slot->size()));
  slot->resize(static_cast<std::size_t>(bytes));
  return *slot;
}

GltfFile::View GltfFile::view(std::uint64_t index, const std::string& place) {
  const Json& json = item("bufferViews", index, place);
  const std::string here = "bufferView " + std::to_string(index);
  for (const char* packing : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    if (has_extension(json, packing, here)) fail(here, std::string("is compressed (") + packing + ")");
  const std::optional<std::uint64_t> source = integer(json, "buffer", here);
  if (!source) fail(here, "names no buffer");
  const Bytes& bytes = buffer(*source, here);
  const std::uint64_t offset = integer(json, "byteOffset", here).value_or(0);
  View v;
  v.number = index;
  v.length = integer(json, "byteLength", here).value_or(0);
  const std::optional<std::uint64_t> stride = integer(json, "byteStride", here);
  v.stride = stride.value_or(0);
  if (v.stride != 0 && (v.stride % 4 != 0 || v.stride > 252))
    fail(here, "byteStride " + std::to_string(v.stride) + " is not a multiple of 4 from 4 to 252");
  // Files of glTF 1 said so where elements lie next to each other.
  if (stride == 0) remarks_.add("bufferView", index, "", "byteStride 0, which is taken as none");
  if (offset > bytes.size() || v.length > bytes.size() - offset) fail(here, "goes past the end of its buffer");
  v.data = bytes.data() + offset;
  return v;
}

/// Elements may not overlap, and only vertices may have gaps between them.
void GltfFile::check_stride(const View& view, std::uint64_t element, bool of_vertices, const std::string& place) const {
  if (view.stride == 0 || view.stride == element) return;
  const std::string says = "byteStride " + std::to_string(view.stride);
  const std::string here = "bufferView " + std::to_string(view.number);
  if (view.stride < element)
    fail(here, says + " is less than the " + std::to_string(element) + " bytes of an element of " + place);
  if (!of_vertices) fail(here, says + ": the elements of " + place + " are no vertices, and have no gaps");
}

GltfFile::Accessor GltfFile::accessor(std::uint64_t index, GltfUse use, const std::string& place) {
  const Json& json = item("accessors", index, place);
  const std::string here = "accessor " + std::to_string(index);
  Accessor a;
  if (const auto v = integer(json, "bufferView", here)) a.view = view(*v, here);
  a.offset = integer(json, "byteOffset", here).value_or(0);
  a.count = integer(json, "count", here).value_or(0);
  if (a.count > kMostElements) fail(here, std::to_string(a.count) + " elements are too many");
  a.components = component_count(text(json, "type", here));
  if (a.components == 0) fail(here, "its type is not SCALAR, VEC2, VEC3, VEC4 or MAT4");
  const std::uint64_t type = integer(json, "componentType", here).value_or(0);
  if (component_size(type) == 0) fail(here, "component type " + std::to_string(type) + " is unknown");
  a.type = static_cast<int>(type);
  const GltfUseFacts& facts = facts_of(use);
  if (a.components < facts.least || a.components > facts.most)
    fail(place, here + " has " + std::to_string(a.components) + " components, not " + std::to_string(facts.least));
  const GltfReading reading =
      remarks_.reading(index, use, a.type, boolean(json, "normalized", false, here), uses("KHR_mesh_quantization"));
  if (!reading.allowed)
    fail(place, here + " has component type " + type_name(a.type) + ", which " + facts.name + " cannot have");
  a.normalized = reading.normalized;
  check_stride(a.view, component_size(type) * a.components, facts.of_vertices, here);
  if (has(json, "sparse")) a.sparse = &object(json, "sparse", here);
  return a;
}

template <typename T>
void GltfFile::copy(const View& view, std::uint64_t offset, std::uint64_t count, std::uint64_t stride, int type,
                    std::size_t components, bool normalized, T* out, const std::string& place) const {
  if (count == 0) return;
  const std::size_t size = component_size(static_cast<std::uint64_t>(type));
  const std::uint64_t element = size * components;
  if (stride == 0) stride = element;
  if (offset > view.length || (count - 1) * stride + element > view.length - offset)
    fail(place, "goes past the end of its bufferView");
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint8_t* p = view.data + offset + i * stride;
    for (std::size_t k = 0; k < components; ++k, p += size, ++out) {
      switch (type) {
        case 5120:
          *out = converted<T, std::int8_t>(p, normalized);
          break;
        case 5121:
          *out = converted<T, std::uint8_t>(p, normalized);
          break;
        case 5122:
          *out = converted<T, std::int16_t>(p, normalized);
          break;
        case 5123:
          *out = converted<T, std::uint16_t>(p, normalized);
          break;
        case 5125:
          *out = converted<T, std::uint32_t>(p, normalized);
          break;
        default:
          *out = converted<T, float>(p, normalized);
          break;
      }
    }
  }
}

template <typename T>
void GltfFile::elements(const Accessor& a, std::vector<T>& out, const std::string& place) {
  out.assign(static_cast<std::size_t>(a.count) * a.components, T{});
  if (a.view.data != nullptr)
    copy(a.view, a.offset, a.count, a.view.stride, a.type, a.components, a.normalized, out.data(), place);
  if (a.sparse == nullptr) return;
  const std::uint64_t n = integer(*a.sparse, "count", place).value_or(0);
  if (n > a.count) fail(place, "its sparse part is larger than the whole");
  const Json& where = object(*a.sparse, "indices", place);
  const Json& what = object(*a.sparse, "values", place);
  const std::uint64_t type = integer(where, "componentType", place).value_or(0);
  if (type != 5121 && type != 5123 && type != 5125) fail(place, "its sparse indices are not unsigned integers");
  const auto where_view = integer(where, "bufferView", place);
  const auto what_view = integer(what, "bufferView", place);
  if (!where_view || !what_view) fail(place, "its sparse part names no bufferView");
  std::vector<std::uint32_t> at(static_cast<std::size_t>(n));
  std::vector<T> values(static_cast<std::size_t>(n) * a.components);
  const View indices = view(*where_view, place);
  const View replaced = view(*what_view, place);
  check_stride(indices, component_size(type), false, place);
  check_stride(replaced, component_size(static_cast<std::uint64_t>(a.type)) * a.components, false, place);
  copy(indices, integer(where, "byteOffset", place).value_or(0), n, 0, static_cast<int>(type), 1, false, at.data(),
       place);
  copy(replaced, integer(what, "byteOffset", place).value_or(0), n, 0, a.type, a.components, a.normalized,
       values.data(), place);
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (at[i] >= a.count) fail(place, "sparse index " + std::to_string(at[i]) + " of " + std::to_string(a.count));
    for (std::size_t k = 0; k < a.components; ++k) out[at[i] * a.components + k] = values[i * a.components + k];
  }
}

GltfFile::Floats GltfFile::floats(std::uint64_t index, GltfUse use, const std::string& place) {
  const Accessor a = accessor(index, use, place);
  Floats f;
  f.components = a.components;
  elements(a, f.values, "accessor " + std::to_string(index));
  return f;
}

bool GltfFile::has_data(std::uint64_t index, const std::string& place) const {
  const Json& json = item("accessors", index, place);
  return has(json, "bufferView") || has(json, "sparse");
}

// Single precision may leave of the last row, which is 0, 0, 0, 1, something near it.
Affine GltfFile::affine_map(const double* by_columns, const char* what, const std::string& place) const {
  constexpr double kTolerance = 1e-3;
  const double* const m = by_columns;
  const double off = std::max({std::abs(m[3]), std::abs(m[7]), std::abs(m[11]), std::abs(m[15] - 1)});
  if (!(off <= kTolerance)) fail(place, std::string(what) + " is projective: its last row is not 0, 0, 0, 1");
  return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

std::vector<Affine> GltfFile::affine_maps(std::uint64_t index, const std::string& place) {
  const std::vector<float> values = floats(index, GltfUse::matrices, place).values;
  std::vector<Affine> maps;
  for (std::size_t i = 0; i < values.size(); i += 16) {
    const std::vector<double> m(values.begin() + static_cast<std::ptrdiff_t>(i),
                                values.begin() + static_cast<std::ptrdiff_t>(i + 16));
    maps.push_back(affine_map(m.data(), "a matrix", place));
    for (const glm::dvec3& v : {maps.back().x, maps.back().y, maps.back().z, maps.back().origin})
      if (!is_finite(v)) fail(place, "a matrix is not finite");
  }
  return maps;
}

std::vector<std::uint32_t> GltfFile::indices(std::uint64_t index, GltfUse use, const std::string& place) {
  const Accessor a = accessor(index, use, place);
  std::vector<std::uint32_t> out;
  elements(a, out, "accessor " + std::to_string(index));
  return out;
}

}  // namespace kage::scene
