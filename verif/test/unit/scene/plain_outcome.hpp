// SPDX-License-Identifier: Apache-2.0
//
// The outcome of reading a text or bytes as a file of a plain format.
#pragma once

#include <cmath>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "files.hpp"
#include "scene/space.hpp"

namespace kage::test {

/// One text behind the other.
inline std::string joined(std::initializer_list<std::string_view> parts) {
  std::string all;
  for (const std::string_view part : parts) all += part;
  return all;
}

/// A folder in which one file after the other is loaded.
class PlainFiles {
 public:
  explicit PlainFiles(std::string extension) : extension_(std::move(extension)) {}

  [[nodiscard]] Scene load(const std::string& text) const { return Scene::load(write(text)); }
  [[nodiscard]] SceneFrame frame(const std::string& text) const { return load(text).frame(0, 1); }

  /// The message of loading, behind the file's name; "loaded" if there is none.
  [[nodiscard]] std::string refusal(const std::string& text) const {
    const std::string file = write(text);
    const std::string message = test::refusal(file);
    return message.rfind(file + ": ", 0) == 0 ? message.substr(file.size() + 2) : message;
  }

  /// Notes on what the file holds, one to a line.
  [[nodiscard]] std::string notes(const std::string& text) const {
    const Scene scene = load(text);
    std::string all;
    for (const std::string& note : scene.notes())
      if (note.rfind("no camera", 0) != 0 && note.rfind("no light", 0) != 0) all += note + "\n";
    return all;
  }

  /// Another file beside it.
  void add(const std::string& name, const std::string& text) const { (void)dir_.write(name, text); }
  [[nodiscard]] std::filesystem::path path() const { return dir_.path(); }

 private:
  [[nodiscard]] std::string write(const std::string& text) const { return dir_.write("t" + extension_, text); }

  TempDirectory dir_;
  std::string extension_;
};

/// Twice the area of all triangles.
inline double area(const SceneFrame& f) {
  double sum = 0;
  for (const Triangle& t : f.triangles) {
    const glm::dvec3 u = f.vertices[t.vertex[1]] - f.vertices[t.vertex[0]];
    const glm::dvec3 v = f.vertices[t.vertex[2]] - f.vertices[t.vertex[0]];
    sum += kage::length({u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x});
  }
  return sum;
}

/// The colours of each triangle's first corner, in thousandths: "1000 0 0, 600 600 600".
inline std::string colors(const SceneFrame& f) {
  std::string all;
  for (const Triangle& t : f.triangles) {
    const glm::dvec3 c = f.shading[t.shading[0]].color;
    all += all.empty() ? "" : ", ";
    for (int i = 0; i < 3; ++i) all += (i == 0 ? "" : " ") + std::to_string(std::lround(1000 * c[i]));
  }
  return all;
}

}  // namespace kage::test
