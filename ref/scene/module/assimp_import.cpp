// SPDX-License-Identifier: Apache-2.0
//
// Whatever else Assimp reads, into a RawScene. Assimp is asked for the file's data as they are, without its own
// processing: kage triangulates, welds and orders itself.
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <new>
#include <optional>
#include <set>
#include <utility>

#include "kage/error.hpp"
#include "scene/functions.hpp"
#include "scene/import.hpp"
#include "scene/module/assimp_files.hpp"
#include "scene/module/table.hpp"
#include "scene/notes.hpp"
#include "scene/polygon.hpp"

namespace kage::scene::mesh_module {
namespace {

// Assimp's defaults for clip planes and shape of the picture, where the file says nothing.
constexpr double kAssimpNear = 0.1;
constexpr double kAssimpFar = 1000;
constexpr double kDefaultAspect = 4.0 / 3.0;

glm::dvec3 vec3(const aiVector3D& v) { return {v.x, v.y, v.z}; }
glm::dvec3 rgb(const aiColor3D& c) { return {c.r, c.g, c.b}; }
std::string text(const aiString& s) { return {s.C_Str()}; }

Affine affine(const aiMatrix4x4& m) {
  return {{m.a1, m.b1, m.c1}, {m.a2, m.b2, m.c2}, {m.a3, m.b3, m.c3}, {m.a4, m.b4, m.c4}};
}

class Reader {
 public:
  Reader(const aiScene& in, const AssimpFiles& files, const std::string& file) : in_(in), files_(files), file_(file) {}

  RawScene run() {
    walk();
    read_cameras();
    read_lights();
    read_animation();
    write_notes();
    return std::move(out_);
  }

 private:
  void walk();
  std::int32_t mesh_of(const aiNode& node);
  void read_mesh(const aiMesh& mesh, RawMesh& out);
  void read_faces(const aiMesh& mesh, RawPrimitive& p);
  void read_material(unsigned index, RawPrimitive& p);
  /// As the file has it, or 1 where that is no share.
  [[nodiscard]] static double opacity(const aiMaterial& material);
  void read_light_of_its_own(const aiMaterial& material, RawPrimitive& p, bool fresh);
  void read_cameras();
  void read_lights();
  static void read_cone(const aiLight& l, Light& light);
  static void read_area(const aiLight& l, Light& light);
  void read_animation();
  void read_node_animation(const aiNodeAnim& channel);
  void write_notes();
  [[nodiscard]] std::uint32_t node_named(const std::string& name) const {
    const auto it = node_of_.find(name);
    return it == node_of_.end() ? 0 : it->second;
  }

