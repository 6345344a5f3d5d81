// SPDX-License-Identifier: Apache-2.0
#include "pack_history.hpp"

#include <fmt/format.h>

#include "kage/explain.hpp"
#include "text.hpp"
#include "vectors/capture.hpp"

namespace kage::cli {

std::string history_of(const vectors::Pack& pack, const std::string& folder, std::uint64_t frame, int x, int line) {
  const PixelHistory h = explain_pixel(pack.config, vectors::words_of(folder, pack, frame), x, line);
  std::string text = fmt::format("the pixel's history: {}\n", counted(h.touches.size(), "token"));
  for (const PixelTouch& t : h.touches) text += fmt::format("{:>8}  {}\n            {}\n", t.token, t.text, t.effect);
  return text + fmt::format("            {}\n", h.color_text);
}

}  // namespace kage::cli
