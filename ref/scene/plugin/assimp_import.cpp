// SPDX-License-Identifier: Apache-2.0
//
// Whatever else Assimp reads, into a RawScene. Assimp is asked for the file's data as they are, without its own
// processing: kage triangulates, welds and orders itself.
#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <new>
#include <span>
#include <utility>
#include <vector>

#include "file/extension.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"
#include "scene/color_range.hpp"
#include "scene/import.hpp"
#include "scene/notes.hpp"
#include "scene/plugin/assimp_animation.hpp"
#include "scene/plugin/assimp_files.hpp"
#include "scene/plugin/assimp_materials.hpp"
#include "scene/plugin/assimp_values.hpp"
#include "scene/plugin/assimp_view.hpp"
#include "scene/plugin/table.hpp"
#include "scene/polygon.hpp"

namespace kage::scene::mesh_plugin {
namespace {

class Reader {
 public:
  Reader(const aiScene& in, const std::string& file) : in_(in), file_(file) {}

  RawScene run() {
    walk();
    AssimpView view(in_, node_of_, file_, out_);
    cameras_ = view.read_cameras();
    view.read_lights();
    read_animation(in_, node_of_, nodes_, out_);
    write_notes();
    return std::move(out_);
  }

 private:
  void walk();
  std::int32_t mesh_of(const aiNode& node);
  void read_mesh(const aiMesh& mesh, RawMesh& out);
  void read_faces(const aiMesh& mesh, RawPrimitive& p);
  void write_notes();

  const aiScene& in_;
  const std::string& file_;
  RawScene out_;
  std::map<std::vector<unsigned>, std::int32_t> mesh_of_;  // meshes that one node draws together
  AssimpMaterials materials_{in_, out_};
  NodeNames node_of_;
  std::vector<const aiNode*> nodes_;
  std::size_t thin_faces_ = 0;
  std::size_t crossing_ = 0;  // faces
  ColorRange colors_;
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
  materials_.read(mesh.mMaterialIndex, p);
  colors_.add(p);
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
    crossing_ += crosses_itself(corners) ? 1 : 0;
    for (const auto& t : triangulate(corners)) {
      for (const std::uint32_t k : t) p.corners.push_back(face.mIndices[k]);
      p.faces.push_back(p.face_count);
    }
    ++p.face_count;
  }
}

void Reader::write_notes() {
  const AssimpMaterials::Counts materials = materials_.counts();
  const auto add = [this](std::size_t count, const char* one, const char* many, const char* rest) {
    if (count > 0) out_.notes.push_back(counted(count, one, many) + rest);
  };
  // Embedded ones, and named ones, which are counted by the slots that use them.
  add(std::max<std::size_t>(in_.mNumTextures, materials.textures), "texture is", "textures are", " ignored");
  add(materials.invisible, "material has", "materials have", " opacity 0, which is ignored: drawn opaque");
  add(materials.emitting, "material emits", "materials emit",
      " light, which is ignored: its diffuse colour is not black");
  add(materials.glossy, "material is", "materials are", " glossy, which is ignored: drawn matt");
  add(materials.unshaded, "material is", "materials are", " said to be without shading, which is ignored: drawn lit");
  colors_.note("mesh has", "meshes have", out_.notes);
  add(alpha_meshes_, "mesh's vertices have", "meshes' vertices have",
      " alpha of their own, which is ignored: the material's is used");
  add(thin_faces_, "point or line is", "points or lines are", " ignored");
  note_crossing(crossing_, out_.notes);
  add(skins_, "skin is", "skins are", " ignored: drawn in the rest pose");
  add(morphs_, "mesh has", "meshes have", " morph targets, which are ignored");
  add(cameras_ > 1 ? cameras_ - 1 : 0, "camera is", "cameras are", " ignored: the first is used");
  out_.contents.cameras = static_cast<std::uint32_t>(cameras_);
  out_.contents.lights = static_cast<std::uint32_t>(out_.lights.size());
  out_.contents.animations = in_.mNumAnimations;
}

void note_textures(const aiScene& scene, const AssimpFiles& files) {
  for (const aiMaterial* m : std::span(scene.mMaterials, scene.mNumMaterials))
    for (int t = aiTextureType_NONE + 1; m != nullptr && t <= AI_TEXTURE_TYPE_MAX; ++t) {
      const auto type = static_cast<aiTextureType>(t);
      aiString name;
      for (unsigned i = 0; i < m->GetTextureCount(type); ++i)
        if (m->GetTexture(type, i, &name) == AI_SUCCESS) files.note_texture(text(name));
    }
}

/// Why no reader takes the file.
std::string no_format(const std::filesystem::path& path) {
  const std::string ending = lower_extension(path);
  if (ending == ".yaml" || ending == ".yml") return "a configuration, and no scene: --config takes it";
  if (ending == ".json") return "JSON, and no scene";
  return "no format of scenes or meshes that is read";
}

}  // namespace

RawScene read(const std::filesystem::path& path, const std::string& name, bool allow_outside) {
  std::vector<std::unique_ptr<Assimp::BaseImporter>> unused;
  Assimp::Importer importer;
  for (const char* own :
       {"obj", "ply", "stl", "off"}) {  // kage reads these itself: Assimp is not to, whatever a file's name ends in
    unused.emplace_back(importer.GetImporter(own));
    importer.UnregisterLoader(unused.back().get());
  }
  auto* const files = new AssimpFiles(path.string(), allow_outside);  // the importer deletes it
  importer.SetIOHandler(files);
  const aiScene* scene = importer.ReadFile(path.string(), 0);
  if (!files->refused().empty()) throw Error(name + ": " + SideFiles::refusal(files->refused()));
  if (scene == nullptr) {
    const std::string cause = cause_of(importer.GetErrorString());
    if (cause.find("bad_alloc") != std::string::npos) throw std::bad_alloc();  // Assimp turns it into this text
    if (cause.rfind("No suitable reader found", 0) == 0) throw Error(name + ": " + no_format(path));
    throw Error(name + ": " + (cause.empty() ? "Assimp cannot read it" : cause));
  }
  RawScene read = Reader(*scene, name).run();
  note_textures(*scene, *files);
  read.files = files->files();
  return read;
}

}  // namespace kage::scene::mesh_plugin
