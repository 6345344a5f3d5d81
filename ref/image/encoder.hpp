// SPDX-License-Identifier: Apache-2.0
//
// Picture formats, line by line, into a file whose errors are thrown.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "file/output_file.hpp"

namespace kage {

/// Puts the lines of a picture into a file. An encoder that is given up before its last line leaves the file as it is,
/// and its end neither waits nor throws.
class ImageEncoder {
 public:
  virtual ~ImageEncoder() = default;

  /// The next line from the top: width x channels bytes. Throws Error that names the file.
  virtual void line(std::span<const std::uint8_t> pixels) = 0;

  /// After the last line. Throws Error that names the file; the file itself is closed by whoever has it.
  virtual void finish() = 0;
};

/// 8 bits a sample; one channel is grey, three are red, green and blue. `out` must outlive the encoder, and `name` is
/// what messages call the file.
std::unique_ptr<ImageEncoder> encode_png(OutputFile& out, const std::string& name, int width, int height, int channels);

/// The same as floating point, 255 is 1.0; one channel is Y.
std::unique_ptr<ImageEncoder> encode_exr(OutputFile& out, const std::string& name, int width, int height, int channels);

}  // namespace kage
