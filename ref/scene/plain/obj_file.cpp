// SPDX-License-Identifier: Apache-2.0
//
// OBJ, by the specification of Wavefront's Advanced Visualizer 4.0, with colours of vertices behind their places, as
// many programs write them. docs/scenes.md, "OBJ", says what is read and what is not.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "file/read_file.hpp"
#include "number/counted.hpp"
#include "scene/import.hpp"
#include "scene/notes.hpp"
#include "scene/plain/obj_data.hpp"
#include "scene/plain/statements.hpp"

namespace kage::scene {
namespace {

bool is_free_form(std::string_view keyword) {
  constexpr std::array<std::string_view, 24> kFreeForm{
      "vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim",  "hole",  "scrv",
      "sp", "end",    "con", "mg",   "bsp",  "bzp",  "cdc",   "cdp",  "res",  "ctech", "stech", "c_interp"};
  return std::find(kFreeForm.begin(), kFreeForm.end(), keyword) != kFreeForm.end();
}

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::filesystem::path& path, const std::string& name, bool allow_outside)
      : in_(text, name), own_name_(path.filename().string()), libraries_(path, name, allow_outside) {}

  RawScene run();

 private:
  void read_statement();
  void read_vertex();
  void read_normal();
  void read_thin();
  void read_face();
  std::uint32_t read_vertex_number(std::string_view part, std::string_view word);
  std::uint32_t read_normal_number(std::string_view part, std::string_view word);
  std::int64_t read_number(std::string_view part, std::string_view word) const;
  ObjCorner read_corner(std::string_view word, std::size_t parts);
  void check_numbers();

  void write_notes();

  Statements in_;
  std::string own_name_;
  ObjLibraries libraries_;
  RawScene scene_;
  IgnoredWords words_;

  ObjData data_;
  std::string object_name_;
  std::string group_name_;           // since the last o
  std::uint32_t object_ = kObjNone;  // of these names, once there is a face
  std::uint32_t material_ = kObjNone;
  bool smooth_ = false;  // a smoothing group is on

  struct Ahead {
    std::size_t line;
    std::uint32_t number;
  };
  std::vector<Ahead> ahead_;  // vertices that were named before they came: those that are above all before them
  std::size_t weights_ = 0;   // vertices with a weight that is not 1
  std::size_t alphas_ = 0;
  std::size_t bright_ = 0;  // vertices whose colour is above 1
  std::size_t dark_ = 0;    // below 0
  FaceCounts counts_;
  std::size_t flat_faces_ = 0;  // without normals, in a smoothing group
  std::size_t free_form_ = 0;   // statements
  std::size_t free_form_line_ = 0;
  std::size_t missing_normals_ = 0;  // of corners
};

RawScene ObjReader::run() {
  while (in_.next_statement()) read_statement();
  check_numbers();
  libraries_.fall_back(scene_.notes);
  missing_normals_ = build_obj(std::move(data_), libraries_, scene_, counts_);
  write_notes();
  scene_.files = libraries_.files();
  return std::move(scene_);
}

void ObjReader::read_statement() {
  const std::string_view key = in_.keyword();
  if (key == "v") {
    read_vertex();
  } else if (key == "vn") {
    read_normal();
  } else if (key == "f" || key == "fo") {
    read_face();
  } else if (key == "l" || key == "p") {
    read_thin();
  } else if (key == "o" || key == "g") {
    if (key == "o") object_name_ = in_.name();
    group_name_ = key == "g" ? in_.name() : "";
    object_ = kObjNone;
  } else if (key == "usemtl") {
    material_ = data_.materials.number(std::string(in_.name()));
  } else if (key == "mtllib") {
    libraries_.add(in_.name(), scene_.notes);
  } else if (key == "s") {
    const std::string_view group = in_.word();
    smooth_ = group != "off" && group != "0";
  } else if (is_free_form(key)) {
    if (free_form_++ == 0) free_form_line_ = in_.at();
  } else if (key != "vt") {
    words_.add(std::string(key), in_.at());
  }
}

void ObjReader::read_vertex() {
  std::array<float, 7> v{};
  std::size_t count = 0;
  for (std::string_view word = in_.word(); !word.empty(); word = in_.word(), ++count) {
    const float value = in_.finite(word);
    if (count < v.size()) v[count] = value;
  }
  if (count != 3 && count != 4 && count != 6 && count != 7)
    in_.fail(fmt::format("a vertex has 3 numbers, 4 with w, 6 or 7 with a colour, not {}", count));
  data_.positions.insert(data_.positions.end(), v.begin(), v.begin() + 3);
  if (data_.positions.size() / 3 >= kObjNone) in_.fail("there are too many vertices");
  weights_ += count == 4 && v[3] != 1 ? 1 : 0;
  if (count < 6) return;
  alphas_ += count == 7 && v[6] < 1 ? 1 : 0;
  bright_ += std::max({v[3], v[4], v[5]}) > 1 ? 1 : 0;
  dark_ += std::min({v[3], v[4], v[5]}) < 0 ? 1 : 0;
  data_.colors.resize(data_.positions.size() - 3, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 3; i < 6; ++i) data_.colors.push_back(std::clamp(v[i], 0.0F, 1.0F));
}

