// SPDX-License-Identifier: Apache-2.0
//
// Options that several subcommands have.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "kage/cosim.hpp"

namespace kage::cli {

/// A whole number from `least` to `most`, in decimal. As text: of CLI11's own numbers 010 is 8, and a minus sign or too
/// many digits wrap round in an unsigned one.
Check whole_number(std::uint64_t least = 0, std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// One of these words. A message says which was probably meant.
Check one_of(const std::vector<std::string>& words);

/// End of the type of an option whose value is a file, or - for standard output. Any other option that names a file
/// refuses - before the command begins.
inline constexpr const char* kOrStandardOutput = "|-";
/// Whether a value of such an option is standard output.
bool is_standard_output(const std::string& value);

/// A number from `least` to `most`, written as people write it: strtod() would take nan, inf and hexadecimal. Messages
/// call the least one `least_text`, where that is given.
Check real_number(double least, double most, const char* least_text = nullptr);

/// Options that several subcommands have, and what they default to.
struct Options : cosim::SourceOptions {
  std::string out;
  std::string json;
};

/// --config: the core's parameters.
void option_config(Command command, cosim::SourceOptions& options);

/// Options that decide the pictures of a scene: --size, --frames, --order, --alpha, --cull, --max-fragments, --samples,
/// --classes, --max-shading, --sub-bits, --seed; and --threads, --allow-outside. `frames` says how many are made
/// without --frames.
void options_of_pictures(Command command, cosim::SourceOptions& options, const char* frames = "the scene's own");
/// Options of every command that makes frames for a core: those, and --config, --degrade, --units-only, --all-spans.
void options_of_frames(Command command, cosim::SourceOptions& options);
void option_max_fragments(Command command, cosim::SourceOptions& options);
void option_seed(Command command, std::uint64_t& seed);
void option_json(Command command, std::string& json);
/// --level: of frames that are written.
void option_level(Command command, cosim::SourceOptions& options);

/// Sources of frames that a command takes: scenes; stream files, too; random frames, too.
enum class Taken : std::uint8_t { scenes, streams, random };
/// SCENE, a positional.
void option_scene(Command command, cosim::SourceOptions& options, Taken taken = Taken::streams);
/// One or more of them.
void option_scenes(Command command, std::vector<std::string>& inputs, Taken taken = Taken::scenes);
void option_threads(Command command, cosim::SourceOptions& options);
void option_size(Command command, cosim::SourceOptions& options);
void option_outside(Command command, cosim::SourceOptions& options);  // --allow-outside
void option_fault(Command command, std::string& fault);
/// --front-end: who makes spans of polygons.
void option_front_end(Command command, cosim::SourceOptions& options);
/// --cache-verdicts and --no-cache-verdicts.
void option_cache_verdicts(Command command, bool& cache);

}  // namespace kage::cli
