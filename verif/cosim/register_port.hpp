// SPDX-License-Identifier: Apache-2.0
//
// Registers of a core, each access held against what is expected of it.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "cosim/model/rtl.hpp"

namespace kage::cosim {

/// Thrown by the register check at the first thing that is not as it must be: "FRAMES: expected 3, got 2".
struct WrongRegister {
  std::string what;
};

/// The registers of a core. Every function throws WrongRegister where something else comes than is expected, and
/// CoreFailure as of Core.
class RegisterPort {
 public:
  static constexpr int kOkay = 0;
  static constexpr int kSlverr = 2;

  explicit RegisterPort(RtlCore& rtl) : rtl_(rtl) {}

  static void same(const std::string& name, std::uint32_t expected, std::uint32_t actual) {
    if (expected != actual) throw WrongRegister{fmt::format("{}: expected {:#x}, got {:#x}", name, expected, actual)};
  }
  static void responded(const RegisterAccess& access, int response) {
    same(fmt::format("response of {}", access.name), static_cast<std::uint32_t>(response),
         static_cast<std::uint32_t>(access.bus.answer));
  }

  [[nodiscard]] RtlCore& rtl() const { return rtl_; }

  // ---- by a master that takes its time ----------------------------------------------------------------------------
  [[nodiscard]] std::uint32_t read(const char* name, std::uint32_t address, int response = kOkay) const {
    RegisterAccess r{name, {address, 0, 0, 0}};
    rtl_.access(nullptr, &r);
    responded(r, response);
    return r.bus.data;
  }
  void expect(const char* name, std::uint32_t address, std::uint32_t value) const {
    same(name, value, read(name, address));
  }
  void write(const char* name, std::uint32_t address, std::uint32_t value, int response = kOkay,
             unsigned strobes = 0b1111) const {
    RegisterAccess w{name, {address, value, strobes, 0}};
    rtl_.access(&w, nullptr);
    responded(w, response);
  }

  // ---- at once: address and data in the first clock ----------------------------------------------------------------
  [[nodiscard]] std::uint32_t read_at_once(const char* name, std::uint32_t address) const {
    RegisterAccess r{name, {address, 0, 0, 0}};
    rtl_.access_at_once(r, false);
    responded(r, kOkay);
    return r.bus.data;
  }
  void write_at_once(const char* name, std::uint32_t address, std::uint32_t value) const {
    RegisterAccess w{name, {address, value, 0b1111, 0}};
    rtl_.access_at_once(w, true);
    responded(w, kOkay);
  }

 private:
  RtlCore& rtl_;
};

}  // namespace kage::cosim
