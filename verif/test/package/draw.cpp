// SPDX-License-Identifier: Apache-2.0
// A mesh, or a built-in scene, as a picture: draw_consumer MESH PICTURE.png
#include <kage/pipeline.hpp>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  kage::SceneFrames frames(kage::Scene::load(argv[1]), {.width = 640, .height = 480});
  kage::save_image(argv[2], kage::Renderer(frames).image(0));
}
