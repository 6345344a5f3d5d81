// SPDX-License-Identifier: Apache-2.0
//
// The results of kage's readers as figures that another reader's can be held against (second_reader.py). For each file
// named there is a line of JSON with the triangles, the box round their corners, twice their area, and their mean
// colour by area; or with the refusal.
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "kage/error.hpp"
#include "scene/import.hpp"
#include "scene/space.hpp"
#include "scene/transform.hpp"

using namespace kage;
using nlohmann::json;

namespace {

struct Figures {
  std::size_t triangles = 0;
  SpaceBox box;
  double area = 0;
  glm::dvec3 color{0, 0, 0};  // times area
};

void add(const scene::RawPrimitive& p, Figures& f) {
  const auto triple = [](const std::vector<float>& values, std::size_t i) {
    return glm::dvec3{values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  };
  for (std::size_t t = 0; t < p.triangle_count(); ++t) {
    glm::dvec3 corner[3];
    glm::dvec3 color{0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t v = p.corners[3 * t + i];
      corner[i] = triple(p.positions, v);
      f.box.add(corner[i]);
      color += p.colors.empty() ? p.color : p.color * triple(p.colors, v);
    }
    const double area = kage::length(scene::cross(corner[1] - corner[0], corner[2] - corner[0]));
    f.area += area;
    f.color += color * (area / 3);
    ++f.triangles;
  }
}

json of(const std::string& file) {
  try {
    const scene::RawScene s = scene::import_file(file, "");
    Figures f;
    for (const scene::RawNode& node : s.nodes)
      if (node.mesh >= 0)
        for (const scene::RawPrimitive& p : s.meshes[static_cast<std::size_t>(node.mesh)].primitives) add(p, f);
    const glm::dvec3 mean = f.area > 0 ? f.color / f.area : f.color;
    return {{"triangles", f.triangles},
            {"low", {f.box.low.x, f.box.low.y, f.box.low.z}},
            {"high", {f.box.high.x, f.box.high.y, f.box.high.z}},
            {"area", f.area},
            {"colour", {mean.x, mean.y, mean.z}},
            {"notes", s.notes}};
  } catch (const Error& e) {
    return {{"refused", e.what()}};
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    std::printf("%s\n", of(argv[i]).dump(-1, ' ', false, json::error_handler_t::replace).c_str());
  return 0;
}
