// SPDX-License-Identifier: Apache-2.0
#include "order_build.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kage/error.hpp"
#include "signals.hpp"

namespace kage::cli {

OrderBuildOptions order_build(const Options& options) {
  OrderBuildOptions build;
  build.threads = options.threads;
  build.max_fragments = options.max_fragments;
  build.progress = [](double) { check_interrupt(); };
  return build;
}

OrderBuildOptions order_build(const Options& options, Progress& progress, const std::string& what) {
  OrderBuildOptions build = order_build(options);
  build.progress = [&progress, what](double done) {
    check_interrupt();
    progress.show(fmt::format("{}: {:.0f} %", what, std::floor(100 * done)));
  };
  return build;
}

void refuse_fragments(const std::string& where, const TooManyFragments& why) {
  throw Error(fmt::format("{} (--max-fragments)", TooManyFragments(why.limit(), where).what()));
}

}  // namespace kage::cli
