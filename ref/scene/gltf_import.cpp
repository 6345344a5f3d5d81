// SPDX-License-Identifier: Apache-2.0
//
// glTF 2.0 into a RawScene. kage reads it itself, because Assimp computes with it (matrices and fields of view in
// float, by libm) and the result differs between its versions; here numbers go from the file into the scene untouched.
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "functions.hpp"
#include "gltf_file.hpp"
#include "gltf_materials.hpp"
#include "gltf_notes.hpp"
#include "import.hpp"
#include "notes.hpp"

namespace kage::scene {
namespace {

using Json = GltfJson::Json;

class Importer {
 public:
  explicit Importer(GltfFile file) : file_(std::move(file)) {}

  RawScene run() {
    refuse_required(file_);
    read_frames();
    walk_nodes();
    read_animation();
    count_contents();
    write_notes();
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
  std::int32_t read_mesh(std::uint64_t index);
  void read_primitive(const Json& json, RawMesh& mesh, const std::string& place);
  void read_corners(const Json& json, RawPrimitive& primitive, const std::string& place);
  void read_camera(std::uint64_t index, std::uint32_t node);
  void read_light(std::uint64_t index, std::uint32_t node);
  void read_cone(const Json& json, Light& light, const std::string& place);
  void read_shape(const Json& json, Light& light, const std::string& place);
  void read_animation();
  void read_channel(const Json& animation, const Json& channel, const std::string& place);
  bool is_drawn_path(const Json& target, const std::string& path, bool has_node, const std::string& place);
  void count_contents();
  void write_notes();

  GltfFile file_;
  GltfMaterials materials_;
  RawScene scene_;
  std::map<std::uint64_t, std::int32_t> mesh_of_;   // file's mesh -> ours
  std::map<std::uint64_t, std::uint32_t> node_of_;  // file's node -> ours
  std::size_t cameras_ = 0;
  std::size_t black_lights_ = 0;
  std::size_t shaped_suns_ = 0;  // directional lights with a shape
  std::size_t skins_ = 0;
  std::size_t morphs_ = 0;
  std::size_t morph_channels_ = 0;
  std::size_t thin_primitives_ = 0;
  std::size_t bare_primitives_ = 0;
  std::size_t instanced_ = 0;
  std::size_t alpha_primitives_ = 0;  // by the colours of their vertices
  std::size_t hidden_meshes_ = 0;     // nodes with a mesh that are not visible
  std::size_t blinking_ = 0;          // animated properties: of visibility,
  std::size_t pointed_ = 0;           // of what else KHR_animation_pointer reaches,
  std::size_t unknown_channels_ = 0;  // and of no kind that is known
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
    node.matrix = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
    return;
  }
  node.fixed = false;
  const std::vector<double> t = file_.numbers(json, "translation", 3, place);
  const std::vector<double> r = file_.numbers(json, "rotation", 4, place);
  const std::vector<double> s = file_.numbers(json, "scale", 3, place);
  if (!t.empty()) node.translation = vec3(t);
  if (!r.empty()) node.rotation = {r[0], r[1], r[2], r[3]};
  if (!s.empty()) node.scale = vec3(s);
}

// What is hidden is neither drawn nor shines; a camera sees all the same. [KHR_node_visibility]
void Importer::read_content(const Json& json, RawNode& node, std::uint32_t number, bool hidden,
                            const std::string& place) {
  const auto mesh = file_.integer(json, "mesh", place);
  const bool skin = file_.has(json, "skin");
  const bool instanced = file_.has_extension(json, "EXT_mesh_gpu_instancing", place);
  const Json& lamp = file_.extension(json, "KHR_lights_punctual", place);
  const auto light = file_.integer(lamp, "light", place);
  if (const auto camera = file_.integer(json, "camera", place)) read_camera(*camera, number);
  if (hidden) {
    hidden_meshes_ += mesh ? 1 : 0;
    return;
  }
  if (light) read_light(*light, number);
  if (!mesh) return;
  node.mesh = read_mesh(*mesh);
  skins_ += skin ? 1 : 0;
  instanced_ += instanced ? 1 : 0;
}

std::int32_t Importer::read_mesh(std::uint64_t index) {
  if (const auto known = mesh_of_.find(index); known != mesh_of_.end()) return known->second;
  const std::string place = "mesh " + std::to_string(index);
  const Json& json = file_.item("meshes", index, place);
  RawMesh mesh;
  mesh.name = file_.text(json, "name", place);
  if (mesh.name.empty()) mesh.name = std::to_string(index);
  const Json& primitives = file_.array(json, "primitives", place);
  for (std::size_t k = 0; k < primitives.size(); ++k) {
    const std::string here = place + " primitive " + std::to_string(k);
    if (!primitives[k].is_object()) file_.fail(here, "not an object");
    read_primitive(primitives[k], mesh, here);
  }
  const auto number = static_cast<std::int32_t>(scene_.meshes.size());
  scene_.meshes.push_back(std::move(mesh));
  mesh_of_.emplace(index, number);
  return number;
}

void Importer::read_primitive(const Json& json, RawMesh& mesh, const std::string& place) {
  const std::uint64_t mode = file_.integer(json, "mode", place).value_or(4);
  if (mode > 6) file_.fail(place, "mode " + std::to_string(mode) + " is unknown");
  const Json& attributes = file_.object(json, "attributes", place);
  const auto position = file_.integer(attributes, "POSITION", place);
  if (mode < 4 || !position) {
    ++(mode < 4 ? thin_primitives_ : bare_primitives_);
    file_.pass_over(json);
    return;
  }
  if (!file_.array(json, "targets", place).empty()) ++morphs_;
  RawPrimitive p;
  p.positions = file_.floats(*position, 3, 3, place).values;
  if (const auto normal = file_.integer(attributes, "NORMAL", place)) {
    p.normals = file_.floats(*normal, 3, 3, place).values;
    if (p.normals.size() != p.positions.size()) file_.fail(place, "has more or fewer normals than positions");
  }
  if (const auto color = file_.integer(attributes, "COLOR_0", place)) {
    const GltfFile::Floats c = file_.floats(*color, 3, 4, place);
    if (c.values.size() / c.components != p.vertex_count())
      file_.fail(place, "has more or fewer colours than positions");
    bool translucent = false;
    for (std::size_t i = 0; i < c.values.size(); ++i)
      if (i % c.components < 3)
        p.colors.push_back(c.values[i]);
      else
        translucent = translucent || c.values[i] < 1;
    alpha_primitives_ += translucent ? 1 : 0;
  }
  materials_.read(file_, json, p, place);
  read_corners(json, p, place);
  mesh.primitives.push_back(std::move(p));
}

void Importer::read_corners(const Json& json, RawPrimitive& p, const std::string& place) {
  const std::uint64_t mode = file_.integer(json, "mode", place).value_or(4);
  std::vector<std::uint32_t> order;
  if (const auto indices = file_.integer(json, "indices", place)) {
    order = file_.indices(*indices, place);
  } else {
    order.resize(p.vertex_count());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  }
  const std::size_t triangles = mode == 4 ? order.size() / 3 : (order.size() < 3 ? 0 : order.size() - 2);
  for (std::size_t i = 0; i < triangles; ++i) {
    std::array<std::size_t, 3> at{3 * i, 3 * i + 1, 3 * i + 2};
    if (mode == 5) at = {i, i + 1 + i % 2, i + 2 - i % 2};
    if (mode == 6) at = {0, i + 1, i + 2};
    for (const std::size_t k : at) p.corners.push_back(order[k]);
    p.faces.push_back(static_cast<std::uint32_t>(i));
  }
  p.face_count = static_cast<std::uint32_t>(triangles);
}

void Importer::read_camera(std::uint64_t index, std::uint32_t node) {
  if (++cameras_ > 1) return;
  const std::string place = "camera " + std::to_string(index);
  const Json& json = file_.item("cameras", index, place);
  RawCamera camera;
  camera.node = node;
  const std::string type = file_.text(json, "type", place);
  const Json& view = file_.object(json, type == "orthographic" ? "orthographic" : "perspective", place);
  camera.perspective = type != "orthographic";
  camera.near = file_.number(view, "znear", place).value_or(0);
  camera.far = file_.number(view, "zfar", place).value_or(0);
  if (camera.perspective) {
    const double angle = file_.number(view, "yfov", place).value_or(0);
    if (!(angle > 0 && angle < portable::kPi)) file_.fail(place, "'yfov' is not between 0 and pi");
    camera.half_height = portable::tan(angle / 2);
    camera.aspect = file_.number(view, "aspectRatio", place).value_or(0);
    if (!(camera.near > 0)) file_.fail(place, "'znear' is not above 0");
  } else {
    camera.half_height = file_.number(view, "ymag", place).value_or(0);
    if (camera.half_height < 0) camera.half_height = -camera.half_height;
    if (!(camera.half_height > 0)) file_.fail(place, "'ymag' is 0");
    camera.aspect = std::abs(file_.number(view, "xmag", place).value_or(0)) / camera.half_height;
    if (camera.near < 0 || !(camera.far > 0)) file_.fail(place, "'znear' is negative, or no 'zfar'");
  }
  if (camera.far != 0 && camera.far <= camera.near) file_.fail(place, "'zfar' is not beyond 'znear'");
  scene_.camera = camera;
}

void Importer::read_light(std::uint64_t index, std::uint32_t node) {
  const std::string place = "light " + std::to_string(index);
  const Json& all = file_.array(file_.extension(file_.root(), "KHR_lights_punctual", "JSON"), "lights", place);
  const Json& json = file_.item_of(all, index, "lights", place);
  const std::string type = file_.text(json, "type", place);
  if (type != "directional" && type != "point" && type != "spot")
    file_.fail(place, "type '" + one_line(type, 40) + "' is unknown");
  RawLight raw;
  raw.node = node;
  Light& light = raw.light;
  light.directional = type == "directional";
  light.falls_off = !light.directional;
  const std::vector<double> color = file_.numbers(json, "color", 3, place);
  if (!color.empty()) light.color = vec3(color);
  light.color *= file_.number(json, "intensity", place).value_or(1);
  for (int c = 0; c < 3; ++c)
    if (!(light.color[c] >= 0) || !std::isfinite(light.color[c]))
      file_.fail(place, "colour times intensity is negative or not finite");
  const auto range = file_.number(json, "range", place);
  if (range && !(*range > 0)) file_.fail(place, "'range' is not above 0");
  if (light.falls_off) light.range = range.value_or(0);
  if (type == "spot") read_cone(json, light, place);
  if (!light.directional)
    read_shape(json, light, place);
  else if (file_.has(file_.own_extras(json), "shape"))
    ++shaped_suns_;
  if (light.color == glm::dvec3(0)) {
    ++black_lights_;
    return;
  }
  if (scene_.lights.size() == kMaxLights)
    file_.fail(place, "there are more than " + std::to_string(kMaxLights) + " lights");
  scene_.lights.push_back(raw);
}

void Importer::read_cone(const Json& json, Light& light, const std::string& place) {
  const Json& spot = file_.object(json, "spot", place);
  const double inner = file_.number(spot, "innerConeAngle", place).value_or(0);
  const double outer = file_.number(spot, "outerConeAngle", place).value_or(portable::kPi / 4);
  if (!(inner >= 0 && inner < outer && outer <= portable::kPi / 2))
    file_.fail(place, "its cone is not 0 <= innerConeAngle < outerConeAngle <= pi / 2");
  light.spot = true;
  light.inner_cosine = portable::cos(inner);
  light.outer_cosine = portable::cos(outer);
}

// The format knows no lights that extend over something: kage's own words for them are in `extras`.
void Importer::read_shape(const Json& json, Light& light, const std::string& place) {
  const Json& own = file_.own_extras(json);
  if (!file_.has(own, "shape")) return;
  const std::string shape = file_.text(own, "shape", place);
  const auto size = [&](const char* key) {
    const double v = file_.number(own, key, place).value_or(0);
    if (!(v > 0))
      file_.fail(place, "extras.kage: '" + std::string(key) + "' of a " + one_line(shape, 40) + " is not above 0");
    return v;
  };
  if (shape == "disc" || shape == "sphere") {
    const double radius = size("radius");
    light.shape = shape == "disc" ? LightShape::disc : LightShape::sphere;
    light.axis_u = {radius, 0, 0};
    light.axis_v = {0, shape == "disc" ? radius : 0, 0};
  } else if (shape == "rectangle") {
    light.shape = LightShape::rectangle;
    light.axis_u = {size("width") / 2, 0, 0};
    light.axis_v = {0, size("height") / 2, 0};
  } else {
    file_.fail(place, "extras.kage: shape '" + one_line(shape, 40) + "' is none of disc, rectangle and sphere");
  }
}

void Importer::read_animation() {
  const std::size_t animations = file_.count("animations");
  if (animations == 0) return;
  const Json& animation = file_.item("animations", 0, "JSON");
  const Json& channels = file_.array(animation, "channels", "animation 0");
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const std::string place = "animation 0 channel " + std::to_string(i);
    if (!channels[i].is_object()) file_.fail(place, "not an object");
    read_channel(animation, channels[i], place);
  }
  if (animations > 1)
    scene_.notes.push_back(counted(animations - 1, "animation is", "animations are") + " ignored: the first is played");
}

// Whether a channel moves a node, which is all that is drawn of animations; the others are counted.
bool Importer::is_drawn_path(const Json& target, const std::string& path, bool has_node, const std::string& place) {
  if (path == "pointer") {
    const Json& pointer = file_.extension(target, "KHR_animation_pointer", place);
    const bool visibility = file_.text(pointer, "pointer", place).find("/KHR_node_visibility/") != std::string::npos;
    ++(visibility ? blinking_ : pointed_);
    return false;
  }
  if (path == "weights") {
    ++morph_channels_;
    return false;
  }
  if (has_node && (path == "translation" || path == "rotation" || path == "scale")) return true;
  ++unknown_channels_;
  return false;
}

void Importer::read_channel(const Json& animation, const Json& channel, const std::string& place) {
  const Json& target = file_.object(channel, "target", place);
  const auto node = file_.integer(target, "node", place);
  const std::string path = file_.text(target, "path", place);
  const auto sampler_index = file_.integer(channel, "sampler", place);
  const Json& samplers = file_.array(animation, "samplers", place);
  if (!is_drawn_path(target, path, node.has_value(), place)) return;
  const auto known = node_of_.find(*node);
  if (known == node_of_.end()) return;  // of another scene

  RawTrack track;
  track.node = known->second;
  track.path = path == "translation" ? RawPath::kTranslation
               : path == "rotation"  ? RawPath::kRotation
                                     : RawPath::kScale;
  if (!sampler_index) file_.fail(place, "names no sampler");
  const Json& sampler = file_.item_of(samplers, *sampler_index, "samplers", place);
  const std::string interpolation = file_.text(sampler, "interpolation", place);
  if (!interpolation.empty() && interpolation != "LINEAR" && interpolation != "STEP" && interpolation != "CUBICSPLINE")
    file_.fail(place, "interpolation '" + one_line(interpolation, 40) + "' is unknown");
  if (interpolation == "STEP") track.interpolation = RawInterpolation::kStep;
  if (interpolation == "CUBICSPLINE") track.interpolation = RawInterpolation::kCubic;
  const auto input = file_.integer(sampler, "input", place);
  const auto output = file_.integer(sampler, "output", place);
  if (!input || !output) file_.fail(place, "its sampler has no input or output");
  const std::vector<float> times = file_.floats(*input, 1, 1, place).values;
  const std::vector<float> values = file_.floats(*output, track.width(), track.width(), place).values;
  const std::size_t per_key = track.width() * (track.interpolation == RawInterpolation::kCubic ? 3 : 1);
  if (values.size() != times.size() * per_key) file_.fail(place, "has not one value for each time");
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1])) file_.fail(place, "key " + std::to_string(i) + " is not later than the one before");
  track.times.assign(times.begin(), times.end());
  track.values.assign(values.begin(), values.end());
  if (times.empty()) return;
  // A matrix is not to be animated, says the format; a track then replaces it, as it does a translation or rotation.
  scene_.nodes[track.node].fixed = false;
  scene_.tracks.push_back(std::move(track));
}

