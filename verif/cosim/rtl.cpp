// SPDX-License-Identifier: Apache-2.0
#include "cosim/rtl.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <limits>
#include <string>

#include "kage/error.hpp"
#include "kage/registers.h"
#include "rtl_model/rtl_model.h"

namespace kage::cosim {
namespace {

constexpr std::uint32_t kAlways = 65536;

/// The library, closed with the object.
class Library {
 public:
  explicit Library(const std::filesystem::path& path) : handle_(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) throw Error(fmt::format("{}: cannot be loaded: {}", path.string(), dlerror()));
  }
  ~Library() { dlclose(handle_); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  [[nodiscard]] const kage_rtl_table* table() const {
    const auto function = reinterpret_cast<kage_rtl_api_function>(dlsym(handle_, KAGE_RTL_API_SYMBOL));
    return function == nullptr ? nullptr : function();
  }

 private:
  void* handle_;
};

class Rtl : public Core {
 public:
  Rtl(const std::filesystem::path& path, const Config& config, const RtlOptions& options)
      : config_(config), library_(path), table_(library_.table()) {
    if (table_ == nullptr || table_->abi != KAGE_RTL_ABI)
      throw Error(fmt::format("{}: not an RTL model of this version", path.string()));
    for (const ParamInfo& p : kParams)
      if (built_with(p.name) != config.*(p.member))
        throw Error(fmt::format("{}: {} is not that of the configuration", path.string(), p.name));
    model_ = table_->create(options.seed);
    if (model_ == nullptr) throw Error(fmt::format("{}: out of memory", path.string()));
    const auto chance = [](int idle) { return kAlways - kAlways * static_cast<std::uint32_t>(idle) / 100; };
    table_->stalls(model_, chance(options.idle_percent), chance(options.backpressure_percent), options.seed);
  }
  ~Rtl() override { table_->destroy(model_); }

  FrameResult frame(std::span<const std::uint32_t> words) override {
    const auto start = std::chrono::steady_clock::now();
    if (broken_) table_->reset(model_, 2);
    if (broken_) errors_ = frames_ = 0;
    broken_ = false;
    table_->clear_pixels(model_);
    table_->clear_stats(model_);

    FrameResult result;
    const bool whole_header = words.size() >= kHeaderWords;
    const std::uint32_t width = whole_header ? words[1] & 0xFFFF : 0;
    const std::uint32_t height = whole_header ? words[1] >> 16 : 0;
    const std::uint64_t pixels = std::uint64_t{width} * height;
    table_->expect(model_, width, height);
    table_->submit(model_, words.data(), words.size(), 1);
    const int why = table_->run(model_, pixels == 0 ? std::numeric_limits<std::uint64_t>::max() : pixels,
                                std::numeric_limits<std::uint64_t>::max());
    if (why == KAGE_RTL_ASSERT) throw Error("RTL model: an assertion failed (its message is above)");
    std::string trouble = why == KAGE_RTL_STUCK                   ? "the core hangs, with input waiting"
                          : why == KAGE_RTL_PIXELS || pixels == 0 ? ""
                                                                  : "the core went idle";
    if (why == KAGE_RTL_PIXELS) trouble = wait_for_end();
    result.status = status();
    broken_ = why != KAGE_RTL_PIXELS || !trouble.empty();

    const bool header_error = result.status.error == ErrorCode::HEADER || result.status.error == ErrorCode::SIZE ||
                              result.status.error == ErrorCode::PARAMS ||
                              (result.status.error == ErrorCode::LAST_EARLY && result.status.token == 0);
    if (header_error && why != KAGE_RTL_STUCK) trouble.clear();
    if (!header_error) take_image(static_cast<int>(width), static_cast<int>(height), result);
    result.status.width = result.image.width;
    result.status.height = result.image.height;

    kage_rtl_stats stats{};
    table_->stats(model_, &stats);
    result.misconduct = misconduct(stats, trouble);
    result.cycles = stats.cycles;
    result.starved = stats.input_starved;
    result.blocked = stats.output_blocked;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
  }

 private:
  [[nodiscard]] int built_with(std::string_view name) const {
    for (std::uint32_t i = 0; i < table_->param_count; ++i)
      if (name == table_->param_names[i]) return table_->param_values[i];
    return -1;
  }

  std::uint32_t read(std::uint32_t address) {
    std::uint32_t value = 0;
    if (table_->reg_read(model_, address, &value) != 0)
      throw Error(fmt::format("RTL model: register {:#04x} does not answer", address));
    return value;
  }

  /// The last pixel leaves before END is read: wait until the core has counted the frame.
  std::string wait_for_end() {
    for (int tries = 0; tries < 10000; ++tries)
      if (read(KAGE_REG_FRAMES) == frames_ + 1) {
        ++frames_;
        return {};
      }
    return "the frame does not end";
  }

  FrameStatus status() {
    FrameStatus s;
    const std::uint32_t errors = read(KAGE_REG_ERRORS);
    if (errors == errors_) return s;
    errors_ = errors;
    const std::uint32_t error = read(KAGE_REG_ERROR);
    s.error = static_cast<ErrorCode>(error & 15);
    s.line = error >> 16;
    s.frame = read(KAGE_REG_ERROR_FRAME);
    s.token = read(KAGE_REG_ERROR_TOKEN);
    return s;
  }

  void take_image(int width, int height, FrameResult& result) {
    std::uint64_t count = 0;
    const std::uint8_t* pixels = table_->pixels(model_, &count);
    result.image = Image(width, height, config_.channels);
    const std::size_t have =
        std::min<std::size_t>(result.image.data.size(), count * static_cast<std::size_t>(config_.channels));
    if (have != 0) std::memcpy(result.image.data.data(), pixels, have);
    result.missing = (result.image.data.size() - have) / static_cast<std::size_t>(config_.channels);
  }

  static std::string misconduct(const kage_rtl_stats& stats, const std::string& trouble) {
    std::string text = trouble;
    const auto add = [&](std::uint64_t n, const char* what) {
      if (n != 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, what);
    };
    add(stats.user_errors, "pixels with a wrong TUSER");
    add(stats.last_errors, "pixels with a wrong TLAST");
    add(stats.extra_pixels, "pixels too many");
    add(stats.unstable, "clocks in which a waiting pixel changed");
    return text;
  }

  Config config_;
  Library library_;
  const kage_rtl_table* table_;
  kage_rtl* model_ = nullptr;
  std::uint32_t frames_ = 0;
  std::uint32_t errors_ = 0;
  bool broken_ = false;
};

}  // namespace

std::unique_ptr<Core> make_rtl(const std::filesystem::path& library, const Config& config, const RtlOptions& options) {
  return std::make_unique<Rtl>(library, config, options);
}

}  // namespace kage::cosim