  const aiScene& in_;
  const AssimpFiles& files_;
  const std::string& file_;
  RawScene out_;
  std::map<std::vector<unsigned>, std::int32_t> mesh_of_;  // meshes that one node draws together
  std::map<std::string, std::uint32_t> node_of_;           // the first of that name
  std::vector<const aiNode*> nodes_;
  std::set<unsigned> materials_;
  std::size_t emitting_ = 0;  // materials that give light over a colour that is not black
  std::size_t glossy_ = 0;
  std::size_t unshaded_ = 0;
  std::size_t thin_faces_ = 0;
  std::size_t alpha_meshes_ = 0;  // by the colours of their vertices
  std::size_t skins_ = 0;
  std::size_t morphs_ = 0;
  std::size_t cameras_ = 0;
};

void Reader::walk() {
  struct Waiting {
    const aiNode* node;
    std::int32_t parent;
  };
  if (in_.mRootNode == nullptr) return;
  std::vector<Waiting> stack{{in_.mRootNode, -1}};
  while (!stack.empty()) {
    const Waiting at = stack.back();
    stack.pop_back();
    const auto number = static_cast<std::int32_t>(out_.nodes.size());
    RawNode node;
    node.name = text(at.node->mName);
    node.parent = at.parent;
    node.matrix = affine(at.node->mTransformation);
    node.mesh = mesh_of(*at.node);
    node_of_.emplace(node.name, static_cast<std::uint32_t>(number));
    nodes_.push_back(at.node);
    out_.nodes.push_back(std::move(node));
    for (unsigned i = at.node->mNumChildren; i-- > 0;)
      if (at.node->mChildren[i] != nullptr) stack.push_back({at.node->mChildren[i], number});
  }
}

std::int32_t Reader::mesh_of(const aiNode& node) {
  if (node.mNumMeshes == 0) return -1;
  std::vector<unsigned> key(node.mMeshes, node.mMeshes + node.mNumMeshes);
  if (const auto known = mesh_of_.find(key); known != mesh_of_.end()) return known->second;
  RawMesh mesh;
  for (const unsigned i : key) {
    if (i >= in_.mNumMeshes || in_.mMeshes[i] == nullptr)
      throw Error(file_ + ": node '" + one_line(text(node.mName), 60) + "' draws mesh " + std::to_string(i) + " of " +
                  std::to_string(in_.mNumMeshes));
    if (mesh.name.empty()) mesh.name = text(in_.mMeshes[i]->mName);
    read_mesh(*in_.mMeshes[i], mesh);
  }
  if (mesh.name.empty()) mesh.name = std::to_string(key[0]);
  const auto number = static_cast<std::int32_t>(out_.meshes.size());
  out_.meshes.push_back(std::move(mesh));
  mesh_of_.emplace(std::move(key), number);
  return number;
}

void Reader::read_mesh(const aiMesh& mesh, RawMesh& out) {
  RawPrimitive p;
  if (mesh.mVertices == nullptr) return;
  const auto push = [](std::vector<float>& to, auto a, auto b, auto c) {
    to.push_back(static_cast<float>(a));
    to.push_back(static_cast<float>(b));
    to.push_back(static_cast<float>(c));
  };
  bool translucent = false;
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    translucent = translucent || (mesh.mColors[0] != nullptr && mesh.mColors[0][i].a < 1);
    push(p.positions, mesh.mVertices[i].x, mesh.mVertices[i].y, mesh.mVertices[i].z);
    if (mesh.mNormals != nullptr) push(p.normals, mesh.mNormals[i].x, mesh.mNormals[i].y, mesh.mNormals[i].z);
    if (mesh.mColors[0] != nullptr) push(p.colors, mesh.mColors[0][i].r, mesh.mColors[0][i].g, mesh.mColors[0][i].b);
  }
  read_material(mesh.mMaterialIndex, p);
  alpha_meshes_ += translucent ? 1 : 0;
  skins_ += mesh.HasBones() ? 1 : 0;
  morphs_ += mesh.mNumAnimMeshes > 0 ? 1 : 0;
  read_faces(mesh, p);
  out.primitives.push_back(std::move(p));
}

void Reader::read_faces(const aiMesh& mesh, RawPrimitive& p) {
  if (mesh.mFaces == nullptr) return;
  std::vector<glm::dvec3> corners;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices < 3) {
      thin_faces_ += face.mNumIndices > 0 ? 1 : 0;
      continue;
    }
    corners.clear();
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
      if (face.mIndices[i] >= mesh.mNumVertices)
        throw Error(file_ + ": mesh '" + one_line(text(mesh.mName), 60) + "' face " + std::to_string(f) +
                    " names vertex " + std::to_string(face.mIndices[i]) + " of " + std::to_string(mesh.mNumVertices));
      corners.push_back(vec3(mesh.mVertices[face.mIndices[i]]));
    }
    for (const auto& t : triangulate(corners)) {
      for (const std::uint32_t k : t) p.corners.push_back(face.mIndices[k]);
      p.faces.push_back(p.face_count);
    }
    ++p.face_count;
  }
}

// Several formats, and readers, say 0 and mean that nothing was said: what is drawn at all is not wholly invisible.
double Reader::opacity(const aiMaterial& material) {
  ai_real value = 1;
  if (material.Get(AI_MATKEY_OPACITY, value) != AI_SUCCESS || !(value > 0 && value < 1)) return 1;
  return static_cast<double>(value);
}

void Reader::read_material(unsigned index, RawPrimitive& p) {
  if (index >= in_.mNumMaterials || in_.mMaterials[index] == nullptr) return;
  const bool fresh = materials_.insert(index).second;
  const aiMaterial& material = *in_.mMaterials[index];
  p.alpha = opacity(material);
  int two_sided = 0;
  if (material.Get(AI_MATKEY_TWOSIDED, two_sided) == AI_SUCCESS) {
    out_.contents.says_sides = true;
    p.double_sided = two_sided != 0;
  }
  aiColor4D color(1, 1, 1, 1);
  if (material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS ||
      material.Get(AI_MATKEY_BASE_COLOR, color) == AI_SUCCESS) {
    const glm::dvec3 c{color.r, color.g, color.b};
    if (is_finite(c)) p.color = c;
  }
  read_light_of_its_own(material, p, fresh);
  if (!fresh) return;
  SceneContents& c = out_.contents;
  ++c.materials;
  c.translucent += p.alpha < 1 ? 1 : 0;
  c.unlit += p.unlit ? 1 : 0;
  c.single_sided += p.double_sided ? 0 : 1;
}

