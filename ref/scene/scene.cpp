// SPDX-License-Identifier: Apache-2.0
#include "kage/scene.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "animation.hpp"
#include "child.hpp"
#include "file/meant.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"
#include "mesh.hpp"
#include "notes.hpp"
#include "number/counted.hpp"
#include "raw_parts.hpp"
#include "view.hpp"

namespace kage {
namespace {

// Places further off than this many radii of the scene are far: see note_large_places().
constexpr double kFarPlace = 1 << 29;

constexpr int kDefaultFrames = 8;
constexpr int kPoses = 16;  // of an animation, to find its bounds

using scene::Affine;

// A mesh placed in the world by a node.
struct Object {
  std::uint32_t node;  // that places it: of a skin, the first joint
  std::uint32_t mesh;
  std::uint32_t carrier;  // the node that has the mesh
  std::int32_t skin;      // -1: none
};

/// Which of a list's entries frame `index` of `count` takes.
std::size_t share_of(int index, int count, std::size_t entries) {
  return static_cast<std::size_t>(index) * entries / static_cast<std::size_t>(count);
}

/// A mesh as its node places it.
scene::Moved placed(const Affine& world, const scene::Mesh& mesh) {
  scene::Moved out;
  for (const glm::dvec3& p : mesh.vertices) out.vertices.push_back(world.point(p));
  for (const ShadingVertex& s : mesh.shading)
    out.shading.push_back({scene::unit(world.normal(s.normal), s.normal), s.color});
  out.mirrored = world.determinant() < 0;
  return out;
}

void append(const scene::Moved& placed, const scene::Mesh& mesh, std::uint32_t object, SceneFrame& frame) {
  const bool mirrored = placed.mirrored;
  const auto vertex = static_cast<std::uint32_t>(frame.vertices.size());
  const auto shading = static_cast<std::uint32_t>(frame.shading.size());
  const auto triangle = static_cast<std::uint32_t>(frame.triangles.size());
  frame.vertices.insert(frame.vertices.end(), placed.vertices.begin(), placed.vertices.end());
  frame.shading.insert(frame.shading.end(), placed.shading.begin(), placed.shading.end());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    scene::Corners v = mesh.triangles[i];
    scene::Corners s = mesh.shading_corners[i];
    if (mirrored) {
      std::swap(v[1], v[2]);
      std::swap(s[1], s[2]);
    }
    frame.triangles.push_back({{vertex + v[0], vertex + v[1], vertex + v[2]},
                               {shading + s[0], shading + s[1], shading + s[2]},
                               object,
                               mesh.faces[i],
                               mesh.surfaces[i].alpha,
                               mesh.surfaces[i].unlit,
                               mesh.surfaces[i].sides});
  }
  const auto corner = static_cast<std::uint32_t>(frame.corners.size());
  for (const std::uint32_t v : mesh.corners) frame.corners.push_back(vertex + v);
  for (Polygon p : mesh.polygons) {
    p.first += corner;
    p.triangle += triangle;
    // As for triangles, the first corner stays.
    if (mirrored) std::reverse(frame.corners.begin() + p.first + 1, frame.corners.begin() + p.first + p.count);
    frame.polygons.push_back(p);
  }
}

}  // namespace

struct Scene::Data {
  std::string name;
  std::string place;    // of the file: messages open with it
  scene::RawScene raw;  // nodes and tracks; its meshes are empty once `meshes` is built
  std::vector<scene::Mesh> meshes;
  std::vector<Object> objects;
  std::vector<std::string> object_names;
  std::vector<Component> components;  // of all objects, as in every frame
  std::vector<std::string> notes;
  scene::WorkingFrame frame;  // of all frames; `bounds` are in it
  scene::Bounds bounds;
  double exposure = 1;
  std::vector<bool> dark;  // of the file's lights, those that reach nothing in any frame; empty if all may
  double end_time = 0;
  bool smooth = false;
  // Cameras and lights of a program's own scene, frame by frame; if empty, those of `raw`.
  std::vector<scene::RawCamera> cameras;
  std::vector<std::vector<scene::RawLight>> light_sets;

