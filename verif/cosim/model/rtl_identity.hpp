// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kage/defs.hpp"

namespace kage::cosim {

/// Identity of an RTL: whether the RTL of two runs behaves alike.
struct RtlIdentity {
  std::string model_key = {};  ///< of the model that find_model() would give now
  std::string behaviour = {};  ///< a SHA-256; empty if it cannot be told, which is `why_not`
  std::string why_not = {};
};

/// The identity of the sound RTL in `config`, without faults, mutants and monitors. `behaviour` hashes the RTL's text
/// as Verilator's preprocessor gives it, so a changed comment, an empty line or blanks at a line's end leave it as it
/// was, and any other change does not. With that go the parameters, the other files that the model is made of (byte by
/// byte), $CXX, and the versions of Verilator and compiler. It cannot be told where such a version does not say what
/// the tool is: one that was built of changed or unknown sources ("dirty", "(mod)", "UNKNOWN"). Throws Error if RTL
/// or Verilator are missing.
RtlIdentity rtl_identity(const Config& config);

}  // namespace kage::cosim
