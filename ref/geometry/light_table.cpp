// SPDX-License-Identifier: Apache-2.0
#include "geometry/light_table.hpp"

#include <algorithm>

#include "contract/derived.hpp"
#include "geometry/view.hpp"

namespace kage {

LightTable::LightTable(const Config& config, const Look& look, std::span<const Light> lights, const Lighting& lighting,
                       std::span<const int> samples)
    : config_(&config), lighting_(&lighting), samples_(samples) {
  if (!derived::has_table(config)) return;
  normals_.emplace(look.classes);
  positional_ = std::any_of(lights.begin(), lights.end(), [](const Light& l) { return !l.directional; });
}

std::uint32_t LightTable::classify(const glm::dvec3& normal, const glm::dvec3& place, double area,
                                   const std::bitset<kMaxLights>& lit) {
  const int nearest = normals_->nearest(normal);
  const auto [at, fresh] =
      numbers_.emplace(Key{nearest, lit.to_ullong()}, static_cast<std::uint32_t>(classes_.size()) + 1);
  if (fresh) classes_.push_back({nearest, lit, {}, 0});
  if (positional_) {
    Class& c = classes_[at->second - 1];
    const auto parts = lighting_->shares(place, normal, lit, config_->channels == 1);
    const double weight = std::max(area, 1e-100);  // a face without area may be a class's only one
    c.parts.resize(samples_.size(), glm::dvec3(0));
    for (std::size_t l = 0; l < samples_.size(); ++l) c.parts[l] += parts[l] * weight;
    c.weight += weight;
  }
  return at->second;
}

// Puts the classes together that have the same of `count` normals, and the same lights if `by_light`. `number` follows.
void LightTable::coarsen(int count, bool by_light, std::vector<std::uint32_t>& number) {
  const NormalClasses coarse(count);
  std::vector<Class> merged;
  std::map<Key, std::uint32_t> numbers;
  std::vector<std::uint32_t> becomes(classes_.size() + 1, 0);
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const Class& c = classes_[i];
    const int nearest = coarse.nearest(normals_->normal(c.normal));
    const Key key{nearest, by_light ? c.lit.to_ullong() : 0};
    const auto [at, fresh] = numbers.emplace(key, static_cast<std::uint32_t>(merged.size()) + 1);
    if (fresh) merged.push_back({nearest, {}, std::vector<glm::dvec3>(c.parts.size(), glm::dvec3(0)), 0});
    Class& m = merged[at->second - 1];
    m.lit |= c.lit;
    for (std::size_t l = 0; l < c.parts.size(); ++l) m.parts[l] += c.parts[l];
    m.weight += c.weight;
    becomes[i + 1] = at->second;
  }
  for (std::uint32_t& n : number) n = becomes[n];
  classes_ = std::move(merged);
  normals_ = coarse;
}

std::vector<glm::dvec3> LightTable::shares(const Class& c) const {
  if (!positional_) return lighting_->shares({}, normals_->normal(c.normal), c.lit, config_->channels == 1);
  std::vector<glm::dvec3> parts;
  for (const glm::dvec3& part : c.parts) parts.push_back(part / c.weight);
  return parts;
}

void LightTable::finish(FrameGeometry& out) {
  if (!normals_) return;
  const auto most = static_cast<std::size_t>(derived::most_class(*config_));
  std::vector<std::uint32_t> number(classes_.size() + 1);
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = static_cast<std::uint32_t>(i);
  for (int count = normals_->count(); classes_.size() > most;) {
    // With one normal left, what is left to differ is the lights.
    coarsen(std::max(count / 2, 1), count > 1, number);
    count = normals_->count();
  }
  for (ScreenPolygon& p : out.polygons) p.normal_class = number[p.normal_class];

  for (const Class& c : classes_) {
    const auto parts = shares(c);
    for (std::size_t l = 0; l < static_cast<std::size_t>(config_->lights); ++l) {
      auto& entry = out.shares.emplace_back();
      if (l >= samples_.size()) continue;
      for (int k = 0; k < 3; ++k)
        entry[static_cast<std::size_t>(k)] =
            static_cast<std::uint32_t>(to_fixed(parts[l][k] / samples_[l], config_->shade_frac));
    }
  }
}

}  // namespace kage