void Importer::count_contents() {
  SceneContents& c = scene_.contents;
  materials_.count(c);
  c.cameras = static_cast<std::uint32_t>(cameras_);
  c.lights = static_cast<std::uint32_t>(scene_.lights.size());
  c.animations = static_cast<std::uint32_t>(file_.count("animations"));
  c.says_sides = true;
}

void Importer::write_notes() {
  std::vector<std::string>& notes = scene_.notes;
  const auto add = [&notes](std::size_t count, const char* singular, const char* plural, const char* rest) {
    if (count > 0) notes.push_back(counted(count, singular, plural) + rest);
  };
  add(file_.count("textures"), "texture is", "textures are", " ignored");
  materials_.note(notes);
  add(alpha_primitives_, "primitive's vertices have", "primitives' vertices have",
      " alpha of their own, which is ignored: the material's is used");
  add(thin_primitives_, "primitive of points or lines is", "primitives of points or lines are", " ignored");
  add(bare_primitives_, "primitive without positions is", "primitives without positions are", " ignored");
  add(skins_, "skin is", "skins are", " ignored: drawn in the rest pose");
  add(morphs_, "primitive has", "primitives have", " morph targets, which are ignored");
  add(morph_channels_, "morph animation is", "morph animations are", " ignored");
  add(instanced_, "node's", "nodes'", " GPU instances are ignored: drawn once");
  add(blinking_, "node's visibility is", "nodes' visibilities are",
      " animated, which is ignored: shown or hidden as at rest");
  add(pointed_, "animated property is", "animated properties are", " ignored (KHR_animation_pointer)");
  add(unknown_channels_, "animation channel is", "animation channels are", " of no known kind, and ignored");
  add(file_.count("scenes") > 1 ? file_.count("scenes") - 1 : 0, "scene is", "scenes are",
      " ignored: the file's default one is drawn");
  add(cameras_ > 1 ? cameras_ - 1 : 0, "camera is", "cameras are", " ignored: the first is used");
  add(black_lights_, "light is", "lights are", " black, and ignored");
  add(shaped_suns_, "directional light has", "directional lights have",
      " a shape, which is ignored: the shadows are hard");
  std::set<std::string> told;
  if (blinking_ + pointed_ > 0) told.insert("KHR_animation_pointer");
  if (instanced_ > 0) told.insert("EXT_mesh_gpu_instancing");
  note_unknown(file_, told, notes);
}

}  // namespace

RawScene import_gltf(GltfFile file) { return Importer(std::move(file)).run(); }

}  // namespace kage::scene
