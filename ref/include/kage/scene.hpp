// SPDX-License-Identifier: Apache-2.0

/// @file
/// Scenes: what is to be drawn, in floating point and in world space, frame by frame.
///
/// Units and conventions, for all of this header: right-handed coordinates, lengths in the file's unit, angles in
/// radians. All numbers are finite; a file with others is refused. Colours are linear, 0 .. 1. A Scene does not change
/// once loaded, and any number of threads may call frame() at once.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace kage {

/// A camera: an orthonormal frame at `eye`. The view ray of a pixel leaves `eye` (perspective) or a point of the plane
/// through it (parallel) towards `forward`.
struct Camera {
  glm::dvec3 eye{0, 0, 0};       ///< where it is, or the middle of the plane that parallel rays leave
  glm::dvec3 right{1, 0, 0};     ///< unit, to the right of the picture
  glm::dvec3 up{0, 1, 0};        ///< unit, to its top
  glm::dvec3 forward{0, 0, -1};  ///< unit, into it
  bool perspective = true;       ///< else parallel
  double half_height = 0.5;  ///< perspective: tan(vertical field of view / 2); parallel: half the height of the view
  double near = 0.1;         ///< distance of the near plane along forward, > 0
  double far = 0;            ///< distance of the far plane, > near; 0: not given. Geometry cuts nothing there
  double aspect = 0;         ///< width over height of the file's own pictures; 0: not given. The picture's shape counts
};

/// A point that light comes from, or, at infinity, a direction: what casts one set of shadows.
struct LightPoint {
  bool directional = true;         ///< at infinity
  glm::dvec3 direction{0, -1, 0};  ///< directional: unit vector the light travels along
  glm::dvec3 position{0, 0, 0};    ///< else
};

/// The extent of a light that is no point: the disc or rectangle that two half axes span, or a ball.
enum class LightShape : std::uint8_t {
  point,      ///< nothing: hard shadows
  disc,       ///< an ellipse round `position`, with the half axes
  rectangle,  ///< a parallelogram round `position`, with the half axes
  sphere,     ///< a ball round `position`
};

/// A light. Fall-off and cone are those of glTF's KHR_lights_punctual. An area light shines from the points
/// that stand for it (light_points()), and from its middle where a configuration has no counter for its shadows.
struct Light : LightPoint {
  glm::dvec3 color{1, 1, 1};  ///< >= 0, times intensity; a scene's lights are scaled by one factor (Scene::load)
  bool falls_off = false;     ///< not directional: with the square of the distance; `color` is that at distance 1
  double range = 0;           ///< falls_off: distance from which on it does not shine; 0: none
  bool spot = false;          ///< not directional: it shines within a cone round `direction`
  double inner_cosine = 1;    ///< spot: cosine of the angle up to which it is full
  double outer_cosine = 0;    ///< spot: cosine of the angle from which on it is 0
  LightShape shape = LightShape::point;  ///< what it extends over
  glm::dvec3 axis_u{0, 0, 0};            ///< disc, rectangle: half axes; sphere: its radius in x
  glm::dvec3 axis_v{0, 0, 0};            ///< disc, rectangle: the other one
};

/// Most lights of a scene.
inline constexpr std::size_t kMaxLights = 64;

/// Which sides of a triangle its material shows, as it is numbered here: `back` where the file's winding was turned.
enum class Sides : std::uint8_t {
  both,   ///< it is double-sided
  front,  ///< only where its corners are seen counter-clockwise
  back,   ///< only where they are seen clockwise
};

/// A triangle, counter-clockwise seen from outside.
struct Triangle {
  std::array<std::uint32_t, 3> vertex{};   ///< into SceneFrame::vertices
  std::array<std::uint32_t, 3> shading{};  ///< into SceneFrame::shading
  std::uint32_t object = 0;                ///< into Scene::objects()
  std::uint32_t face = 0;                  ///< number of the face within its object, as in the file
  std::uint8_t alpha = 255;                ///< 255 is opaque, 0 not to be seen
  bool unlit = false;                      ///< it shows its colour whatever light or shadow falls on it
  Sides sides = Sides::both;               ///< all are drawn unless Look::cull is set
};

