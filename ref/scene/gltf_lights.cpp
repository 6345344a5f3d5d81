// SPDX-License-Identifier: Apache-2.0
#include "gltf_lights.hpp"

#include <cmath>
#include <vector>

#include "functions.hpp"
#include "notes.hpp"

namespace kage::scene {

void GltfLights::read(std::uint64_t index, std::uint32_t node) {
  const std::string place = "light " + std::to_string(index);
  const Json& all = file_->array(file_->extension(file_->root(), "KHR_lights_punctual", "JSON"), "lights", place);
  const Json& json = file_->item_of(all, index, "lights", place);
  const std::string type = file_->text(json, "type", place);
  if (type != "directional" && type != "point" && type != "spot")
    file_->fail(place, "type '" + one_line(type, 40) + "' is unknown");
  RawLight raw;
  raw.node = node;
  Light& light = raw.light;
  light.directional = type == "directional";
  light.falls_off = !light.directional;
  const std::vector<double> color = file_->numbers(json, "color", 3, place);
  if (!color.empty()) light.color = vec3(color);
  light.color *= file_->number(json, "intensity", place).value_or(1);
  for (int c = 0; c < 3; ++c)
    if (!(light.color[c] >= 0) || !std::isfinite(light.color[c]))
      file_->fail(place, "colour times intensity is negative or not finite");
  const auto range = file_->number(json, "range", place);
  if (range && !(*range > 0)) file_->fail(place, "'range' is not above 0");
  if (light.falls_off) light.range = range.value_or(0);
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
  if (!(inner >= 0 && inner < outer && outer <= portable::kPi / 2))
    file_->fail(place, "its cone is not 0 <= innerConeAngle < outerConeAngle <= pi / 2");
  light.spot = true;
  light.inner_cosine = portable::cos(inner);
  light.outer_cosine = portable::cos(outer);
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
