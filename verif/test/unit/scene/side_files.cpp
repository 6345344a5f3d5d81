// SPDX-License-Identifier: Apache-2.0
// Files that a scene's file names: read from its folder and below, refused elsewhere, whatever the way out.
#include "scene/side_files.hpp"

#include <unistd.h>

#include <set>

#include "file/real_path.hpp"
#include "files.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::TempDirectory;
namespace fs = std::filesystem;

namespace {

const std::string kPositions = test::bytes_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});

/// Folders `home` (of the scene) with `below`, and `away`, each with the same buffer and materials, and links of
/// `home`.
class Folders {
 public:
  Folders() {
    for (const char* folder : {"home", "home/below", "away"}) {
      fs::create_directory(dir_.path() / folder);
      (void)dir_.write(std::string(folder) + "/data.bin", kPositions);
      (void)dir_.write(std::string(folder) + "/look.mtl", "newmtl m\nKd 0.25 0.5 0.75\n");
    }
    for (const auto& [to, link] : {std::pair{"../away/data.bin", "out.bin"},
                                   {"out.bin", "chain.bin"},
                                   {"../away", "door"},
                                   {"below/data.bin", "in.bin"},
                                   {"../home/below", "round"},
                                   {"loop.bin", "loop.bin"},
                                   {"../away/look.mtl", "out.mtl"},
                                   {"below/look.mtl", "in.mtl"}})
      fs::create_symlink(to, dir_.path() / "home" / link);
  }

  [[nodiscard]] fs::path path() const { return dir_.path(); }

  /// The message of loading a glTF file whose buffer is at `uri`; "loaded" if it reads.
  [[nodiscard]] std::string gltf(const std::string& uri, bool allow_outside) const {
    std::string text = test::triangle_gltf(R"("nodes": [{"mesh": 0}])");
    const std::size_t first = text.find("data:application");
    text.replace(first, text.find('"', first) - first, uri);
    return load("scene.gltf", text, allow_outside);
  }

  /// The same of an OBJ file and its materials.
  [[nodiscard]] std::string obj(const std::string& materials, bool allow_outside) const {
    return load("scene.obj", "mtllib " + materials + "\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", allow_outside);
  }

  /// The same of a LightWave scene and its object.
  [[nodiscard]] std::string lws(const std::string& object, bool allow_outside) const {
    return load("scene.lws", "LWSC\n3\n\nLoadObjectLayer 1 " + object + "\n", allow_outside);
  }

  /// The same of a glTF 1.0 file, which Assimp reads.
  [[nodiscard]] std::string gltf1(const std::string& uri, bool allow_outside) const {
    return load("scene.gltf",
                R"({"asset": {"version": "1.0"}, "scene": "s", "scenes": {"s": {"nodes": ["n"]}},
        "nodes": {"n": {"meshes": ["m"]}}, "buffers": {"b": {"byteLength": 36, "uri": ")" +
                    uri + R"("}},
        "bufferViews": {"v": {"buffer": "b", "byteOffset": 0, "byteLength": 36, "target": 34962}},
        "accessors": {"a": {"bufferView": "v", "byteOffset": 0, "componentType": 5126, "count": 3, "type": "VEC3"}},
        "meshes": {"m": {"primitives": [{"attributes": {"POSITION": "a"}, "mode": 4}]}}})",
                allow_outside);
  }

  /// The red of the mesh that was loaded last.
  [[nodiscard]] double red() const { return red_; }

 private:
  std::string load(const std::string& name, const std::string& text, bool allow_outside) const {
    const std::string file = dir_.write("home/" + name, text);
    try {
      const Scene scene = Scene::load(file, {1, allow_outside});
      red_ = scene.frame(0, 1).shading[0].color.x;
    } catch (const Error& e) {
      const std::string message = e.what();
      CHECK(message.find('\n') == std::string::npos);
      CHECK(message.rfind(file + ": ", 0) == 0);
      return message.substr(std::min(message.size(), file.size() + 2));
    }
    return "loaded";
  }

  TempDirectory dir_;
  mutable double red_ = 0;
};

}  // namespace

TEST_CASE("glTF: buffers outside the file's folder are refused, whatever the way there") {
  const Folders f;
  const std::string away = (f.path() / "away").string();
  for (const std::string& uri :
       {std::string("../away/data.bin"), away + "/data.bin", std::string("%2e%2e/away/data.bin"),
        std::string("%2E%2E%2Faway%2Fdata.bin"), std::string("below/../../away/data.bin"),
        std::string("./.././away/data.bin"), std::string("out.bin"), std::string("chain.bin"),
        std::string("door/data.bin"), std::string("round/../../away/data.bin")}) {
    INFO(uri);
    CHECK(f.gltf(uri, false) == "buffer 0: '" + uri + "' lies outside the file's folder; --allow-outside reads it");
    CHECK(f.gltf(uri, true) == "loaded");
  }
  // That nothing is there, or no file, is not told of a place that is not to be looked at.
  for (const char* uri :
       {"../../../../../../../../../../../etc/passwd", "/etc/passwd", "../nothing", "/dev/zero", ".."}) {
    INFO(uri);
    CHECK(f.gltf(uri, false).find("lies outside the file's folder") != std::string::npos);
  }
  for (const char* uri : {"data.bin", "below/data.bin", "below/../data.bin", "../home/data.bin", "in.bin",
                          "round/data.bin", "d%61ta.bin"}) {
    INFO(uri);
    CHECK(f.gltf(uri, false) == "loaded");
  }
  for (const char* uri : {"missing.bin", "below", "loop.bin", "data.bin%00/../../../etc/passwd"}) {
    INFO(uri);
    CHECK(f.gltf(uri, false) == "buffer 0: no file " + std::string(uri));
    CHECK(f.gltf(uri, true) == "buffer 0: no file " + std::string(uri));
  }
  for (const bool allow : {false, true})
    CHECK(f.gltf("file:///etc/passwd", allow) == "buffer 0: lies at another place: file:///etc/passwd");
}

