// SPDX-License-Identifier: Apache-2.0
//
// Models of the whole RTL as cases use them: those that the build has made for tests.
#pragma once

#include <map>
#include <mutex>
#include <string>

#include "cosim/model/driver/rtl_model.h"
#include "kage/defs.hpp"

namespace kage::verif {

/// A model: a library that build.py made, and the configuration that it says it has.
struct CoreModel {
  std::string path;
  const kage_rtl_table* api = nullptr;
  Config config;
};

/// Throws Error that names the path where it is no model of this interface. The library stays loaded.
CoreModel load_core(const std::string& path);

/// The models of a folder, loaded when first asked for. For several threads at once.
struct RtlModels {
 public:
  explicit RtlModels(std::string folder) : folder_(std::move(folder)) {}
  /// Whether a model is missing that cases ask for.
  [[nodiscard]] bool empty() const;
  /// The model of FOLDER/NAME.so.
  const CoreModel& named(const std::string& name);

 private:
  std::string folder_;
  std::mutex mutex_;
  std::map<std::string, CoreModel> loaded_;
};

}  // namespace kage::verif
