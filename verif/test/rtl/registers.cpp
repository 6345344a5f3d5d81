// SPDX-License-Identifier: Apache-2.0
// registers: AXI4-Lite under random timing, every register, interrupt, counters, watchdog.
#include "kage/registers.h"

#include "Vregisters.h"
#include "bench.hpp"
#include "kage/defs.hpp"

using namespace kage::rtl;

namespace {

constexpr std::uint32_t kOkay = 0, kSlverr = 2;
constexpr std::uint32_t kEvents = KAGE_IRQ_FRAME_END_MASK | KAGE_IRQ_ERROR_MASK | KAGE_IRQ_WATCHDOG_MASK;
constexpr ErrorBus kError(kage::Config{});
constexpr BehindBus kBehind(kage::Config{});

class Axil {
 public:
  explicit Axil(Dice& dice) : dice_(dice), top(dice) {
    top->s_axil_awvalid_i = top->s_axil_wvalid_i = top->s_axil_bready_i = top->s_axil_arvalid_i = top->s_axil_rready_i =
        0;
    quiet();
    stall_ = stall_percent(dice);
  }
  void quiet() {
    top->open_i = top->draining_i = top->waiting_input_i = top->coming_i = top->waiting_output_i = 0;
    top->progress_i = top->frame_end_i = top->error_valid_i = top->behind_valid_i = 0;
    put(top->error_i, kError.unit, 0);
    behind(0, 0);
  }
  void behind(std::uint64_t unit, std::uint64_t line) {
    put(top->behind_i, kBehind.unit, unit);
    put(top->behind_i, kBehind.line, line);
  }
  void clock() {
    top.settle();
    top.edge();
  }

  std::uint32_t read(std::uint32_t address, std::uint32_t response = kOkay) {
    bool asked = false;
    for (int n = 0; n < 1000; ++n) {
      if (!asked && !top->s_axil_arvalid_i && !dice_.percent(stall_)) {
        top->s_axil_arvalid_i = 1;
        top->s_axil_araddr_i = static_cast<CData>(address);
      }
      top->s_axil_rready_i = dice_.percent(stall_) ? 0 : 1;
      top.settle();
      const bool ar = top->s_axil_arvalid_i && top->s_axil_arready_o;
      const bool done = top->s_axil_rvalid_o && top->s_axil_rready_i;
      const std::uint32_t value = top->s_axil_rdata_o;
      const std::uint32_t resp = top->s_axil_rresp_o;
      top.edge();
      if (ar) {
        asked = true;
        top->s_axil_arvalid_i = 0;
      }
      if (done) {
        REQUIRE(resp == response);
        top->s_axil_rready_i = 0;
        return value;
      }
    }
    FAIL("no answer to a read");
    return 0;
  }

  void write(std::uint32_t address, std::uint32_t value, std::uint32_t response = kOkay, unsigned strobe = 15) {
    bool aw_done = false, w_done = false;
    for (int n = 0; n < 1000; ++n) {  // address and data in either order
      if (!aw_done && !top->s_axil_awvalid_i && !dice_.percent(stall_)) {
        top->s_axil_awvalid_i = 1;
        top->s_axil_awaddr_i = static_cast<CData>(address);
      }
      if (!w_done && !top->s_axil_wvalid_i && !dice_.percent(stall_)) {
        top->s_axil_wvalid_i = 1;
        top->s_axil_wdata_i = value;
        top->s_axil_wstrb_i = static_cast<CData>(strobe);
      }
      top->s_axil_bready_i = dice_.percent(stall_) ? 0 : 1;
      top.settle();
      const bool aw = top->s_axil_awvalid_i && top->s_axil_awready_o;
      const bool w = top->s_axil_wvalid_i && top->s_axil_wready_o;
      const bool done = top->s_axil_bvalid_o && top->s_axil_bready_i;
      const std::uint32_t resp = top->s_axil_bresp_o;
      top.edge();
      if (aw) {
        aw_done = true;
        top->s_axil_awvalid_i = 0;
      }
      if (w) {
        w_done = true;
        top->s_axil_wvalid_i = 0;
      }
      if (done) {
        REQUIRE((aw_done && w_done));
        REQUIRE(resp == response);
        top->s_axil_bready_i = 0;
        return;
      }
    }
    FAIL("no answer to a write");
  }

 private:
  Dice& dice_;
  int stall_ = 0;

 public:
  Bench<Vregisters> top;
};

}  // namespace