/// A face as it is drawn, counter-clockwise seen from outside: a triangle, or, of convex bodies, triangles in one plane
/// that look the same, put together again.
struct Polygon {
  std::uint32_t first = 0;     ///< of its corners, into SceneFrame::corners
  std::uint32_t count = 0;     ///< at least 3
  std::uint32_t triangle = 0;  ///< the largest of its triangles, which has its plane and its shading
};

/// The data that shading needs at a corner of a triangle.
struct ShadingVertex {
  glm::dvec3 normal;  ///< unit, outward; the face's normal where the file has none
  glm::dvec3 color;   ///< base colour times vertex colour
};

/// A maximal set of triangles joined by shared edges, within one object, all of them opaque or all translucent.
struct Component {
  std::uint32_t first = 0;  ///< first of its triangles; they are consecutive in SceneFrame::triangles
  std::uint32_t count = 0;  ///< of its triangles
  /// Every edge is shared by exactly two triangles, in opposite directions, and the volume is not 0.
  bool closed = false;
  bool translucent = false;  ///< its triangles have alpha < 255: they are drawn last, cast no shadow and take none
  bool convex = false;       ///< closed, and no vertex is further than the stated tolerance outside a face's plane
  std::uint32_t first_polygon = 0;  ///< its polygons are consecutive in SceneFrame::polygons
  std::uint32_t polygon_count = 0;  ///< of its polygons
  std::string reason;  ///< why it is not closed or not convex, naming the edge or vertex; empty if it is both
};

/// One frame of a scene: all that geometry needs.
/// Vertices are welded: corners at the same position in the same object share an index, so neighbours share
/// coordinates. Triangles of inside-out closed components are turned so that they face outward.
struct SceneFrame {
  Camera camera;                                      ///< what the frame is seen by
  std::vector<Light> lights = std::vector<Light>(1);  ///< 1 to kMaxLights
  std::vector<glm::dvec3> vertices;                   ///< in world space, like all lengths and places of the frame
  std::vector<ShadingVertex> shading;                 ///< what triangles look like at their corners
  /// In draw order: objects in the file's order, components in order of their first face.
  std::vector<Triangle> triangles;
  std::vector<Polygon> polygons;       ///< the same surface, in the same order
  std::vector<std::uint32_t> corners;  ///< of polygons, into vertices
  std::vector<Component> components;   ///< in the order of their triangles; every triangle and polygon belongs to one
  /// Where the frame's world lies in the file's: a point p of this frame is origin + 2^exponent p there. 0 and 0, but
  /// for scenes far from their file's origin or in a unit so small or large that doubles would lose them; the same in
  /// all frames of a scene. Geometry does not look at it.
  glm::dvec3 origin{0, 0, 0};
  int exponent = 0;  ///< see `origin`

  /// A polygon's corners.
  /// @param p one of `polygons`
  /// @return into `vertices`, counter-clockwise seen from outside
  [[nodiscard]] std::span<const std::uint32_t> outline(const Polygon& p) const {
    return std::span(corners).subspan(p.first, p.count);
  }
};

/// Counts of the parts of a file that are used.
struct SceneContents {
  std::uint32_t materials = 0;     ///< that faces have
  std::uint32_t translucent = 0;   ///< of these, with alpha below 1
  std::uint32_t unlit = 0;         ///< of these, that light does not touch
  std::uint32_t single_sided = 0;  ///< of these, to be seen from one side only
  bool says_sides = false;         ///< the file tells single-sided from double-sided
  std::uint32_t cameras = 0;       ///< of which the first is used
  std::uint32_t lights = 0;        ///< that are used
  std::uint32_t animations = 0;    ///< of which the first is played
  std::uint32_t moving = 0;        ///< nodes that it moves
};

/// How a scene is loaded.
struct SceneOptions {
  double alpha = 1;  ///< 0 < alpha <= 1, multiplies that of every material: below 1 all of the scene is translucent
  bool allow_outside = false;  ///< files that the scene's file names (buffers, materials) may lie outside its folder
  /// Called several times a second while the file is imported, and between the steps that follow; what it throws ends
  /// that and is thrown on.
  std::function<void()> wait = {};
};

