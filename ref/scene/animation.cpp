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

// Part 0, 1 or 2 of a cubic key: in-tangent, value, out-tangent. Other keys have only the value.
std::array<double, 4> key(const RawTrack& track, std::size_t index, std::size_t part) {
  const std::size_t width = track.width();
  const bool cubic = track.interpolation == RawInterpolation::kCubic;
  const std::size_t at = (cubic ? 3 * index + part : index) * width;
  std::array<double, 4> v{};
  for (std::size_t i = 0; i < width; ++i) v[i] = track.values[at + i];
  return v;
}

// Hermite spline, glTF 2.0 appendix C.
std::array<double, 4> cubic(const RawTrack& track, std::size_t index, double u, double span) {
  const double u2 = u * u;
  const double u3 = u2 * u;
  const std::array<double, 4> v0 = key(track, index, 1);
  const std::array<double, 4> b0 = key(track, index, 2);
  const std::array<double, 4> a1 = key(track, index + 1, 0);
  const std::array<double, 4> v1 = key(track, index + 1, 1);
  std::array<double, 4> v{};
  for (std::size_t i = 0; i < 4; ++i)
    v[i] = (2 * u3 - 3 * u2 + 1) * v0[i] + span * (u3 - 2 * u2 + u) * b0[i] + (3 * u2 - 2 * u3) * v1[i] +
           span * (u3 - u2) * a1[i];
  return v;
}

}  // namespace

std::array<double, 4> sample(const RawTrack& track, double time) {
  const bool rotation = track.path == RawPath::kRotation;
  const auto finish = [rotation](const std::array<double, 4>& v) { return rotation ? unit_rotation(v) : v; };
  const auto next = std::upper_bound(track.times.begin(), track.times.end(), time);
  const bool held = track.interpolation == RawInterpolation::kStep;
  if (next == track.times.begin()) return finish(key(track, 0, 1));
  const auto index = static_cast<std::size_t>(std::distance(track.times.begin(), next)) - 1;
  if (next == track.times.end() || held || track.times[index] == time) return finish(key(track, index, 1));
  const double span = track.times[index + 1] - track.times[index];
  const double u = (time - track.times[index]) / span;
  if (track.interpolation == RawInterpolation::kCubic) return finish(cubic(track, index, u, span));
  const std::array<double, 4> a = finish(key(track, index, 1));
  const std::array<double, 4> b = finish(key(track, index + 1, 1));
  if (rotation) {
    const Quaternion q = slerp(quaternion(a), quaternion(b), u);
    return {q.x, q.y, q.z, q.w};
  }
  std::array<double, 4> v{};
  for (std::size_t i = 0; i < 4; ++i) v[i] = a[i] + (b[i] - a[i]) * u;
  return v;
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
