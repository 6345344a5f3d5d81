// SPDX-License-Identifier: Apache-2.0
//
// An OBJ file's contents as a scene: a node for each object, a primitive for each run of faces of one material.
#include <cmath>
#include <limits>
#include <utility>

#include "number/counted.hpp"
#include "scene/plain/obj_data.hpp"

namespace kage::scene {
namespace {

class ObjBuilder {
 public:
  ObjBuilder(ObjData data, ObjLibraries& libraries, RawScene& scene, FaceCounts& counts)
      : data_(std::move(data)), libraries_(libraries), scene_(scene), counts_(counts) {}

  std::size_t run();

 private:
  /// A run of faces of one object, material and sort.
  struct Run {
    std::int32_t mesh = -1;       // none yet
    std::uint32_t primitive = 0;  // numbered through all meshes
    ObjFace first;
  };
  /// The vertex of the primitive that a vertex of the file became when it was last used.
  struct Last {
    std::uint32_t primitive = kObjNone;
    std::uint32_t normal = kObjNone;
    std::uint32_t number = 0;
  };

  void ask_materials();
  RawPrimitive& primitive_for(const ObjFace& face, Run& run);
  std::uint32_t vertex_of(ObjCorner corner, const Run& run, RawPrimitive& p);
  void push_color(std::size_t vertex, const ObjFace& face, RawPrimitive& p);
  void finish(RawMesh& mesh) const;
  void count_materials() const;