// As for glTF (gltf_materials.cpp): a black surface shows its own light alone, and gloss is not drawn.
void Reader::read_light_of_its_own(const aiMaterial& material, RawPrimitive& p, bool fresh) {
  const auto color = [&material](const char* key, unsigned type, unsigned index) {
    aiColor3D c(0, 0, 0);
    if (material.Get(key, type, index, c) != AI_SUCCESS || !is_finite(rgb(c))) return glm::dvec3(0);
    return glm::dvec3(std::max(rgb(c).x, 0.0), std::max(rgb(c).y, 0.0), std::max(rgb(c).z, 0.0));
  };
  const glm::dvec3 light = color(AI_MATKEY_COLOR_EMISSIVE);
  p.unlit = light != glm::dvec3(0) && p.color == glm::dvec3(0);
  if (p.unlit) {
    p.color = light;
    p.colors.clear();
  }
  if (!fresh || p.unlit) return;
  // Several readers say "no shading" of what is only shaded plainly, so it is not drawn like that.
  int model = aiShadingMode_Gouraud;
  (void)material.Get(AI_MATKEY_SHADING_MODEL, model);
  unshaded_ += model == aiShadingMode_NoShading ? 1 : 0;
  emitting_ += light != glm::dvec3(0) ? 1 : 0;
  glossy_ += color(AI_MATKEY_COLOR_SPECULAR) != glm::dvec3(0) ? 1 : 0;
}

void Reader::read_cameras() {
  for (unsigned i = 0; i < in_.mNumCameras; ++i) {
    if (in_.mCameras[i] == nullptr || ++cameras_ > 1) continue;
    const aiCamera& c = *in_.mCameras[i];
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
        out_.notes.emplace_back("the camera's field of view is not between 0 and pi: the camera is ignored");
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
      out_.notes.emplace_back("the camera has no direction: it is ignored");
      continue;
    }
    out_.camera = camera;
  }
}

