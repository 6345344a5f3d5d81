// SPDX-License-Identifier: Apache-2.0
//
// A frame by Embree on one thread: a primary ray a pixel, and a shadow ray from each lit face it meets. Rays go one by
// one or in packets of 8 or 16, whose pixels are a block.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <type_traits>

#include "bench/others/looks.hpp"
#include "oracle/embree_scene.hpp"

namespace kage::verif {

/// Embree's types and functions for a packet of N rays.
template <int N>
struct Packet {
  static constexpr int kAcross = 4;
  using Ray = std::conditional_t<N == 8, RTCRay8, RTCRay16>;
  using RayHit = std::conditional_t<N == 8, RTCRayHit8, RTCRayHit16>;
  using Valid = std::array<int, N>;  // -1: the ray is there

#if RTC_VERSION_MAJOR >= 4
  static void nearest(const Valid& valid, RTCScene scene, RayHit& hit) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    if constexpr (N == 8)
      rtcIntersect8(valid.data(), scene, &hit, &arguments);
    else
      rtcIntersect16(valid.data(), scene, &hit, &arguments);
  }
  static void blocked(const Valid& valid, RTCScene scene, Ray& ray) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    if constexpr (N == 8)
      rtcOccluded8(valid.data(), scene, &ray, &arguments);
    else
      rtcOccluded16(valid.data(), scene, &ray, &arguments);
  }
#else
  static RTCIntersectContext coherent() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
  }
  static void nearest(const Valid& valid, RTCScene scene, RayHit& hit) {
    RTCIntersectContext context = coherent();
    if constexpr (N == 8)
      rtcIntersect8(valid.data(), scene, &context, &hit);
    else
      rtcIntersect16(valid.data(), scene, &context, &hit);
  }
  static void blocked(const Valid& valid, RTCScene scene, Ray& ray) {
    RTCIntersectContext context = coherent();
    if constexpr (N == 8)
      rtcOccluded8(valid.data(), scene, &context, &ray);
    else
      rtcOccluded16(valid.data(), scene, &context, &ray);
  }
#endif
};

template <>
struct Packet<1> {
  static constexpr int kAcross = 1;
  struct Ray {  // an array of one ray looks like a packet
    std::array<float, 1> org_x{}, org_y{}, org_z{}, dir_x{}, dir_y{}, dir_z{}, tnear{}, tfar{}, time{};
    std::array<unsigned, 1> mask{}, id{}, flags{};
  };
  struct Hit {
    std::array<unsigned, 1> primID{}, geomID{};
  };
  struct RayHit {
    Ray ray;
    Hit hit;
  };
  using Valid = std::array<int, 1>;

  static RTCRay one(const Ray& r) {
    RTCRay s{};
    s.org_x = r.org_x[0];
    s.org_y = r.org_y[0];
    s.org_z = r.org_z[0];
    s.dir_x = r.dir_x[0];
    s.dir_y = r.dir_y[0];
    s.dir_z = r.dir_z[0];
    s.tnear = r.tnear[0];
    s.tfar = r.tfar[0];
    s.mask = ~0U;
    return s;
  }
  static void nearest(const Valid&, RTCScene scene, RayHit& hit) {
    RTCRayHit single{};
    single.ray = one(hit.ray);
    single.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, &single);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &single);
#endif
    hit.ray.tfar[0] = single.ray.tfar;
    hit.hit.primID[0] = single.hit.primID;
    hit.hit.geomID[0] = single.hit.geomID;
  }
  static void blocked(const Valid& valid, RTCScene scene, Ray& ray) {
    if (valid[0] == 0) return;
    RTCRay single = one(ray);
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(scene, &single);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &single);
#endif
    ray.tfar[0] = single.tfar;
  }
};

/// How a frame is traced.
struct TraceView {
  int width = 0;
  int height = 0;
  std::array<std::uint8_t, 3> background{};
  unsigned shade = 0;  ///< what a pixel loses in shadow, in 1/256
  float offset = 0;    ///< shadow rays begin so far from their surface
};

/// Fills a picture with a frame, whose first light is the one, packet by packet.
template <int N>
class Tracer {
 public:
  Tracer(const SceneFrame& f, const EmbreeScene& scene, Looks& looks, const TraceView& v)
      : camera_(f.camera), light_(f.lights[0]), scene_(scene), looks_(looks), v_(v) {}

  void run(Picture& out) {
    out.resize(static_cast<std::size_t>(v_.width) * static_cast<std::size_t>(v_.height) * 3);
    for (int y = 0; y < v_.height; y += kDown)
      for (int x = 0; x < v_.width; x += kAcross) {
        Block b;
        b.x = x;
        b.y = y;
        primary(b);
        P::nearest(b.valid, scene_.handle(), b.hit);
        if (secondary(b)) P::blocked(b.shadow, scene_.handle(), b.ray);
        paint(b, out);
      }
  }

