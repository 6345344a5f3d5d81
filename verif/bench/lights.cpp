// SPDX-License-Identifier: Apache-2.0
// How far the light of pictures, as kage render draws them, is from the reference (verif/oracle/light_reference.hpp).
// 320x240; errors in LSB of a channel: mean and worst over pixels in some shadow, then over those of faces that are in
// none.
#include <fmt/format.h>

#include "kage/geometry.hpp"
#include "kage/pipeline.hpp"
#include "oracle/judge.hpp"
#include "oracle/light_reference.hpp"
#include "stimulus/scenes/lit_scenes.hpp"

namespace {

using namespace kage;
using namespace kage::verif;

constexpr int kWidth = 320;
constexpr int kHeight = 240;

void reference_errors() {
  fmt::print("{:17} {:13} {:>5} {:>8} {:>6} {:>6} {:>6} {:>6} {:>6}\n", "scene", "configuration", "ties", "shadowed",
             "mean", "worst", "else", "worst", "dB");
  for (const LitScene& lit : lit_scenes()) {
    const Scene scene = Scene::from(lit.parts);
    const DrawOptions options{.width = kWidth, .height = kHeight};
    const NamedConfig chosen = choose_config(scene, options);
    const SceneFrame f = scene.frame(0, 1);
    const RayScene rays(f);
    const LightReference reference(f, rays, sampled_points(f, options.look), kWidth, kHeight);
    const FrameGeometry g = make_geometry(f, chosen.config, kWidth, kHeight, {.look = options.look});
    const LightError e = compare_light(draw(g, chosen.config), kWidth, kHeight, reference);
    fmt::print("{:17} {:13} {:5} {:8} {:6.2f} {:6.1f} {:6.2f} {:6.1f} {:6.1f}\n", lit.name, chosen.name, e.ties,
               e.shadowed, e.mean(), e.worst, e.lit_mean(), e.lit_worst, e.psnr());
  }
}

}  // namespace

int main() { reference_errors(); }
