// SPDX-License-Identifier: Apache-2.0
#include "animation.hpp"

#include <algorithm>
#include <array>
#include <iterator>

namespace kage::scene {
namespace {

Quaternion quaternion(const std::array<double, 4>& v) { return {v[0], v[1], v[2], v[3]}; }

std::array<double, 4> unit_rotation(const std::array<double, 4>& v) {
  const Quaternion q = normalized(quaternion(v));
  return {q.x, q.y, q.z, q.w};
}

/// Where a time lies among a track's keys.
struct Place {
  std::size_t key = 0;   // the last that has come, or the first
  bool between = false;  // it and the next one; else it alone counts
  double u = 0;          // from 0 at it to 1 at the next
  double span = 0;       // of time
};

Place place(const RawTrack& track, double time) {
  const auto next = std::upper_bound(track.times.begin(), track.times.end(), time);
  if (next == track.times.begin()) return {};
  Place p;
  p.key = static_cast<std::size_t>(std::distance(track.times.begin(), next)) - 1;
  const bool held = track.interpolation == RawInterpolation::kStep;
  if (next == track.times.end() || held || track.times[p.key] == time) return p;
  p.between = true;
  p.span = track.times[p.key + 1] - track.times[p.key];
  p.u = (time - track.times[p.key]) / p.span;
  return p;
}

// Part 0, 1 or 2 of a cubic key: in-tangent, value, out-tangent. Other keys have only the value.
double key(const RawTrack& track, std::size_t index, std::size_t part, std::size_t component) {
  const bool cubic = track.interpolation == RawInterpolation::kCubic;
  return track.values[(cubic ? 3 * index + part : index) * track.width() + component];
}

// Linear, or a Hermite spline, glTF 2.0 appendix C.
double value(const RawTrack& track, const Place& p, std::size_t component) {
  const double v0 = key(track, p.key, 1, component);
  if (!p.between) return v0;
  const double v1 = key(track, p.key + 1, 1, component);
  const double u = p.u;
  if (track.interpolation != RawInterpolation::kCubic) return v0 + (v1 - v0) * u;
  const double u2 = u * u;
  const double u3 = u2 * u;
  const double b0 = key(track, p.key, 2, component);
  const double a1 = key(track, p.key + 1, 0, component);
  return (2 * u3 - 3 * u2 + 1) * v0 + p.span * (u3 - 2 * u2 + u) * b0 + (3 * u2 - 2 * u3) * v1 +
         p.span * (u3 - u2) * a1;
}

}  // namespace

std::array<double, 4> sample(const RawTrack& track, double time) {
  const Place p = place(track, time);
  std::array<double, 4> v{};
  if (track.path == RawPath::kRotation && p.between && track.interpolation != RawInterpolation::kCubic) {
    std::array<double, 4> w{};
    for (std::size_t i = 0; i < 4; ++i) v[i] = key(track, p.key, 1, i), w[i] = key(track, p.key + 1, 1, i);
    const Quaternion q = slerp(quaternion(unit_rotation(v)), quaternion(unit_rotation(w)), p.u);
    return {q.x, q.y, q.z, q.w};
  }
  for (std::size_t i = 0; i < track.width(); ++i) v[i] = value(track, p, i);
  return track.path == RawPath::kRotation ? unit_rotation(v) : v;
}

std::vector<double> morph_weights(const RawScene& scene, std::uint32_t node, double time) {
  std::vector<double> weights = scene.nodes[node].weights;
  for (const RawTrack& track : scene.tracks) {
    if (track.node != node || track.path != RawPath::kWeights) continue;
    const Place p = place(track, time);
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = value(track, p, i);
  }
  return weights;
}

std::vector<Affine> pose(const RawScene& scene, double time, const WorkingFrame& frame) {
  struct Local {
    glm::dvec3 translation;
    Quaternion rotation;
    glm::dvec3 scale;
  };
  std::vector<Local> local;
  local.reserve(scene.nodes.size());
  for (const RawNode& n : scene.nodes) local.push_back({n.translation, n.rotation, n.scale});
  for (const RawTrack& track : scene.tracks) {
    if (track.path == RawPath::kWeights) continue;
    const std::array<double, 4> v = sample(track, time);
    Local& l = local[track.node];
    switch (track.path) {
      case RawPath::kTranslation:
        l.translation = {v[0], v[1], v[2]};
        break;
      case RawPath::kRotation:
        l.rotation = quaternion(v);
        break;
      case RawPath::kScale:
        l.scale = {v[0], v[1], v[2]};
        break;
      case RawPath::kWeights:  // not of a node's place
        break;
    }
  }
  std::vector<Affine> own;
  own.reserve(scene.nodes.size());
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const RawNode& n = scene.nodes[i];
    own.push_back(n.fixed ? n.matrix : compose(local[i].translation, local[i].rotation, local[i].scale));
  }
  return placed(scene, own, frame);
}

double end_time(const RawScene& scene) {
  double end = scene.start_time;
  for (const RawTrack& track : scene.tracks)
    if (!track.times.empty()) end = std::max(end, track.times.back());
  return end;
}

}  // namespace kage::scene
