// SPDX-License-Identifier: Apache-2.0
#include "scene/plugin/assimp_view.hpp"

#include <algorithm>
#include <cmath>

#include "kage/error.hpp"
#include "scene/functions.hpp"
#include "scene/notes.hpp"
#include "scene/plugin/assimp_values.hpp"
#include "scene/space.hpp"

namespace kage::scene::mesh_plugin {
namespace {

// Assimp's defaults for clip planes and shape of the picture, where the file says nothing.
constexpr double kAssimpNear = 0.1;
constexpr double kAssimpFar = 1000;
constexpr double kDefaultAspect = 4.0 / 3.0;

// Assimp's angles are those of the whole cone.
void read_cone(const aiLight& l, Light& light) {
  const double outer = std::clamp(static_cast<double>(l.mAngleOuterCone) / 2, 0.0, portable::kPi / 2);
  const double inner = std::clamp(static_cast<double>(l.mAngleInnerCone) / 2, 0.0, outer);
  if (!(outer > 0)) return;  // no cone is given
  light.spot = true;
  light.inner_cosine = portable::cos(inner);
  light.outer_cosine = portable::cos(outer);
}

void read_area(const aiLight& l, Light& light) {
  const glm::dvec3 up = unit(vec3(l.mUp), {0, 1, 0});
  const glm::dvec3 side = unit(cross(vec3(l.mDirection), up), {1, 0, 0});
  light.axis_u = side * (static_cast<double>(l.mSize.x) / 2);
  light.axis_v = up * (static_cast<double>(l.mSize.y) / 2);
  if (light.axis_u != glm::dvec3(0) && light.axis_v != glm::dvec3(0)) light.shape = LightShape::rectangle;
}

}  // namespace

std::size_t AssimpView::read_cameras() {
  std::size_t cameras = 0;
  for (unsigned i = 0; i < in_->mNumCameras; ++i) {
    if (in_->mCameras[i] == nullptr || ++cameras > 1) continue;
    const aiCamera& c = *in_->mCameras[i];
    RawCamera camera;
    camera.node = node_named(text(c.mName));
    camera.eye = vec3(c.mPosition);
    camera.forward = vec3(c.mLookAt);
    camera.up = vec3(c.mUp);
    camera.aspect = c.mAspect > 0 ? static_cast<double>(c.mAspect) : 0;
    const double aspect = camera.aspect > 0 ? camera.aspect : kDefaultAspect;
    camera.perspective = !(c.mOrthographicWidth > 0);
    if (camera.perspective) {
      // The importers store the whole horizontal angle, whatever the header says of half of it.
      const double angle = c.mHorizontalFOV;
      if (!(angle > 0 && angle < portable::kPi)) {
        scene_->notes.emplace_back("the camera's field of view is not between 0 and pi: the camera is ignored");
        continue;
      }
      camera.half_height = portable::tan(angle / 2) / aspect;
    } else {
      camera.half_height = static_cast<double>(c.mOrthographicWidth) / aspect;
    }
    const bool given =
        static_cast<float>(kAssimpNear) != c.mClipPlaneNear || static_cast<float>(kAssimpFar) != c.mClipPlaneFar;
    if (given && c.mClipPlaneNear > 0 && std::isfinite(c.mClipPlaneNear)) camera.near = c.mClipPlaneNear;
    if (given && c.mClipPlaneFar > c.mClipPlaneNear && std::isfinite(c.mClipPlaneFar)) camera.far = c.mClipPlaneFar;
    const glm::dvec3 right = cross(camera.forward, camera.up);
    if (!is_finite(right) || right == glm::dvec3{0, 0, 0} || !is_finite(camera.eye)) {
      scene_->notes.emplace_back("the camera has no direction: it is ignored");
      continue;
    }
    scene_->camera = camera;
  }
  return cameras;
}

void AssimpView::read_lights() {
  for (unsigned i = 0; i < in_->mNumLights; ++i) {
    if (in_->mLights[i] == nullptr) continue;
    const aiLight& l = *in_->mLights[i];
    const std::string name = one_line(text(l.mName), 60);
    if (l.mType == aiLightSource_AMBIENT || l.mType == aiLightSource_UNDEFINED) {
      scene_->notes.push_back("the light '" + name + "' is ambient or of no kind, and ignored");
      continue;
    }
    RawLight raw;
    raw.node = node_named(text(l.mName));
    Light& light = raw.light;
    light.directional = l.mType == aiLightSource_DIRECTIONAL;
    light.direction = vec3(l.mDirection);
    light.position = vec3(l.mPosition);
    light.color = rgb(l.mColorDiffuse);
    for (int c = 0; c < 3; ++c) light.color[c] = std::max(light.color[c], 0.0);
    if (l.mType == aiLightSource_SPOT) read_cone(l, light);
    if (l.mType == aiLightSource_AREA) read_area(l, light);
    if (!is_finite(light.direction) || !is_finite(light.position) || !is_finite(light.color) ||
        !is_finite(light.axis_u) || !is_finite(light.axis_v))
      throw Error(*file_ + ": light '" + name + "' is not finite");
    if (light.color == glm::dvec3(0)) {
      scene_->notes.push_back("the light '" + name + "' is black, and ignored");
      continue;
    }
    if (scene_->lights.size() == kMaxLights)
      throw Error(*file_ + ": there are more than " + std::to_string(kMaxLights) + " lights");
    scene_->lights.push_back(raw);
  }
}

}  // namespace kage::scene::mesh_plugin
