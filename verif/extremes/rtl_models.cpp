// SPDX-License-Identifier: Apache-2.0
#include "extremes/rtl_models.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "extremes/rtl_cases.hpp"
#include "kage/error.hpp"

namespace kage::verif {

CoreModel load_core(const std::string& path) {
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* symbol = library != nullptr ? dlsym(library, KAGE_RTL_API_SYMBOL) : nullptr;
  if (symbol == nullptr) throw Error(dlerror());
  CoreModel model{path, reinterpret_cast<kage_rtl_api_function>(symbol)(), {}};
  if (model.api->abi != KAGE_RTL_ABI) throw Error(fmt::format("{}: no RTL model of this interface", path));
  for (const ParamInfo& p : kParams)
    for (std::uint32_t i = 0; i < model.api->param_count; ++i)
      if (p.name == model.api->param_names[i]) model.config.*(p.member) = model.api->param_values[i];
  return model;
}

bool RtlModels::empty() const {
  const auto& names = model_names();
  return std::any_of(names.begin(), names.end(), [this](const char* name) {
    return !std::filesystem::exists(fmt::format("{}/{}.so", folder_, name));
  });
}

const CoreModel& RtlModels::named(const std::string& name) {
  const std::scoped_lock lock(mutex_);
  const auto found = loaded_.find(name);
  if (found != loaded_.end()) return found->second;
  return loaded_.emplace(name, load_core(fmt::format("{}/{}.so", folder_, name))).first->second;
}

}  // namespace kage::verif
