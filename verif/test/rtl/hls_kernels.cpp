// SPDX-License-Identifier: Apache-2.0
// The modules that hls/tool makes, against the kernels that they are made of (hls_pipelines.hpp).
#include <cstdlib>
#include <string>

#include "Vhls_edge_setup.h"
#include "Vhls_edge_step.h"
#include "Vhls_plane_step.h"
#include "Vhls_segment_make.h"
#include "Vhls_span_setup.h"
#include "bench.hpp"
#include "hls_pipelines.hpp"

using namespace kage::rtl;

namespace {

long vectors() {
  const char* asked = std::getenv("KAGE_HLS_VECTORS");
  return asked != nullptr ? std::strtol(asked, nullptr, 10) : 100000;
}

template <class Ports, class Model>
void same(std::uint64_t stages) {
  each_seed(4, [&](Dice& dice) {
    for (const Stalls& stalls : all_stalls(dice)) {
      Bench<Model> top(dice);
      REQUIRE(wrong_in<Ports>(top, dice, stages, vectors() / 12, stalls) == std::string());
    }
  });
}

}  // namespace

TEST_CASE("hls_edge_setup does what its kernel does", "[hls_kernels]") {
  same<EdgeSetupPorts, Vhls_edge_setup>(KAGE_CLOCKS_hls_edge_setup);
}

TEST_CASE("hls_edge_step does what its kernel does", "[hls_kernels]") {
  same<EdgeStepPorts, Vhls_edge_step>(KAGE_CLOCKS_hls_edge_step);
}

TEST_CASE("hls_plane_step does what its kernel does", "[hls_kernels]") {
  same<PlaneStepPorts, Vhls_plane_step>(KAGE_CLOCKS_hls_plane_step);
}

TEST_CASE("hls_span_setup does what its kernel does", "[hls_kernels]") {
  same<SpanSetupPorts, Vhls_span_setup>(KAGE_CLOCKS_hls_span_setup);
}

TEST_CASE("hls_segment_make does what its kernel does", "[hls_kernels]") {
  same<SegmentMakePorts, Vhls_segment_make>(KAGE_CLOCKS_hls_segment_make);
}
