// SPDX-License-Identifier: Apache-2.0
// The import process and its limits, and files that are no scenes.
#include <dlfcn.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

#include "files.hpp"
#include "plugin/plugin.hpp"
#include "scene/child.hpp"
#include "scene/wire.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using scene::ImportLimits;
using test::refusal;
using test::TempDirectory;

namespace {

using Bytes = std::vector<std::uint8_t>;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer);  // clang's
#else
constexpr bool kSanitized = false;
#endif

Bytes answer(const std::string& work, const ImportLimits& limits = {}) {
  return scene::answer_of(
      {KAGE_IMPORT_ANSWERS, work, std::to_string(getpid()), std::to_string(limits.seconds), std::to_string(limits.mib)},
      "x", limits);
}

std::string end_of(const std::string& work, const ImportLimits& limits = {}) {
  try {
    (void)answer(work, limits);
  } catch (const Error& e) {
    return e.what();
  }
  return "returned";
}

}  // namespace

TEST_CASE("what the process returns or throws arrives") {
  const Bytes large = answer("large");
  REQUIRE(large.size() == 5'000'000);
  for (std::size_t i = 0; i < large.size(); ++i)
    if (large[i] != static_cast<std::uint8_t>(i * 7)) FAIL(i);
  CHECK(answer("nothing").empty());
  CHECK(end_of("error") == "x: no good");
  CHECK(end_of("bare") == "x: bare");
}

TEST_CASE("the process's death is told by its cause") {
  CHECK(end_of("killed") == "x: killed by signal 9 while importing");
  CHECK(end_of("code") == "x: the import process ended with code 7 and gave no scene");
  if (!kSanitized) CHECK(end_of("abort") == "x: killed by signal 6 while importing");
}

TEST_CASE("a process that cannot be started, and one that is no importer, are told") {
  try {
    (void)scene::answer_of({"/no/such/kage-import"}, "x", {});
    FAIL("started");
  } catch (const Error& e) {
    CHECK(std::string(e.what()) == "x: no import process: /no/such/kage-import: No such file or directory");
  }
  CHECK_THROWS_WITH(scene::answer_of({"/bin/true"}, "x", {}),
                    "x: the import process ended with code 0 and gave no scene");
  // Whoever starts kage-import by hand is told what it is, on standard error, with exit code 2.
  CHECK_THROWS_WITH(scene::answer_of({helper_file(scene::kImporter, "").string()}, "x", {}),
                    "x: the import process ended with code 2 and gave no scene");
}

TEST_CASE("time and memory are limited") {
  CHECK(end_of("pause", {1, 64}) == "x: import took longer than 1 s");
  CHECK(end_of("busy", {1, 64}) == "x: import took longer than 1 s");
  CHECK(end_of("100 MiB", {60, 150}) == "returned");
  if (kSanitized) return;  // it ends the program rather than throw
  CHECK(end_of("300 MiB", {60, 150}) == "x: import needs more than 150 MiB");
  CHECK(end_of("all memory") == "x: import needs more than 4096 MiB");
}

TEST_CASE("limits come from the environment") {
  setenv("KAGE_IMPORT_SECONDS", "7", 1);
  setenv("KAGE_IMPORT_MIB", "100", 1);
  CHECK(ImportLimits::from_environment().seconds == 7);
  CHECK(ImportLimits::from_environment().mib == 100);
  for (const char* bad : {"0", "-3", "x", "7x", "99999999999999999999"}) {
    setenv("KAGE_IMPORT_SECONDS", bad, 1);
    CHECK_THROWS_AS(ImportLimits::from_environment(), Error);
  }
  unsetenv("KAGE_IMPORT_SECONDS");
  unsetenv("KAGE_IMPORT_MIB");
  CHECK(ImportLimits::from_environment().seconds == 20);
}