void Reader::read_lights() {
  for (unsigned i = 0; i < in_.mNumLights; ++i) {
    if (in_.mLights[i] == nullptr) continue;
    const aiLight& l = *in_.mLights[i];
    const std::string name = one_line(text(l.mName), 60);
    if (l.mType == aiLightSource_AMBIENT || l.mType == aiLightSource_UNDEFINED) {
      out_.notes.push_back("the light '" + name + "' is ambient or of no kind, and ignored");
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
      throw Error(file_ + ": light '" + name + "' is not finite");
    if (light.color == glm::dvec3(0)) {
      out_.notes.push_back("the light '" + name + "' is black, and ignored");
      continue;
    }
    if (out_.lights.size() == kMaxLights)
      throw Error(file_ + ": there are more than " + std::to_string(kMaxLights) + " lights");
    out_.lights.push_back(raw);
  }
}

// Assimp's angles are those of the whole cone.
void Reader::read_cone(const aiLight& l, Light& light) {
  const double outer = std::clamp(static_cast<double>(l.mAngleOuterCone) / 2, 0.0, portable::kPi / 2);
  const double inner = std::clamp(static_cast<double>(l.mAngleInnerCone) / 2, 0.0, outer);
  if (!(outer > 0)) return;  // no cone is given
  light.spot = true;
  light.inner_cosine = portable::cos(inner);
  light.outer_cosine = portable::cos(outer);
}

void Reader::read_area(const aiLight& l, Light& light) {
  const glm::dvec3 up = unit(vec3(l.mUp), {0, 1, 0});
  const glm::dvec3 side = unit(cross(vec3(l.mDirection), up), {1, 0, 0});
  light.axis_u = side * (static_cast<double>(l.mSize.x) / 2);
  light.axis_v = up * (static_cast<double>(l.mSize.y) / 2);
  if (light.axis_u != glm::dvec3(0) && light.axis_v != glm::dvec3(0)) light.shape = LightShape::rectangle;
}

void Reader::read_animation() {
  if (in_.mNumAnimations == 0 || in_.mAnimations[0] == nullptr) return;
  const aiAnimation& animation = *in_.mAnimations[0];
  for (unsigned i = 0; i < animation.mNumChannels; ++i)
    if (animation.mChannels[i] != nullptr) read_node_animation(*animation.mChannels[i]);
  if (!out_.tracks.empty()) {
    out_.start_time = out_.tracks[0].times[0];
    for (const RawTrack& t : out_.tracks) out_.start_time = std::min(out_.start_time, t.times[0]);
  }
  if (in_.mNumAnimations > 1)
    out_.notes.push_back(counted(in_.mNumAnimations - 1, "animation is", "animations are") +
                         " ignored: the first is played");
}

void Reader::read_node_animation(const aiNodeAnim& channel) {
  const auto found = node_of_.find(text(channel.mNodeName));
  if (found == node_of_.end()) return;
  RawNode& node = out_.nodes[found->second];
  // Keys replace the node's map. What has none keeps its part of it.
  aiVector3D scale;
  aiQuaternion rotation;
  aiVector3D position;
  nodes_[found->second]->mTransformation.Decompose(scale, rotation, position);
  const auto start = [&](RawPath path) {
    RawTrack t;
    t.node = found->second;
    t.path = path;
    return t;
  };
  const auto push = [](RawTrack& t, double time, std::initializer_list<double> value) {
    if (!std::isfinite(time) || (!t.times.empty() && time <= t.times.back()))
      return;  // a key that goes back is skipped
    t.times.push_back(time);
    t.values.insert(t.values.end(), value);
  };
  RawTrack translation = start(RawPath::kTranslation);
  RawTrack turn = start(RawPath::kRotation);
  RawTrack size = start(RawPath::kScale);
  for (unsigned i = 0; i < channel.mNumPositionKeys; ++i) {
    const aiVectorKey& k = channel.mPositionKeys[i];
    push(translation, k.mTime, {k.mValue.x, k.mValue.y, k.mValue.z});
  }
  for (unsigned i = 0; i < channel.mNumRotationKeys; ++i) {
    const aiQuatKey& k = channel.mRotationKeys[i];
    push(turn, k.mTime, {k.mValue.x, k.mValue.y, k.mValue.z, k.mValue.w});
  }
  for (unsigned i = 0; i < channel.mNumScalingKeys; ++i) {
    const aiVectorKey& k = channel.mScalingKeys[i];
    push(size, k.mTime, {k.mValue.x, k.mValue.y, k.mValue.z});
  }
  if (translation.times.empty() && turn.times.empty() && size.times.empty()) return;
  node.fixed = false;
  node.translation = vec3(position);
  node.rotation = {rotation.x, rotation.y, rotation.z, rotation.w};
  node.scale = vec3(scale);
  for (RawTrack* t : {&translation, &turn, &size})
    if (!t->times.empty()) out_.tracks.push_back(std::move(*t));
}

void Reader::write_notes() {
  std::size_t textures = in_.mNumTextures;  // embedded ones; named ones are counted by the slots that use them
  std::size_t slots = 0;
  std::size_t invisible = 0;
  std::set<std::string> drawn;  // the names of materials
  for (const unsigned i : materials_) {
    const aiMaterial& m = *in_.mMaterials[i];
    for (int type = aiTextureType_NONE + 1; type <= AI_TEXTURE_TYPE_MAX; ++type)
      slots += m.GetTextureCount(static_cast<aiTextureType>(type));
    ai_real value = 1;
    if (m.Get(AI_MATKEY_OPACITY, value) == AI_SUCCESS && !(value > 0)) ++invisible;
    drawn.insert(text(m.GetName()));
  }
  for (std::string& note : files_.obj_notes(drawn)) out_.notes.push_back(std::move(note));
  const auto add = [this](std::size_t count, const char* one, const char* many, const char* rest) {
    if (count > 0) out_.notes.push_back(counted(count, one, many) + rest);
  };
  add(std::max(textures, slots), "texture is", "textures are", " ignored");
  add(invisible, "material has", "materials have", " opacity 0, which is ignored: drawn opaque");
  add(emitting_, "material emits", "materials emit", " light, which is ignored: its diffuse colour is not black");
  add(glossy_, "material is", "materials are", " glossy, which is ignored: drawn matt");
  add(unshaded_, "material is", "materials are", " said to be without shading, which is ignored: drawn lit");
  add(alpha_meshes_, "mesh's vertices have", "meshes' vertices have",
      " alpha of their own, which is ignored: the material's is used");
  add(thin_faces_, "point or line is", "points or lines are", " ignored");
  add(skins_, "skin is", "skins are", " ignored: drawn in the rest pose");
  add(morphs_, "mesh has", "meshes have", " morph targets, which are ignored");
  add(cameras_ > 1 ? cameras_ - 1 : 0, "camera is", "cameras are", " ignored: the first is used");
  out_.contents.cameras = static_cast<std::uint32_t>(cameras_);
  out_.contents.lights = static_cast<std::uint32_t>(out_.lights.size());
  out_.contents.animations = in_.mNumAnimations;
}

}  // namespace

RawScene read(const std::filesystem::path& path, const std::string& name, bool allow_outside) {
  Assimp::Importer importer;
  auto* const files = new AssimpFiles(path.string(), name, allow_outside);  // the importer deletes it
  importer.SetIOHandler(files);
  const aiScene* scene = importer.ReadFile(path.string(), 0);
  if (!files->refused().empty()) throw Error(name + ": " + SideFiles::refusal(files->refused()));
  if (scene == nullptr) {
    const std::string cause = cause_of(importer.GetErrorString());
    if (cause.find("bad_alloc") != std::string::npos) throw std::bad_alloc();  // Assimp turns it into this text
    throw Error(name + ": " + (cause.empty() ? "Assimp cannot read it" : cause));
  }
  return Reader(*scene, *files, name).run();
}

}  // namespace kage::scene::mesh_module