TEST_CASE("a scene in the current folder, or reached by a link, has the folder of the name that was given") {
  const Folders f;
  const fs::path before = fs::current_path();
  (void)f.gltf("data.bin", false);
  fs::current_path(f.path() / "home");
  CHECK(test::refusal("scene.gltf") == "loaded");
  fs::current_path(before);
  fs::create_symlink("../home/scene.gltf", f.path() / "away/scene.gltf");
  CHECK(test::refusal((f.path() / "away/scene.gltf").string()) == "loaded");  // with the buffer of `away`
}

TEST_CASE("other formats: an OBJ file's materials and what Assimp opens are confined too") {
  const Folders f;
  for (const std::string name : {"../away/look.mtl", "out.mtl", "door/look.mtl"}) {
    INFO(name);
    const std::string message = f.obj(name, false);
    CHECK(message.find("lies outside the file's folder; --allow-outside reads it") != std::string::npos);
    CHECK(message.find(name) != std::string::npos);
  }
  // For an absolute name, its last part is looked for in an OBJ file's folder first. In a LightWave scene, Assimp opens
  // the name as it is.
  const std::string away = (f.path() / "away/look.mtl").string();
  CHECK(f.obj(away, false) == "loaded");
  CHECK(f.red() == 0.25);
  CHECK(f.lws(away, false).find("lies outside the file's folder; --allow-outside reads it") != std::string::npos);
  CHECK(f.lws(away, true).find("lies outside") == std::string::npos);
  for (const char* name : {"../away/look.mtl", "out.mtl", "look.mtl", "in.mtl", "below/look.mtl"}) {
    INFO(name);
    CHECK(f.obj(name, true) == "loaded");
    CHECK(f.red() == 0.25);
  }
  for (const char* name : {"look.mtl", "in.mtl", "below/look.mtl"}) {
    CHECK(f.obj(name, false) == "loaded");
    CHECK(f.red() == 0.25);
  }
  CHECK(f.obj("../nothing.mtl", false) == "loaded");  // without its colour, as before
  CHECK(f.gltf1("data.bin", false) == "loaded");
  CHECK(f.gltf1("../away/data.bin", true) == "loaded");
  CHECK(f.gltf1("../away/data.bin", false).find("lies outside the file's folder") != std::string::npos);
}

TEST_CASE("textures are the scene's files, though they are not read and may lie anywhere") {
  const TempDirectory dir;
  for (const char* folder : {"home", "away"}) fs::create_directory(dir.path() / folder);
  for (const char* name : {"home/a.png", "home/b c.png", "home/d.png", "away/e.png", "home/unnamed.png"})
    (void)dir.write(name, "");
  const auto textures = [&](const std::string& name, const std::string& text) {
    std::set<std::string> found;
    const Scene scene = Scene::load(dir.write("home/" + name, text));
    for (const fs::path file : scene.files())
      if (file.extension() == ".png") found.insert(file.lexically_relative(real_path(dir.path())).string());
    return found;
  };
  std::string gltf = test::triangle_gltf(R"("nodes": [{"mesh": 0}])");
  gltf.insert(gltf.rfind('}'), R"(, "images": [{"uri": "b%20c.png"}, {"uri": "../away/e.png"}, {"uri": "none.png"}])");
  CHECK(textures("scene.gltf", gltf) == std::set<std::string>{"home/b c.png", "away/e.png"});

  (void)dir.write(
      "home/look.mtl",
      "newmtl m\nmap_Kd a.png # wood\nbump -bm 0.5 b c.png\nmap_d C:\\work\\d.png\nrefl -type sphere none.png\n");
  CHECK(textures("scene.obj", "mtllib look.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n") ==
        std::set<std::string>{"home/a.png", "home/b c.png", "home/d.png"});

  // Names of millions of words, and millions of names, are not looked for word by word.
  std::string many = "newmtl m\nmap_Kd";
  for (int i = 0; i < 1'000'000; ++i) many += " w";
  for (int i = 0; i < 20'000; ++i) many += "\nmap_Ks -s 1 1 1 none" + std::to_string(i) + ".png";
  (void)dir.write("home/look.mtl", many);
  CHECK(textures("scene.obj", "mtllib look.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").empty());

  CHECK(textures("scene.ply",
                 "ply\nformat ascii 1.0\ncomment TextureFile b c.png\ncomment TextureFile none.png\n"
                 "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                 "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n") ==
        std::set<std::string>{"home/b c.png"});

  CHECK(textures("scene.x",
                 "xof 0303txt 0032\nMesh m { 3; 0;0;0;, 1;0;0;, 0;1;0;; 1; 3;0,1,2;;\nMeshMaterialList { 1; 1; 0;;\n"
                 "Material { 1;0;0;1;; 0; 0;0;0;; 0;0;0;; TextureFilename { \"a.png\"; } } } }\n") ==
        std::set<std::string>{"home/a.png"});
}