  void build(const std::function<void()>& wait);
  void build_meshes(const std::function<void()>& wait);
  void place_objects();
  void describe();
  /// Where an object is at a time, `world` being that of the nodes.
  [[nodiscard]] scene::Moved where(const Object& object, const std::vector<Affine>& world, double time) const;
  /// Vertices, or corners of boxes round objects, at some times of the animation.
  [[nodiscard]] std::vector<glm::dvec3> points() const;
  void measure();
  void note_large_places();
  /// Leaves lights out that reach nothing, but for the first where none reaches anything.
  void leave_dark_lights_out();
  [[nodiscard]] std::vector<Light> lights(const std::vector<Affine>& world, int index, int count) const;
  [[nodiscard]] const scene::RawCamera* camera(int index, int count) const;
  [[nodiscard]] double time(int index, int count) const {
    return raw.start_time + (end_time - raw.start_time) * index / count;
  }
};

void Scene::Data::build_meshes(const std::function<void()>& wait) {
  std::uint64_t budget = scene::kSceneBudget;
  std::size_t dropped = 0;
  std::size_t turned = 0;
  std::size_t inside_out = 0;
  std::size_t normals = 0;
  for (scene::RawMesh& mesh : raw.meshes) {
    if (wait) wait();
    meshes.push_back(scene::build_mesh(mesh, budget));
    mesh.primitives = {};
    const scene::Mesh& m = meshes.back();
    dropped += m.dropped;
    turned += m.turned;
    inside_out += m.inside_out;
    normals += m.bad_normals;
  }
  const auto note = [this](std::size_t count, const char* one, const char* many, const char* rest) {
    if (count > 0) notes.push_back(counted(count, one, many) + rest);
  };
  note(dropped, "triangle repeats", "triangles repeat", " a vertex: left out");
  note(turned, "triangle is", "triangles are", " turned to agree with the neighbours");
  note(inside_out, "closed part is", "closed parts are", " inside out: turned");
  note(normals, "corner has", "corners have", " a normal that is 0 or not finite: the face's is taken");
}

void Scene::Data::place_objects() {
  std::uint32_t vertices = 0;
  std::uint32_t triangles = 0;
  std::uint32_t polygons = 0;
  std::size_t flat = 0;
  for (std::uint32_t i = 0; i < raw.nodes.size(); ++i) {
    const scene::RawNode& node = raw.nodes[i];
    if (node.mesh < 0) continue;
    const auto number = static_cast<std::uint32_t>(node.mesh);
    const scene::Mesh& mesh = meshes[number];
    if (mesh.triangles.empty()) continue;
    const bool skinned = node.skin >= 0 && mesh.motion;
    const std::uint32_t at = skinned ? raw.skins[static_cast<std::size_t>(node.skin)].joints[0] : i;
    objects.push_back({at, number, i, skinned ? node.skin : -1});
    if (!mesh.has_area) ++flat;
    std::string called = scene::one_line(node.name.empty() ? raw.meshes[number].name : node.name, 80);
    object_names.push_back(called.empty() ? "object " + std::to_string(objects.size() - 1) : std::move(called));
    for (const scene::MeshComponent& c : mesh.components)
      components.push_back({triangles + c.first, c.count, c.closed, c.translucent, c.convex, polygons + c.first_polygon,
                            c.polygon_count, c.reason.text(vertices, triangles + c.first)});
    vertices += static_cast<std::uint32_t>(mesh.vertices.size());
    triangles += static_cast<std::uint32_t>(mesh.triangles.size());
    polygons += static_cast<std::uint32_t>(mesh.polygons.size());
    smooth = smooth || mesh.smooth;
  }
  if (objects.empty()) throw Error("no faces: every triangle repeats a vertex");
  if (flat == objects.size()) throw Error("no faces: no triangle has an area");
  if (flat > 0)
    notes.push_back(counted(flat, "object is", "objects are") + " not seen: none of its triangles has an area");
}

