// SPDX-License-Identifier: Apache-2.0
#include "options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cstdlib>

#include "cosim/session/option_names.hpp"
#include "file/meant.hpp"
#include "kage/error.hpp"
#include "kage/frontend.hpp"
#include "kage/light.hpp"
#include "kage/order.hpp"
#include "kage/scene.hpp"

namespace kage::cli {

bool is_standard_output(const std::string& value) { return value == "-"; }

Check whole_number(std::uint64_t least, std::uint64_t most) {
  return {[least, most](const std::string& text) {
            std::uint64_t value = 0;
            const char* const end = text.data() + text.size();
            const auto [stop, error] = std::from_chars(text.data(), end, value);
            if (error != std::errc{} || stop != end || value < least || value > most)
              return fmt::format("{} is not a whole number from {} to {}", text, least,
                                 most == std::numeric_limits<std::uint64_t>::max() ? "2^64 - 1" : fmt::to_string(most));
            // CLI11 would take it for octal.
            return text.size() > 1 && text.front() == '0' ? text + " begins with 0" : std::string();
          },
          ""};
}

Check one_of(const std::vector<std::string>& words) {
  const std::string all = fmt::format("{{{}}}", fmt::join(words, ","));
  return {[words, all](const std::string& text) {
            const bool known = std::find(words.begin(), words.end(), text) != words.end();
            return known ? std::string() : fmt::format("{} not in {}{}", text, all, meant(text, words));
          },
          all};
}

Check real_number(double least, double most, const char* least_text) {
  return {[least, most, first = least_text != nullptr ? std::string(least_text) : fmt::format("{}", least)](
              const std::string& text) {
            const bool plain = text.find_first_not_of("0123456789.eE+-") == std::string::npos;
            char* stop = nullptr;
            const double value = plain ? std::strtod(text.c_str(), &stop) : 0;
            if (!plain || text.empty() || *stop != '\0') return text + " is not a number";
            return value >= least && value <= most ? std::string()
                                                   : text + fmt::format(" is not in {} .. {}", first, most);
          },
          ""};
}

void option_size(Command command, cosim::SourceOptions& options) {
  command
      .add_option_function<std::string>(
          "--size",
          [&options](const std::string& text) {
            const char* const end = text.data() + text.size();
            cosim::Size size;
            const auto w = std::from_chars(text.data(), end, size.width);
            if (w.ec != std::errc{} || w.ptr == end || *w.ptr != 'x')
              throw ValueError("--size", text + " is not WxH, like 640x480");
            const auto h = std::from_chars(w.ptr + 1, end, size.height);
            if (h.ec != std::errc{} || h.ptr != end) throw ValueError("--size", text + " is not WxH, like 640x480");
            if (size.width < 1 || size.width > kMaxSize || size.height < 1 || size.height > kMaxSize)
              throw ValueError("--size", fmt::format("{}: width and height are 1 .. {}", text, kMaxSize));
            options.size = size;
            options.size_given = true;
          },
          fmt::format("picture size, default {}x{}", options.size.width, options.size.height))
      .type_name("WxH");
}

static void option_frames(Command command, cosim::SourceOptions& options, const char* usual) {
  command
      .add_option("--frames", options.frames,
                  fmt::format("number of frames, spread over the animation or the camera path, default: {}", usual))
      .check(whole_number(1, cosim::kMostFrames))
      .type_name("N");
}

void option_config(Command command, cosim::SourceOptions& options) {
  command
      .add_option("--config", options.config,
                  "the core's parameters: a name in rtl/defs/configs.yaml, a YAML file of PARAMETER: value lines, or "
                  "plan for those that kage plan finds for the scene; default: a cheap name that can draw it all")
      .type_name("NAME|FILE");
}

void option_seed(Command command, std::uint64_t& seed) {
  command.add_option("--seed", seed, "seed of everything random, default 1").check(whole_number()).type_name("S");
}

void option_json(Command command, std::string& json) {
  command.add_option("--json", json, "write the result as JSON; - is standard output, with nothing else on it")
      .type_name(std::string("FILE") + kOrStandardOutput);
}

static std::string what_is_taken(Taken taken) {
  return fmt::format(
      "a built-in scene ({}){} a mesh or scene file (glTF, OBJ, PLY, STL, OFF, or what else Assimp reads){}",
      fmt::join(builtin_scenes(), ", "), taken == Taken::scenes ? " or" : ",",
      taken == Taken::scenes    ? ""
      : taken == Taken::streams ? ", or a stream file"
                                : ", a stream file, or random frames (random, random:damaged, "
                                  "random:mixed)");
}

void option_scene(Command command, cosim::SourceOptions& options, Taken taken) {
  command.add_option("SCENE", options.input, what_is_taken(taken)).required();
}

void option_scenes(Command command, std::vector<std::string>& inputs, Taken taken) {
  command.add_option("SCENE", inputs, "one or more, each " + what_is_taken(taken)).required();
}

static void option_degrade(Command command, cosim::SourceOptions& options) {
  command.add_flag(
      "--degrade", options.degrade,
      "where the configuration lacks something, draw without it (no shadows, those of one light, hard ones; flat, grey "
      "or opaque instead of smooth, coloured or translucent) instead of refusing");
}

static void option_units_only(Command command, cosim::SourceOptions& options) {
  command.add_flag(
      "--units-only", options.units_only,
      "refuse a frame in which a convex polyhedron finds no expansion unit, instead of drawing it by spans");
}

static void option_translucent(Command command, cosim::SourceOptions& options) {
  command
      .add_option_function<std::string>(
          "--order", [&options](const std::string& name) { options.order = cosim::translucent_ways().at(name); },
          "order of translucent faces, default exact; the others show what cheaper orders get wrong")
      .option_text("exact|centroid|submission")
      .check(one_of({"exact", "centroid", "submission"}))
      .type_name("WAY");
  command
      .add_option("--alpha", options.alpha,
                  "multiply the alpha of every material by A, 1/255 to 1; below 1 all is translucent")
      .option_text("A")
      .check(real_number(1.0 / 255, 1, "1/255"))
      .type_name("A");
}

static void option_cull(Command command, cosim::SourceOptions& options) {
  command.add_flag("--cull", options.cull,
                   "leave out faces of single-sided materials that are turned away from the eye; they cast shadows all "
                   "the same");
}

static void option_lights(Command command, cosim::SourceOptions& options) {
  command
      .add_option("--samples", options.samples,
                  fmt::format("points that stand for an area light (a disc, rectangle or sphere); "
                              "default {}",
                              options.samples))
      .check(whole_number(1, kMaxSamples))
      .type_name("N");
  command
      .add_option("--classes", options.classes,
                  "classes that a light table tells apart, of faces that lose alike in shadow; default: as many as it "
                  "has room for")
      .check(whole_number(1, kMaxClasses))
      .type_name("N");
  command
      .add_option("--max-shading", options.max_shading,
                  fmt::format("with SMOOTH, cut faces where colours between their corners are more than N of 255 off "
                              "the light at the pixel; 0: never; default {}",
                              options.max_shading))
      .check(whole_number(0, 255))
      .type_name("N");
}

static void option_sub_bits(Command command, cosim::SourceOptions& options) {
  command
      .add_option("--sub-bits", options.sub_bits,
                  fmt::format("round positions on the screen to 2^-N pixel, {} to {}; default {}", kLeastSubBits,
                              kMostSubBits, options.sub_bits))
      .check(whole_number(kLeastSubBits, kMostSubBits))
      .type_name("N");
}

void option_max_fragments(Command command, cosim::SourceOptions& options) {
  command
      .add_option(
          "--max-fragments", options.max_fragments,
          fmt::format("refuse a visibility order that would cut its faces into more than N fragments, default {} or "
                      "four times the faces, whichever is more: faces through one another are cut into more and more "
                      "(docs/order.md)",
                      OrderBuildOptions::kFragments))
      .check(whole_number())
      .type_name("N");
}

void option_front_end(Command command, cosim::SourceOptions& options) {
  command
      .add_option_function<std::string>(
          "--front-end",
          [&options](const std::string& who) {
            options.level = cosim::front_ends().at(who);
            options.level_option = "--front-end " + who;
          },
          fmt::format(
              "who makes spans of polygons, default host: rtl sends frames at the polygon level, and the "
              "core gets a front end (ACTIVE, {} polygons at once if the configuration has none; docs/stream.md)",
              kUsualActive))
      .option_text("host|rtl")
      .check(one_of({"host", "rtl"}))
      .type_name("WHO");
}

void option_threads(Command command, cosim::SourceOptions& options) {
  command.add_option("--threads", options.threads, "threads to use, default: one per processor")
      .check(whole_number(1, 1024))
      .type_name("N");
}

void option_outside(Command command, cosim::SourceOptions& options) {
  command.add_flag("--allow-outside", options.allow_outside,
                   "read files that a scene's file names (buffers, materials) wherever they lie, instead of refusing "
                   "those outside its folder");
}

void option_level(Command command, cosim::SourceOptions& options) {
  command
      .add_option_function<std::string>(
          "--level",
          [&options](const std::string& name) {
            options.level = cosim::levels().at(name);
            options.level_option = "--level";
          },
          fmt::format(
              "what the tokens of frames are, default spans; polygons are fewer words, and the core's front end "
              "makes the spans (docs/stream.md): a core with ACTIVE, which is {} for a scene whose configuration "
              "has none",
              kUsualActive))
      .option_text("spans|polygons")
      .check(one_of({"spans", "polygons"}))
      .type_name("LEVEL");
}

void option_fault(Command command, std::string& fault) {
  command
      .add_option("--fault", fault,
                  "build the RTL with a deliberate defect, to see it found: a name that kage list faults prints")
      .type_name("NAME");
}

void option_cache_verdicts(Command command, bool& cache) {
  // Taken as they are read, so that the last one counts.
  const auto flag = [&](const char* name, bool value, const char* about) {
    command
        .add_flag_function(
            name, [&cache, value] { cache = value; }, about)
        .in_order_of_parsing();
  };
  flag("--cache-verdicts", true,
       "skip a frame that an earlier run with this option found the same. Its words, the frame before it (with "
       "--jobs 1 "
       "all frames before it), the RTL, the configuration, the stalls and the seed must be those of the earlier run. "
       "Verdicts "
       "are kept in ~/.cache/kage/verdicts; a run with --fault or --netlist leaves them alone");
  flag("--no-cache-verdicts", false,
       "run every frame, also where --cache-verdicts stands before this option; the default");
}

void options_of_pictures(Command command, cosim::SourceOptions& options, const char* frames) {
  option_size(command, options);
  option_frames(command, options, frames);
  option_translucent(command, options);
  option_cull(command, options);
  option_max_fragments(command, options);
  option_lights(command, options);
  option_sub_bits(command, options);
  option_seed(command, options.seed);
  option_threads(command, options);
  option_outside(command, options);
}

void options_of_frames(Command command, cosim::SourceOptions& options) {
  option_config(command, options);
  option_degrade(command, options);
  option_units_only(command, options);
  command.add_flag("--all-spans", options.all_spans,
                   "write the spans that have no effect on any pixel, too, and the ends of volumes without one "
                   "(docs/shadows.md, \"Without effect\"); no picture changes");
  options_of_pictures(command, options);
}

}  // namespace kage::cli