TEST_CASE("Constants and values after reset", "[registers]") {
  each_seed(5, [](Dice& dice) {
    Axil a(dice);
    CHECK(a.read(KAGE_REG_ID) == 0x4B414745);
    CHECK(a.read(KAGE_REG_VERSION) == kage::kStreamVersion);
    CHECK(a.read(KAGE_REG_PARAM_HASH) == kage::param_hash(kage::Config{}));
    CHECK(a.read(KAGE_REG_SHAPE) ==
          (KAGE_FIELD_IS(KAGE_SHAPE_MAX_WIDTH, 640U) | KAGE_FIELD_IS(KAGE_SHAPE_LANES, 4U) |
           KAGE_FIELD_IS(KAGE_SHAPE_BEAT_WORDS, 4U) | KAGE_FIELD_IS(KAGE_SHAPE_ARRANGEMENT, 1U)));
    CHECK(a.read(KAGE_REG_CAPABILITY) == KAGE_CAPABILITY_SPANS_MASK);
    for (const std::uint32_t r :
         {KAGE_REG_CONTROL, KAGE_REG_IRQ, KAGE_REG_WATCHDOG, KAGE_REG_STATUS, KAGE_REG_ERROR, KAGE_REG_ERROR_FRAME,
          KAGE_REG_ERROR_TOKEN, KAGE_REG_ERRORS, KAGE_REG_FRAMES, KAGE_REG_STARVED, KAGE_REG_BLOCKED,
          KAGE_REG_ERROR_UNIT, KAGE_REG_TREE, KAGE_REG_STALL})
      CHECK(a.read(r) == 0);
  });
}

TEST_CASE("Writes: byte strobes, read-only registers, addresses without a register", "[registers]") {
  each_seed(10, [](Dice& dice) {
    Axil a(dice);
    a.write(KAGE_REG_WATCHDOG, 0x11223344);
    a.write(KAGE_REG_WATCHDOG, 0xAABBCCDD, kOkay, 0b0101);
    CHECK(a.read(KAGE_REG_WATCHDOG) == 0x11BB33DD);
    a.write(KAGE_REG_CONTROL, 0xFFFFFFFF);
    CHECK(a.read(KAGE_REG_CONTROL) == kEvents);
    a.write(KAGE_REG_ID, 5);
    CHECK(a.read(KAGE_REG_ID) == 0x4B414745);
    a.write(KAGE_REG_TREE, 0xFFFFFFFF);
    a.write(KAGE_REG_LAST + 4, 1, kSlverr);
    a.write(0xFC, 1, kSlverr);
    a.read(KAGE_REG_LAST + 4, kSlverr);
  });
}

TEST_CASE("Errors, frames and the interrupt", "[registers]") {
  each_seed(10, [](Dice& dice) {
    Axil a(dice);
    a.top->error_valid_i = 1;
    put(a.top->error_i, kError.code, 6);
    put(a.top->error_i, kError.frame, 77);
    put(a.top->error_i, kError.line, 0x7001);
    put(a.top->error_i, kError.token, 123456);
    put(a.top->error_i, kError.unit, 61);
    a.clock();
    a.quiet();
    a.top->frame_end_i = 1;
    a.clock();
    a.quiet();
    CHECK(a.read(KAGE_REG_ERROR) == (KAGE_FIELD_IS(KAGE_ERROR_LINE, 0x7001U) | KAGE_FIELD_IS(KAGE_ERROR_CODE, 6U)));
    CHECK(a.read(KAGE_REG_ERROR_FRAME) == 77);
    CHECK(a.read(KAGE_REG_ERROR_TOKEN) == 123456);
    CHECK(a.read(KAGE_REG_ERROR_UNIT) == 61);
    CHECK(a.read(KAGE_REG_ERRORS) == 1);
    CHECK(a.read(KAGE_REG_FRAMES) == 1);
    CHECK(a.read(KAGE_REG_IRQ) == (KAGE_IRQ_FRAME_END_MASK | KAGE_IRQ_ERROR_MASK));
    CHECK(!a.top->irq_o);
    a.write(KAGE_REG_CONTROL, KAGE_IRQ_ERROR_MASK);
    CHECK(a.top->irq_o);
    a.write(KAGE_REG_IRQ, KAGE_IRQ_FRAME_END_MASK);
    CHECK(a.read(KAGE_REG_IRQ) == KAGE_IRQ_ERROR_MASK);
    CHECK(a.top->irq_o);
    a.write(KAGE_REG_IRQ, KAGE_IRQ_ERROR_MASK);
    CHECK(a.read(KAGE_REG_IRQ) == 0);
    CHECK(!a.top->irq_o);
  });
}

