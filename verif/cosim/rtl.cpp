// SPDX-License-Identifier: Apache-2.0
#include "cosim/rtl.hpp"

#include "kage/error.hpp"

namespace kage::cosim {

std::unique_ptr<Core> make_rtl(const std::filesystem::path& library, const Config&, const RtlOptions&) {
  throw Error(library.string() + ": not yet");
}

}  // namespace kage::cosim
