// SPDX-License-Identifier: Apache-2.0
//
// OFF, by Geomview's description, as text. docs/scenes.md, "OFF", says what is read and what is not.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
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

class OffReader {
 public:
  OffReader(std::string_view text, const std::filesystem::path& path, const std::string& name) : in_(text, name) {
    mesh_.name = path.stem().string();
    mesh_.double_sided = true;  // the format leaves open from which side a face is meant to be seen
  }

  RawScene run() {
    read_kind();
    read_counts();
    for (std::uint32_t i = 0; i < vertices_; ++i) read_vertex(i);
    for (std::uint32_t i = 0; i < faces_; ++i) read_face(i);
    finish_colors();
    append(mesh_, scene_, counts_);
    write_notes();
    return std::move(scene_);
  }

 private:
  /// A colour as the file has it.
  struct Color {
    bool given = false;
    bool whole = true;  // its numbers have neither point nor exponent
    std::array<float, 4> rgba{0, 0, 0, 1};
  };

  bool next_line();
  void need_line(const char* what, std::uint32_t number, std::uint32_t count);
  void read_kind();
  void read_counts();
  void read_vertex(std::uint32_t number);
  void read_face(std::uint32_t number);
  Color read_color(float& largest_whole);
  void finish_colors();
  void write_notes();

  TextLines in_;
  std::string_view left_;  // of the line, without its comment
  bool has_normals_ = false;
  bool has_colors_ = false;
  bool has_places_ = false;  // of textures
  std::uint32_t vertices_ = 0;
  std::uint32_t faces_ = 0;
  PlainMesh mesh_;
  std::vector<Color> vertex_colors_;
  std::vector<Color> face_colors_;
  RawScene scene_;
  float vertex_whole_ = 0;  // the largest number of a colour of whole ones
  float face_whole_ = 0;
  std::size_t mapped_ = 0;  // colours that are a place in a list which the file does not have
  std::size_t alphas_ = 0;
  std::size_t bright_ = 0;
  std::size_t dark_ = 0;
  FaceCounts counts_;
};

/// The next line that has more than blanks and a comment. False at the end.
bool OffReader::next_line() {
  while (in_.next()) {
    left_ = trimmed(in_.line().substr(0, in_.line().find('#')));
    if (!left_.empty()) return true;
  }
  return false;
}

void OffReader::need_line(const char* what, std::uint32_t number, std::uint32_t count) {
  if (!next_line()) in_.fail(fmt::format("the file ends behind {} of {} {}", number, count, what));
}

/// The first word: [ST][C][N][4][n]OFF, which may be left out, and then is OFF.
void OffReader::read_kind() {
  if (!next_line()) in_.fail("there is nothing in it");
  std::string_view rest = left_;
  const std::string_view word = take_word(rest);
  if (!word.ends_with("OFF")) return;
  std::string_view kind = word.substr(0, word.size() - 3);
  const auto take = [&kind](std::string_view prefix) {
    const bool there = kind.starts_with(prefix);
    if (there) kind.remove_prefix(prefix.size());
    return there;
  };
  has_places_ = take("ST");
  has_colors_ = take("C");
  has_normals_ = take("N");
  if (take("4") || take("n")) in_.fail(one_line(word, 40) + ": vertices of other than three coordinates are not read");
  if (!kind.empty())
    in_.fail("'" + one_line(word, 40) + "' is none of OFF, COFF, NOFF, CNOFF and these with ST before");
  left_ = trimmed(rest);
  if (left_.starts_with("BINARY")) in_.fail("binary OFF is not read");
  if (left_.empty() && !next_line()) in_.fail("the file ends before the counts of vertices and faces");
}

void OffReader::read_counts() {
  vertices_ = in_.whole(take_word(left_), "count of vertices");
  faces_ = in_.whole(take_word(left_), "count of faces");
  // The number of edges may be missing, and means nothing.
  if (const std::string_view edges = take_word(left_); !edges.empty()) (void)in_.whole(edges, "count of edges");
  if (const std::string_view word = take_word(left_); !word.empty())
    in_.fail(fmt::format("'{}' stands behind the counts of vertices, faces and edges", one_line(word, 40)));
}