TEST_CASE("Counters and status", "[registers]") {
  each_seed(3, [](Dice& dice) {
    Axil a(dice);
    a.quiet();
    a.top->waiting_input_i = 1;
    for (int i = 0; i < 5; ++i) a.clock();
    a.quiet();
    a.top->waiting_output_i = 1;
    for (int i = 0; i < 7; ++i) a.clock();
    a.quiet();
    a.top->waiting_input_i = a.top->coming_i = 1;  // nothing is waited for while something comes
    for (int i = 0; i < 3; ++i) a.clock();
    CHECK(a.read(KAGE_REG_STATUS) == 0);
    a.quiet();
    CHECK(a.read(KAGE_REG_STARVED) == 5);
    CHECK(a.read(KAGE_REG_BLOCKED) == 7);
    const std::uint32_t before = a.read(KAGE_REG_CYCLES);
    for (int i = 0; i < 10; ++i) a.clock();
    CHECK(a.read(KAGE_REG_CYCLES) >= before + 10);
    a.top->open_i = a.top->waiting_output_i = 1;
    a.clock();  // what the core says is seen a clock later
    CHECK(a.read(KAGE_REG_STATUS) == (KAGE_STATUS_OPEN_MASK | KAGE_STATUS_WAITING_OUTPUT_MASK));
    a.top->open_i = a.top->draining_i = a.top->waiting_input_i = 1;
    a.top->waiting_output_i = 0;
    a.clock();
    CHECK(a.read(KAGE_REG_STATUS) ==
          (KAGE_STATUS_OPEN_MASK | KAGE_STATUS_DRAINING_MASK | KAGE_STATUS_WAITING_INPUT_MASK));
    a.quiet();
    a.top->behind_valid_i = 1;
    a.behind(37, 12345);
    a.top->waiting_input_i = 0;
    a.clock();
    CHECK(a.read(KAGE_REG_TREE) == 0);  // the stream is not waited for
    a.top->waiting_input_i = 1;
    a.clock();
    CHECK(a.read(KAGE_REG_TREE) ==
          (KAGE_TREE_BEHIND_MASK | KAGE_FIELD_IS(KAGE_TREE_LINE, 12345U) | KAGE_FIELD_IS(KAGE_TREE_UNIT, 37U)));
  });
}

TEST_CASE("The watchdog bites once, after its clocks without progress, in a frame only", "[registers]") {
  each_seed(5, [](Dice& dice) {
    Axil a(dice);
    a.write(KAGE_REG_WATCHDOG, 20);
    a.write(KAGE_REG_CONTROL, KAGE_IRQ_WATCHDOG_MASK);
    for (int i = 0; i < 100; ++i) a.clock();  // no frame is open
    CHECK(!a.top->irq_o);
    CHECK(a.read(KAGE_REG_STALL) == 0);
    a.top->open_i = 1;
    for (int i = 0; i < 200; ++i) {  // progress now and then
      a.top->progress_i = i % 20 == 0 ? 1 : 0;
      a.clock();
      REQUIRE(!a.top->irq_o);
    }
    a.top->progress_i = 1;
    a.clock();
    a.top->progress_i = 0;
    a.top->behind_valid_i = a.top->waiting_input_i = 1;
    a.behind(5, 77);
    for (int i = 0; i < 20; ++i) {  // a clock late
      a.clock();
      REQUIRE(!a.top->irq_o);
    }
    a.clock();
    CHECK(a.top->irq_o);
    // STALL tells what was waited for at the bite, whatever has come since.
    a.behind(6, 77);
    a.top->behind_valid_i = a.top->waiting_input_i = 0;
    a.clock();
    CHECK(a.read(KAGE_REG_STALL) == (KAGE_STALL_BEHIND_MASK | KAGE_FIELD_IS(KAGE_STALL_LINE, 77U) |
                                     KAGE_STALL_ON_INPUT_MASK | KAGE_FIELD_IS(KAGE_STALL_UNIT, 5U)));
    CHECK(a.read(KAGE_REG_TREE) == 0);
    a.write(KAGE_REG_IRQ, KAGE_IRQ_WATCHDOG_MASK);
    for (int i = 0; i < 100; ++i) a.clock();
    CHECK(!a.top->irq_o);  // one bite for one standstill
    a.top->progress_i = 1;
    a.clock();
    a.top->progress_i = 0;
    a.top->waiting_output_i = 1;
    for (int i = 0; i < 21; ++i) a.clock();
    CHECK(a.top->irq_o);
    CHECK(a.read(KAGE_REG_STALL) == (KAGE_FIELD_IS(KAGE_STALL_LINE, 77U) | KAGE_STALL_ON_OUTPUT_MASK));
    a.write(KAGE_REG_WATCHDOG, 0);
    a.write(KAGE_REG_IRQ, KAGE_IRQ_WATCHDOG_MASK);
    for (int i = 0; i < 100; ++i) a.clock();
    CHECK(!a.top->irq_o);  // off
  });
}
