// SPDX-License-Identifier: Apache-2.0
// The golden core behind C functions. Nothing is computed here: words go to GoldenCore, values come from its LineView.
#include "kage/golden.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "contract/config_text.hpp"
#include "generated/golden_names.hpp"
#include "golden_core.hpp"
#include "golden_fields.hpp"
#include "kage/config.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"

using kage::Config;
using kage::Error;

namespace {

thread_local std::string creation_error;

/// Returns work()'s result; after an exception, `failure` with the cause in `error`.
template <class Result, class Work>
Result guarded(std::string& error, Result failure, Work&& work) noexcept {
  try {
    error.clear();
    return std::forward<Work>(work)();
  } catch (const std::exception& e) {
    try {
      error = e.what();
    } catch (...) {
      error.clear();  // no memory for the cause
    }
  } catch (...) {
    error.clear();
  }
  return failure;
}

// A handle that nobody made, as a DPI chandle is at first, has no place for a cause: that of the create stays.
template <class Work>
int guarded(kage_golden* core, Work&& work) noexcept {
  if (core == nullptr) return KAGE_GOLDEN_ERROR;
  return guarded(core->error, int{KAGE_GOLDEN_ERROR}, std::forward<Work>(work));
}

std::string given(const char* text, const char* what) {
  if (text == nullptr) throw Error(fmt::format("no {} given", what));
  return text;
}

bool has_line(const kage_golden* core) { return core != nullptr && core->line; }

/// Lines leave to no one while this lives.
class NoTaker {
 public:
  explicit NoTaker(kage_golden& core) : core_(core), taker_(std::exchange(core.taker, nullptr)) {}
  ~NoTaker() { core_.taker = taker_; }
  NoTaker(const NoTaker&) = delete;
  NoTaker& operator=(const NoTaker&) = delete;

 private:
  kage_golden& core_;
  kage_golden_taker taker_;
};

kage_golden* create(const Config& config) { return std::make_unique<kage_golden>(config).release(); }

}  // namespace

int kage_golden_abi() { return KAGE_GOLDEN_ABI; }

kage_golden* kage_golden_create(const char* config) {
  return guarded<kage_golden*>(creation_error, nullptr, [&] {
    const std::string name = given(config, "configuration");
    if (kage::is_stream_file(name)) return create(kage::StreamFile(name).config());
    return create(kage::load_config(name).config);
  });
}

kage_golden* kage_golden_create_parameters(const char* yaml) {
  return guarded<kage_golden*>(creation_error, nullptr,
                               [&] { return create(kage::config_from_text(given(yaml, "parameters"), "parameters")); });
}

void kage_golden_destroy(kage_golden* core) { delete core; }

const char* kage_golden_error(const kage_golden* core) {
  return core == nullptr ? creation_error.c_str() : core->error.c_str();
}

int kage_golden_parameter(kage_golden* core, const char* name) {
  return guarded(core, [&] {
    const std::string wanted = given(name, "parameter");
    for (const kage::ParamInfo& p : kage::kParams)
      if (p.name == wanted) return core->config.*(p.member);
    throw Error(fmt::format("{}: no such parameter", wanted));
  });
}

int kage_golden_word(kage_golden* core, unsigned int word) {
  return guarded(core, [&] { return core->word(word); });
}

int kage_golden_feed(kage_golden* core, const unsigned int* words, int count) {
  return guarded(core, [&] {
    if (count < 0 || (words == nullptr && count > 0)) throw Error(fmt::format("{} words cannot be given", count));
    core->feed({words, static_cast<std::size_t>(count)});
    return core->state;
  });
}

int kage_golden_finish(kage_golden* core) {
  return guarded(core, [&] { return core->finish(); });
}

int kage_golden_open(kage_golden* core, const char* path) {
  return guarded(core, [&] {
    const std::string name = given(path, "stream file");
    kage::StreamFile file(name);
    if (kage::param_hash(file.config()) != kage::param_hash(core->config))
      throw Error(fmt::format("{}: its pixel parameters are not this core's", name));
    core->rest = {};
    core->file.emplace(std::move(file));
    return core->file->frame_count();
  });
}

int kage_golden_frame(kage_golden* core, int index) {
  return guarded(core, [&] {
    if (!core->file) throw Error("no stream file is open");
    if (index < 0 || index >= core->file->frame_count())
      throw Error(fmt::format("frame {}: the file has {}", index, core->file->frame_count()));
    const auto words = core->file->frame(index);
    const kage::FrameStatus before = core->status;
    {
      const NoTaker forgotten(*core);
      core->finish();
    }
    core->status = before;
    core->rest = words;
    return 0;
  });
}

