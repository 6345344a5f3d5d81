// SPDX-License-Identifier: Apache-2.0
//
// STL, text and binary. docs/scenes.md, "STL", says what is read and what is not.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "file/read_file.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"
#include "scene/import.hpp"
#include "scene/notes.hpp"
#include "scene/plain/plain_mesh.hpp"
#include "scene/plain/text_lines.hpp"

namespace kage::scene {
namespace {

constexpr std::size_t kStlHeader = 80;  // bytes of a binary file before the number of its triangles
constexpr double kWhite = 1;            // the colour of what has none
constexpr std::size_t kStlFacet =
    50;  // bytes of a triangle: normal, three corners, two bytes that are the program's own

std::uint32_t little(const char* p) {
  std::uint32_t bits = 0;
  for (int i = 3; i >= 0; --i) bits = bits << 8 | static_cast<unsigned char>(p[i]);
  return bits;
}

std::string lower(std::string_view word) {
  std::string out(word);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// A header of binary files may begin with "solid" too. Then the size, or a byte that no text has, tells.
bool is_text(std::string_view bytes) {
  std::string_view begin = bytes.substr(0, 512);
  if (begin.starts_with("\xEF\xBB\xBF")) begin.remove_prefix(3);
  begin.remove_prefix(std::min(begin.find_first_not_of(" \t\r\n"), begin.size()));
  if (lower(begin.substr(0, 5)) != "solid") return false;
  if (bytes.size() >= kStlHeader + 4 &&
      bytes.size() == kStlHeader + 4 + kStlFacet * std::size_t{little(bytes.data() + kStlHeader)})
    return false;
  return std::none_of(begin.begin(), begin.end(), [](char c) {
    return static_cast<unsigned char>(c) < 32 && std::string_view("\t\r\n\v\f").find(c) == std::string_view::npos;
  });
}

/// Gives a mesh whose facets have normals all of them 0 none: then the file says none.
void drop_zero_normals(PlainMesh& mesh) {
  if (std::all_of(mesh.normals.begin(), mesh.normals.end(), [](float v) { return v == 0; })) mesh.normals.clear();
}

class StlTextReader {
 public:
  StlTextReader(std::string_view text, const std::string& name) : in_(text, name) {}

  RawScene run() {
    for (std::string word = next(); !word.empty(); word = next()) {
      if (word != "solid") unexpected("solid");
      read_solid();
    }
    note_faces(counts_, scene_.notes);
    return std::move(scene_);
  }

 private:
  /// The next word, wherever it stands, in lower case; empty at the end of the file.
  std::string next() {
    for (;;) {
      word_ = take_word(left_);
      if (!word_.empty()) return lower(word_);
      if (!in_.next()) return {};
      left_ = in_.line();
    }
  }

  [[noreturn]] void unexpected(const char* wanted) const {
    if (word_.empty()) in_.fail(fmt::format("the file ends, and {} is to come", wanted));
    in_.fail(fmt::format("'{}' stands where {} is to come", one_line(word_, 40), wanted));
  }

  void expect(const char* wanted) {
    if (next() != wanted) unexpected(wanted);
  }

  void read_solid() {
    PlainMesh mesh;
    mesh.name = one_line(left_, 80);
    mesh.color = kWhite;
    left_ = {};
    for (std::string word = next(); word != "endsolid"; word = next()) {
      if (word != "facet") unexpected("facet or endsolid");
      read_facet(mesh);
    }
    left_ = {};
    if (mesh.face_count() == 0) return;
    drop_zero_normals(mesh);
    append(mesh, scene_, counts_);
  }

  /// Three corners, as the format has it, or more, as some programs write them.
  void read_facet(PlainMesh& mesh) {
    expect("normal");
    std::array<float, 3> normal{};
    for (float& v : normal) v = (void(next()), in_.number(word_));
    expect("outer");
    expect("loop");
    for (std::string word = next(); word != "endloop"; word = next()) {
      if (word != "vertex") unexpected("vertex or endloop");
      mesh.corners.push_back(static_cast<std::uint32_t>(mesh.vertex_count()));
      for (int i = 0; i < 3; ++i) mesh.positions.push_back((void(next()), in_.finite(word_)));
      mesh.normals.insert(mesh.normals.end(), normal.begin(), normal.end());
    }
    expect("endfacet");
    mesh.ends.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  }

  TextLines in_;
  std::string_view left_;  // of the line
  std::string_view word_;
  RawScene scene_;
  FaceCounts counts_;
};

/// Two programs' ways of giving a facet a colour in its two own bytes, 5 bits a channel. VisCAM and SolidView: bit 15
/// is set where there is one, blue is lowest. Magics: the header has the whole body's colour, bit 15 is set where a
/// facet has that one, red is lowest.
class FacetColors {
 public:
  explicit FacetColors(std::string_view header) {
    const std::size_t at = header.find("COLOR=");
    if (at == std::string_view::npos || at + 10 > header.size()) return;
    body_.emplace();
    for (std::size_t i = 0; i < 4; ++i) (*body_)[i] = static_cast<unsigned char>(header[at + 6 + i]) / 255.0F;
  }

  /// The colour, or none.
  [[nodiscard]] std::optional<std::array<float, 3>> of(std::uint32_t bits) const {
    const bool high = (bits & 0x8000U) != 0;
    if (body_ && high) return std::array{(*body_)[0], (*body_)[1], (*body_)[2]};
    if (!body_ && !high) return std::nullopt;
    const auto channel = [&](unsigned shift) { return static_cast<float>(bits >> shift & 31U) / 31; };
    return body_ ? std::array{channel(0), channel(5), channel(10)} : std::array{channel(10), channel(5), channel(0)};
  }

  [[nodiscard]] bool is_translucent() const { return body_ && (*body_)[3] < 1; }

 private:
  std::optional<std::array<float, 4>> body_;
};

RawScene read_binary(std::string_view bytes, const std::string& stem, const std::string& name) {
  if (bytes.size() < kStlHeader + 4)
    throw Error(fmt::format("{}: begins without 'solid', and has {}, too few for a binary file", name,
                            counted(bytes.size(), "byte")));
  const std::size_t count = little(bytes.data() + kStlHeader);
  const std::string_view header = bytes.substr(0, kStlHeader);
  bytes.remove_prefix(kStlHeader + 4);
  if (count > bytes.size() / kStlFacet)
    throw Error(fmt::format("{}: says {} triangles, and has bytes for {}", name, count, bytes.size() / kStlFacet));
  PlainMesh mesh;
  mesh.name = stem;
  mesh.color = kWhite;
  const FacetColors colors(header);
  std::size_t colored = 0;
  std::size_t own = 0;  // facets whose own bytes say something else
  for (std::size_t i = 0; i < count; ++i, bytes.remove_prefix(kStlFacet)) {
    std::array<float, 12> v{};
    for (std::size_t k = 0; k < v.size(); ++k) v[k] = std::bit_cast<float>(little(bytes.data() + 4 * k));
    if (!std::all_of(v.begin() + 3, v.end(), [](float f) { return std::isfinite(f); }))
      throw Error(fmt::format("{}: triangle {}: a position is not finite", name, i));
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.corners.push_back(static_cast<std::uint32_t>(mesh.vertex_count()));
      mesh.positions.insert(mesh.positions.end(), v.begin() + 3 + static_cast<std::ptrdiff_t>(3 * k),
                            v.begin() + 6 + static_cast<std::ptrdiff_t>(3 * k));
      mesh.normals.insert(mesh.normals.end(), v.begin(), v.begin() + 3);
    }
    mesh.ends.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    const std::uint32_t bits = little(bytes.data() + 46) >> 16;
    const auto color = colors.of(bits);
    colored += color ? 1 : 0;
    own += !color && bits != 0 ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k) mesh.face_colors.push_back(color ? (*color)[k] : static_cast<float>(kWhite));
  }
  if (colored == 0) mesh.face_colors.clear();
  drop_zero_normals(mesh);
  RawScene scene;
  FaceCounts counts;  // none: all of them are triangles
  append(mesh, scene, counts);
  note_alpha(colors.is_translucent() ? 1 : 0, scene.notes);
  if (own > 0)
    scene.notes.push_back(counted(own, "triangle has", "triangles have") +
                          " bytes of a program's own that are no colour, and ignored");
  if (!bytes.empty()) scene.notes.push_back(counted(bytes.size(), "byte") + " behind the last triangle are ignored");
  return scene;
}

}  // namespace

RawScene import_stl(const std::filesystem::path& path, const std::string& name) {
  const std::string bytes = read_file(path, name);
  if (is_text(bytes)) return StlTextReader(bytes, name).run();
  return read_binary(bytes, path.stem().string(), name);
}

}  // namespace kage::scene
