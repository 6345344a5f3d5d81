// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/rtl_changed.hpp"

#include <chrono>
#include <thread>

#include "cosim/model/process.hpp"
#include "cosim/session/models.hpp"
#include "kage/error.hpp"

namespace kage::cosim {
namespace {

constexpr std::chrono::seconds kPatience{2};  // of a folder that is slow to read: then nothing is told
constexpr std::chrono::milliseconds kPause{2};

}  // namespace

bool rtl_changed(const RtlRun& rtl) {
  if (!rtl.fault.empty() || rtl.mutant != 0) return true;
  try {
    Process git({"git", "-C", rtl_directory(), "diff", "--name-only", "HEAD", "--", "."}, Said::output);
    const auto begin = std::chrono::steady_clock::now();
    bool ok = false;
    while (!git.ended(ok)) {
      if (std::chrono::steady_clock::now() - begin > kPatience) return false;
      std::this_thread::sleep_for(kPause);
    }
    return ok && !git.said().empty();
  } catch (const Error&) {
    return false;
  }
}

}  // namespace kage::cosim
