// SPDX-License-Identifier: Apache-2.0
#include "color_range.hpp"

#include "number/counted.hpp"

namespace kage::scene {

void ColorRange::add(const RawPrimitive& p) {
  bool bright = false;
  bool dark = false;
  const auto look = [&](const glm::dvec3& c) {
    bright = bright || c.x > 1 || c.y > 1 || c.z > 1;
    dark = dark || c.x < 0 || c.y < 0 || c.z < 0;
  };
  if (p.colors.empty()) look(p.color);
  for (std::size_t i = 0; i + 2 < p.colors.size(); i += 3)
    look(p.color * glm::dvec3(p.colors[i], p.colors[i + 1], p.colors[i + 2]));
  bright_ += bright ? 1 : 0;
  dark_ += dark ? 1 : 0;
}

void ColorRange::note(const char* one, const char* many, std::vector<std::string>& notes) const {
  if (bright_ > 0) notes.push_back(counted(bright_, one, many) + " a colour above 1, which is taken as 1");
  if (dark_ > 0) notes.push_back(counted(dark_, one, many) + " a colour below 0, which is taken as 0");
}

}  // namespace kage::scene