void OffReader::read_vertex(std::uint32_t number) {
  need_line("vertices", number, vertices_);
  for (int i = 0; i < 3; ++i) mesh_.positions.push_back(in_.finite(take_word(left_)));
  for (int i = 0; has_normals_ && i < 3; ++i) mesh_.normals.push_back(in_.number(take_word(left_)));
  std::string_view rest = left_;
  std::size_t words = 0;
  while (!take_word(rest).empty()) ++words;
  const std::size_t places = has_places_ ? 2 : 0;
  const bool fits = has_colors_ ? words == 3 + places || words == 4 + places : words == places;
  if (!fits)
    in_.fail(fmt::format("a vertex has {} more than its place{}, not {}", counted(words, "number"),
                         has_normals_ ? " and normal" : "",
                         has_colors_ ? (has_places_ ? "5 or 6" : "3 or 4") : (has_places_ ? "2" : "0")));
  if (!has_colors_) return;
  if (has_places_) left_ = trimmed(left_.substr(0, left_.find_last_of(" \t")));
  if (has_places_) left_ = trimmed(left_.substr(0, left_.find_last_of(" \t")));
  vertex_colors_.push_back(read_color(vertex_whole_));
}

/// The rest of the line: none, a place in a list of colours, or three or four numbers.
OffReader::Color OffReader::read_color(float& largest_whole) {
  Color color;
  std::size_t count = 0;
  for (std::string_view word = take_word(left_); !word.empty(); word = take_word(left_), ++count) {
    if (count == 4) in_.fail(fmt::format("'{}' is too much for a colour", one_line(word, 40)));
    color.rgba[count] = in_.finite(word);
    color.whole = color.whole && word.find_first_of(".eE") == std::string_view::npos;
  }
  if (count == 2) in_.fail("a colour has two numbers");
  mapped_ += count == 1 ? 1 : 0;
  color.given = count >= 3;
  for (std::size_t i = 0; color.given && color.whole && i < count; ++i)
    largest_whole = std::max(largest_whole, color.rgba[i]);
  if (count == 3) color.rgba[3] = std::numeric_limits<float>::infinity();  // opaque, whatever the others mean
  return color;
}

void OffReader::read_face(std::uint32_t number) {
  need_line("faces", number, faces_);
  const std::uint32_t corners = in_.whole(take_word(left_), "count of corners");
  for (std::uint32_t i = 0; i < corners; ++i) {
    const std::uint32_t vertex = in_.whole(take_word(left_), "vertex's number");
    if (vertex >= vertices_) in_.fail(fmt::format("vertex {} of {} is named (they count from 0)", vertex, vertices_));
    mesh_.corners.push_back(vertex);
  }
  mesh_.ends.push_back(static_cast<std::uint32_t>(mesh_.corners.size()));
  face_colors_.push_back(read_color(face_whole_));
}

/// Whole numbers count from 0 to 255, others from 0 to 1. Where the whole ones of vertices, or of faces, are all 0 or
/// 1, points were left out.
void OffReader::finish_colors() {
  const auto push = [this](const Color& color, float largest_whole, std::vector<float>& to) {
    const float full = color.whole && largest_whole > 1 ? 255.0F : 1.0F;
    float most = 0;
    float least = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      to.push_back(color.given ? color.rgba[i] / full : static_cast<float>(mesh_.color));
      most = std::max(most, to.back());
      least = std::min(least, to.back());
    }
    bright_ += most > 1 ? 1 : 0;
    dark_ += least < 0 ? 1 : 0;
    alphas_ += color.given && color.rgba[3] < full ? 1 : 0;
  };
  for (const Color& color : vertex_colors_) push(color, vertex_whole_, mesh_.colors);
  if (std::none_of(face_colors_.begin(), face_colors_.end(), [](const Color& c) { return c.given; })) return;
  if (!mesh_.colors.empty()) {
    scene_.notes.emplace_back("the faces' colours are ignored: the vertices' are drawn");
    return;
  }
  for (const Color& color : face_colors_) push(color, face_whole_, mesh_.face_colors);
}

void OffReader::write_notes() {
  std::vector<std::string>& notes = scene_.notes;
  if (mapped_ > 0)
    notes.push_back(counted(mapped_, "face has", "faces have") +
                    " the number of a colour in a list that is not in the file: drawn grey");
  note_range(bright_, dark_, notes);
  note_alpha(alphas_, notes);
  note_faces(counts_, notes);
  if (next_line())
    notes.push_back(fmt::format("what stands behind the last face, from line {} on, is ignored", in_.at()));
}

}  // namespace

RawScene import_off(const std::filesystem::path& path, const std::string& name) {
  const std::string text = read_file(path, name);
  return OffReader(text, path, name).run();
}

}  // namespace kage::scene
