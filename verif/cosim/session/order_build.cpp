// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/order_build.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kage/error.hpp"

namespace kage::cosim {

OrderBuildOptions order_build(const SourceOptions& options, Host& host) {
  OrderBuildOptions build;
  build.threads = options.threads;
  build.max_fragments = options.max_fragments;
  build.progress = [&host](double) { host.check(); };
  return build;
}

OrderBuildOptions order_build(const SourceOptions& options, Host& host, Progress& progress, const std::string& what) {
  OrderBuildOptions build = order_build(options, host);
  build.progress = [&host, &progress, what](double done) {
    host.check();
    progress.show(fmt::format("{}: {:.0f} %", what, std::floor(100 * done)));
  };
  return build;
}

void refuse_fragments(const std::string& where, const TooManyFragments& why) {
  throw Error(fmt::format("{} (--max-fragments)", TooManyFragments(why.limit(), where).what()));
}

}  // namespace kage::cosim
