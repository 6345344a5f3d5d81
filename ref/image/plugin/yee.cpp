// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "image/plugin/table.hpp"

namespace kage::picture_plugin {

std::optional<std::uint64_t> yee(int width, int height, float* a, float* b) {
  const OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::FLOAT);
  const OIIO::ImageBuf buffer_a(spec, a);
  const OIIO::ImageBuf buffer_b(spec, b);
  OIIO::ImageBufAlgo::CompareResults results;
  const int failed = OIIO::ImageBufAlgo::compare_Yee(buffer_a, buffer_b, results);
  if (failed < 0) return {};
  return static_cast<std::uint64_t>(failed);
}

}  // namespace kage::picture_plugin
