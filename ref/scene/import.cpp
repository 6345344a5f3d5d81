// SPDX-License-Identifier: Apache-2.0
#include "import.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "file/extension.hpp"
#include "kage/error.hpp"
#include "notes.hpp"
#include "scene/plugin/table.hpp"

namespace kage::scene {
namespace {

// Enough for any scene that a line of pixels can tell apart, and few enough for 32-bit numbers and a machine's memory.
constexpr std::uint64_t kMostTriangles = std::uint64_t{1} << 25;

void check_finite(const std::vector<float>& values, const char* what, const std::string& place) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw Error(place + " vertex " + std::to_string(i / 3) + ": " + what + " is " +
                  (std::isnan(values[i]) ? "not a number" : "infinite"));
}

std::uint64_t check_mesh(const RawMesh& mesh, const std::string& place) {
  std::uint64_t triangles = 0;
  for (std::size_t k = 0; k < mesh.primitives.size(); ++k) {
    const RawPrimitive& p = mesh.primitives[k];
    const std::string here = mesh.primitives.size() > 1 ? place + " primitive " + std::to_string(k) : place;
    check_finite(p.positions, "position", here);
    check_finite(p.colors, "colour", here);
    // Normals that are zero or not finite are common, and a face has one of its own: scene.cpp replaces them.
    for (const std::uint32_t corner : p.corners)
      if (corner >= p.vertex_count())
        throw Error(here + ": a face names vertex " + std::to_string(corner) + " of " +
                    std::to_string(p.vertex_count()));
    triangles += p.triangle_count();
  }
  return triangles;
}

}  // namespace

void check(const RawScene& scene, const std::string& name) {
  std::vector<std::uint64_t> triangles;
  for (const RawMesh& mesh : scene.meshes) {
    const std::string place = name + ": mesh '" + one_line(mesh.name, 60) + "'";
    triangles.push_back(check_mesh(mesh, place));
  }
  std::uint64_t total = 0;
  for (const RawNode& node : scene.nodes) {
    if (node.mesh >= 0) total += triangles[static_cast<std::size_t>(node.mesh)];
    if (total > kMostTriangles) throw Error(name + ": more than " + std::to_string(kMostTriangles) + " triangles");
    const bool finite = is_finite(node.matrix.x) && is_finite(node.matrix.y) && is_finite(node.matrix.z) &&
                        is_finite(node.matrix.origin) && is_finite(node.translation) && is_finite(node.scale) &&
                        std::isfinite(node.rotation.x + node.rotation.y + node.rotation.z + node.rotation.w);
    if (!finite) throw Error(name + ": node '" + one_line(node.name, 60) + "': its transformation is not finite");
  }
  for (const RawTrack& track : scene.tracks) {
    double sum = scene.start_time;
    for (const double t : track.times) sum += t;
    for (const double v : track.values) sum += v;
    if (!std::isfinite(sum))
      throw Error(name + ": animation of node '" + one_line(scene.nodes[track.node].name, 60) +
                  "': a key is not finite");
  }
  if (total == 0) throw Error(name + ": no faces");
}

RawScene import_assimp(const std::filesystem::path& path, const std::string& name, bool allow_outside) {
  return plugin_table<MeshPlugin>().read(path, name, allow_outside);
}

RawScene import_file(const std::filesystem::path& path, const std::string& name, bool allow_outside) {
  const auto checked = [&name](RawScene scene) {
    check(scene, name);
    return scene;
  };
  if (GltfFile::recognises(path)) {
    GltfFile file(path, name, allow_outside);
    if (file.is_version_2()) return checked(import_gltf(std::move(file)));
    if (file.is_binary()) throw Error(name + ": binary glTF 1 is not read (glTF 2, and glTF 1 as .gltf, are)");
  }
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return checked(import_obj(path, name, allow_outside));
  if (extension == ".ply") return checked(import_ply(path, name));
  if (extension == ".stl") return checked(import_stl(path, name));
  if (extension == ".off") return checked(import_off(path, name));
  return checked(import_assimp(path, name, allow_outside));
}

}  // namespace kage::scene
