// SPDX-License-Identifier: Apache-2.0
//
// The master of the core's AXI4-Lite port: a write and a read at a time. A line of address or data has noise while its
// valid is 0, so a core that looks at it then does not get what it wants by luck.
#pragma once

#include <cstdint>

#include "flow.hpp"
#include "rtl_model.h"

/// When an access does what: clocks since it began, and clocks that a response waits for its ready. 0: ready is there
/// from the first clock on, whether there is a response or none.
struct AccessTiming {
  int address = 0;
  int data = 0;
  int ready = 0;
};

/// An access that is under way, or has ended.
class Access {
 public:
  void begin(const AccessTiming& timing, bool has_data) {
    timing_ = timing;
    clock_ = waited_ = 0;
    address_taken_ = false;
    data_taken_ = !has_data;
    open_ = true;
  }
  /// It ends without a response.
  void drop(int answer) {
    answer_ = answer;
    open_ = false;
  }

  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] bool address_valid() const { return open_ && !address_taken_ && clock_ >= timing_.address; }
  [[nodiscard]] bool data_valid() const { return open_ && !data_taken_ && clock_ >= timing_.data; }
  [[nodiscard]] bool ready() const { return open_ && waited_ >= timing_.ready; }
  /// The response, or what came in its place.
  [[nodiscard]] int answer() const { return answer_; }
  [[nodiscard]] std::uint32_t value() const { return held_; }

  /// A clock's end: what the core says in it.
  void look(bool address_ready, bool data_ready, bool valid, int response, std::uint32_t value) {
    if (!open_) return;
    address_taken_ = address_taken_ || (address_valid() && address_ready);
    data_taken_ = data_taken_ || (data_valid() && data_ready);
    if (valid && !(address_taken_ && data_taken_)) return drop(KAGE_RTL_UNASKED);
    if (waited_ > 0 && (!valid || response != answer_ || value != held_)) return drop(KAGE_RTL_UNSTABLE);
    answer_ = response;
    held_ = value;
    if (valid && ready()) open_ = false;
    if (valid) ++waited_;
    ++clock_;
  }

 private:
  AccessTiming timing_;
  int clock_ = 0;
  int waited_ = 0;  // clocks in which the response has been there
  bool address_taken_ = false;
  bool data_taken_ = false;
  bool open_ = false;
  int answer_ = KAGE_RTL_NO_ANSWER;
  std::uint32_t held_ = 0;
};

class RegisterBus {
 public:
  Access write;
  Access read;

  void begin_write(std::uint32_t address, std::uint32_t data, unsigned strobes, const AccessTiming& timing) {
    write_address_ = address;
    data_ = data;
    strobes_ = strobes;
    write.begin(timing, true);
  }
  void begin_read(std::uint32_t address, const AccessTiming& timing) {
    read_address_ = address;
    read.begin(timing, false);
  }

  /// Timing of an access by a master that takes its time: address first, data first, both at once, in turn; most
  /// responses wait.
  AccessTiming patient(Random& random) {
    const unsigned turn = turn_++;
    AccessTiming t;
    (turn % 3 == 0 ? t.address : t.data) = turn % 3 == 2 ? 0 : static_cast<int>(random.in(1, 6));
    t.ready = turn % 4 == 3 ? 0 : static_cast<int>(random.in(1, 6));
    return t;
  }

  /// A clock begins: what the master says in it. Between accesses the lines keep the noise that they have: new noise in
  /// every clock would wake the core's read channel in every clock, in frames that ask no register.
  template <class Top>
  void drive(Top& top, Random& noise) {
    const bool busy = write.open() || read.open();
    if (!busy && at_rest_) return;
    at_rest_ = !busy;
    const auto byte = [&] { return static_cast<std::uint8_t>(noise.next()); };
    top.s_axil_awvalid_i = write.address_valid() ? 1 : 0;
    top.s_axil_awaddr_i = write.address_valid() ? static_cast<std::uint8_t>(write_address_) : byte();
    top.s_axil_wvalid_i = write.data_valid() ? 1 : 0;
    top.s_axil_wdata_i = write.data_valid() ? data_ : noise.next();
    top.s_axil_wstrb_i = static_cast<std::uint8_t>((write.data_valid() ? strobes_ : byte()) & 15U);
    top.s_axil_bready_i = write.ready() ? 1 : 0;
    top.s_axil_arvalid_i = read.address_valid() ? 1 : 0;
    top.s_axil_araddr_i = read.address_valid() ? static_cast<std::uint8_t>(read_address_) : byte();
    top.s_axil_rready_i = read.ready() ? 1 : 0;
  }

  /// Its end: what the core says.
  template <class Top>
  void look(const Top& top) {
    write.look(top.s_axil_awready_o, top.s_axil_wready_o, top.s_axil_bvalid_o, top.s_axil_bresp_o, 0);
    read.look(top.s_axil_arready_o, true, top.s_axil_rvalid_o, top.s_axil_rresp_o, top.s_axil_rdata_o);
  }

 private:
  std::uint32_t write_address_ = 0;
  std::uint32_t data_ = 0;
  unsigned strobes_ = 0;
  std::uint32_t read_address_ = 0;
  unsigned turn_ = 0;
  bool at_rest_ = false;  // the lines say so already
};
