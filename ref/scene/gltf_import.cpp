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
#include "import.hpp"
#include "notes.hpp"

namespace kage::scene {
namespace {

using Json = GltfFile::Json;

glm::dvec3 vec3(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

class Importer {
 public:
  explicit Importer(GltfFile file) : file_(std::move(file)) {}

  RawScene run() {
    refuse_compression();
    read_frames();
    walk_nodes();
    read_animation();
    write_notes();
    return std::move(scene_);
  }

 private:
  struct Waiting {
    std::uint64_t node;
    std::int32_t parent;
  };

  void refuse_compression() const;
  void read_frames();
  void walk_nodes();
  [[nodiscard]] std::vector<std::uint64_t> roots() const;
  void read_node(const Json& json, RawNode& node, const std::string& place);
  std::int32_t read_mesh(std::uint64_t index);
  void read_primitive(const Json& json, RawMesh& mesh, const std::string& place);
  void read_corners(const Json& json, RawPrimitive& primitive, const std::string& place);
  void read_material(const Json& primitive, RawPrimitive& p, const std::string& place);
  void read_camera(std::uint64_t index, std::uint32_t node);
  void read_light(std::uint64_t index, std::uint32_t node);
  void read_cone(const Json& json, Light& light, const std::string& place);
  void read_shape(const Json& json, Light& light, const std::string& place);
  void read_animation();
  void read_channel(const Json& animation, const Json& channel, const std::string& place);
  void write_notes();

  GltfFile file_;
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
  std::set<std::uint64_t> mask_materials_;
  std::string camera_name_;
};

void Importer::refuse_compression() const {
  for (const Json& e : file_.array(file_.root(), "extensionsRequired", "JSON"))
    if (e == Json("KHR_draco_mesh_compression") || e == Json("EXT_meshopt_compression"))
      file_.fail("extensionsRequired", "meshes compressed by " + e.get<std::string>() + " are not read");
}

void Importer::read_frames() {
  const Json& kage = file_.object(file_.object(file_.object(file_.root(), "asset"), "extras"), "kage");
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
  for (std::size_t i = first.size(); i-- > 0;) stack.push_back({first[i], -1});
  while (!stack.empty()) {
    const Waiting at = stack.back();
    stack.pop_back();
    const std::string place = "node " + std::to_string(at.node);
    const Json& json = file_.item("nodes", at.node, place);
    const auto number = static_cast<std::uint32_t>(scene_.nodes.size());
    if (!node_of_.emplace(at.node, number).second) file_.fail(place, "has two parents, or is its own ancestor");
    RawNode node;
    node.parent = at.parent;
    node.name = file_.text(json, "name");
    read_node(json, node, place);
    if (const auto camera = file_.integer(json, "camera", place)) read_camera(*camera, number);
    const Json& extensions = file_.object(json, "extensions");
    if (const auto light = file_.integer(file_.object(extensions, "KHR_lights_punctual"), "light", place))
      read_light(*light, number);
    if (extensions.contains("EXT_mesh_gpu_instancing")) ++instanced_;
    scene_.nodes.push_back(std::move(node));
    const Json& children = file_.array(json, "children", place);
    for (std::size_t i = children.size(); i-- > 0;) {
      if (!children[i].is_number_unsigned()) file_.fail(place, "'children' holds what is not a number");
      stack.push_back({children[i].get<std::uint64_t>(), static_cast<std::int32_t>(number)});
    }
  }
}

void Importer::read_node(const Json& json, RawNode& node, const std::string& place) {
  const std::vector<double> m = file_.numbers(json, "matrix", 16, place);
  if (!m.empty()) {  // by columns
    node.matrix = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  } else {
    node.fixed = false;
    const std::vector<double> t = file_.numbers(json, "translation", 3, place);
    const std::vector<double> r = file_.numbers(json, "rotation", 4, place);
    const std::vector<double> s = file_.numbers(json, "scale", 3, place);
    if (!t.empty()) node.translation = vec3(t);
    if (!r.empty()) node.rotation = {r[0], r[1], r[2], r[3]};
    if (!s.empty()) node.scale = vec3(s);
  }
  if (const auto mesh = file_.integer(json, "mesh", place)) {
    node.mesh = read_mesh(*mesh);
    if (json.contains("skin")) ++skins_;
  }
}

std::int32_t Importer::read_mesh(std::uint64_t index) {
  if (const auto known = mesh_of_.find(index); known != mesh_of_.end()) return known->second;
  const std::string place = "mesh " + std::to_string(index);
  const Json& json = file_.item("meshes", index, place);
  RawMesh mesh;
  mesh.name = file_.text(json, "name");
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
  const Json& attributes = file_.object(json, "attributes");
  const auto position = file_.integer(attributes, "POSITION", place);
  if (mode < 4 || !position) {
    ++(mode < 4 ? thin_primitives_ : bare_primitives_);
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
  read_material(json, p, place);
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

void Importer::read_material(const Json& primitive, RawPrimitive& p, const std::string& place) {
  const auto index = file_.integer(primitive, "material", place);
  if (!index) return;
  const std::string here = "material " + std::to_string(*index);
  const Json& material = file_.item("materials", *index, place);
  const Json& metal = file_.object(material, "pbrMetallicRoughness");
  const Json& gloss = file_.object(file_.object(material, "extensions"), "KHR_materials_pbrSpecularGlossiness");
  std::vector<double> factor = file_.numbers(metal, "baseColorFactor", 4, here);
  if (factor.empty()) factor = file_.numbers(gloss, "diffuseFactor", 4, here);
  if (factor.empty()) factor = {1, 1, 1, 1};
  const std::string mode = file_.text(material, "alphaMode");
  if (mode == "BLEND") p.alpha = std::clamp(factor[3], 0.0, 1.0);
  if (mode == "MASK") mask_materials_.insert(*index);
  p.color = vec3(factor);
}

void Importer::read_camera(std::uint64_t index, std::uint32_t node) {
  if (++cameras_ > 1) return;
  const std::string place = "camera " + std::to_string(index);
  const Json& json = file_.item("cameras", index, place);
  RawCamera camera;
  camera.node = node;
  const std::string type = file_.text(json, "type");
  const Json& view = file_.object(json, type == "orthographic" ? "orthographic" : "perspective");
  camera.perspective = type != "orthographic";
  camera.near = file_.number(view, "znear", place).value_or(0);
  camera.far = file_.number(view, "zfar", place).value_or(0);
  if (camera.perspective) {
    const double angle = file_.number(view, "yfov", place).value_or(0);
    if (!(angle > 0 && angle < portable::kPi)) file_.fail(place, "'yfov' is not between 0 and pi");
    camera.half_height = portable::tan(angle / 2);
    if (!(camera.near > 0)) file_.fail(place, "'znear' is not above 0");
  } else {
    camera.half_height = file_.number(view, "ymag", place).value_or(0);
    if (camera.half_height < 0) camera.half_height = -camera.half_height;
    if (!(camera.half_height > 0)) file_.fail(place, "'ymag' is 0");
    if (camera.near < 0 || !(camera.far > 0)) file_.fail(place, "'znear' is negative, or no 'zfar'");
  }
  if (camera.far != 0 && camera.far <= camera.near) file_.fail(place, "'zfar' is not beyond 'znear'");
  scene_.camera = camera;
  camera_name_ = file_.text(json, "name");
}

void Importer::read_light(std::uint64_t index, std::uint32_t node) {
  const std::string place = "light " + std::to_string(index);
  const Json& all =
      file_.array(file_.object(file_.object(file_.root(), "extensions"), "KHR_lights_punctual"), "lights", place);
  if (index >= all.size() || !all[static_cast<std::size_t>(index)].is_object())
    file_.fail(place, "asked for, but there are " + std::to_string(all.size()));
  const Json& json = all[static_cast<std::size_t>(index)];
  const std::string type = file_.text(json, "type");
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
  else if (file_.object(file_.object(json, "extras"), "kage").contains("shape"))
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
  const Json& spot = file_.object(json, "spot");
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
  const Json& own = file_.object(file_.object(json, "extras"), "kage");
  if (!own.contains("shape")) return;
  const std::string shape = file_.text(own, "shape");
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

void Importer::read_channel(const Json& animation, const Json& channel, const std::string& place) {
  const Json& target = file_.object(channel, "target");
  const auto node = file_.integer(target, "node", place);
  const std::string path = file_.text(target, "path");
  if (path == "weights") ++morph_channels_;
  if (!node || (path != "translation" && path != "rotation" && path != "scale")) return;
  const auto known = node_of_.find(*node);
  if (known == node_of_.end()) return;  // of another scene

  RawTrack track;
  track.node = known->second;
  track.path = path == "translation" ? RawPath::kTranslation
               : path == "rotation"  ? RawPath::kRotation
                                     : RawPath::kScale;
  const Json& samplers = file_.array(animation, "samplers", place);
  const auto sampler_index = file_.integer(channel, "sampler", place);
  if (!sampler_index || *sampler_index >= samplers.size()) file_.fail(place, "names no sampler");
  const Json& sampler = samplers[static_cast<std::size_t>(*sampler_index)];
  if (!sampler.is_object()) file_.fail(place, "its sampler is not an object");
  const std::string interpolation = file_.text(sampler, "interpolation");
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

void Importer::write_notes() {
  std::vector<std::string>& notes = scene_.notes;
  const auto add = [&notes](std::size_t count, const char* singular, const char* plural, const char* rest) {
    if (count > 0) notes.push_back(counted(count, singular, plural) + rest);
  };
  add(file_.count("textures"), "texture is", "textures are", " ignored");
  add(mask_materials_.size(), "material has", "materials have", " an alpha mask, which is ignored: drawn opaque");
  add(alpha_primitives_, "primitive's vertices have", "primitives' vertices have",
      " alpha of their own, which is ignored: the material's is used");
  add(thin_primitives_, "primitive of points or lines is", "primitives of points or lines are", " ignored");
  add(bare_primitives_, "primitive without positions is", "primitives without positions are", " ignored");
  add(skins_, "skin is", "skins are", " ignored: drawn in the rest pose");
  add(morphs_, "primitive has", "primitives have", " morph targets, which are ignored");
  add(morph_channels_, "morph animation is", "morph animations are", " ignored");
  add(instanced_, "node's", "nodes'", " GPU instances are ignored: drawn once");
  add(cameras_ > 1 ? cameras_ - 1 : 0, "camera is", "cameras are", " ignored: the first is used");
  add(black_lights_, "light is", "lights are", " black, and ignored");
  add(shaped_suns_, "directional light has", "directional lights have",
      " a shape, which is ignored: the shadows are hard");
}

}  // namespace

RawScene import_gltf(GltfFile file) { return Importer(std::move(file)).run(); }

}  // namespace kage::scene