int kage_golden_next(kage_golden* core) {
  return guarded(core, [&] {
    if (core->state != KAGE_GOLDEN_MORE) return core->state;
    if (core->rest.empty()) throw Error("no frame of a stream file is at hand");
    int result = KAGE_GOLDEN_MORE;
    while (result == KAGE_GOLDEN_MORE && !core->rest.empty()) {
      const std::uint32_t word = core->rest.front();
      core->rest = core->rest.subspan(1);
      result = core->word(word);
    }
    return result;
  });
}

int kage_golden_token_kind(kage_golden* core) { return core == nullptr ? int{KAGE_GOLDEN_ERROR} : core->shown().kind; }
int kage_golden_token_index(kage_golden* core) { return core == nullptr ? -1 : core->index; }
int kage_golden_token_words(kage_golden* core) {
  return core == nullptr || core->index < 0 ? 0 : static_cast<int>(core->shown().words.size());
}

int kage_golden_made(kage_golden* core) { return core == nullptr ? 0 : static_cast<int>(core->made.size()); }

int kage_golden_choose_made(kage_golden* core, int i) {
  return guarded(core, [&] {
    if (i < -1 || i >= static_cast<int>(core->made.size()))
      throw Error(fmt::format("{}: {} made of the token at hand", i, core->made.size()));
    core->chosen = i;
    return 0;
  });
}

unsigned int kage_golden_token_word(kage_golden* core, int i) {
  return i >= 0 && i < kage_golden_token_words(core) ? core->shown().words[static_cast<std::size_t>(i)] : 0;
}

long long kage_golden_token_field(kage_golden* core, int field) {
  return core == nullptr || core->shown().kind == KAGE_KIND_HEADER
             ? 0
             : token_field(core->config, core->layout, core->shown().token, field);
}

const char* kage_golden_token_text(kage_golden* core) {
  if (core == nullptr) return "";
  (void)guarded(core, [&] {
    if (core->index < 0)
      core->text.clear();
    else if (core->shown().kind == KAGE_KIND_HEADER) {
      const kage::FrameHeader h = kage::FrameHeader::read(core->shown().words);
      core->text = fmt::format("header {}x{}", h.width, h.height);
    } else
      core->text = kage::to_string(core->config, core->shown().token);
    return 0;
  });
  return core->text.c_str();
}

int kage_golden_width(kage_golden* core) { return has_line(core) ? core->core.line().width() : 0; }
int kage_golden_height(kage_golden* core) { return has_line(core) ? core->height : 0; }
int kage_golden_line(kage_golden* core) { return has_line(core) ? core->core.line().y() : 0; }
int kage_golden_bias(kage_golden* core) { return has_line(core) ? static_cast<int>(core->core.line().bias()) : 0; }
unsigned int kage_golden_background(kage_golden* core) { return has_line(core) ? core->core.line().background() : 0; }

int kage_golden_pixel(kage_golden* core, int x, int field) {
  if (!has_line(core) || field < 0 || field >= KAGE_PIXEL_FIELDS || !has_pixel_field(core->config, field))
    return KAGE_PIXEL_ABSENT;
  const kage::LineView line = core->core.line();
  if (x < 0 || x >= line.width()) return KAGE_PIXEL_ABSENT;
  return pixel_field(core->config, line, x, field);
}

const char* kage_golden_pixel_name(int field) {
  return field >= 0 && field < KAGE_PIXEL_FIELDS ? kPixelFields[static_cast<std::size_t>(field)] : "";
}

int kage_golden_out_line(kage_golden* core) { return core == nullptr ? -1 : core->out_line; }

int kage_golden_out(kage_golden* core, int x, int channel) {
  if (core == nullptr || core->out_line < 0 || x < 0 || channel < 0 || channel >= core->config.channels) return -1;
  const std::size_t at =
      static_cast<std::size_t>(x) * static_cast<std::size_t>(core->config.channels) + static_cast<std::size_t>(channel);
  return at < core->out.size() ? core->out[at] : -1;
}

void kage_golden_on_line(kage_golden* core, kage_golden_taker taker, void* user) {
  if (core == nullptr) return;
  core->taker = taker;
  core->user = user;
}

long long kage_golden_status(kage_golden* core, int field) {
  if (core == nullptr) return -1;
  const kage::FrameStatus& s = core->status;
  const std::array<long long, KAGE_STATUS_FIELDS> values{
      static_cast<long long>(s.error), s.frame, s.line, s.token, s.unit, s.width, s.height};
  return field >= 0 && field < KAGE_STATUS_FIELDS ? values[static_cast<std::size_t>(field)] : -1;
}

const char* kage_golden_status_text(kage_golden* core) {
  if (core == nullptr) return "";
  (void)guarded(core, [&] {
    const kage::FrameStatus& s = core->status;
    const auto code = static_cast<std::size_t>(s.error);
    core->text = code == 0 ? std::string("no error")
                           : fmt::format("{}: {}: frame {}, line {}, token {}", kage::kErrorNames[code],
                                         kage::kErrorTexts[code], s.frame, s.line, s.token);
    return 0;
  });
  return core->text.c_str();
}
