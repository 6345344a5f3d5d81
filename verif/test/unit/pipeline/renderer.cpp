// SPDX-License-Identifier: Apache-2.0
// Sources of frames and the renderer: the words and pixels of the steps one by one, and what is left of a frame that
// ended half-way.
#include <filesystem>
#include <stdexcept>

#include "kage/error.hpp"
#include "kage/pipeline.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

struct Stop : std::runtime_error {
  Stop() : std::runtime_error("stop") {}
};

Config config_of(const char* name) { return load_config(name).config; }

}  // namespace

TEST_CASE("a scene's frames have the words of geometry and front end, and the pixels of the golden core") {
  const auto scene = std::make_shared<const Scene>(Scene::load("glass"));
  const Config config = config_of("glass");
  SceneFrames frames(scene, config, {.width = kWidth, .height = kHeight, .frames = 3, .threads = 1});
  Renderer renderer(frames, true);
  REQUIRE(frames.frames() == 3);
  for (const int i : {2, 0, 1}) {  // in any order: what is kept from frame to frame changes no word
    std::vector<std::uint32_t> words;
    make_frame(make_geometry(scene->frame(i, 3), config, kWidth, kHeight), config, static_cast<std::uint32_t>(i), words,
               {.threads = 1});
    CHECK(frames.words(i) == words);
    Image image(kWidth, kHeight, config.channels);
    GoldenCore core(config);
    core.frame(words, [&](int y, std::span<const std::uint8_t> line) {
      std::copy(line.begin(), line.end(), image.data.begin() + static_cast<std::ptrdiff_t>(image.index(0, y)));
    });
    CHECK(renderer.image(i) == image);
    REQUIRE(renderer.counts());
    CHECK(renderer.counts()->words == words.size());
    Renderer direct(frames);
    CHECK(direct.image(i) == image);
    CHECK(!direct.counts());
  }
  CHECK_THROWS_AS(frames.words(3), Error);
  CHECK_THROWS_AS(frames.words(-1), Error);
}

TEST_CASE("an order that was refused names the scene, the frame and the limit") {
  SceneFrames frames(std::make_shared<const Scene>(Scene::load("glass")), config_of("glass"),
                     {.width = kWidth, .height = kHeight, .order = {.max_fragments = 5, .progress = {}}, .threads = 1});
  std::string said;
  std::uint64_t limit = 0;
  try {
    frames.words(1);
  } catch (const TooManyFragments& e) {
    said = e.what();
    limit = e.limit();
  }
  CHECK(said == "glass: frame 1: to be put in order, polygons would be cut into more than 5 fragments");
  CHECK(limit == 5);
}

TEST_CASE("a stream file's frames are its words, and its pictures the scene's") {
  SceneFrames frames(Scene::load("courtyard"), {.width = kWidth, .height = kHeight, .frames = 2});
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "kage_pipeline_test.kage";
  StreamFileWriter writer(path, frames.config());
  for (int i = 0; i < frames.frames(); ++i) writer.frame(frames.words(i));
  writer.finish();
  StreamFrames again(std::make_shared<const StreamFile>(path));
  std::filesystem::remove(path);
  REQUIRE(again.frames() == frames.frames());
  CHECK(again.config() == frames.config());
  for (int i = 0; i < frames.frames(); ++i) {
    CHECK(again.words(i) == frames.words(i));
    CHECK(Renderer(again).image(i) == Renderer(frames).image(i));
  }
}

TEST_CASE("lines longer than MAX_WIDTH are refused by words and without them") {
  Config narrow = config_of("default");
  narrow.max_width = 48;
  SceneFrames frames(std::make_shared<const Scene>(Scene::load("courtyard")), narrow,
                     {.width = kWidth, .height = kHeight, .frames = 1});
  for (const bool through_words : {false, true}) {
    Renderer renderer(frames, through_words);
    CHECK_THROWS_AS(renderer.image(0), Error);
  }
}

TEST_CASE("a frame that its sink ends, at any line, leaves nothing in the renderer") {
  SceneFrames frames(Scene::load("courtyard"), {.width = kWidth, .height = kHeight, .frames = 2});
  const Image wanted = Renderer(frames).image(1);
  for (const bool through_words : {false, true})
    for (const int last : {0, 17, kHeight - 1}) {
      Renderer renderer(frames, through_words);
      const auto stop = [&](int y, std::span<const std::uint8_t>) {
        if (y == last) throw Stop();
      };
      CHECK_THROWS_AS(renderer.frame(
                          0, [](int, int) {}, stop),
                      Stop);
      CHECK(renderer.image(1) == wanted);
    }
}

TEST_CASE("options that are not as they say are refused before a frame is made") {
  const auto scene = std::make_shared<const Scene>(Scene::load("courtyard"));
  for (const DrawOptions& wrong :
       {DrawOptions{.width = 0}, DrawOptions{.height = kMaxSize + 1}, DrawOptions{.frames = -1}})
    CHECK_THROWS_AS(SceneFrames(scene, Config{}, wrong), Error);
}

TEST_CASE("a frame that a configuration cannot hold is refused by scene and frame; with Look::fit it is drawn") {
  const auto scene = std::make_shared<const Scene>(Scene::load("canopy"));
  Config config = config_of("counting");
  config.dsf_bits = 2;
  DrawOptions options{.width = kWidth, .height = kHeight, .frames = 2};
  SceneFrames frames(scene, config, options);
  CHECK_THROWS_WITH(frames.words(1), Catch::Matchers::StartsWith("canopy: frame 1: several shadow volumes need FSF"));
  options.look.fit = true;
  SceneFrames fitted(scene, config, options);
  FrameParts parts;
  fitted.frame(
      1, [](std::span<const std::uint32_t>) {}, parts);
  CHECK(parts.geometry.left_out > 0);
  REQUIRE(parts.geometry.volumes.size() == 1);
  // Nothing is left of the others, which the front end would draw.
  CHECK(parts.geometry.volumes[0].face_count == parts.geometry.volume_faces.size());
  CHECK(parts.geometry.volumes[0].near_count == parts.geometry.near_edges.size());
}

}  // namespace kage::verif