void Scene::Data::describe() {
  notes.insert(notes.begin(), raw.notes.begin(), raw.notes.end());
  if (!raw.camera) notes.emplace_back("no camera: an orbit round the scene is added");
  if (raw.lights.empty()) notes.emplace_back("no light: a directional one is added");
}

scene::Moved Scene::Data::where(const Object& object, const std::vector<Affine>& world, double time) const {
  const scene::Mesh& mesh = meshes[object.mesh];
  if (!mesh.motion) return placed(world[object.node], mesh);
  std::vector<Affine> bones{world[object.node]};
  if (object.skin >= 0) {
    const scene::RawSkin& skin = raw.skins[static_cast<std::size_t>(object.skin)];
    bones.clear();
    for (std::size_t k = 0; k < skin.joints.size(); ++k) bones.push_back(world[skin.joints[k]] * skin.inverse[k]);
  }
  return scene::moved(mesh, bones, scene::morph_weights(raw, object.carrier, time));
}

// The ball that holds all frames: what moves, by the corners of its box at a number of times.
std::vector<glm::dvec3> Scene::Data::points() const {
  std::vector<glm::dvec3> points;
  const int steps = raw.tracks.empty() ? 1 : kPoses;
  for (int step = 0; step < steps; ++step) {
    const std::vector<Affine> world = scene::pose(raw, time(step, steps), frame);
    for (const Object& object : objects) {
      const std::vector<glm::dvec3>& vertices = meshes[object.mesh].vertices;
      if (steps == 1 || meshes[object.mesh].motion) {
        const std::vector<glm::dvec3> now = where(object, world, time(step, steps)).vertices;
        points.insert(points.end(), now.begin(), now.end());
        continue;
      }
      SpaceBox box;
      for (const glm::dvec3& p : vertices) box.add(p);
      for (unsigned corner = 0; corner < 8; ++corner) points.push_back(world[object.node].point(box.corner(corner)));
    }
  }
  return points;
}

void Scene::Data::measure() {
  std::vector<glm::dvec3> all = points();
  const auto box = [&all] {
    SpaceBox b;
    for (const glm::dvec3& p : all) b.add(p);
    if (!is_finite(b.high - b.low)) throw Error("the scene is too large to be measured");
    return b;
  };
  // From far away a scene's size is rounded itself, so the origin comes first.
  frame.origin = scene::working_origin(box());
  if (frame.is_moved()) all = points();
  frame.exponent = scene::working_exponent(box());
  if (frame.exponent != 0) all = points();
  bounds = scene::bounds_of(all);
  if (!std::isfinite(bounds.radius) || !is_finite(bounds.center)) throw Error("the scene is too large to be measured");
  note_large_places();
}

// A node that is far away moves all that hangs on it alike, and loses nothing. Where objects hang on different far
// nodes, or a mesh lies far from its own origin, the objects' places to each other depend on the rounding of the file's
// numbers. It is noticeable where a double tells places apart by no less than 2^-23 of the scene, a subpixel of the
// widest picture.
void Scene::Data::note_large_places() {
  const std::vector<Affine> world = scene::pose(raw, time(0, 1), frame);
  std::vector<std::int32_t> hangs_on(raw.nodes.size(), -1);
  const auto here = [this](double v) { return frame.length(v); };
  for (std::size_t i = 0; i < raw.nodes.size(); ++i) {
    const scene::RawNode& n = raw.nodes[i];
    const auto parent = static_cast<std::size_t>(n.parent);
    const glm::dvec3 at = n.fixed ? n.matrix.origin : n.translation;
    const glm::dvec3 moved = n.parent < 0 ? glm::dvec3{here(at.x), here(at.y), here(at.z)} : world[parent].vector(at);
    const bool far = largest(moved) > bounds.radius * kFarPlace;
    hangs_on[i] = far ? static_cast<std::int32_t>(i) : n.parent < 0 ? -1 : hangs_on[parent];
  }
  const std::int32_t first = hangs_on[objects[0].node];
  bool same = !raw.camera || hangs_on[raw.camera->node] == first;
  for (const Object& object : objects) {
    // A mesh's own positions are in single precision, and one of them stands for all.
    const glm::dvec3 own = world[object.node].vector(meshes[object.mesh].vertices.front());
    same = same && hangs_on[object.node] == first && !(largest(own) > bounds.radius * kFarPlace);
  }
  if (!same)
    notes.emplace_back(
        "the scene is so far from the origin, for its size, that its file's numbers are noticeably rounded");
}

