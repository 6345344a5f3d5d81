// SPDX-License-Identifier: Apache-2.0
// kage_top at its ports, where core_random's driver does not go: what is ready in reset, and the watchdog, with the
// smallest limits, under stalls whose longest is known.
#include "Vkage_banked.h"
#include "Vkage_polygons.h"
#include "Vkage_systolic.h"
#include "top_bench.hpp"

using namespace kage::rtl;

TEST_CASE("In reset nothing is ready or valid, and a beat offered through it is not lost", "[kage_top]") {
  reset_test<Vkage_banked>();
  reset_test<Vkage_systolic>();
  reset_test<Vkage_polygons>();
}

TEST_CASE("A reset within a frame leaves nothing of it", "[kage_top]") {
  reset_within_test<Vkage_banked>();
  reset_within_test<Vkage_systolic>();
  reset_within_test<Vkage_polygons>();
}

TEST_CASE("A watchdog longer than any rest of the ports never bites a healthy frame", "[kage_top]") {
  healthy_test<Vkage_banked>();
  healthy_test<Vkage_systolic>();
  healthy_test<Vkage_polygons>();
}

TEST_CASE("The watchdog names an input that stops and an output that stops, once each", "[kage_top]") {
  standstill_test<Vkage_banked>();
  standstill_test<Vkage_systolic>();
  standstill_test<Vkage_polygons>();
}