  ObjData data_;
  ObjLibraries& libraries_;
  RawScene& scene_;
  FaceCounts& counts_;
  std::vector<const MtlMaterial*> looks_;  // of each material; nullptr for those that are not there, or not drawn
  bool bare_ = false;                      // a face has no material
  std::vector<Last> last_;
  std::uint32_t primitives_ = 0;
  std::size_t missing_normals_ = 0;
};

std::size_t ObjBuilder::run() {
  ask_materials();
  if (!data_.colors.empty()) data_.colors.resize(data_.positions.size(), std::numeric_limits<float>::quiet_NaN());
  last_.resize(data_.positions.size() / 3);
  std::vector<Run> runs(data_.objects.all().size());
  std::vector<std::uint32_t> vertices;
  std::size_t at = 0;
  for (const ObjFace& face : data_.faces) {
    Run& run = runs[face.object];
    RawPrimitive& p = primitive_for(face, run);
    vertices.clear();
    for (; at < face.end; ++at) vertices.push_back(vertex_of(data_.corners[at], run, p));
    append_face(p, vertices, counts_);
  }
  for (RawMesh& mesh : scene_.meshes) finish(mesh);
  count_materials();
  return missing_normals_;
}

void ObjBuilder::ask_materials() {
  std::vector<bool> drawn(data_.materials.all().size(), false);
  for (const ObjFace& face : data_.faces)
    if (face.material == kObjNone)
      bare_ = true;
    else
      drawn[face.material] = true;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    looks_.push_back(drawn[i] ? libraries_.find(data_.materials.all()[i]) : nullptr);
    bare_ = bare_ || (drawn[i] && looks_.back() == nullptr);
  }
}

/// Its object's last one, or a new one where the material changes, or normals begin or end.
RawPrimitive& ObjBuilder::primitive_for(const ObjFace& face, Run& run) {
  const bool fresh = run.mesh < 0;
  if (fresh) {
    run.mesh = static_cast<std::int32_t>(scene_.meshes.size());
    const std::string& names = data_.objects.all()[face.object];
    const std::size_t end = names.find('\n');
    RawNode node;
    node.name = end + 1 < names.size() ? names.substr(end + 1) : names.substr(0, end);
    node.mesh = run.mesh;
    scene_.meshes.push_back({node.name, {}});
    scene_.nodes.push_back(std::move(node));
  }
  RawMesh& mesh = scene_.meshes[static_cast<std::size_t>(run.mesh)];
  if (!fresh && run.first.material == face.material && run.first.has_normals == face.has_normals)
    return mesh.primitives.back();
  run.first = face;
  run.primitive = primitives_++;
  RawPrimitive& p = mesh.primitives.emplace_back();
  const MtlMaterial* const look = face.material == kObjNone ? nullptr : looks_[face.material];
  p.color = look == nullptr ? glm::dvec3(kGrey) : look->color;
  if (look != nullptr) p.alpha = look->alpha, p.unlit = look->unlit;
  return p;
}

std::uint32_t ObjBuilder::vertex_of(ObjCorner corner, const Run& run, RawPrimitive& p) {
  if (corner.normal != kObjNone && corner.normal >= data_.normals.size() / 3) {
    ++missing_normals_;
    corner.normal = kObjNone;
  }
  Last& last = last_[corner.vertex];
  if (last.primitive == run.primitive && last.normal == corner.normal) return last.number;
  last = {run.primitive, corner.normal, static_cast<std::uint32_t>(p.vertex_count())};
  const auto push = [](std::vector<float>& to, const std::vector<float>& from, std::size_t at) {
    const auto first = from.begin() + static_cast<std::ptrdiff_t>(3 * at);
    to.insert(to.end(), first, first + 3);
  };
  push(p.positions, data_.positions, corner.vertex);
  if (corner.normal != kObjNone) p.normals.resize(p.positions.size() - 3);  // 0 where there was none
  if (corner.normal != kObjNone) push(p.normals, data_.normals, corner.normal);
  if (!data_.colors.empty()) push_color(corner.vertex, run.first, p);
  return last.number;
}

/// A vertex without a colour shows the material's, or the grey of what has none; one with a colour and no material has
/// its own.
void ObjBuilder::push_color(std::size_t vertex, const ObjFace& face, RawPrimitive& p) {
  const bool has_material = face.material != kObjNone && looks_[face.material] != nullptr;
  const bool colored = !std::isnan(data_.colors[3 * vertex]);
  for (std::size_t i = 0; i < 3; ++i)
    p.colors.push_back(colored ? data_.colors[3 * vertex + i] : has_material ? 1 : static_cast<float>(kGrey));
  if (!has_material) p.color = glm::dvec3(1);
}

void ObjBuilder::finish(RawMesh& mesh) const {
  for (RawPrimitive& p : mesh.primitives) {
    if (!p.normals.empty()) p.normals.resize(p.positions.size());
    if (p.unlit) p.colors.clear();  // its colour is its own light
  }
}

void ObjBuilder::count_materials() const {
  SceneContents& c = scene_.contents;
  const auto note = [this](std::size_t count, const char* one, const char* many, const char* rest) {
    if (count > 0) scene_.notes.push_back(counted(count, one, many) + rest);
  };
  std::size_t textures = 0;
  std::size_t invisible = 0;
  std::size_t emitting = 0;
  std::size_t glossy = 0;
  std::size_t unshaded = 0;
  std::size_t bright = 0;
  std::size_t dark = 0;
  std::size_t dense = 0;
  c.materials = bare_ ? 1 : 0;
  for (const MtlMaterial* const m : looks_) {
    if (m == nullptr) continue;
    ++c.materials;
    c.translucent += m->alpha < 1 ? 1 : 0;
    c.unlit += m->unlit ? 1 : 0;
    textures += m->textures.size();
    invisible += m->invisible ? 1 : 0;
    emitting += m->emits ? 1 : 0;
    glossy += m->glossy ? 1 : 0;
    unshaded += m->unshaded ? 1 : 0;
    bright += m->bright ? 1 : 0;
    dark += m->dark ? 1 : 0;
    dense += m->dense ? 1 : 0;
  }
  c.single_sided = c.materials;
  libraries_.note_missing(scene_.notes);
  note(textures, "texture is", "textures are", " ignored");
  note(bright, "material has", "materials have", " a colour above 1, which is taken as 1");
  note(dark, "material has", "materials have", " a colour below 0, which is taken as 0");
  note(dense, "material has", "materials have", " an opacity above 1, which is taken as 1");
  note(invisible, "material has", "materials have", " opacity 0, which is ignored: drawn opaque");
  note(emitting, "material emits", "materials emit", " light, which is ignored: its diffuse colour is not black");
  note(glossy, "material is", "materials are", " glossy, which is ignored: drawn matt");
  note(unshaded, "material is", "materials are", " said to be without shading, which is ignored: drawn lit");
}

}  // namespace

std::size_t build_obj(ObjData data, ObjLibraries& libraries, RawScene& scene, FaceCounts& counts) {
  return ObjBuilder(std::move(data), libraries, scene, counts).run();
}

}  // namespace kage::scene
