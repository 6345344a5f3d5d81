// SPDX-License-Identifier: Apache-2.0
// Meshes and scenes, in this process: what kage reads in a child's is kept from it there.
#include "fuzz/target.hpp"
#include "kage/error.hpp"
#include "scene/import.hpp"
#include "scene/wire.hpp"

namespace kage::fuzz {
namespace {

/// Reads a file of this name, and sends what comes of it through the pipe's form and back.
void read_scene(const char* name, Bytes bytes) {
  const auto path = file_of(name, bytes);
  const scene::RawScene read = scene::import_file(path, name);
  const std::vector<std::uint8_t> packed = scene::packed(read);
  require(scene::packed(scene::unpacked(packed)) == packed, "a scene is the same behind the pipe");
}

void run_gltf(Bytes bytes) { read_scene("s.gltf", bytes); }
void run_glb(Bytes bytes) { read_scene("s.glb", bytes); }
void run_obj(Bytes bytes) { read_scene("s.obj", bytes); }
void run_mtl(Bytes bytes) {
  (void)file_of("m.mtl", bytes);
  read_scene("m.obj", bytes_of("mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
}
void run_ply(Bytes bytes) { read_scene("s.ply", bytes); }
void run_stl(Bytes bytes) { read_scene("s.stl", bytes); }
void run_off(Bytes bytes) { read_scene("s.off", bytes); }

const char* const kTriangle =
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA";

std::string gltf() {
  return std::string(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,)") +
         R"("translation":[0,0,1],"rotation":[0,0,0,1],"scale":[1,1,2]},{"camera":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]}],)" +
         R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],"meshes":[{"primitives":[{"attributes":)" +
         R"({"POSITION":0},"indices":1,"material":0}]}],"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,0.5]},)" +
         R"("alphaMode":"BLEND"}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":0,)" +
         R"("byteOffset":36,"componentType":5123,"count":3,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":42}],)" +
         R"("animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],"samplers":[{"input":2,"output":0}]}],)" +
         R"("buffers":[{"byteLength":42,"uri":")" + kTriangle + R"("}]})";
}

std::string little(std::uint32_t v) {
  return {static_cast<char>(v), static_cast<char>(v >> 8), static_cast<char>(v >> 16), static_cast<char>(v >> 24)};
}

std::string glb() {
  std::string json =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":)"
      R"([{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,)"
      R"("type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string points(36, '\0');
  points[14] = points[15] = points[30] = '\x3f';
  const auto size = static_cast<std::uint32_t>(json.size());
  return "glTF" + little(2) + little(12 + 8 + size + 8 + 36) + little(size) + "JSON" + json + little(36) +
         std::string("BIN\0", 4) + points;
}

std::string binary_stl() {
  std::string file(80, ' ');
  file += little(1) + std::string(50, '\0');
  file[84 + 12 + 15] = file[84 + 12 + 28] = '\x3f';
  return file;
}

std::vector<std::string> gltf_seeds() { return {gltf()}; }
std::vector<std::string> glb_seeds() { return {glb()}; }
std::vector<std::string> obj_seeds() {
  return {"o a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\ng b\ns 1\nf 1 2 3 4\nf 1/1/1 2/1/1 -1//1\n",
          "# c\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 \\\n2 3\nl 1 2\np 1\n"};
}
std::vector<std::string> mtl_seeds() {
  return {"newmtl a\nKa 0 0 0\nKd 0.8 0.1 0.2\nKs 0 0 0\nd 0.5\nTr 0.5\nNs 10\nillum 2\nmap_Kd x.png\n"};
}
std::vector<std::string> ply_seeds() {
  const std::string head =
      "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  std::string points(45, '\0');
  points[3] = points[18] = '\x3f';
  return {"ply\nformat ascii 1.0\ncomment c\nelement vertex 3\n" + head +
              "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n",
          "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + head + points + "\3" + little(0) + little(1) +
              little(2),
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
          "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2 -1\n"};
}
std::vector<std::string> stl_seeds() {
  return {
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid "
      "a\n",
      binary_stl()};
}
std::vector<std::string> off_seeds() {
  return {"OFF\n# c\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n",
          "COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 0 1 0 1\n0 1 0 0 0 1 1\n3 0 1 2\n"};
}

}  // namespace

std::span<const Target> scene_targets() {
  static const Target kTargets[] = {{"gltf", "glTF as text", run_gltf, gltf_seeds},
                                    {"glb", "binary glTF", run_glb, glb_seeds},
                                    {"obj", "Wavefront OBJ", run_obj, obj_seeds},
                                    {"mtl", "its materials", run_mtl, mtl_seeds},
                                    {"ply", "PLY", run_ply, ply_seeds},
                                    {"stl", "STL", run_stl, stl_seeds},
                                    {"off", "OFF", run_off, off_seeds}};
  return kTargets;
}

}  // namespace kage::fuzz