TEST_CASE("a packed scene survives, and damage to it is noticed") {
  scene::RawScene s;
  s.meshes.resize(2);
  s.meshes[1].name = "m";
  s.meshes[1].primitives.resize(1);
  s.meshes[1].primitives[0].positions = {1, 2, 3};
  s.nodes.resize(3);
  s.nodes[2].name = "node";
  s.camera.emplace().half_height = 0.125;
  s.notes = {"a", ""};
  const Bytes bytes = scene::packed(s);
  const scene::RawScene t = scene::unpacked(bytes);
  CHECK(t.meshes[1].name == "m");
  CHECK(t.meshes[1].primitives[0].positions[2] == 3);
  CHECK(t.nodes[2].name == "node");
  CHECK(t.camera->half_height == 0.125);
  CHECK(t.lights.empty());
  CHECK(t.notes == s.notes);
  for (std::size_t cut = 0; cut < bytes.size(); ++cut)
    CHECK_THROWS_AS(scene::unpacked(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(cut))), Error);
  Bytes more = bytes;
  more.push_back(0);
  CHECK_THROWS_AS(scene::unpacked(more), Error);
}

TEST_CASE("files that are none") {
  const TempDirectory dir;
  const std::string missing = (dir.path() / "missing.obj").string();
  const auto none_of = [](const std::string& meant) {
    return fmt::format(": no such file, and no built-in scene of that name{} (there are {})", meant,
                       fmt::join(builtin_scenes(), ", "));
  };
  const std::string none = none_of("");
  CHECK(refusal(missing) == missing + none);
  CHECK(refusal("courtyrad") == "courtyrad" + none_of(" (did you mean courtyard?)"));
  CHECK(refusal(dir.path().string()) == dir.path().string() + ": is a directory");
  for (const char* blank : {"", " "}) CHECK(refusal(blank) == fmt::format("'{}'", blank) + none);
  const std::string empty = dir.write("empty.ply", "");
  CHECK(refusal(empty) == empty + ": is empty");
  const std::string fifo = (dir.path() / "fifo.obj").string();
  REQUIRE(mkfifo(fifo.c_str(), 0600) == 0);
  CHECK(refusal(fifo) == fifo + ": is not a regular file");
  if (geteuid() != 0) {
    const std::string secret = dir.write("secret.obj", "v 0 0 0\n");
    chmod(secret.c_str(), 0);
    CHECK(refusal(secret) == secret + ": cannot be read: Permission denied");
  }
  const std::string through = dir.write("plain", "x") + "/below.obj";
  CHECK(refusal(through).rfind(through + ": ", 0) == 0);
}

TEST_CASE("files that hold no scene are refused in one line") {
  const TempDirectory dir;
  const std::string nothing = dir.write("noise.xyz", "what is this?");
  const std::vector<std::string> files{nothing,
                                       dir.write("noise.obj", std::string("\0\1\2\3", 4)),
                                       dir.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n"),
                                       dir.write("nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n"),
                                       dir.write("range.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n"),
                                       dir.write("same.obj", "v 0 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n"),
                                       dir.write("cut.ply", "ply\nformat ascii 1.0\nelement vertex"),
                                       dir.write("absurd.off", "OFF\n2000000000 2000000000 0\n0 0 0\n"),
                                       dir.write("fake.glb", "glTF\2\0\0\0"),
                                       dir.write("name\nwith a break.obj", "?"),
                                       dir.write("one.glb", std::string("glTF\1\0\0\0", 8) + std::string(12, ' '))};
  for (const std::string& file : files) {
    const std::string message = refusal(file);
    INFO(message);
    CHECK(message != "loaded");
    CHECK(message.find('\n') == std::string::npos);
    CHECK(message.rfind(dir.path().string(), 0) == 0);
  }
  CHECK(refusal(files[3]) == files[3] + ": line 2: nan is not finite");
  CHECK(refusal(files[4]) == files[4] + ": line 3: vertex 3 of 2 is named");
  CHECK(refusal(files[5]).find("no faces: every triangle repeats a vertex") != std::string::npos);
  CHECK(refusal(files[10]) == files[10] + ": binary glTF 1 is not read (glTF 2, and glTF 1 as .gltf, are)");
}

