// SPDX-License-Identifier: Apache-2.0
#include "geometry/light_table.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "contract/derived.hpp"
#include "geometry/kept_light.hpp"
#include "geometry/view.hpp"
#include "scene/space.hpp"

namespace kage {
namespace {

constexpr std::size_t kChannels = 3;
constexpr double kWhite = 255;

// A face's middle stands for so much of its light; its corners share the rest. So the mean of what goes with the square
// of the place is exact on a triangle.
constexpr double kMiddleWeight = 0.75;

// Where several lights are kept out together a surface loses more than the sum of what it loses to each alone. So much
// of the difference goes to the lights, each by its part of the light; 0 is right for each alone, 1 for all together.
constexpr double kTogether = 0.25;

// Weight of a share that, as far as boxes tell, no pixel needs.
constexpr double kNeverKept = 0x1p-10;

// A part of its class to speak of, by area.
constexpr double kOfClass = 1.0 / 16;

// A face whose class was not made for it is left so much at least by its own shadow.
constexpr double kLeastLeft = 1.0 / 64;

// A face is parted while shares within a part are further off their mean, root mean square, in steps of 255, and while
// there are fewer parts than this of a face and of all.
constexpr double kSpread = 1;
constexpr std::size_t kPartsOfFace = 256;
constexpr std::size_t kPartsOfAll = 4096;

}  // namespace

FaceSide::FaceSide(const SceneFrame& frame, const SampledLights& lights, std::uint32_t of_polygon, int of_eye)
    : polygon(of_polygon), eye_side(of_eye) {
  const FacePlane plane(frame, frame.polygons[polygon]);
  sides.reserve(lights.points.size());
  for (const ShadowCaster& c : lights.points) sides.push_back(static_cast<std::int8_t>(c.facing(plane)));
}

bool FaceSide::takes_shadow(const SampledLights& lights) const {
  return std::any_of(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(lights.samples().size()),
                     [this](std::int8_t s) { return s * eye_side > 0; });
}

int FaceSide::count(const SampledLights& lights, std::size_t l, int side) const {
  return static_cast<int>(
      std::count(sides.begin() + lights.first[l], sides.begin() + lights.first[l + 1], side * eye_side));
}

LightTable::LightTable(const SceneFrame& frame, const Config& config, const Look& look, const SampledLights& lights,
                       const Lighting& lighting)
    : frame_(&frame),
      config_(&config),
      lights_(&lights),
      lighting_(&lighting),
      self_shadow_(!look.fit || config.fsf > 0),
      diced_(config.smooth > 0 && look.max_shading > 0),
      numbers_(lights.casting * kChannels),
      known_(frame.polygons.size()) {
  if (lights.casting == 0 || config.linear_bits > 0) return;  // light after light takes no shares
  WeightedVectors all;
  all.dimensions = numbers_;
  std::vector<Member> members;
  double area = 0;
  add_sides(false, all, members, area);
  if (members.empty()) add_sides(true, all, members, area);
  if (!derived::has_table(config)) {
    make_one(all, look);
    make_entries({});  // not limited: one bright face would take the shadows of all others
    measure(all, std::vector<std::uint32_t>(members.size(), 0), area);
    return;
  }
  const auto room = static_cast<std::size_t>(std::min(derived::most_class(config), look.classes));
  const Clusters clusters = clusters_of(all, room);
  middles_ = clusters.middles;
  for (std::size_t i = 0; i < members.size(); ++i)
    if (members[i].number != nullptr) *members[i].number = clusters.of[i] + 1;
  make_entries(limit(members, clusters.of));
  measure(all, clusters.of, area);
}

// All sides that light reaches and that the eye may see. The inside of a closed component gets light from within alone;
// if `inner`, it counts all the same.
void LightTable::add_sides(bool inner, WeightedVectors& all, std::vector<Member>& members, double& area) {
  const KeptLight kept(*frame_);
  const std::vector<SpaceBox> boxes = component_boxes(*frame_);
  for (std::size_t p = 0; p < boxes.size(); ++p) {
    const Component& part = frame_->components[p];
    const auto samples = lights_->samples();
    const bool from_within =
        std::any_of(samples.begin(), samples.end(), [&](const ShadowCaster& c) { return !c.light_outside(boxes[p]); });
    for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i) {
      const Triangle& t = frame_->triangles[frame_->polygons[i].triangle];
      if (t.unlit || t.alpha < 255) continue;  // one that is drawn opaque all the same has the nearest class
      FaceSide side(*frame_, *lights_, i, 1);
      for (const int eye_side : {1, -1}) {
        side.eye_side = eye_side;
        if ((eye_side < 0 && part.closed && !from_within && !inner) || !side.takes_shadow(*lights_)) continue;
        Known& known = known_[i][eye_side > 0 ? 0 : 1];
        known.needed = 0;
        for (std::size_t k = 0; k < lights_->casting; ++k)
          if (side.count(*lights_, k, -1) > 0 || kept.may_be(i, part, eye_side, frame_->lights[k]))
            known.needed |= 1U << k;
        const std::vector<Part> parts = parts_of(side);
        for (const Part& one : parts) {
          const Loss& l = one.loss;
          Member& m =
              members.emplace_back(Member{parts.size() == 1 ? &known.number : nullptr, l.area, l.brightest, {}});
          for (std::size_t k = 0; k < lights_->casting; ++k) {
            m.behind.push_back(shadows_itself(side) ? side.count(*lights_, k, -1) : 0);
            if ((known.needed >> k & 1U) != 0) area += l.area * kChannels;
          }
          all.values.insert(all.values.end(), l.shares.begin(), l.shares.end());
          all.weights.insert(all.weights.end(), l.weights.begin(), l.weights.end());
          law_ += l.law;
        }
        extra_ += parts.size() - 1;
      }
    }
  }
}