/// How faces of a program's own scene look.
struct Material {
  glm::dvec3 color{1, 1, 1};  ///< 0 .. 1
  double alpha = 1;           ///< 0 < alpha <= 1; below 1 they are translucent
  bool unlit = false;         ///< they show their colour whatever light or shadow falls on them
  bool double_sided = true;   ///< both sides are meant to be seen: Triangle::sides
};

/// An object of a program's own scene: triangles, counter-clockwise seen from outside. Positions are single precision,
/// as in files.
struct SceneObject {
  std::string name;                                     ///< for messages
  std::vector<glm::vec3> positions;                     ///< of its vertices, in world space
  std::vector<glm::vec3> normals;                       ///< of as many vertices, or none: the faces' are taken
  std::vector<glm::vec3> colors;                        ///< of as many vertices, 0 .. 1, times the material's; or none
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< into `positions`
  std::vector<std::uint32_t> materials;  ///< of as many triangles, into SceneParts::materials; or none: the first
};

/// A scene that a program makes, as a file would hold it.
struct SceneParts {
  std::string name = "scene";        ///< pictures are called by it
  std::vector<SceneObject> objects;  ///< at least one triangle in all
  std::vector<Material> materials;   ///< none: white
  /// One for all frames, or one for each; none: an orbit round the scene. Camera::right is made anew.
  std::vector<Camera> cameras;
  /// One set for all frames, or one for each, of at most kMaxLights lights; none: a directional light. One set
  /// for all loses lights that reach nothing: black ones, and those whose range or cone ends before the scene.
  std::vector<std::vector<Light>> lights;
};

/// A scene, loaded from a file or made of a program's parts.
class Scene {
 public:
  /// Loads a file (glTF 2.0, OBJ, PLY, STL, OFF, or what else Assimp reads), or a built-in scene. Throws Error that
  /// names file, place and cause. The file is read by a process of its own, kage-import, which is installed beside
  /// kage's plugins, with limits of time and memory; its death is an Error like any other. Several threads may load at
  /// once, whatever others do. Intensities of lights are scaled by one factor, the same in all frames. With it, light
  /// that meets a surface head-on from all of them adds up to 1 in the largest channel. That sum is taken at the middle
  /// of the scene, in the first frame, cones and ranges aside.
  /// @param name_or_path a name of builtin_scenes(), or a file
  /// @param options how it is loaded
  /// @return the scene, which does not change any more
  static Scene load(const std::string& name_or_path, const SceneOptions& options = {});

  /// Makes a scene of parts, as load() makes one of a file: corners are welded, bodies found, lights scaled. No process
  /// is started. Throws Error that names object and place where the parts are no scene.
  /// @param parts what it consists of
  /// @return the scene. Where cameras or lights change, it has as many frames as they have sets; of another number of
  ///         frames each takes the set at its share of the way.
  static Scene from(const SceneParts& parts);

  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// @return frames of the scene's own camera path or animation, at least 1
  [[nodiscard]] int frame_count() const;

  /// A frame of so many equal steps through the animation (or the orbit, where the file has no camera). Throws Error if
  /// there is no such frame, or a number in it is not finite.
  /// @param index 0 .. count - 1
  /// @param count at least 1
  /// @return all that geometry needs
  [[nodiscard]] SceneFrame frame(int index, int count) const;

  /// @return the names of the objects, as the file has them
  [[nodiscard]] const std::vector<std::string>& objects() const;

  /// @return what the file holds that kage does not draw, and what was added: one sentence each ("2 textures are
  /// ignored")
  [[nodiscard]] const std::vector<std::string>& notes() const;

  /// @return what of the file is used
  [[nodiscard]] const SceneContents& contents() const;

  /// @return the scene's file, and the files that it names and that are there, as a library of materials
  [[nodiscard]] const std::vector<std::string>& files() const;

  /// @return whether corners of some triangle differ in shading, so that colour varies within it
  [[nodiscard]] bool needs_smooth() const;

  /// @return that of the built-in scene, or the file's without folder and extension
  [[nodiscard]] const std::string& name() const;

 private:
  struct Data;
  explicit Scene(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

/// The scenes of the folder scenes/.
/// @return the names of the built-in scenes
const std::vector<std::string>& builtin_scenes();

}  // namespace kage
