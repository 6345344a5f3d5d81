// SPDX-License-Identifier: Apache-2.0
#include "cosim/report/report_lock.hpp"

#include <fmt/format.h>

#include "kage/error.hpp"

namespace kage::report {

ReportLock::ReportLock(const std::string& folder) : lock_(folder, O_RDONLY | O_DIRECTORY) {
  // Where the file system knows no locks nothing is kept out.
  if (!lock_.try_lock() && errno == EWOULDBLOCK)
    throw Error(
        fmt::format("{}: another run writes its report there: give one of them a folder of its own by --out", folder));
}

}  // namespace kage::report
