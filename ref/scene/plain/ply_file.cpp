// SPDX-License-Identifier: Apache-2.0
//
// PLY, by Greg Turk's description. It reads the elements and properties that programs have agreed on: vertices with
// normals and colours, faces with colours, strips of triangles. docs/scenes.md, "PLY", has the whole list.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "file/read_file.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"
#include "scene/import.hpp"
#include "scene/notes.hpp"
#include "scene/plain/plain_mesh.hpp"
#include "scene/plain/ply_values.hpp"
#include "scene/side_files.hpp"

namespace kage::scene {
namespace {

/// The use of a property.
enum class Role : std::uint8_t { kX, kY, kZ, kNormalX, kNormalY, kNormalZ, kRed, kGreen, kBlue, kAlpha, kNone };

Role role_of(const std::string& name) {
  static const std::map<std::string, Role, std::less<>> kRoles{{"x", Role::kX},
                                                               {"y", Role::kY},
                                                               {"z", Role::kZ},
                                                               {"nx", Role::kNormalX},
                                                               {"ny", Role::kNormalY},
                                                               {"nz", Role::kNormalZ},
                                                               {"red", Role::kRed},
                                                               {"green", Role::kGreen},
                                                               {"blue", Role::kBlue},
                                                               {"alpha", Role::kAlpha},
                                                               {"diffuse_red", Role::kRed},
                                                               {"diffuse_green", Role::kGreen},
                                                               {"diffuse_blue", Role::kBlue},
                                                               {"diffuse_alpha", Role::kAlpha},
                                                               {"r", Role::kRed},
                                                               {"g", Role::kGreen},
                                                               {"b", Role::kBlue}};
  const auto at = kRoles.find(name);
  return at == kRoles.end() ? Role::kNone : at->second;
}

/// Coordinates of textures, which have a note of their own where there are textures.
bool is_of_textures(const std::string& name) {
  return name == "s" || name == "t" || name == "u" || name == "v" || name.starts_with("texture_") ||
         name == "texcoord" || name == "texnumber";
}

/// The value that stands for a full colour: whole numbers count to 255, those of 16 bits to 65535.
double full_of(PlyType type) { return !is_integer(type) ? 1 : type == PlyType::kUint16 ? 65535 : 255; }

/// A normal counts with all of its coordinates, alpha with a colour.
bool lacks_others(const PlyElement& element, Role role) {
  const auto has = [&](Role wanted) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [&](const PlyProperty& p) { return p.count == PlyType::kNone && role_of(p.name) == wanted; });
  };
  if (role >= Role::kNormalX && role <= Role::kNormalZ)
    return !has(Role::kNormalX) || !has(Role::kNormalY) || !has(Role::kNormalZ);
  return role == Role::kAlpha && !has(Role::kRed) && !has(Role::kGreen) && !has(Role::kBlue);
}

class PlyReader {
 public:
  PlyReader(std::string_view text, const std::filesystem::path& path, const std::string& name)
      : lines_(text, name), header_(read_ply_header(lines_)), values_(lines_, header_.form), side_files_(path, false) {
    mesh_.name = path.stem().string();
    mesh_.color = 1;
    mesh_.double_sided = true;  // the format leaves open from which side a face is meant to be seen
  }

  RawScene run();

 private:
  /// How an element's properties are read.
  struct Reading {
    std::vector<Role> roles;
    std::size_t indices = 0;  // the property with a face's vertices, behind the last where there is none
    [[nodiscard]] bool has(Role role) const { return std::count(roles.begin(), roles.end(), role) > 0; }
    [[nodiscard]] bool has_color() const { return has(Role::kRed) || has(Role::kGreen) || has(Role::kBlue); }
  };
  Reading reading_of(const PlyElement& element, bool of_faces);
  /// One element: of the roles, `row` gets the values, colours from 0 to 1; a face's vertices go to `list_`.
  void read_row(const PlyElement& element, const Reading& reading, std::array<double, 11>& row);
  void read_list(const PlyProperty& property, bool wanted);
  std::uint32_t vertex(std::int64_t number) const;
  void read_vertices(const PlyElement& element);
  void read_faces(const PlyElement& element);
  void read_strips(const PlyElement& element);
  void add_strip();
  void color_faces(const Reading& reading, const std::array<double, 11>& row, std::size_t first);
  void read_color(const Reading& reading, const std::array<double, 11>& row, std::vector<float>& to);
  void skip(const PlyElement& element);
  void write_notes();

  TextLines lines_;
  PlyHeader header_;
  PlyValues values_;
  SideFiles side_files_;
  PlainMesh mesh_;
  RawScene scene_;
  std::uint64_t vertices_ = 0;
  std::vector<std::int64_t> list_;
  std::vector<std::string> ignored_;  // "element camera", "property quality of element vertex"
  FaceCounts counts_;
  std::size_t alphas_ = 0;
  std::size_t bright_ = 0;
  std::size_t dark_ = 0;
  bool both_colored_ = false;
};

