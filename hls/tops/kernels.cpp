// SPDX-License-Identifier: Apache-2.0
//
// The kernels as the functions that tools take: of the widest widths where a core's own are narrower, because what a
// core does not connect costs it nothing.
#include "kernels/compare_cell.hpp"
#include "kernels/edge_setup.hpp"
#include "kernels/edge_step.hpp"
#include "kernels/plane_step.hpp"
#include "kernels/segment_make.hpp"
#include "kernels/span_setup.hpp"
#include "pragmas.hpp"

namespace kage::hls {

constexpr int kPlaneBits = 54;  // Z_BITS 28, and 26
constexpr int kDepthBits = 46;  // depth_bits of Z_BITS 28, Z_FRAC 16

extern "C" {

void hls_edge_setup(const EdgeSetupIn& __restrict in, Edge& __restrict out) {
  KAGE_HLS_PIPELINE
  edge_setup(in, out);
}
void hls_edge_step(const Edge& __restrict in, Edge& __restrict out) {
  KAGE_HLS_PIPELINE
  edge_step(in, out);
}
void hls_plane_step(const PlaneStepIn<kPlaneBits>& __restrict in, PlaneStepOut<kPlaneBits>& __restrict out) {
  KAGE_HLS_PIPELINE
  plane_step(in, out);
}
void hls_span_setup(const SpanSetupIn<kPlaneBits>& __restrict in, SpanSetupOut<kPlaneBits>& __restrict out) {
  KAGE_HLS_PIPELINE
  span_setup(in, out);
}
void hls_segment_make(const SegmentMakeIn<15, kDepthBits>& __restrict in,
                      SegmentMakeOut<15, 15, kDepthBits>& __restrict out) {
  KAGE_HLS_PIPELINE
  segment_make(in, out);
}
void hls_compare_cell(const CompareCellIn<44, 35>& __restrict in, TreePoint<44, 35>& __restrict out) {
  KAGE_HLS_PIPELINE
  compare_cell(in, out);
}
}

}  // namespace kage::hls