// The part that is furthest off its mean goes first, so that few parts leave little error.
std::vector<LightTable::Part> LightTable::parts_of(const FaceSide& side) const {
  const FaceSurface surface(*frame_, side.polygon);
  const std::vector<SurfacePoint> outline = surface.outline();
  std::vector<Part> parts{{{}, loss(side, outline), 0}};
  std::size_t count = 0;
  const auto wide = [this](const Part& p) {
    return p.loss.spread > kSpread * kSpread * p.loss.area * static_cast<double>(numbers_);
  };
  if (!diced_ || !derived::has_table(*config_) || !wide(parts[0])) return parts;
  const auto part = [&](const SurfacePoint& a, const SurfacePoint& b, const SurfacePoint& c) {
    const std::array<SurfacePoint, 3> corners{a, b, c};
    return Part{corners, loss(side, corners), count++};
  };
  // Rounded, and as a share of the whole: rounding alone does not put parts that are alike in another order, and a unit
  // of length neither.
  const double whole = parts[0].loss.area;
  const auto less = [whole](const Part& a, const Part& b) {
    const auto of_a = static_cast<float>(a.loss.spread / whole);
    const auto of_b = static_cast<float>(b.loss.spread / whole);
    return of_a != of_b ? of_a < of_b : a.number > b.number;
  };
  parts.clear();
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) parts.push_back(part(outline[0], outline[i], outline[i + 1]));
  std::make_heap(parts.begin(), parts.end(), less);
  while (wide(parts[0]) && parts.size() < kPartsOfFace && extra_ + parts.size() < kPartsOfAll) {
    std::pop_heap(parts.begin(), parts.end(), less);
    const std::array<SurfacePoint, 3> c = parts.back().corners;
    parts.pop_back();
    std::size_t longest = 0;  // the edge that begins there
    for (std::size_t k = 1; k < 3; ++k)
      if (squared(c[(k + 1) % 3].point - c[k].point) > kLonger * squared(c[(longest + 1) % 3].point - c[longest].point))
        longest = k;
    const SurfacePoint& from = c[longest];
    const SurfacePoint& to = c[(longest + 1) % 3];
    const SurfacePoint& third = c[(longest + 2) % 3];
    const SurfacePoint middle = surface.at((from.point + to.point) * 0.5);
    for (const Part& half : {part(from, middle, third), part(middle, to, third)}) {
      parts.push_back(half);
      std::push_heap(parts.begin(), parts.end(), less);
    }
  }
  // Heaps of other libraries may have another order.
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.number < b.number; });
  return parts;
}

