// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

namespace kage {

/// Held while a library is opened or closed, and while this process forks to go on working in the child. A child that
/// was forked while another thread was within the dynamic loader has the loader's lock taken for ever, and waits for it
/// as soon as it needs the loader itself.
inline std::mutex& loader_lock() {
  static std::mutex lock;
  return lock;
}

}  // namespace kage
