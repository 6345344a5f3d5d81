// SPDX-License-Identifier: Apache-2.0
#include "scene/plain/mtl_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>

#include "number/counted.hpp"
#include "scene/notes.hpp"
#include "scene/plain/statements.hpp"

namespace kage::scene {
namespace {

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Ambient light there is none, exponents and refraction belong to gloss and glass, which have notes of their own.
bool is_passed_over(std::string_view keyword) {
  return is_one_of(keyword, {"Ka", "Ns", "Ni", "sharpness", "Pcr", "map_aat"});
}

bool is_texture(std::string_view keyword) {
  return keyword.starts_with("map_") || is_one_of(keyword, {"bump", "disp", "decal", "refl", "norm"});
}

class MtlReader {
 public:
  MtlReader(std::string_view text, const std::string& file) : in_(text, file) {}

  void run(MtlMaterials& materials, std::vector<std::string>& notes) {
    while (in_.next_statement())
      if (in_.keyword() == "newmtl") {
        finish(materials);
        name_ = in_.name();
        known_ = Known{};  // clang 14 finds no emplace() for a type that is not whole yet
      } else {
        read_statement();
      }
    finish(materials);
    words_.note(in_.file(), notes);
    if (twice_ > 0)
      notes.push_back(counted(twice_, "material", "materials") + " of " + one_line(in_.file(), 120) +
                      (twice_ == 1 ? " has a name that was there before, and is ignored"
                                   : " have names that were there before, and are ignored"));
  }

 private:
  /// As the file has them.
  struct Known {
    std::optional<glm::dvec3> diffuse, specular, emission;
    std::optional<double> dissolve, transparency;
    double illumination = 1;
    double gloss = 0;  // the most of metalness, sheen, clearcoat and 1 - roughness
    std::vector<std::string> textures;
  };

  void read_statement();
  void read_color(std::optional<glm::dvec3>& to);
  void read_filter();
  void read_dissolve();
  std::optional<double> read_number();
  void finish(MtlMaterials& materials);
  static MtlMaterial material(const Known& known);

  /// Says that the statement is ignored, by its keyword and, where that alone is well known, what follows it.
  void ignore(std::string_view with = {}) {
    words_.add(std::string(in_.keyword()) + (with.empty() ? "" : " " + std::string(with)), in_.at());
  }

  Statements in_;
  IgnoredWords words_;
  std::string name_;
  std::optional<Known> known_;  // none before the first newmtl
  std::size_t twice_ = 0;
};

void MtlReader::read_statement() {
  const std::string_view key = in_.keyword();
  if (!known_) return ignore();
  if (is_passed_over(key)) return;
  if (is_texture(key)) {
    known_->textures.emplace_back(in_.name());
  } else if (key == "Kd") {
    read_color(known_->diffuse);
  } else if (key == "Ks") {
    read_color(known_->specular);
  } else if (key == "Ke") {
    read_color(known_->emission);
  } else if (key == "Tf") {
    read_filter();
  } else if (key == "d") {
    read_dissolve();
  } else if (key == "Tr") {
    if (const auto v = read_number()) known_->transparency = v;
  } else if (key == "illum") {
    if (const auto v = read_number()) known_->illumination = *v;
  } else if (is_one_of(key, {"Pm", "Ps", "Pc"})) {
    if (const auto v = read_number()) known_->gloss = std::max(known_->gloss, *v);
  } else if (key == "Pr") {
    if (const auto v = read_number()) known_->gloss = std::max(known_->gloss, 1 - *v);
  } else {
    ignore();
  }
}

/// The format has red, green and blue, or red alone for all three; "spectral" and a file, or "xyz" and numbers.
void MtlReader::read_color(std::optional<glm::dvec3>& to) {
  glm::dvec3 color{0};
  int count = 0;
  for (std::string_view word = in_.word(); !word.empty(); word = in_.word(), ++count) {
    const auto value = number_of(word);
    if (!value || !std::isfinite(*value) || count == 3) return ignore(word);
    color[count] = *value;
  }
  if (count != 1 && count != 3) return ignore(count == 0 ? "alone" : "of two numbers");
  to = count == 1 ? glm::dvec3(color.x) : color;
}

/// The colour of light that a translucent material lets through: kage draws white.
void MtlReader::read_filter() {
  std::optional<glm::dvec3> filter;
  read_color(filter);
  if (filter && *filter != glm::dvec3(1)) ignore();
}

void MtlReader::read_dissolve() {
  std::string_view word = in_.word();
  if (word == "-halo") {
    ignore(word);
    word = in_.word();
  }
  const auto value = number_of(word);
  if (!value || !std::isfinite(*value) || !in_.word().empty()) return ignore(word);
  known_->dissolve = *value;
}

std::optional<double> MtlReader::read_number() {
  const std::string_view word = in_.word();
  const auto value = number_of(word);
  if (value && std::isfinite(*value) && in_.word().empty()) return *value;
  ignore(word);
  return std::nullopt;
}

MtlMaterial MtlReader::material(const Known& known) {
  const auto positive = [](const std::optional<glm::dvec3>& c) {
    const glm::dvec3 v = c.value_or(glm::dvec3(0));
    return glm::dvec3(std::max(v.x, 0.0), std::max(v.y, 0.0), std::max(v.z, 0.0));
  };
  MtlMaterial m;
  const glm::dvec3 diffuse = known.diffuse.value_or(m.color);
  const glm::dvec3 light = positive(known.emission);
  m.unlit = light != glm::dvec3(0) && positive(diffuse) == glm::dvec3(0);
  m.emits = light != glm::dvec3(0) && !m.unlit;
  const glm::dvec3 color = positive(m.unlit ? light : diffuse);
  m.color = {std::min(color.x, 1.0), std::min(color.y, 1.0), std::min(color.z, 1.0)};
  m.bright = m.color != color;
  m.dark = positive(diffuse) != diffuse || light != known.emission.value_or(light);
  // Several programs write 0 and mean that nothing is said: what is drawn at all is not wholly invisible.
  const double opacity = known.dissolve ? *known.dissolve : 1 - known.transparency.value_or(0);
  if (opacity > 0 && opacity < 1) m.alpha = opacity;
  m.invisible = !(opacity > 0);
  m.dense = opacity > 1;
  const bool shines = positive(known.specular) != glm::dvec3(0) || known.gloss > 0 || known.illumination >= 3;
  m.glossy = shines && !m.unlit;
  m.unshaded = known.illumination == 0 && !m.unlit;
  m.textures = known.textures;
  return m;
}

void MtlReader::finish(MtlMaterials& materials) {
  if (!known_) return;
  const MtlMaterial m = material(*known_);
  if (!materials.try_emplace(name_, m).second) ++twice_;
  // A file may write "usemtl red" for "newmtl red # of the door".
  (void)materials.try_emplace(std::string(without_comment(name_)), m);
}

}  // namespace

void read_mtl(std::string_view text, const std::string& file, MtlMaterials& materials,
              std::vector<std::string>& notes) {
  MtlReader(text, file).run(materials, notes);
}

}  // namespace kage::scene