void ObjReader::read_normal() {
  std::size_t count = 0;
  for (std::string_view word = in_.word(); !word.empty(); word = in_.word(), ++count) {
    const float value = in_.number(word);
    if (count < 3) data_.normals.push_back(value);
  }
  if (count != 3) in_.fail(fmt::format("a normal has 3 numbers, not {}", count));
}

void ObjReader::read_thin() {
  const bool points = in_.keyword() == "p";
  for (std::string_view word = in_.word(); !word.empty(); word = in_.word()) {
    (void)read_corner(word, points ? 1 : 2);
    counts_.thin += points ? 1 : 0;
  }
  counts_.thin += points ? 0 : 1;
}

void ObjReader::read_face() {
  const std::size_t first = data_.corners.size();
  bool has_normals = false;
  for (std::string_view word = in_.word(); !word.empty(); word = in_.word()) {
    data_.corners.push_back(read_corner(word, 3));
    has_normals = has_normals || data_.corners.back().normal != kObjNone;
  }
  if (data_.corners.size() < first + 3) {
    data_.corners.resize(first);
    ++counts_.thin;
    return;
  }
  if (data_.corners.size() >= kObjNone) in_.fail("there are too many faces");
  if (object_ == kObjNone) object_ = data_.objects.number(object_name_ + '\n' + group_name_);
  flat_faces_ += smooth_ && !has_normals ? 1 : 0;
  data_.faces.push_back({static_cast<std::uint32_t>(data_.corners.size()), object_, material_, has_normals});
}

std::int64_t ObjReader::read_number(std::string_view part, std::string_view word) const {
  const auto value = integer_of(part);
  if (!value || *value == 0 || *value > kObjNone - 1 || *value < -static_cast<std::int64_t>(kObjNone))
    in_.fail(one_line(word, 40) + " is no vertex's number");
  return *value;
}

/// A vertex may come after the face that names it, so one that is not there yet is looked for at the end.
std::uint32_t ObjReader::read_vertex_number(std::string_view part, std::string_view word) {
  const std::int64_t value = read_number(part, word);
  const auto vertices = static_cast<std::int64_t>(data_.positions.size() / 3);
  if (value < -vertices) in_.fail(fmt::format("vertex {} of {} is named", value, vertices));
  if (value < 0) return static_cast<std::uint32_t>(vertices + value);
  const auto number = static_cast<std::uint32_t>(value);
  if (value > vertices && (ahead_.empty() || number > ahead_.back().number)) ahead_.push_back({in_.at(), number});
  return number - 1;
}

/// One that is not there is no reason to refuse a face, which has a normal of its own: build() counts them.
std::uint32_t ObjReader::read_normal_number(std::string_view part, std::string_view word) {
  const std::int64_t value = read_number(part, word);
  const auto normals = static_cast<std::int64_t>(data_.normals.size() / 3);
  if (value < -normals) return kObjNone - 1;
  return static_cast<std::uint32_t>(value < 0 ? normals + value : value - 1);
}

/// "3", "3/1", "3/1/2" or "3//2"; numbers of texture coordinates need not be there. `parts`: at most so many.
ObjCorner ObjReader::read_corner(std::string_view word, std::size_t parts) {
  std::array<std::string_view, 3> part;
  std::string_view rest = word;
  std::size_t count = 0;
  for (bool more = true; more; ++count) {
    if (count == parts) in_.fail(one_line(word, 40) + " is no vertex's number");
    const std::size_t slash = rest.find('/');
    part[count] = rest.substr(0, slash);
    more = slash != std::string_view::npos;
    if (more) rest.remove_prefix(slash + 1);
  }
  ObjCorner corner{read_vertex_number(part[0], word), kObjNone};
  if (!part[1].empty()) (void)read_number(part[1], word);
  if (!part[2].empty()) corner.normal = read_normal_number(part[2], word);
  return corner;
}

void ObjReader::check_numbers() {
  const std::size_t vertices = data_.positions.size() / 3;
  for (const Ahead& a : ahead_)
    if (a.number > vertices) in_.fail_at(a.line, fmt::format("vertex {} of {} is named", a.number, vertices));
}

void ObjReader::write_notes() {
  std::vector<std::string>& notes = scene_.notes;
  const auto add = [&notes](std::size_t count, const char* one, const char* many, const char* rest) {
    if (count > 0) notes.push_back(counted(count, one, many) + rest);
  };
  words_.note(own_name_, notes);
  if (free_form_ > 0)
    notes.push_back(counted(free_form_, "statement") + fmt::format(" of curves and surfaces from line {} on {} ignored",
                                                                   free_form_line_, free_form_ == 1 ? "is" : "are"));
  add(weights_, "vertex has", "vertices have",
      " a weight (w) that is not 1, which concerns curves alone and is ignored");
  add(bright_, "vertex has", "vertices have", " a colour above 1, which is taken as 1");
  add(dark_, "vertex has", "vertices have", " a colour below 0, which is taken as 0");
  note_alpha(alphas_, notes);
  add(missing_normals_, "corner names", "corners name", " a normal that is not there: the face's is taken");
  add(flat_faces_, "face of a smoothing group has", "faces of smoothing groups have",
      " no normals, and no smooth shading");
  note_faces(counts_, notes);
}

}  // namespace

RawScene import_obj(const std::filesystem::path& path, const std::string& name, bool allow_outside) {
  const std::string text = read_file(path, name);
  return ObjReader(text, path, name, allow_outside).run();
}

}  // namespace kage::scene
