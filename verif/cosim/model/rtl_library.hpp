// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "cosim/model/driver/rtl_model.h"
#include "kage/defs.hpp"
#include "kage/error.hpp"

namespace kage::cosim {

/// A model's shared library, closed with the object.
class RtlLibrary {
 public:
  /// Throws Error if it cannot be loaded, is of another version, or of another configuration.
  RtlLibrary(const std::filesystem::path& path, const Config& config) : handle_(opened(path)) {
    const auto function = reinterpret_cast<kage_rtl_api_function>(dlsym(handle_, KAGE_RTL_API_SYMBOL));
    table_ = function == nullptr ? nullptr : function();
    try {
      check(path, config);
    } catch (...) {
      close();
      throw;
    }
  }
  ~RtlLibrary() { close(); }
  RtlLibrary(const RtlLibrary&) = delete;
  RtlLibrary& operator=(const RtlLibrary&) = delete;

  [[nodiscard]] const kage_rtl_table* table() const { return table_; }

 private:
  static void* opened(const std::filesystem::path& path) {
    void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) throw Error(fmt::format("{}: cannot be loaded: {}", path.string(), dlerror()));
    return handle;
  }
  void close() { dlclose(handle_); }
  void check(const std::filesystem::path& path, const Config& config) const {
    if (table_ == nullptr || table_->abi != KAGE_RTL_ABI)
      throw Error(fmt::format("{}: not an RTL model of this version", path.string()));
    for (const ParamInfo& p : kParams)
      if (built_with(p.name) != config.*(p.member))
        throw Error(fmt::format("{}: {} is not that of the configuration", path.string(), p.name));
  }

  [[nodiscard]] int built_with(std::string_view name) const {
    for (std::uint32_t i = 0; i < table_->param_count; ++i)
      if (name == table_->param_names[i]) return table_->param_values[i];
    return -1;
  }

  void* handle_;
  const kage_rtl_table* table_ = nullptr;
};

}  // namespace kage::cosim