// Lowers entries by which a member's own shadow would ask for a colour above white: what is lit must come out right.
// Members that are a small part of their class are passed over, or they would take the shadows of all others.
std::vector<bool> LightTable::limit(const std::vector<Member>& members, const std::vector<std::uint32_t>& of) {
  std::vector<bool> limited(middles_.size(), false);
  std::vector<double> areas(middles_.size() / numbers_, 0);
  for (std::size_t i = 0; i < members.size(); ++i) areas[of[i]] += members[i].area;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i].area < kOfClass * areas[of[i]]) continue;
    for (std::size_t c = 0; c < kChannels; ++c) {
      double own_shadow = 0;
      for (std::size_t l = 0; l < lights_->casting; ++l)
        own_shadow += members[i].behind[l] * middles_[of[i] * numbers_ + l * kChannels + c];
      const double room = std::max(1 - members[i].brightest[static_cast<int>(c)] / kWhite, 0.0);
      if (own_shadow <= room) continue;
      for (std::size_t l = 0; l < lights_->casting; ++l) {
        const std::size_t at = of[i] * numbers_ + l * kChannels + c;
        middles_[at] *= room / own_shadow;
        limited[at] = true;
      }
    }
  }
  return limited;
}

// Entries as RESOLVE has them. A limited one is rounded down.
void LightTable::make_entries(const std::vector<bool>& limited) {
  for (double& m : middles_) m = std::isfinite(m) ? std::clamp(m, 0.0, 1.0) : 0;
  const int frac = config_->shade_frac;
  for (std::size_t i = 0; i < middles_.size(); ++i) {
    const bool down = i < limited.size() && limited[i];
    const double whole =
        down ? std::floor(std::ldexp(middles_[i], frac)) : static_cast<double>(to_fixed(middles_[i], frac));
    entries_.push_back(std::ldexp(whole, -frac));
  }
}

void LightTable::measure(const WeightedVectors& all, const std::vector<std::uint32_t>& of, double area) {
  double squares = 0;
  for (std::size_t i = 0; i < of.size(); ++i)
    for (std::size_t d = 0; d < numbers_; ++d) {
      const double off = all.value(i)[d] - entries_[of[i] * numbers_ + d];
      squares += all.weight(i)[d] * (off * off);
    }
  error_ = area > 0 ? std::sqrt(squares / area) : 0;
  law_error_ = area > 0 ? std::sqrt(law_ / area) : 0;
}

// One share for all faces, channels and lights: that of least error.
void LightTable::make_one(const WeightedVectors& all, const Look& look) {
  double sum = 0;
  double weight = 0;
  for (std::size_t i = 0; i < all.values.size(); ++i) {
    sum += all.values[i] * all.weights[i];
    weight += all.weights[i];
  }
  middles_.assign(numbers_, weight > 0 ? sum / weight : 0);
  if (look.darkening) middles_.assign(numbers_, *look.darkening / lights_->points_of(0));
}

bool LightTable::shadows_itself(const FaceSide& side) const {
  return self_shadow_ && frame_->triangles[frame_->polygons[side.polygon].triangle].alpha == 255;
}