const scene::RawCamera* Scene::Data::camera(int index, int count) const {
  if (!cameras.empty()) return &cameras[share_of(index, count, cameras.size())];
  return raw.camera ? &*raw.camera : nullptr;
}

std::vector<Light> Scene::Data::lights(const std::vector<Affine>& world, int index, int count) const {
  const std::vector<scene::RawLight>& own =
      light_sets.empty() ? raw.lights : light_sets[share_of(index, count, light_sets.size())];
  if (own.empty()) return {scene::default_light()};
  std::vector<Light> all;
  for (const scene::RawLight& l : own) all.push_back(scene::file_light(l, world[l.node], frame));
  scene::relative_intensities(all, frame);
  for (std::size_t i = dark.size(); i-- > 0;)
    if (dark[i]) all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
  return all;
}

// A light takes a place in a table, or a pass of each line, whatever it gives. Where something moves, it may come
// within reach, so all lights stay.
void Scene::Data::leave_dark_lights_out() {
  if (!raw.tracks.empty() || light_sets.size() > 1) return;
  const std::vector<Light> all = lights(scene::pose(raw, time(0, 1), frame), 0, 1);
  std::vector<bool> found;
  for (const Light& l : all) found.push_back(!scene::may_reach(l, bounds));
  if (std::all_of(found.begin(), found.end(), [](bool d) { return d; })) found[0] = false;
  const auto count = static_cast<std::size_t>(std::count(found.begin(), found.end(), true));
  if (count == 0) return;
  dark = std::move(found);
  notes.push_back(counted(count, "light reaches", "lights reach") + " nothing: left out");
}

Scene Scene::load(const std::string& name_or_path, const SceneOptions& options) {
  namespace fs = std::filesystem;
  auto data = std::make_unique<Data>();
  const std::vector<std::string>& builtin = builtin_scenes();
  fs::path path = name_or_path;
  data->name = name_or_path;
  if (std::find(builtin.begin(), builtin.end(), name_or_path) != builtin.end())
    path = data_directory() / "scenes" / (name_or_path + ".gltf");
  else
    data->name = path.stem().string();
  data->place = scene::one_line(path.string(), 300);
  const std::string shown = data->place;
  std::error_code ec;
  if (path == name_or_path && fs::status(path, ec).type() == fs::file_type::not_found) {
    std::string names;
    for (const std::string& name : builtin) names += (names.empty() ? "" : ", ") + name;
    const std::string named = shown.empty() ? "'" + name_or_path + "'" : shown;  // a name of blanks is to be seen too
    throw Error(named + ": no such file, and no built-in scene of that name" + meant(shown, builtin) + " (there are " +
                names + ")");
  }
  data->raw = scene::import_in_child(path, shown, options.allow_outside, options.wait);
  data->raw.files.push_back(path.string());
  for (scene::RawMesh& mesh : data->raw.meshes)
    for (scene::RawPrimitive& p : mesh.primitives) p.alpha *= options.alpha;
  data->build(options.wait);
  Scene scene(std::move(data));
  if (options.wait) options.wait();
  (void)scene.frame(0, scene.frame_count());  // what cannot be drawn is to be refused here
  if (options.wait) options.wait();
  return scene;
}

Scene Scene::from(const SceneParts& parts) {
  auto data = std::make_unique<Data>();
  data->name = parts.name;
  data->place = scene::one_line(parts.name, 300);
  scene::RawParts raw = scene::raw_parts(parts);
  data->raw = std::move(raw.scene);
  data->cameras = std::move(raw.cameras);
  data->light_sets = std::move(raw.lights);
  data->build({});
  Scene scene(std::move(data));
  (void)scene.frame(0, scene.frame_count());  // what cannot be drawn is to be refused here
  return scene;
}

