// SPDX-License-Identifier: Apache-2.0
//
// glTF 2.0 into a RawScene. kage reads it itself, and numbers go from the file into the scene untouched. Assimp
// computes with them (matrices and fields of view in float, by libm), and its results differ between its versions.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "functions.hpp"
#include "gltf_animation.hpp"
#include "gltf_file.hpp"
#include "gltf_lights.hpp"
#include "gltf_meshes.hpp"
#include "gltf_notes.hpp"
#include "gltf_skins.hpp"
#include "import.hpp"
#include "notes.hpp"
#include "number/counted.hpp"

namespace kage::scene {
namespace {

using Json = GltfJson::Json;

// Files have floats, and programs that write them compute in floats too.
constexpr double kUnitTolerance = 1e-3;

class Importer {
 public:
  explicit Importer(GltfFile file) : file_(std::move(file)) {}

  RawScene run() {
    refuse_required(file_);
    read_frames();
    walk_nodes();
    skins_.read(node_of_);
    animation_.read(node_of_);
    skins_.drop_unmoved();
    count_contents();
    write_notes();
    scene_.files = file_.files();
    return std::move(scene_);
  }

 private:
  struct Waiting {
    std::uint64_t node;
    std::int32_t parent;
    bool hidden;
  };

  void read_frames();
  void walk_nodes();
  [[nodiscard]] std::vector<std::uint64_t> roots() const;
  void read_map(const Json& json, RawNode& node, const std::string& place);
  void read_content(const Json& json, RawNode& node, std::uint32_t number, bool hidden, const std::string& place);
  void read_camera(std::uint64_t index, std::uint32_t node, const std::string& asker);
  double read_half(const Json& view, const char* key, const std::string& place);
  void count_contents();
  void write_notes();