LightTable::Loss LightTable::loss(const FaceSide& side, std::span<const SurfacePoint> outline) const {
  const auto count = static_cast<double>(outline.size());
  glm::dvec3 twice_area{0, 0, 0};
  for (std::size_t i = 1; i + 1 < outline.size(); ++i)
    twice_area += glm::cross(outline[i].point - outline[0].point, outline[i + 1].point - outline[0].point);
  const double area = outline.size() > 2 ? glm::length(twice_area) : 1;

  SurfacePoint middle{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  bool alike = true;
  for (const SurfacePoint& corner : outline) {
    alike = alike && corner.normal == outline[0].normal && corner.base == outline[0].base;
    middle.point += corner.point / count;
    middle.normal += corner.normal;
    middle.base += corner.base / count;
  }
  const double length = glm::length(middle.normal);
  if (length > 0) middle.normal /= length;

  Loss out{std::vector<double>(numbers_, 0), std::vector<double>(numbers_, 0), 0, area};
  // Asked for only where a shadow of the side's own is to be made up for.
  if (shadows_itself(side) &&
      std::any_of(side.sides.begin(), side.sides.end(), [&](std::int8_t s) { return s * side.eye_side < 0; })) {
    out.brightest = lit_color(side, middle);
    for (std::size_t i = 0; i < outline.size() && outline.size() > 1; ++i)
      out.brightest = glm::max(out.brightest, lit_color(side, outline[i]));
  }
  if (outline.size() == 1 || (alike && !lighting_->depends_on_place(side.sides, side.eye_side))) {
    add_loss(side, middle, area, out);
  } else {
    add_loss(side, middle, area * kMiddleWeight, out);
    for (const SurfacePoint& corner : outline) add_loss(side, corner, area * (1 - kMiddleWeight) / count, out);
  }
  const std::uint32_t needed = known(side).needed;
  for (std::size_t i = 0; i < numbers_; ++i) {
    if (out.weights[i] > 0) out.shares[i] /= out.weights[i];
    if ((needed >> (i / kChannels) & 1U) == 0) out.weights[i] *= kNeverKept;
  }
  return out;
}

// The colour of a place with no shadow on it.
glm::dvec3 LightTable::lit_color(const FaceSide& side, const SurfacePoint& at) const {
  std::array<glm::dvec3, kMaxLights> arrive;
  const std::span<glm::dvec3> of = std::span(arrive).first(lighting_->lights());
  const glm::dvec3 to_eye = at.normal * static_cast<double>(side.eye_side);
  lighting_->arriving(at.point, to_eye, side.sides, side.eye_side, of);
  return lighting_->displayed(to_eye, at.base, std::accumulate(of.begin(), of.end(), glm::dvec3(0)));
}

// At one place of a side, adds to `out` what its shadows take, times the weight of it.
void LightTable::add_loss(const FaceSide& side, const SurfacePoint& at, double weight, Loss& out) const {
  std::array<glm::dvec3, kMaxLights> arrive;
  const glm::dvec3 to_eye = at.normal * static_cast<double>(side.eye_side);
  lighting_->arriving(at.point, to_eye, side.sides, side.eye_side, std::span(arrive).first(lighting_->lights()));
  const auto sum = [&](std::size_t first, std::size_t end) {
    return std::accumulate(arrive.begin() + static_cast<std::ptrdiff_t>(first),
                           arrive.begin() + static_cast<std::ptrdiff_t>(end), glm::dvec3(0));
  };
  const std::size_t casting = lights_->casting;
  const std::uint32_t needed = known(side).needed;
  const glm::dvec3 kept = sum(0, casting);
  const glm::dvec3 others = sum(casting, lighting_->lights());
  const auto displayed = [&](const glm::dvec3& light) { return lighting_->displayed(to_eye, at.base, light); };
  const glm::dvec3 lit = displayed(others + kept);

  std::array<glm::dvec3, kMaxLights> taken;  // by each light's full shadow alone
  std::array<int, kMaxLights> before{};
  std::array<int, kMaxLights> behind{};
  for (std::size_t l = 0; l < casting; ++l) {
    before[l] = side.count(*lights_, l, 1);
    if (shadows_itself(side)) behind[l] = side.count(*lights_, l, -1);
    taken[l] = before[l] > 0 ? lit - displayed(others + (sum(0, l) + sum(l + 1, casting))) : glm::dvec3(0);
  }
  const glm::dvec3 alone =
      std::accumulate(taken.begin(), taken.begin() + static_cast<std::ptrdiff_t>(casting), glm::dvec3(0));
  const glm::dvec3 displayed_others = displayed(others);
  const glm::dvec3 together = lit - displayed_others - alone;

  for (int c = 0; c < static_cast<int>(kChannels); ++c) {
    if (!(lit[c] > 0)) continue;
    double own_shadow = 0;
    std::array<double, kMaxLights> share{};  // by a sample
    for (std::size_t l = 0; l < casting; ++l) {
      if (before[l] == 0) continue;
      const double of_all = kept[c] > 0 ? arrive[l][c] / kept[c] : 0;
      share[l] = std::max(taken[l][c] + kTogether * together[c] * of_all, 0.0) / (lit[c] * before[l]);
      own_shadow += share[l] * behind[l];
    }
    double all_off = lit[c] - displayed_others[c];
    for (std::size_t l = 0; l < casting; ++l) all_off -= share[l] * before[l] * lit[c];
    for (std::size_t l = 0; l < casting; ++l) {
      if (before[l] == 0 || (needed >> l & 1U) == 0) continue;
      const double off = taken[l][c] - share[l] * before[l] * lit[c];
      out.law += weight * (off * off + all_off * all_off) / 2;
    }
    // With its own shadow made up for, the colour must still be one: else its shadows are fainter.
    const double most = kWhite / std::max(out.brightest[c], lit[c]) - 1;
    const double scale = own_shadow > most ? most / own_shadow : 1;
    const double color = lit[c] * (1 + scale * own_shadow);
    for (std::size_t l = 0; l < casting; ++l) {
      const double by_all = color * lights_->points_of(l);
      const double importance = weight * (by_all * by_all);
      const std::size_t to = l * kChannels + static_cast<std::size_t>(c);
      const double value = scale * share[l] / (1 + scale * own_shadow);
      const double so_far = out.weights[to];
      if (importance > 0 && so_far > 0 && (needed >> l & 1U) != 0) {
        const double off = value - out.shares[to] / so_far;
        out.spread += importance * (so_far / (so_far + importance)) * (off * off);
      }
      out.shares[to] += importance * value;
      out.weights[to] += importance;
    }
  }
}

std::uint32_t LightTable::number(const FaceSide& side) const {
  const std::uint32_t number_known = known(side).number;
  if (middles_.empty()) return 0;
  if (number_known > 0 || !derived::has_table(*config_)) return std::max(number_known, 1U);
  return nearest(loss(side, FaceSurface(*frame_, side.polygon).outline()));
}

LightTable::Loss LightTable::loss_at(const FaceSide& side, const SurfacePoint& place) const {
  return middles_.empty() || !derived::has_table(*config_) ? Loss{} : loss(side, std::span(&place, 1));
}

std::uint32_t LightTable::nearest(const Loss& loss) const {
  return nearest_middle(middles_, numbers_, loss.shares.data(), loss.weights.data()) + 1;
}

double LightTable::error_of(const FaceSide& side, const Loss& l, std::uint32_t number) const {
  double most = 0;
  for (std::size_t d = 0; d < numbers_; ++d) {
    if ((known(side).needed >> (d / kChannels) & 1U) == 0) continue;
    const double off = l.shares[d] - middles_[(number - 1) * numbers_ + d];
    most = std::max(most, l.weights[d] * (off * off));
  }
  return std::sqrt(most);
}

glm::dvec3 LightTable::before_own_shadow(const FaceSide& side, std::uint32_t number) const {
  return own_shadow(side, number, entries_);
}

glm::dvec3 LightTable::about_own_shadow(const FaceSide& side, std::uint32_t number) const {
  return own_shadow(side, number, middles_);
}

glm::dvec3 LightTable::own_shadow(const FaceSide& side, std::uint32_t number, const std::vector<double>& shares) const {
  glm::dvec3 left{1, 1, 1};
  if (number == 0 || !shadows_itself(side)) return left;
  for (std::size_t l = 0; l < lights_->casting; ++l) {
    const int behind = side.count(*lights_, l, -1);
    for (std::size_t c = 0; c < kChannels; ++c)
      left[static_cast<int>(c)] -= behind * shares[(number - 1) * numbers_ + l * kChannels + c];
  }
  return 1.0 / glm::max(left, glm::dvec3(kLeastLeft));
}

void LightTable::put(FrameGeometry& out) const {
  const auto fixed = [this](double share) { return static_cast<std::uint32_t>(to_fixed(share, config_->shade_frac)); };
  if (!derived::has_table(*config_)) {
    if (!middles_.empty()) out.shade = fixed(entries_[0]);
    return;
  }
  for (std::size_t first = 0; first < middles_.size(); first += numbers_)
    for (std::size_t l = 0; l < static_cast<std::size_t>(config_->lights); ++l) {
      auto& entry = out.shares.emplace_back();
      if (l >= lights_->casting) continue;
      for (std::size_t c = 0; c < kChannels; ++c) entry[c] = fixed(entries_[first + l * kChannels + c]);
    }
}

}  // namespace kage
