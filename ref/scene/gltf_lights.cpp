// SPDX-License-Identifier: Apache-2.0
#include "gltf_lights.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "functions.hpp"
#include "notes.hpp"

namespace kage::scene {

/// Several nodes may have one light.
void GltfLights::tell(const std::string& defect) {
  if (std::find(defects_.begin(), defects_.end(), defect) == defects_.end()) defects_.push_back(defect);
}

void GltfLights::read(std::uint64_t index, std::uint32_t node, const std::string& asker) {
  const std::string place = "light " + std::to_string(index);
  const Json& all = file_->array(file_->extension(file_->root(), "KHR_lights_punctual", "JSON"), "lights", place);
  const Json& json = file_->item_of(all, index, "lights", asker);
  const std::string type = file_->text(json, "type", place);
  if (type != "directional" && type != "point" && type != "spot") {
    file_->pass_over(json);
    return tell(place + ": type '" + one_line(type, 40) + "' is unknown: it is ignored");
  }
  RawLight raw;
  raw.node = node;
  Light& light = raw.light;
  light.directional = type == "directional";
  light.falls_off = !light.directional;
  const std::vector<double> color = file_->numbers(json, "color", 3, place);
  if (!color.empty()) light.color = vec3(color);
  light.color *= file_->number(json, "intensity", place).value_or(1);
  for (int c = 0; c < 3; ++c)
    if (!(light.color[c] >= 0) || !std::isfinite(light.color[c])) {
      tell(place + ": colour times intensity is negative or not finite: taken as 0");
      light.color[c] = 0;
    }
  const double range = file_->number(json, "range", place).value_or(0);
  if (file_->has(json, "range") && !(range > 0)) tell(place + ": 'range' is not above 0: it has none");
  if (light.falls_off) light.range = std::max(range, 0.0);
  if (type == "spot") read_cone(json, light, place);
  if (!light.directional)
    read_shape(json, light, place);
  else if (file_->has(file_->own_extras(json), "shape"))
    ++counts_.shaped_suns;
  if (light.color == glm::dvec3(0)) {
    ++counts_.black;
    return;
  }
  if (scene_->lights.size() == kMaxLights)
    file_->fail(place, "there are more than " + std::to_string(kMaxLights) + " lights");
  scene_->lights.push_back(raw);
}

void GltfLights::read_cone(const Json& json, Light& light, const std::string& place) {
  const Json& spot = file_->object(json, "spot", place);
  const double inner = file_->number(spot, "innerConeAngle", place).value_or(0);
  const double outer = file_->number(spot, "outerConeAngle", place).value_or(portable::kPi / 4);
  // Files have floats, of which the nearest to pi / 2 is above it, and nearer than any other.
  const double most = static_cast<double>(static_cast<float>(portable::kPi / 2));
  if (!(inner >= 0 && inner <= outer && outer <= most))
    tell(place + ": its cone is not 0 <= innerConeAngle <= outerConeAngle <= pi / 2: the nearest that is, is taken");
  light.spot = true;
  const double widest = std::clamp(outer, 0.0, portable::kPi / 2);
  light.inner_cosine = portable::cos(std::clamp(inner, 0.0, widest));
  light.outer_cosine = portable::cos(widest);
}

// The format knows no lights that extend over something: kage's own words for them are in `extras`.
void GltfLights::read_shape(const Json& json, Light& light, const std::string& place) {
  const Json& own = file_->own_extras(json);
  if (!file_->has(own, "shape")) return;
  const std::string shape = file_->text(own, "shape", place);
  const auto size = [&](const char* key) {
    const double v = file_->number(own, key, place).value_or(0);
    if (!(v > 0))
      file_->fail(place, "extras.kage: '" + std::string(key) + "' of a " + one_line(shape, 40) + " is not above 0");
    return v;
  };
  if (shape == "disc" || shape == "sphere") {
    const double radius = size("radius");
    light.shape = shape == "disc" ? LightShape::disc : LightShape::sphere;
    light.axis_u = {radius, 0, 0};
    light.axis_v = {0, shape == "disc" ? radius : 0, 0};
  } else if (shape == "rectangle") {
    light.shape = LightShape::rectangle;
    light.axis_u = {size("width") / 2, 0, 0};
    light.axis_v = {0, size("height") / 2, 0};
  } else {
    file_->fail(place, "extras.kage: shape '" + one_line(shape, 40) + "' is none of disc, rectangle and sphere");
  }
}

}  // namespace kage::scene
