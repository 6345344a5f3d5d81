// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/host.hpp"

#include <mutex>
#include <set>

namespace kage::cosim {
namespace {

class Silence final : public Progress {
 public:
  void show(const std::string& /*text*/) override {}
  void clear() override {}
};

}  // namespace

void Host::say(const std::string& /*text*/) {}

std::unique_ptr<Progress> Host::progress() { return std::make_unique<Silence>(); }

void Host::maps(const std::string& /*path*/) {}

void say_once(Host& host, const std::string& line) {
  static std::mutex mutex;
  static std::set<std::string> told;
  const std::lock_guard lock(mutex);
  if (told.insert(line).second) host.say(line);
}

}  // namespace kage::cosim
