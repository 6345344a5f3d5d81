// SPDX-License-Identifier: Apache-2.0
//
// A scene's frame for Embree: a ray tracer that many renderers trust, in single precision. Its version 3 and 4.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cmath>
#include <cstddef>
#include <glm/vec3.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "kage/scene.hpp"
#include "oracle/ray_truth.hpp"

namespace kage::verif {

/// Purpose of a scene for Embree: to be right, or to be fast. Only for truth, a ray's own face and translucent faces
/// are left out (nearest(), blocked()).
enum class EmbreeUse { truth, speed };

class EmbreeScene {
 public:
  explicit EmbreeScene(const SceneFrame& f, EmbreeUse use = EmbreeUse::truth)
      : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    if (use == EmbreeUse::truth) rtcSetSceneFlags(scene_, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | kFilter));
    std::size_t triangles = 0;
    for (const Polygon& p : f.polygons) triangles += p.count - 2;
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), f.vertices.size()));
    auto* corners = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles));
    for (const glm::dvec3& v : f.vertices)
      for (int i = 0; i < 3; ++i) *vertices++ = static_cast<float>(v[i]);
    for (std::uint32_t p = 0; p < f.polygons.size(); ++p) {
      opaque_.push_back(f.triangles[f.polygons[p].triangle].alpha == 255);
      const auto outline = f.outline(f.polygons[p]);
      for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
        polygon_.push_back(p);
        *corners++ = outline[0];
        *corners++ = outline[i];
        *corners++ = outline[i + 1];
      }
    }
    rtcSetGeometryUserData(geometry, this);
    if (use == EmbreeUse::truth) rtcSetGeometryOccludedFilterFunction(geometry, pass);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree does not take the scene");
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// For rays of the caller's own; no longer than this object.
  [[nodiscard]] RTCScene handle() const { return scene_; }

  /// The polygon, of SceneFrame::polygons, that Embree's triangle is part of.
  [[nodiscard]] std::uint32_t polygon(std::uint32_t triangle) const { return polygon_[triangle]; }

  /// As RayScene::nearest().
  [[nodiscard]] std::pair<double, std::uint32_t> nearest(const glm::dvec3& origin, const glm::dvec3& direction,
                                                         double least) const {
    RTCRayHit hit{};
    hit.ray = ray(origin, direction, static_cast<float>(least), INFINITY);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene_, &hit);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &hit);
#endif
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {INFINITY, kNothing};
    return {static_cast<double>(hit.ray.tfar), polygon_[hit.hit.primID]};
  }

  /// As RayScene::blocked().
  [[nodiscard]] bool blocked(const glm::dvec3& origin, const glm::dvec3& direction, double reach,
                             std::uint32_t own) const {
    RTCRay shadow = ray(origin, direction, 0, static_cast<float>(reach));
    Context context;
    context.own = own;
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&context.embree);
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context.embree;
    rtcOccluded1(scene_, &shadow, &arguments);
#else
    rtcInitIntersectContext(&context.embree);
    rtcOccluded1(scene_, &context.embree, &shadow);
#endif
    return shadow.tfar < 0;
  }

 private:
#if RTC_VERSION_MAJOR >= 4
  static constexpr int kFilter = 0;
  struct Context {
    RTCRayQueryContext embree;
    std::uint32_t own = 0;
  };
#else
  static constexpr int kFilter = RTC_SCENE_FLAG_NONE;
  struct Context {
    RTCIntersectContext embree;
    std::uint32_t own = 0;
  };
#endif

  // The face itself and translucent faces cast no shadow.
  static void pass(const RTCFilterFunctionNArguments* a) {
    const auto* self = static_cast<const EmbreeScene*>(a->geometryUserPtr);
    const auto* context = reinterpret_cast<const Context*>(a->context);  // begins with Embree's own
    const std::uint32_t face = self->polygon_[RTCHitN_primID(a->hit, a->N, 0)];
    if (face == context->own || !self->opaque_[face]) a->valid[0] = 0;
  }

  static RTCRay ray(const glm::dvec3& origin, const glm::dvec3& direction, float from, float to) {
    RTCRay r{};
    r.org_x = static_cast<float>(origin.x);
    r.org_y = static_cast<float>(origin.y);
    r.org_z = static_cast<float>(origin.z);
    r.dir_x = static_cast<float>(direction.x);
    r.dir_y = static_cast<float>(direction.y);
    r.dir_z = static_cast<float>(direction.z);
    r.tnear = from;
    r.tfar = to;
    r.mask = ~0U;
    return r;
  }

  RTCDevice device_;
  RTCScene scene_;
  std::vector<std::uint32_t> polygon_;  // by triangle
  std::vector<bool> opaque_;            // by polygon
};

}  // namespace kage::verif
