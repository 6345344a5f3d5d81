// SPDX-License-Identifier: Apache-2.0
//
// Options that several subcommands have.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "kage/defs.hpp"
#include "kage/geometry.hpp"

namespace kage::cli {

/// A whole number from `least` to `most`, in decimal. As text: of CLI11's own numbers 010 is 8, and a minus sign or too
/// many digits wrap round in an unsigned one.
CLI::Validator whole_number(std::uint64_t least = 0, std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// One of these words. A message says which was probably meant.
CLI::Validator one_of(const std::vector<std::string>& words);

/// What the type of an option ends with whose value is a file, or - for standard output. Any other option that names a
/// file refuses - before the command begins.
inline constexpr const char* kOrStandardOutput = "|-";
/// Whether a value of such an option is standard output.
bool is_standard_output(const std::string& value);

/// A number from `least` to `most`, written as people write it: strtod() would take nan, inf and hexadecimal. Messages
/// call the least one `least_text`, where that is given.
CLI::Validator real_number(double least, double most, const char* least_text = nullptr);

/// The most frames of a run, and the most shards.
inline constexpr int kMostFrames = 1000000;

/// A picture's size, "640x480".
struct Size {
  int width = 640;
  int height = 480;
};

/// Options that several subcommands have, and what they default to.
struct Options {
  std::string input;
  Size size;
  bool size_given = false;
  int frames = 0;  ///< 0: as many as the scene has
  std::string config;
  std::uint64_t seed = 1;
  std::string out;
  std::string json;
  int threads = 0;  ///< 0: one per processor
  bool degrade = false;
  bool units_only = false;  ///< polyhedra that find no unit are an error
  TranslucentWay order = TranslucentWay::exact;
  double alpha = 1;
  bool cull = false;           ///< faces are not drawn if the eye sees the side that their material does not show
  bool allow_outside = false;  ///< files that a scene's file names may lie outside its folder
  std::optional<std::uint64_t> max_fragments;  ///< that the order of translucent faces may cut; none: order.hpp's
  int samples = Look{}.samples;                ///< of a light that is no point
  int classes = Look{}.classes;                ///< of normals
  int sub_bits = Look{}.sub_bits;              ///< of snapped positions
  Level level = Level::spans;                  ///< of the frames that are made
  std::string level_option;                    ///< that asked for a level which not every source has
};

/// As --order has it.
std::string name_of(TranslucentWay way);

/// --config: the core's parameters.
void option_config(CLI::App& command, Options& options);

/// What decides the pictures of a scene: --size, --frames, --order, --alpha, --cull, --max-fragments, --samples,
/// --classes, --sub-bits, --seed; and --threads, --allow-outside. `frames` says how many are made without --frames.
void options_of_pictures(CLI::App& command, Options& options, const char* frames = "the scene's own");
/// What every command that makes frames for a core takes: those, and --config, --degrade, --units-only.
void options_of_frames(CLI::App& command, Options& options);
void option_max_fragments(CLI::App& command, Options& options);
void option_seed(CLI::App& command, Options& options);
void option_json(CLI::App& command, Options& options);
/// --level: of frames that are written.
void option_level(CLI::App& command, Options& options);
std::string name_of(Level level);  // as --level has it

/// What a command takes frames from: scenes; stream files, too; random frames, too.
enum class Taken : std::uint8_t { scenes, streams, random };
/// SCENE, a positional.
void option_scene(CLI::App& command, Options& options, Taken taken = Taken::streams);
/// One or more of them.
void option_scenes(CLI::App& command, std::vector<std::string>& inputs, Taken taken = Taken::scenes);
void option_threads(CLI::App& command, Options& options);
void option_size(CLI::App& command, Options& options);
void option_outside(CLI::App& command, Options& options);  // --allow-outside
void option_fault(CLI::App& command, std::string& fault);
/// --front-end: who makes spans of polygons.
void option_front_end(CLI::App& command, Options& options);
std::string front_end_of(Level level);  // as --front-end has it
/// Gives the core of frames at the polygon level a front end, of kUsualActive polygons, if the configuration has none.
/// Returns whether it did.
bool give_front_end(const Options& options, Config& config);

}  // namespace kage::cli