RawScene PlyReader::run() {
  for (const PlyElement& e : header_.elements)
    if (e.name == "vertex") vertices_ = e.count;
  for (const PlyElement& e : header_.elements) {
    values_.check_room(e);
    if (e.properties.empty()) continue;
    if (e.name == "vertex")
      read_vertices(e);
    else if (e.name == "face")
      read_faces(e);
    else if (e.name == "tristrips" || e.name == "tristrip")
      read_strips(e);
    else
      skip(e);
  }
  if (mesh_.vertex_count() == 0) throw Error(lines_.file() + ": no vertices");
  both_colored_ = !mesh_.colors.empty() && !mesh_.face_colors.empty();
  if (both_colored_) mesh_.face_colors.clear();
  if (!mesh_.face_colors.empty()) mesh_.face_colors.resize(3 * mesh_.face_count(), 1);  // of elements without colours
  append(mesh_, scene_, counts_);
  write_notes();
  for (const std::string& texture : header_.textures) side_files_.note_texture(texture);
  scene_.files = side_files_.files();
  return std::move(scene_);
}

PlyReader::Reading PlyReader::reading_of(const PlyElement& element, bool of_faces) {
  Reading reading;
  reading.indices = element.properties.size();
  std::vector<std::string> ignored;
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& p = element.properties[i];
    const bool is_list = p.count != PlyType::kNone;
    Role role = is_list ? Role::kNone : role_of(p.name);
    if (of_faces && role < Role::kRed) role = Role::kNone;
    if (role != Role::kNone && (reading.has(role) || lacks_others(element, role))) role = Role::kNone;
    reading.roles.push_back(role);
    if (of_faces && is_list && (p.name == "vertex_indices" || p.name == "vertex_index")) {
      if (reading.indices != element.properties.size())
        throw Error(lines_.file() + ": element " + element.name + " has both vertex_indices and vertex_index");
      reading.indices = i;
    } else if (role == Role::kNone && !is_of_textures(p.name)) {
      ignored.push_back("property " + one_line(p.name, 40) + " of element " + element.name);
    }
  }
  ignored_.insert(ignored_.end(), ignored.begin(), ignored.end());
  if (!of_faces) return reading;
  if (reading.indices == element.properties.size())
    throw Error(lines_.file() + ": element " + element.name + " has no list vertex_indices");
  if (!is_integer(element.properties[reading.indices].type))
    throw Error(lines_.file() + ": the numbers in vertex_indices of element " + element.name + " are not whole");
  return reading;
}

void PlyReader::read_row(const PlyElement& element, const Reading& reading, std::array<double, 11>& row) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& p = element.properties[i];
    if (p.count != PlyType::kNone) {
      read_list(p, i == reading.indices);
      continue;
    }
    const Role role = reading.roles[i];
    // Normals that are not finite are replaced by those of faces, and what is ignored may be anything.
    const bool counts = role != Role::kNone && (role < Role::kNormalX || role > Role::kNormalZ);
    double v = counts ? values_.finite(p.type) : values_.value(p.type);
    if (role >= Role::kRed) v /= full_of(p.type);
    row[static_cast<std::size_t>(role)] = v;
  }
  values_.end();
}

void PlyReader::read_list(const PlyProperty& property, bool wanted) {
  const std::uint64_t length = values_.length(property.count, property.type);
  if (wanted) list_.clear();
  for (std::uint64_t i = 0; i < length; ++i) {
    const double v = values_.value(property.type);
    if (wanted) list_.push_back(static_cast<std::int64_t>(v));
  }
}

std::uint32_t PlyReader::vertex(std::int64_t number) const {
  if (number < 0 || static_cast<std::uint64_t>(number) >= vertices_)
    values_.fail(fmt::format("vertex {} of {} is named (they count from 0)", number, vertices_));
  return static_cast<std::uint32_t>(number);
}

void PlyReader::read_vertices(const PlyElement& element) {
  const Reading reading = reading_of(element, false);
  for (const auto& [role, name] : {std::pair{Role::kX, "x"}, {Role::kY, "y"}, {Role::kZ, "z"}})
    if (!reading.has(role)) throw Error(fmt::format("{}: element vertex has no property {}", lines_.file(), name));
  const bool has_normals = reading.has(Role::kNormalX) && reading.has(Role::kNormalY) && reading.has(Role::kNormalZ);
  std::array<double, 11> row{};
  for (std::uint64_t i = 0; i < element.count; ++i) {
    values_.begin(element, i);
    read_row(element, reading, row);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto position = static_cast<float>(row[k]);
      if (!std::isfinite(position)) values_.fail("a position is too large");
      mesh_.positions.push_back(position);
    }
    if (has_normals)
      for (std::size_t k = 3; k < 6; ++k) mesh_.normals.push_back(static_cast<float>(row[k]));
    read_color(reading, row, mesh_.colors);
  }
}