  GltfFile file_;
  RawScene scene_;
  GltfMeshes meshes_{file_, scene_};
  GltfSkins skins_{file_, scene_};
  GltfLights lights_{file_, scene_};
  GltfAnimation animation_{file_, scene_};
  GltfAnimation::NodeNumbers node_of_;
  std::size_t cameras_ = 0;
  std::size_t instanced_ = 0;
  std::size_t long_rotations_ = 0;  // quaternions of another length than 1
  bool mirrored_view_ = false;
  std::size_t hidden_meshes_ = 0;  // nodes with a mesh that are not visible
};

void Importer::read_frames() {
  const Json& kage = file_.own_extras(file_.object(file_.root(), "asset", "JSON"));
  const auto frames = file_.integer(kage, "frames", "asset.extras.kage");
  if (frames && (*frames == 0 || *frames > 1'000'000)) file_.fail("asset.extras.kage", "'frames' is not 1 to 1000000");
  scene_.frames = static_cast<std::uint32_t>(frames.value_or(0));
}

std::vector<std::uint64_t> Importer::roots() const {
  std::vector<std::uint64_t> roots;
  const std::size_t nodes = file_.count("nodes");
  if (file_.count("scenes") == 0) {  // a library of parts: every node that is nobody's child
    std::set<std::uint64_t> children;
    for (const Json& node : file_.array(file_.root(), "nodes", "JSON"))
      if (node.is_object())
        for (const Json& child : file_.array(node, "children", "node"))
          if (child.is_number_unsigned()) children.insert(child.get<std::uint64_t>());
    for (std::uint64_t i = 0; i < nodes; ++i)
      if (children.count(i) == 0) roots.push_back(i);
    return roots;
  }
  const Json& scene = file_.item("scenes", file_.integer(file_.root(), "scene", "JSON").value_or(0), "scene");
  for (const Json& node : file_.array(scene, "nodes", "scene")) {
    if (!node.is_number_unsigned()) file_.fail("scene", "'nodes' holds what is not a number");
    roots.push_back(node.get<std::uint64_t>());
  }
  return roots;
}

// Depth first, children in the file's order, so that the draw order is the order of reading.
void Importer::walk_nodes() {
  std::vector<Waiting> stack;
  const std::vector<std::uint64_t> first = roots();
  for (std::size_t i = first.size(); i-- > 0;) stack.push_back({first[i], -1, false});
  while (!stack.empty()) {
    Waiting at = stack.back();
    stack.pop_back();
    const std::string place = "node " + std::to_string(at.node);
    const Json& json = file_.item("nodes", at.node, place);
    const auto number = static_cast<std::uint32_t>(scene_.nodes.size());
    if (!node_of_.emplace(at.node, number).second) file_.fail(place, "has two parents, or is its own ancestor");
    RawNode node;
    node.parent = at.parent;
    node.name = file_.text(json, "name", place);
    const Json& visibility = file_.extension(json, "KHR_node_visibility", place);
    at.hidden = !file_.boolean(visibility, "visible", true, place) || at.hidden;
    read_map(json, node, place);
    read_content(json, node, number, at.hidden, place);
    scene_.nodes.push_back(std::move(node));
    const Json& children = file_.array(json, "children", place);
    for (std::size_t i = children.size(); i-- > 0;) {
      if (!children[i].is_number_unsigned()) file_.fail(place, "'children' holds what is not a number");
      stack.push_back({children[i].get<std::uint64_t>(), static_cast<std::int32_t>(number), at.hidden});
    }
  }
  const auto draws = [](const RawNode& n) { return n.mesh >= 0; };
  if (hidden_meshes_ > 0 && std::none_of(scene_.nodes.begin(), scene_.nodes.end(), draws))
    file_.fail("nodes", "all that have a mesh are hidden (KHR_node_visibility)");
}

void Importer::read_map(const Json& json, RawNode& node, const std::string& place) {
  const std::vector<double> m = file_.numbers(json, "matrix", 16, place);
  if (!m.empty()) {  // by columns
    node.matrix = file_.affine_map(m.data(), "'matrix'", place);
    return;
  }
  node.fixed = false;
  const std::vector<double> t = file_.numbers(json, "translation", 3, place);
  const std::vector<double> r = file_.numbers(json, "rotation", 4, place);
  const std::vector<double> s = file_.numbers(json, "scale", 3, place);
  if (!t.empty()) node.translation = vec3(t);
  if (!r.empty()) node.rotation = {r[0], r[1], r[2], r[3]};
  const double length = node.rotation.x * node.rotation.x + node.rotation.y * node.rotation.y +
                        node.rotation.z * node.rotation.z + node.rotation.w * node.rotation.w;
  if (!(length > 0)) file_.fail(place, "'rotation' is a quaternion of length 0");
  long_rotations_ += std::abs(length - 1) > kUnitTolerance ? 1 : 0;
  if (!s.empty()) node.scale = vec3(s);
}

// A hidden node's mesh is not drawn and its light does not shine; its camera works all the same. [KHR_node_visibility]
void Importer::read_content(const Json& json, RawNode& node, std::uint32_t number, bool hidden,
                            const std::string& place) {
  const auto mesh = file_.integer(json, "mesh", place);
  const auto skin = file_.integer(json, "skin", place);
  const bool instanced = file_.has_extension(json, "EXT_mesh_gpu_instancing", place);
  const Json& lamp = file_.extension(json, "KHR_lights_punctual", place);
  const auto light = file_.integer(lamp, "light", place);
  if (const auto camera = file_.integer(json, "camera", place)) read_camera(*camera, number, place);
  if (hidden) {
    hidden_meshes_ += mesh ? 1 : 0;
    return;
  }
  if (light) lights_.read(*light, number, place);
  if (!mesh) return;
  node.mesh = meshes_.read(*mesh, place);
  node.weights = meshes_.weights(json, *mesh, node.mesh, place);
  if (skin) skins_.add(number, *skin, place);
  instanced_ += instanced ? 1 : 0;
}

/// Half the height or width of what a parallel view shows. One below 0 would mirror it, which the format advises
/// against.
double Importer::read_half(const Json& view, const char* key, const std::string& place) {
  const double half = file_.number(view, key, place).value_or(0);
  if (half == 0) file_.fail(place, std::string("'") + key + "' is 0 or missing");
  mirrored_view_ = mirrored_view_ || half < 0;
  return std::abs(half);
}

void Importer::read_camera(std::uint64_t index, std::uint32_t node, const std::string& asker) {
  if (++cameras_ > 1) return;
  const std::string place = "camera " + std::to_string(index);
  const Json& json = file_.item("cameras", index, asker);
  RawCamera camera;
  camera.node = node;
  const std::string type = file_.text(json, "type", place);
  camera.perspective = type == "perspective";
  if (!camera.perspective && type != "orthographic")
    file_.fail(place, type.empty() ? "has no type"
                                   : "type '" + one_line(type, 40) + "' is neither perspective nor orthographic");
  const Json& view = file_.object(json, type.c_str(), place);
  camera.near = file_.number(view, "znear", place).value_or(0);
  camera.far = file_.number(view, "zfar", place).value_or(0);
  if (camera.perspective) {
    const double angle = file_.number(view, "yfov", place).value_or(0);
    if (!(angle > 0 && angle < portable::kPi)) file_.fail(place, "'yfov' is not between 0 and pi");
    camera.half_height = portable::tan(angle / 2);
    camera.aspect = file_.number(view, "aspectRatio", place).value_or(0);
    if (file_.has(view, "aspectRatio") && !(camera.aspect > 0)) file_.fail(place, "'aspectRatio' is not above 0");
    if (!(camera.near > 0)) file_.fail(place, "'znear' is not above 0");
  } else {
    camera.half_height = read_half(view, "ymag", place);
    camera.aspect = read_half(view, "xmag", place) / camera.half_height;
    if (camera.near < 0 || !(camera.far > 0)) file_.fail(place, "'znear' is negative, or no 'zfar'");
  }
  if (file_.has(view, "zfar") && !(camera.far > camera.near)) file_.fail(place, "'zfar' is not beyond 'znear'");
  scene_.camera = camera;
}

void Importer::count_contents() {
  SceneContents& c = scene_.contents;
  meshes_.materials().count(c);
  c.cameras = static_cast<std::uint32_t>(cameras_);
  c.lights = static_cast<std::uint32_t>(scene_.lights.size());
  c.animations = static_cast<std::uint32_t>(file_.count("animations"));
  c.says_sides = true;
}

void Importer::write_notes() {
  std::vector<std::string>& notes = scene_.notes;
  file_.note(notes);
  const GltfMeshes::Counts& meshes = meshes_.counts();
  const GltfAnimation::Counts& channels = animation_.counts();
  const auto add = [&notes](std::size_t count, const char* singular, const char* plural, const char* rest) {
    if (count > 0) notes.push_back(counted(count, singular, plural) + rest);
  };
  add(file_.count("textures"), "texture is", "textures are", " ignored");
  meshes_.materials().note(notes);
  add(meshes.alpha, "primitive's vertices have", "primitives' vertices have",
      " alpha of their own, which is ignored: the material's is used");
  meshes_.colors().note("primitive has", "primitives have", notes);
  add(meshes.thin, "primitive of points or lines is", "primitives of points or lines are", " ignored");
  add(meshes.bare, "primitive without positions is", "primitives without positions are", " ignored");
  add(skins_.counts().idle, "skin is", "skins are", " ignored: the mesh has no joints");
  add(skins_.counts().weightless, "vertex of a skinned mesh has", "vertices of skinned meshes have",
      " no weights: the first joint moves it");
  add(channels.morphs, "morph animation is", "morph animations are", " ignored: the mesh has no morph targets");
  add(channels.matrices, "animated node has", "animated nodes have",
      " a matrix, which is ignored: the animation places it");
  add(instanced_, "node's", "nodes'", " GPU instances are ignored: drawn once");
  add(channels.blinking, "node's visibility is", "nodes' visibilities are",
      " animated, which is ignored: shown or hidden as at rest");
  add(channels.pointed, "animated property is", "animated properties are", " ignored (KHR_animation_pointer)");
  add(channels.unknown, "animation channel is", "animation channels are", " of no known kind, and ignored");
  add(file_.count("scenes") > 1 ? file_.count("scenes") - 1 : 0, "scene is", "scenes are",
      " ignored: the file's default one is drawn");
  add(cameras_ > 1 ? cameras_ - 1 : 0, "camera is", "cameras are", " ignored: the first is used");
  if (mirrored_view_)
    notes.emplace_back("the camera's xmag or ymag is negative: its magnitude is taken, nothing is mirrored");
  add(long_rotations_, "node's rotation is", "nodes' rotations are", " no unit quaternion: brought to length 1");
  notes.insert(notes.end(), lights_.defects().begin(), lights_.defects().end());
  add(lights_.counts().black, "light is", "lights are", " black, and ignored");
  add(lights_.counts().shaped_suns, "directional light has", "directional lights have",
      " a shape, which is ignored: the shadows are hard");
  std::set<std::string> told;
  if (channels.blinking + channels.pointed > 0) told.insert("KHR_animation_pointer");
  if (instanced_ > 0) told.insert("EXT_mesh_gpu_instancing");
  note_unknown(file_, told, notes);
}

}  // namespace

RawScene import_gltf(GltfFile file) { return Importer(std::move(file)).run(); }

}  // namespace kage::scene
