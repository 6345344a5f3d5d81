// SPDX-License-Identifier: Apache-2.0
// The text of a progress line.
#include "cosim/session/frame_progress.hpp"
#include "test/support/catch.hpp"

using kage::cosim::progress_text;

TEST_CASE("frames, rate and time left") {
  REQUIRE(progress_text("a", 0, 8, 0) == "a: frame 1/8");
  REQUIRE(progress_text("a", 0, 8, 100) == "a: frame 1/8");   // none is done
  REQUIRE(progress_text("a", 3, 8, 0.05) == "a: frame 4/8");  // too short to tell
  REQUIRE(progress_text("a", 2, 8, 1) == "a: frame 3/8, 2.0 frames/s, 3 s left");
  REQUIRE(progress_text("a", 4, 8, 0.1) == "a: frame 5/8, 40 frames/s, 1 s left");
  REQUIRE(progress_text("a", 1, 8, 2.5) == "a: frame 2/8, 2.5 s a frame, 18 s left");
  REQUIRE(progress_text("a", 1, 50, 2) == "a: frame 2/50, 2.0 s a frame, 1 min 38 s left");
  REQUIRE(progress_text("a", 1, 1000, 30) == "a: frame 2/1000, 30.0 s a frame, 8 h 19 min left");
  REQUIRE(progress_text("a", 8, 8, 4) == "a: frame 8/8, 2.0 frames/s, 0 s left");
}
