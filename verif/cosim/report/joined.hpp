// SPDX-License-Identifier: Apache-2.0
//
// One report page over several scenes and shards (docs/report.md), made of their record.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "cosim/report/run_record.hpp"
#include "file/temp_file.hpp"

namespace kage::report {

/// The most single frames that a page lists, besides those that differ.
inline constexpr std::size_t kListedFrames = 1000;

/// The most runs of kage regress that the page lists: the first ones, and the last, which differs if one does.
inline constexpr std::size_t kListedRuns = 1000;

/// Writes the page over several scenes, runs or shards. It links to the runs' own pages where they are found: beside
/// the file that a shard's report came from, else where they were written, if it is the same page by its checksum. The
/// page gets its name with the others of `files`. Throws Error if it cannot be written or would be larger than a page
/// may be. `wait` is called for each run; it may throw, which ends it.
void write_joined_page(TempFiles& files, const std::filesystem::path& path, const RunRecord& record,
                       const std::function<void()>& wait);

/// Throws Error if `path` is that of a page which the record that `file` holds tells of.
void keep_page(const std::filesystem::path& path, const std::string& file, const RunRecord& record);

}  // namespace kage::report