void Scene::Data::build(const std::function<void()>& wait) {
  try {
    end_time = scene::end_time(raw);
    std::set<std::uint32_t> moving;
    for (const scene::RawTrack& track : raw.tracks) moving.insert(track.node);
    raw.contents.moving = static_cast<std::uint32_t>(moving.size());
    build_meshes(wait);
    place_objects();
    describe();
    measure();
    exposure = scene::exposure(lights(scene::pose(raw, time(0, 1), frame), 0, 1), bounds);
    leave_dark_lights_out();
  } catch (const Error& e) {
    throw Error(place + ": " + e.what());
  }
}

Scene::Scene(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

int Scene::frame_count() const {
  if (data_->raw.frames > 0) return static_cast<int>(data_->raw.frames);
  return data_->raw.camera && data_->raw.tracks.empty() ? 1 : kDefaultFrames;
}

SceneFrame Scene::frame(int index, int count) const {
  const Data& d = *data_;
  if (index < 0 || index >= count)
    throw Error(d.place + ": frame " + std::to_string(index) + " of " + std::to_string(count) + ": there is none");
  const std::vector<Affine> world = scene::pose(d.raw, d.time(index, count), d.frame);
  SceneFrame frame;
  frame.origin = d.frame.origin;
  frame.exponent = d.frame.exponent;
  frame.components = d.components;
  std::size_t component = 0;
  for (std::uint32_t i = 0; i < d.objects.size(); ++i) {
    const Object& object = d.objects[i];
    const scene::Mesh& mesh = d.meshes[object.mesh];
    const std::size_t first = frame.vertices.size();
    append(d.where(object, world, d.time(index, count)), mesh, i, frame);
    for (std::size_t v = first; v < frame.vertices.size(); ++v)
      if (!is_finite(frame.vertices[v]))
        throw Error(d.place + ": object '" + d.object_names[i] + "' vertex " + std::to_string(v) +
                    ": position is not finite");
    const bool flattened = !mesh.motion && world[object.node].determinant() == 0;
    for (std::size_t k = 0; k < mesh.components.size(); ++k, ++component) {
      Component& c = frame.components[component];
      if (!flattened || !c.closed) continue;
      c.closed = false;
      c.convex = false;
      c.reason = "its node scales it to volume 0";
    }
  }
  const scene::RawCamera* const camera = d.camera(index, count);
  try {
    frame.camera = camera != nullptr ? scene::file_camera(*camera, world[camera->node], d.bounds, d.frame)
                                     : scene::orbit_camera(d.bounds, index, count);
  } catch (const Error& e) {
    const std::string node =
        camera != nullptr ? "node '" + scene::one_line(d.raw.nodes[camera->node].name, 60) + "': " : "";
    throw Error(d.place + ": " + node + e.what());
  }
  if (!is_finite(frame.camera.eye)) throw Error(d.place + ": the camera's position is not finite");
  frame.lights = d.lights(world, index, count);
  for (Light& l : frame.lights) {
    l.color *= d.exposure;
    if (!is_finite(l.position) || !is_finite(l.axis_u) || !is_finite(l.axis_v) || !is_finite(l.color))
      throw Error(d.place + ": a light's position, size or intensity is not finite");
  }
  return frame;
}

const std::vector<std::string>& Scene::objects() const { return data_->object_names; }
const SceneContents& Scene::contents() const { return data_->raw.contents; }
const std::vector<std::string>& Scene::files() const { return data_->raw.files; }
const std::vector<std::string>& Scene::notes() const { return data_->notes; }
bool Scene::needs_smooth() const { return data_->smooth; }
const std::string& Scene::name() const { return data_->name; }

const std::vector<std::string>& builtin_scenes() {
  static const std::vector<std::string> kNames{"courtyard",    "knot",    "inside",  "edges",
                                               "polyhedra",    "fifteen", "glass",   "penumbra",
                                               "three-lights", "canopy",  "cutaway", "depths"};
  return kNames;
}

}  // namespace kage
