// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <exception>
#include <mutex>

#include "image/plugin/table.hpp"
#include "kage/error.hpp"

namespace kage::picture_plugin {
namespace {

[[noreturn]] void fail(const std::string& name, std::string cause) {
  for (char& c : cause)
    if (c == '\n' || c == '\r') c = ' ';
  throw Error(fmt::format("{}: cannot be written: {}", name, cause.empty() ? "no cause was given" : cause));
}

/// Where OpenImageIO writes to. After an error OpenEXR's writer may wait for ever, in its destructor too, so it is told
/// of none: the first one is kept, and what comes behind it is swallowed. Its threads may write at the same time.
class Target : public OIIO::Filesystem::IOProxy {
 public:
  Target(OutputFile& out, const std::string& name) : IOProxy(name, IOProxy::Mode::Write), out_(out) {}

  [[nodiscard]] const char* proxytype() const override { return "kage"; }
  void close() override {}
  [[nodiscard]] int64_t tell() override { return position_; }
  bool seek(int64_t offset) override {
    position_ = offset;
    return true;
  }
  std::size_t read(void*, std::size_t) override { return 0; }
  std::size_t write(const void* data, std::size_t size) override { return put(data, size, position_); }
  std::size_t pwrite(const void* data, std::size_t size, int64_t offset) override { return put(data, size, offset); }
  [[nodiscard]] std::size_t size() const override { return static_cast<std::size_t>(size_); }

  /// From now on nothing more is written.
  void leave() {
    const std::lock_guard lock(mutex_);
    left_ = true;
  }

  /// Throws the error that was kept.
  void check() const {
    const std::lock_guard lock(mutex_);
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  std::size_t put(const void* data, std::size_t size, int64_t offset) {
    const std::lock_guard lock(mutex_);
    position_ = offset + static_cast<int64_t>(size);
    size_ = std::max(size_, position_);
    if (left_) return size;
    try {
      if (at_ != offset) out_.seekp(offset);
      out_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
      at_ = position_;
    } catch (...) {
      thrown_ = std::current_exception();
      left_ = true;
    }
    return size;
  }

  OutputFile& out_;
  mutable std::mutex mutex_;
  int64_t position_ = 0;  // as OpenImageIO sees it
  int64_t at_ = 0;        // that of the file
  int64_t size_ = 0;
  bool left_ = false;
  std::exception_ptr thrown_;
};

class ExrEncoder : public ImageEncoder {
 public:
  ExrEncoder(OutputFile& out, std::string name, int width, int height, int channels)
      : name_(std::move(name)), target_(out, name_), output_(OIIO::ImageOutput::create("exr")) {
    if (!output_) fail(name_, OIIO::geterror());
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
    if (channels == 1) spec.channelnames = {"Y"};
    if (!output_->set_ioproxy(&target_) || !output_->open("picture.exr", spec)) fail(name_, output_->geterror());
    target_.check();
  }
  ~ExrEncoder() override { target_.leave(); }
  ExrEncoder(const ExrEncoder&) = delete;
  ExrEncoder& operator=(const ExrEncoder&) = delete;

  void line(std::span<const std::uint8_t> pixels) override {
    const bool good = output_->write_scanline(y_++, 0, OIIO::TypeDesc::UINT8, pixels.data());
    target_.check();
    if (!good) fail(name_, output_->geterror());
  }

  void finish() override {
    const bool good = output_->close();
    target_.check();
    if (!good) fail(name_, output_->geterror());
  }

 private:
  std::string name_;
  Target target_;
  std::unique_ptr<OIIO::ImageOutput> output_;  // it goes before the target
  int y_ = 0;
};

}  // namespace

std::unique_ptr<ImageEncoder> encode_exr(OutputFile& out, const std::string& name, int width, int height,
                                         int channels) {
  return std::make_unique<ExrEncoder>(out, name, width, height, channels);
}

}  // namespace kage::picture_plugin
