// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "cosim/core.hpp"

namespace kage::cosim {
namespace {

class Golden : public Core {
 public:
  explicit Golden(const Config& config) : channels_(config.channels), core_(config) {}

  FrameResult frame(std::span<const std::uint32_t> words) override {
    FrameResult result;
    std::vector<std::uint8_t> pixels;
    const auto start = std::chrono::steady_clock::now();
    result.status = core_.frame(
        words, [&](int, std::span<const std::uint8_t> line) { pixels.insert(pixels.end(), line.begin(), line.end()); });
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.image.width = result.status.width;
    result.image.height = result.status.height;
    result.image.channels = channels_;
    result.image.data = std::move(pixels);
    return result;
  }

 private:
  int channels_;
  GoldenCore core_;
};

}  // namespace

std::unique_ptr<Core> make_golden(const Config& config) { return std::make_unique<Golden>(config); }

std::string describe(const FrameStatus& status) {
  const auto code = static_cast<std::size_t>(status.error);
  if (status.error == ErrorCode::NONE) return "no error";
  return fmt::format("{} at line {}, token {}: {}", kErrorNames[code], status.line, status.token, kErrorTexts[code]);
}

}  // namespace kage::cosim
