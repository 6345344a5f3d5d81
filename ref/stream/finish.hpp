// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "file/temp_file.hpp"
#include "kage/stream.hpp"

namespace kage {

/// Ends a stream file that gets its name with the others of `files`.
void finish(StreamFileWriter& writer, TempFiles& files);

}  // namespace kage
