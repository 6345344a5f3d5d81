// SPDX-License-Identifier: Apache-2.0
//
// A frame by OpenGL's stencil shadow volumes, on Mesa's llvmpipe: no window, one thread, the pixels read back.
#pragma once

#include <memory>
#include <string>

#include "bench/others/looks.hpp"
#include "shadow/volumes.hpp"

namespace kage::verif {

/// Volumes that a pixel's stencil counts. With depth_fail those that end behind the surface: this is right wherever the
/// eye is, but needs both caps. With depth_pass those that begin before the surface: this needs the sides alone, but an
/// eye in no shadow.
enum class StencilWay { depth_fail, depth_pass };

/// A frame's triangles, in single precision and world space. To be used again, so that its memory is kept.
struct StencilMesh {
  std::vector<std::array<float, 3>> corners;        ///< of drawn faces, each with its own
  std::vector<std::array<std::uint8_t, 4>> colors;  ///< of corners; the last: what a pixel loses in shadow, in 1/255
  std::vector<std::uint32_t> faces;
  std::vector<std::array<float, 3>> places;  ///< the frame's vertices and their far points
  std::vector<std::uint32_t> volumes;
};

/// The faces to draw: all but those of closed components that are turned away from the eye.
void add_faces(const SceneFrame& f, Looks& looks, double darkening, StencilMesh& out);

/// The volumes of the light's casters. One volume holds all casters where no ray of light meets more than 255.
void add_volumes(const SceneFrame& f, const ShadowCaster& caster, StencilWay way, StencilMesh& out);

class StencilRenderer {
 public:
  /// Throws std::runtime_error where there is no EGL without window, no OpenGL 3.3, or another driver than llvmpipe.
  StencilRenderer(int width, int height);
  ~StencilRenderer();
  StencilRenderer(const StencilRenderer&) = delete;
  StencilRenderer& operator=(const StencilRenderer&) = delete;

  /// Driver and version.
  [[nodiscard]] std::string name() const;

  /// Hand the mesh over to OpenGL.
  void upload(const StencilMesh& mesh);

  /// Draw what was handed over, with depth from the camera's near plane to `far`, and read the pixels: four bytes each,
  /// lines from top to bottom.
  void draw(const Camera& camera, double far, const std::array<std::uint8_t, 3>& background, StencilWay way,
            std::vector<std::uint8_t>& out);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace kage::verif