TEST_CASE("an OBJ file that names a vertex which is not there is refused with the first such line") {
  const TempDirectory dir;
  const auto of = [&](const std::string& text) {
    const std::string file = dir.write("t.obj", text);
    const std::string message = refusal(file);
    return message.rfind(file + ": ", 0) == 0 ? message.substr(file.size() + 2) : message;
  };
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  CHECK(of("f 1/7 2/1/9 3//5\n" + three) == "loaded");  // before its vertices; 7, 9 and 5 are none
  CHECK(of(three + "f -1 -2 -3\n") == "loaded");
  CHECK(of(three + "f 1 2 4\nf 1 2 9\n") == "line 4: vertex 4 of 3 is named");
  CHECK(of("f 1 2 3\nf 1 2 5\nf 1 2 4\nf 1 2 9\n" + three + "v 1 1 1\n") == "line 2: vertex 5 of 4 is named");
  CHECK(of(three + "f 1 2 3\n\nl 1 \\\n4\n") == "line 6: vertex 4 of 3 is named");
  CHECK(of("f -1 -2 -3\n" + three) == "line 1: vertex -1 of 0 is named");
  CHECK(of(three + "f -1 -2 -4\n") == "line 4: vertex -4 of 3 is named");
  CHECK(of(three + "f 1 2 99999999999999999999\n") == "line 4: 99999999999999999999 is no vertex's number");
  CHECK(of(three + "f 0 1 2\n") == "line 4: 0 is no vertex's number");
  CHECK(of(three + "f a 1 2\n") == "line 4: a is no vertex's number");
}

TEST_CASE("a mesh without any area is refused, one among others is named in a note") {
  const TempDirectory dir;
  const std::string flat = "o a\nv 0 0 0\nv 1 2 3\nv 2 4 6\nf 1 2 3\n";
  const std::string alone = dir.write("flat.obj", flat);
  CHECK(refusal(alone) == alone + ": no faces: no triangle has an area");
  const Scene two = Scene::load(dir.write("two.obj", flat + "o b\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 4 5 6\n"));
  CHECK(test::has_note(two, "1 object is not seen: none of its triangles has an area"));
}

TEST_CASE("a scene too far out for its size is noted") {
  const TempDirectory dir;
  for (const auto& [x, noted] : {std::pair{"0", false}, {"300000000", false}, {"1000000000", true}, {"1e17", true}}) {
    std::string text;
    for (const char* yz : {"0 0", "1 0", "0 1"}) text += std::string("v ") + x + " " + yz + "\n";
    const Scene scene = Scene::load(dir.write("far.obj", text + "f 1 2 3\n"));
    INFO(x);
    CHECK(test::has_note(scene, "so far from the origin") == noted);
  }
}

TEST_CASE("what a frame lacks is said with the file's path") {
  const TempDirectory dir;
  const std::string file = dir.write("eye.gltf", test::triangle_gltf(R"("nodes": [{"mesh": 0},
      {"name": "eye", "camera": 0, "scale": [0, 0, 0]}],
      "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}])"));
  CHECK(refusal(file) == file + ": node 'eye': the camera has no direction");
}

TEST_CASE("a scene is loaded whatever locks other threads hold") {
  const TempDirectory dir;
  const std::string good = dir.write("good.gltf", test::triangle_gltf(R"("nodes": [{"mesh": 0}])"));
  std::atomic<bool> over{false};
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&] {
      while (!over) {
        void* const library = dlopen("libm.so.6", RTLD_NOW);
        std::fflush(stderr);
        const Bytes some(1000);
        if (library != nullptr) dlclose(library);
      }
    });
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 40; ++i) CHECK(refusal(good) == "loaded");
  over = true;
  for (std::thread& t : threads) t.join();
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(kSanitized ? 120 : 20));
}

TEST_CASE("several threads load at once") {
  const TempDirectory dir;
  const std::string good = dir.write("good.gltf", test::triangle_gltf(R"("nodes": [{"mesh": 0}])"));
  const std::string bad = dir.write("bad.gltf", "{");
  std::vector<std::string> results(8);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < results.size(); ++i)
    threads.emplace_back([&, i] { results[i] = refusal(i % 2 == 0 ? good : bad); });
  for (std::thread& t : threads) t.join();
  for (std::size_t i = 0; i < results.size(); ++i) {
    INFO(results[i]);
    CHECK((results[i] == "loaded") == (i % 2 == 0));
  }
}
