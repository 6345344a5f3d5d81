// SPDX-License-Identifier: Apache-2.0
// Tries mutants of a generated pipeline by the vectors of rtl/hls_kernels, and of the blender by all inputs, as
// rtl/hls_blend. Program hls/tool/mutants_run.py compiles it, once for each module. MODEL is Verilator's class,
// whose input mutant_i chooses the mutant. PORTS is the struct of hls_pipelines.hpp and STAGES the pipeline's
// stages; or BLEND_FRAC is the blender's SHADE_FRAC.
//
// usage: mutants VECTORS SEED NUMBER...     prints a line for each: NUMBER, and what is wrong with it, or "lives"
// Exit code 1: the module without a mutant, number 0, has something wrong; 2: usage.
#include <cstdio>
#include <cstdlib>
#include <string>

#ifdef BLEND_FRAC
#include "hls_blend.hpp"
#else
#include "hls_pipelines.hpp"
#endif

namespace {

#ifdef BLEND_FRAC
std::string wrong_with(unsigned mutant, long /*vectors*/, std::uint64_t /*seed*/) {
  MODEL model;
  model.mutant_i = static_cast<SData>(mutant);
  return kage::rtl::wrong_in_blend(model, BLEND_FRAC);
}
#else
using kage::rtl::Bench;
using kage::rtl::Dice;

std::string wrong_with(unsigned mutant, long vectors, std::uint64_t seed) {
  for (std::uint64_t round = 0; round < 4; ++round) {
    Dice dice(seed + round);
    for (const kage::rtl::Stalls& stalls : kage::rtl::all_stalls(dice)) {
      Bench<MODEL> top(dice, [&](MODEL& m) { m.mutant_i = static_cast<SData>(mutant); });
      std::string wrong = kage::rtl::wrong_in<kage::rtl::PORTS>(top, dice, STAGES, vectors / 12 + 1, stalls);
      if (!wrong.empty()) return wrong;
    }
  }
  return {};
}
#endif

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const long vectors = std::strtol(argv[1], nullptr, 10);
  const std::uint64_t seed = std::strtoull(argv[2], nullptr, 10);
  if (const std::string wrong = wrong_with(0, vectors, seed); !wrong.empty()) {
    std::printf("0 %s\n", wrong.c_str());
    return 1;
  }
  for (int i = 3; i < argc; ++i) {
    const std::string wrong = wrong_with(static_cast<unsigned>(std::strtoul(argv[i], nullptr, 10)), vectors, seed);
    std::printf("%s %s\n", argv[i], wrong.empty() ? "lives" : wrong.c_str());
  }
  return 0;
}
