// SPDX-License-Identifier: Apache-2.0
//
// One report page over several scenes and shards (docs/report.md), made of their record.
#pragma once

#include <filesystem>
#include <string>

#include "file/temp_file.hpp"
#include "results.hpp"

namespace kage::cli {

/// What a page tells of single frames: of so many, and of those that differ.
inline constexpr std::size_t kListedFrames = 1000;

/// Of more runs of kage regress than these the page lists the first, and the last: the one that differs if one does.
inline constexpr std::size_t kListedRuns = 1000;

/// Writes the page over several scenes, runs or shards. It links to the runs' own pages where they are found: beside
/// the file that a shard's report came from, else where they were written, if it is the same page by its checksum. The
/// page gets its name with the others of `files`. Throws Error if it cannot be written or would be larger than a page
/// may be. A signal ends it, unless `interruptible` is false: for what was done until a signal came.
void write_joined_page(TempFiles& files, const std::filesystem::path& path, const report::RunRecord& record,
                       bool interruptible = true);

/// Throws Error if `path` is that of a page which the record that `file` holds tells of.
void keep_page(const std::filesystem::path& path, const std::string& file, const report::RunRecord& record);

}  // namespace kage::cli