 private:
  using P = Packet<N>;
  static constexpr int kAcross = P::kAcross;
  static constexpr int kDown = N / kAcross;

  /// The pixels of a packet, and their rays.
  struct Block {
    alignas(64) typename P::Valid valid{};
    alignas(64) typename P::RayHit hit;
    alignas(64) typename P::Valid shadow{};
    alignas(64) typename P::Ray ray;  // to the light
    std::array<FaceLook, N> seen;
    int x, y;  // of the first
  };

  /// Rays from the eye.
  void primary(Block& b) const {
    for (std::size_t i = 0; i < N; ++i) {
      const int x = b.x + static_cast<int>(i) % kAcross;
      const int y = b.y + static_cast<int>(i) / kAcross;
      b.valid[i] = x < v_.width && y < v_.height ? -1 : 0;
      const glm::vec3 across = corner_ + step_x_ * static_cast<float>(x) + step_y_ * static_cast<float>(y);
      const glm::vec3 origin = camera_.perspective ? eye_ : eye_ + across;
      const glm::vec3 direction = camera_.perspective ? forward_ + across : forward_;
      b.hit.ray.org_x[i] = origin.x;
      b.hit.ray.org_y[i] = origin.y;
      b.hit.ray.org_z[i] = origin.z;
      b.hit.ray.dir_x[i] = direction.x;
      b.hit.ray.dir_y[i] = direction.y;
      b.hit.ray.dir_z[i] = direction.z;
      b.hit.ray.tnear[i] = static_cast<float>(camera_.near);
      b.hit.ray.tfar[i] = INFINITY;
      b.hit.ray.time[i] = 0;
      b.hit.ray.mask[i] = ~0U;
      b.hit.ray.flags[i] = 0;
      b.hit.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
  }

  /// Takes the faces that the rays have met, and makes rays from there to the light. True if there is such a ray.
  bool secondary(Block& b) const {
    bool any = false;
    for (std::size_t i = 0; i < N; ++i) {
      b.seen[i].color = v_.background;
      if (b.valid[i] != 0 && b.hit.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID)
        b.seen[i] = looks_[scene_.polygon(b.hit.hit.primID[i])];
      b.shadow[i] = b.seen[i].lit ? -1 : 0;
      any |= b.seen[i].lit;
      const float t = b.seen[i].lit ? b.hit.ray.tfar[i] : 0;
      auto& ray = b.ray;
      ray.org_x[i] = b.hit.ray.org_x[i] + t * b.hit.ray.dir_x[i];
      ray.org_y[i] = b.hit.ray.org_y[i] + t * b.hit.ray.dir_y[i];
      ray.org_z[i] = b.hit.ray.org_z[i] + t * b.hit.ray.dir_z[i];
      ray.dir_x[i] = light_.directional ? sun_.x : lamp_.x - ray.org_x[i];
      ray.dir_y[i] = light_.directional ? sun_.y : lamp_.y - ray.org_y[i];
      ray.dir_z[i] = light_.directional ? sun_.z : lamp_.z - ray.org_z[i];
      const float squared = ray.dir_x[i] * ray.dir_x[i] + ray.dir_y[i] * ray.dir_y[i] + ray.dir_z[i] * ray.dir_z[i];
      ray.tnear[i] = light_.directional ? v_.offset : v_.offset / std::sqrt(squared);
      ray.tfar[i] = light_.directional ? INFINITY : 1;
      ray.time[i] = 0;
      ray.mask[i] = ~0U;
      ray.flags[i] = 0;
    }
    return any;
  }

  void paint(const Block& b, Picture& out) const {
    for (std::size_t i = 0; i < N; ++i) {
      if (b.valid[i] == 0) continue;
      const auto x = static_cast<std::size_t>(b.x) + i % kAcross;
      const auto y = static_cast<std::size_t>(b.y) + i / kAcross;
      std::uint8_t* pixel = &out[3 * (y * static_cast<std::size_t>(v_.width) + x)];
      const unsigned keep = b.shadow[i] != 0 && b.ray.tfar[i] < 0 ? 256 - v_.shade : 256;
      for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>((b.seen[i].color[c] * keep + 128) >> 8U);
    }
  }

  const Camera& camera_;
  const Light& light_;
  const EmbreeScene& scene_;
  Looks& looks_;
  const TraceView v_;
  const double unit_ = 2 * camera_.half_height / v_.height;
  const glm::vec3 step_x_{camera_.right * unit_};
  const glm::vec3 step_y_{-camera_.up * unit_};
  const glm::vec3 corner_{camera_.right * ((0.5 - v_.width / 2.0) * unit_) +
                          camera_.up * ((v_.height / 2.0 - 0.5) * unit_)};  // of the upper left pixel's centre
  const glm::vec3 eye_{camera_.eye};
  const glm::vec3 forward_{camera_.forward};
  const glm::vec3 sun_{-light_.direction};
  const glm::vec3 lamp_{light_.position};
};

}  // namespace kage::verif