/// Reads red, green and blue; those that the file lacks are 0.
void PlyReader::read_color(const Reading& reading, const std::array<double, 11>& row, std::vector<float>& to) {
  if (!reading.has_color()) return;
  bool bright = false;
  bool dark = false;
  for (const Role role : {Role::kRed, Role::kGreen, Role::kBlue}) {
    const double v = row[static_cast<std::size_t>(role)];
    bright = bright || v > 1;
    dark = dark || v < 0;
    to.push_back(static_cast<float>(std::clamp(v, 0.0, 1.0)));
  }
  bright_ += bright ? 1 : 0;
  dark_ += dark ? 1 : 0;
  alphas_ += reading.has(Role::kAlpha) && row[static_cast<std::size_t>(Role::kAlpha)] < 1 ? 1 : 0;
}

void PlyReader::read_faces(const PlyElement& element) {
  const Reading reading = reading_of(element, true);
  std::array<double, 11> row{};
  for (std::uint64_t i = 0; i < element.count; ++i) {
    values_.begin(element, i);
    read_row(element, reading, row);
    for (const std::int64_t number : list_) mesh_.corners.push_back(vertex(number));
    mesh_.ends.push_back(static_cast<std::uint32_t>(mesh_.corners.size()));
    color_faces(reading, row, mesh_.face_count() - 1);
  }
}

/// The faces from the first on get the row's colour, and those before them that have none white.
void PlyReader::color_faces(const Reading& reading, const std::array<double, 11>& row, std::size_t first) {
  std::vector<float>& colors = mesh_.face_colors;
  if (first == mesh_.face_count() || !reading.has_color()) return;
  colors.resize(3 * first, 1);
  read_color(reading, row, colors);
  while (colors.size() < 3 * mesh_.face_count()) colors.push_back(colors[colors.size() - 3]);
}

void PlyReader::read_strips(const PlyElement& element) {
  const Reading reading = reading_of(element, true);
  std::array<double, 11> row{};
  for (std::uint64_t i = 0; i < element.count; ++i) {
    values_.begin(element, i);
    read_row(element, reading, row);
    const std::size_t first = mesh_.face_count();
    add_strip();
    color_faces(reading, row, first);
  }
}

/// Each vertex from the third on makes a triangle with the two before it, every other one the other way round; -1, or
/// what it is without a sign, begins a new strip. A triangle that repeats a vertex is how strips are joined.
void PlyReader::add_strip() {
  std::size_t first = 0;
  for (std::size_t i = 0; i < list_.size(); ++i) {
    if (list_[i] == -1 || list_[i] == 0xffffffff) {
      first = i + 1;
      continue;
    }
    (void)vertex(list_[i]);
    if (i < first + 2) continue;
    std::array<std::int64_t, 3> t{list_[i - 2], list_[i - 1], list_[i]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    if ((i - first) % 2 == 1) std::swap(t[0], t[1]);
    for (const std::int64_t v : t) mesh_.corners.push_back(static_cast<std::uint32_t>(v));
    mesh_.ends.push_back(static_cast<std::uint32_t>(mesh_.corners.size()));
  }
}

void PlyReader::skip(const PlyElement& element) {
  if (element.count == 0) return;
  if (element.name == "edge")
    counts_.thin += element.count;
  else
    ignored_.push_back("element " + one_line(element.name, 40));
  for (std::uint64_t i = 0; i < element.count; ++i) {
    values_.begin(element, i);
    for (const PlyProperty& p : element.properties)
      if (p.count == PlyType::kNone)
        (void)values_.value(p.type);
      else
        read_list(p, false);
    values_.end();
  }
}

void PlyReader::write_notes() {
  std::vector<std::string>& notes = scene_.notes;
  const auto add = [&notes](std::size_t count, const char* one, const char* many, const char* rest) {
    if (count > 0) notes.push_back(counted(count, one, many) + rest);
  };
  notes.insert(notes.end(), header_.ignored.begin(), header_.ignored.end());
  add(header_.textures.size(), "texture is", "textures are", " ignored");
  for (const std::string& what : ignored_) notes.push_back(what + " is ignored");
  if (both_colored_) notes.emplace_back("the faces' colours are ignored: the vertices' are drawn");
  note_range(bright_, dark_, notes);
  note_alpha(alphas_, notes);
  note_faces(counts_, notes);
  if (values_.has_more()) notes.emplace_back("what stands behind the last element is ignored");
}

}  // namespace

RawScene import_ply(const std::filesystem::path& path, const std::string& name) {
  const std::string text = read_file(path, name);
  return PlyReader(text, path, name).run();
}

}  // namespace kage::scene
