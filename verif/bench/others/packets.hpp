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
#include "opinion/embree_scene.hpp"

namespace kage::verif {

/// What Embree calls the rays of a packet of N.
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

/// Fill `out` with the frame, whose first light is the one.
template <int N>
void trace(const SceneFrame& f, const EmbreeScene& scene, Looks& looks, const TraceView& v, Picture& out) {
  using P = Packet<N>;
  constexpr int kAcross = P::kAcross;
  constexpr int kDown = N / kAcross;
  const Camera& camera = f.camera;
  const Light& light = f.lights[0];
  const double unit = 2 * camera.half_height / v.height;
  const glm::vec3 step_x(camera.right * unit);
  const glm::vec3 step_y(-camera.up * unit);
  const glm::vec3 corner(camera.right * ((0.5 - v.width / 2.0) * unit) +
                         camera.up * ((v.height / 2.0 - 0.5) * unit));  // of the upper left pixel's centre
  const glm::vec3 eye(camera.eye);
  const glm::vec3 forward(camera.forward);
  const glm::vec3 sun(-light.direction);
  const glm::vec3 lamp(light.position);
  out.resize(static_cast<std::size_t>(v.width) * static_cast<std::size_t>(v.height) * 3);
  for (int y0 = 0; y0 < v.height; y0 += kDown)
    for (int x0 = 0; x0 < v.width; x0 += kAcross) {
      alignas(64) typename P::Valid valid{};
      alignas(64) typename P::RayHit hit;
      for (std::size_t i = 0; i < N; ++i) {
        const int x = x0 + static_cast<int>(i) % kAcross;
        const int y = y0 + static_cast<int>(i) / kAcross;
        valid[i] = x < v.width && y < v.height ? -1 : 0;
        const glm::vec3 across = corner + step_x * static_cast<float>(x) + step_y * static_cast<float>(y);
        const glm::vec3 origin = camera.perspective ? eye : eye + across;
        const glm::vec3 direction = camera.perspective ? forward + across : forward;
        hit.ray.org_x[i] = origin.x;
        hit.ray.org_y[i] = origin.y;
        hit.ray.org_z[i] = origin.z;
        hit.ray.dir_x[i] = direction.x;
        hit.ray.dir_y[i] = direction.y;
        hit.ray.dir_z[i] = direction.z;
        hit.ray.tnear[i] = static_cast<float>(camera.near);
        hit.ray.tfar[i] = INFINITY;
        hit.ray.time[i] = 0;
        hit.ray.mask[i] = ~0U;
        hit.ray.flags[i] = 0;
        hit.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      }
      P::nearest(valid, scene.handle(), hit);
      alignas(64) typename P::Valid shadow{};
      alignas(64) typename P::Ray ray;
      std::array<FaceLook, N> seen;
      bool any = false;
      for (std::size_t i = 0; i < N; ++i) {
        seen[i].color = v.background;
        if (valid[i] != 0 && hit.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID)
          seen[i] = looks[scene.polygon(hit.hit.primID[i])];
        shadow[i] = seen[i].lit ? -1 : 0;
        any |= seen[i].lit;
        const float t = seen[i].lit ? hit.ray.tfar[i] : 0;
        ray.org_x[i] = hit.ray.org_x[i] + t * hit.ray.dir_x[i];
        ray.org_y[i] = hit.ray.org_y[i] + t * hit.ray.dir_y[i];
        ray.org_z[i] = hit.ray.org_z[i] + t * hit.ray.dir_z[i];
        ray.dir_x[i] = light.directional ? sun.x : lamp.x - ray.org_x[i];
        ray.dir_y[i] = light.directional ? sun.y : lamp.y - ray.org_y[i];
        ray.dir_z[i] = light.directional ? sun.z : lamp.z - ray.org_z[i];
        ray.tnear[i] = light.directional
                           ? v.offset
                           : v.offset / std::sqrt(ray.dir_x[i] * ray.dir_x[i] + ray.dir_y[i] * ray.dir_y[i] +
                                                  ray.dir_z[i] * ray.dir_z[i]);
        ray.tfar[i] = light.directional ? INFINITY : 1;
        ray.time[i] = 0;
        ray.mask[i] = ~0U;
        ray.flags[i] = 0;
      }
      if (any) P::blocked(shadow, scene.handle(), ray);
      for (std::size_t i = 0; i < N; ++i) {
        if (valid[i] == 0) continue;
        const auto x = static_cast<std::size_t>(x0) + i % kAcross;
        const auto y = static_cast<std::size_t>(y0) + i / kAcross;
        std::uint8_t* pixel = &out[3 * (y * static_cast<std::size_t>(v.width) + x)];
        const unsigned keep = shadow[i] != 0 && ray.tfar[i] < 0 ? 256 - v.shade : 256;
        for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>((seen[i].color[c] * keep + 128) >> 8U);
      }
    }
}

}  // namespace kage::verif
