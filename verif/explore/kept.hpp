// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace kage::explore {

/// Values that are made once, by the thread that asks first; threads that ask for the same one meanwhile wait. If
/// making it throws, the next thread makes it.
template <class Value>
class Kept {
 public:
  template <class Make>
  std::shared_ptr<const Value> get(const std::string& key, Make make) {
    std::shared_ptr<Place> place;
    {
      const std::lock_guard lock(mutex_);
      auto& entry = places_[key];
      if (!entry) entry = std::make_shared<Place>();
      place = entry;
    }
    const std::lock_guard lock(place->mutex);
    if (!place->value) place->value = std::make_shared<const Value>(make());
    return place->value;
  }

  /// Whether a value is made already.
  [[nodiscard]] bool has(const std::string& key) {
    std::shared_ptr<Place> place;
    {
      const std::lock_guard lock(mutex_);
      const auto it = places_.find(key);
      if (it == places_.end()) return false;
      place = it->second;
    }
    const std::lock_guard lock(place->mutex);
    return place->value != nullptr;
  }

  /// Drops the values whose keys begin with a text. Whoever has one keeps it.
  void forget(const std::string& begin) {
    const std::lock_guard lock(mutex_);
    for (auto it = places_.lower_bound(begin); it != places_.end() && it->first.starts_with(begin);)
      it = places_.erase(it);
  }

 private:
  struct Place {
    std::mutex mutex;
    std::shared_ptr<const Value> value;
  };
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Place>> places_;
};

}  // namespace kage::explore
