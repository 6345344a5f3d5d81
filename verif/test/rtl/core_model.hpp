// SPDX-License-Identifier: Apache-2.0
//
// A model of the whole core, as the programs core_* load it: without anything of the co-simulation, which is tested
// apart.
#pragma once

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

#include "cosim/model/driver/rtl_model.h"
#include "kage/defs.hpp"

namespace kage::rtl {

struct CoreModel {
  const char* path;
  const kage_rtl_table& api;
  Config config;  ///< as the model says it
};

/// Of a shared library that build.py made. Ends the program with exit code 2 where it is none.
inline CoreModel load_core(const char* program, const char* path) {
  void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  void* symbol = library != nullptr ? dlsym(library, KAGE_RTL_API_SYMBOL) : nullptr;
  if (symbol == nullptr) {
    std::fprintf(stderr, "%s: %s\n", program, dlerror());
    std::exit(2);
  }
  const kage_rtl_table* const api = reinterpret_cast<kage_rtl_api_function>(symbol)();
  if (api->abi != KAGE_RTL_ABI) {
    std::fprintf(stderr, "%s: %s: no RTL model of this interface\n", program, path);
    std::exit(2);
  }
  CoreModel model{path, *api, {}};
  for (const ParamInfo& p : kParams)
    for (std::uint32_t i = 0; i < api->param_count; ++i)
      if (p.name == api->param_names[i]) model.config.*(p.member) = api->param_values[i];
  return model;
}

}  // namespace kage::rtl
