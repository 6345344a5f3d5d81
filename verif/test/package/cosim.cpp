// SPDX-License-Identifier: Apache-2.0
// A scene made in memory goes through golden model and RTL: cosim_consumer [FAULT]
#include <cstdio>
#include <exception>
#include <kage/cosim.hpp>

int main(int argc, char** argv) try {
  kage::SceneParts parts;
  parts.name = "pyramid";
  parts.objects = {{.name = "floor",
                    .positions = {{-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}},
                    .triangles = {{0, 1, 2}, {0, 2, 3}}},
                   {.name = "pyramid",
                    .positions = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {0, 2, 0}},
                    .triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}}};
  kage::Light sun;  // it wanders from frame to frame
  for (const double x : {-1.0, 0.0, 1.0}) {
    sun.direction = {x, -1, 0.5};
    parts.lights.push_back({sun});
  }
  kage::cosim::CosimOptions options;
  options.scene = std::make_shared<const kage::Scene>(kage::Scene::from(parts));
  options.size = {160, 120};
  options.all_spans = true;  // the RTL has more to compare than pixels need
  if (argc > 1) options.rtl.fault = argv[1];
  const kage::cosim::SceneResult r = kage::cosim::run(options).scenes.front();
  std::printf("%s: %d frames, %llu pixels\n", r.same ? "same" : "different", r.frames,
              static_cast<unsigned long long>(r.pixels));
  if (r.difference) std::printf("%s\n", r.difference->text.c_str());
  if (r.difference && r.difference->divergence)
    std::printf("first divergence: %s\n", r.difference->divergence->text.c_str());
  return r.same ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 2;
}
