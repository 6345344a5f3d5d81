// SPDX-License-Identifier: Apache-2.0
#include "kage/config.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <filesystem>
#include <set>
#include <sstream>
#include <vector>

#include "contract/config_text.hpp"
#include "contract/derived.hpp"
#include "file/meant.hpp"
#include "file/one_line.hpp"
#include "file/plain_io.hpp"
#include "file/regular_file.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage {
namespace {

std::string allowed_values(const ParamInfo& p) {
  if (p.allowed == 0) return fmt::format("{} .. {}", p.min, p.max);
  std::string list;
  for (int v = p.min; v <= p.max; ++v)
    if ((p.allowed >> v) & 1U) list += fmt::format("{}{}", list.empty() ? "" : ", ", v);
  return list;
}

/// The values of a rule's parameters: " (FSF 1, DSF_BITS 0)".
std::string values_of(const Config& config, const RuleInfo& rule) {
  std::string text;
  for (const ParamInfo& p : kParams) {
    if (!names(rule.legal, p.name)) continue;
    text += fmt::format("{}{} {}", text.empty() ? " (" : ", ", p.name, config.*(p.member));
  }
  return text + ")";
}

std::vector<std::string> parameter_names() {
  std::vector<std::string> names;
  for (const ParamInfo& p : kParams) names.emplace_back(p.name);
  return names;
}

std::string in_capitals(std::string name) {
  for (char& letter : name) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return name;
}

void check_value(const ParamInfo& p, int value, const std::string& where) {
  if (value < p.min || value > p.max || (p.allowed != 0 && ((p.allowed >> value) & 1U) == 0))
    throw Error(fmt::format("{}: {} is {}, legal are {}", where, p.name, value, allowed_values(p)));
}

// `lines`: errors name the entry's line, for what a person wrote in a file.
Config from_yaml(const YAML::Node& node, const std::string& where, bool lines = false) {
  if (!node.IsMap()) throw Error(fmt::format("{}: not a list of PARAMETER: value", where));
  Config config;
  std::set<std::string> seen;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) throw Error(fmt::format("{}: not a list of PARAMETER: value", where));
    const auto name = entry.first.as<std::string>();
    const std::string shown = one_line(name, 60);
    const std::string place = lines ? fmt::format("{}: line {}: {}", where, entry.first.Mark().line + 1, shown)
                                    : fmt::format("{}: {}", where, shown);
    const auto* p = std::find_if(kParams.begin(), kParams.end(), [&](const ParamInfo& i) { return i.name == name; });
    if (p == kParams.end())
      throw Error(fmt::format(
          "{}: no such parameter{}{}", place, meant(in_capitals(shown), parameter_names()),
          entry.second.IsScalar() ? "" : "; a file has the parameters of one configuration, with no name over them"));
    if (!seen.insert(name).second) throw Error(fmt::format("{}: given twice", place));
    int value = 0;
    // A quotation mark without a second one leaves the line's end in the value.
    if (!entry.second.IsScalar() || entry.second.Scalar().find_first_of(" \n") != std::string::npos ||
        !YAML::convert<int>::decode(entry.second, value))
      throw Error(fmt::format("{}: not a whole number", place));
    if (lines) check_value(*p, value, fmt::format("{}: line {}", where, entry.first.Mark().line + 1));
    config.*(p->member) = value;
  }
  validate(config, where);
  return config;
}

/// Why a text is not YAML, in words of who writes a configuration.
std::string no_yaml(const YAML::Exception& e) {
  const auto begins = [&](const char* words) { return e.msg.rfind(words, 0) == 0; };
  if (begins(YAML::ErrorMsg::END_OF_SEQ_FLOW)) return "a [ has no ]";
  if (begins(YAML::ErrorMsg::END_OF_MAP_FLOW)) return "a { has no }";
  if (begins(YAML::ErrorMsg::FLOW_END)) return "a ] or } closes nothing";
  if (begins(YAML::ErrorMsg::EOF_IN_SCALAR)) return "a quotation mark has no second one";
  if (begins(YAML::ErrorMsg::TAB_IN_INDENTATION)) return "blanks indent a line, tabs do not";
  if (begins(YAML::ErrorMsg::UNKNOWN_ANCHOR)) return "* wants the name of an anchor, and there is none of this name";
  return "not YAML: a line is PARAMETER: value";
}

/// The line, from 1, of the mark behind the first document of a text.
int second_document(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  bool begun = false;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.starts_with("...") || (line.starts_with("---") && begun)) return number;
    begun = begun || (!line.empty() && line.front() != '#' && line.front() != '%');
  }
  return 1;
}

/// The values of a text; `where` opens the message of an Error. yaml-cpp keeps a limit of depth itself.
YAML::Node parsed_yaml(const std::string& text, const std::string& where) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1)
      throw Error(fmt::format("{}: line {}: a second document begins, and a configuration is one", where,
                              second_document(text)));
    return documents.empty() ? YAML::Node() : documents.front();
  } catch (const YAML::DeepRecursion& e) {
    throw Error(fmt::format("{}: line {}: lists nest too deeply", where, e.mark.line + 1));
  } catch (const YAML::Exception& e) {
    throw Error(fmt::format("{}: line {}: {}", where, e.mark.line + 1, no_yaml(e)));
  }
}

// Bytes of a configuration's file: fifty times what rtl/defs/configs.yaml has.
constexpr std::size_t kYamlBytes = std::size_t{1} << 18;

YAML::Node read_yaml(const std::string& path) {
  check_regular(path);
  const ReadOnly in(path);
  std::string text(kYamlBytes + 1, '\0');
  std::size_t size = 0;
  while (const std::size_t n = in.read(text.data() + size, text.size() - size)) size += n;
  text.resize(size);
  if (text.size() > kYamlBytes) throw Error(fmt::format("{}: more than {} bytes: no configuration", path, kYamlBytes));
  return parsed_yaml(text, path);
}

}  // namespace

bool names(std::string_view expression, std::string_view parameter) {
  const auto in_name = [&](std::size_t i) {
    return i < expression.size() && (expression[i] == '_' || (expression[i] >= 'A' && expression[i] <= 'Z'));
  };
  for (std::size_t at = expression.find(parameter); at != std::string_view::npos;
       at = expression.find(parameter, at + 1))
    if ((at == 0 || !in_name(at - 1)) && !in_name(at + parameter.size())) return true;
  return false;
}

Config config_from_text(const std::string& text, const std::string& where) {
  return from_yaml(parsed_yaml(text, where + ": configuration"), where);
}

void validate(const Config& config, const std::string& where) {
  for (const ParamInfo& p : kParams) check_value(p, config.*(p.member), where);
  for (const RuleInfo& rule : kRules)
    if (!rule.holds(config)) throw Error(fmt::format("{}: {}{}", where, rule.text, values_of(config, rule)));
}

std::vector<NamedConfig> named_configs() {
  const std::string path = (data_directory() / "rtl/defs/configs.yaml").string();
  const YAML::Node all = read_yaml(path);
  if (!all.IsMap()) throw Error(fmt::format("{}: not a list of configurations", path));
  std::vector<NamedConfig> list;
  for (const auto& entry : all) {
    const auto name = entry.first.as<std::string>();
    list.push_back({name, from_yaml(entry.second, fmt::format("{}: {}", path, name))});
  }
  return list;
}

NamedConfig load_config(const std::string& name_or_file) {
  // It is printed, and a line that begins with it may be a command to whoever reads the output, as GitHub does.
  if (std::any_of(name_or_file.begin(), name_or_file.end(),
                  [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }))
    throw Error(fmt::format("{}: a configuration's name holds no control characters", name_or_file));
  const auto named = named_configs();
  for (const NamedConfig& n : named)
    if (n.name == name_or_file) return n;
  if (!std::filesystem::exists(name_or_file)) {
    std::vector<std::string> names;
    for (const NamedConfig& n : named) names.push_back(n.name);
    throw Error(fmt::format("{}: no such file, and no configuration of that name{} (there are {})", name_or_file,
                            meant(name_or_file, names), fmt::join(names, ", ")));
  }
  return {name_or_file, from_yaml(read_yaml(name_or_file), name_or_file, true)};
}

std::string to_yaml(const Config& config) {
  std::string text;
  for (const ParamInfo& p : kParams) text += fmt::format("{}: {}\n", p.name, config.*(p.member));
  return text;
}

namespace {

/// The largest LIGHTS that any configuration can have.
int most_lights() {
  for (const ParamInfo& p : kParams)
    if (p.member == &Config::lights) return p.max;
  return 0;
}

}  // namespace

std::vector<std::string> lacks(const Config& config, const Needs& needs) {
  std::vector<std::string> missing;
  if (needs.shadows && config.dsf_bits == 0) missing.emplace_back("shadows (DSF_BITS > 0)");
  // Counting may do with one volume; whether it does is known once it is made.
  if (needs.shadows && needs.several_volumes && config.fsf == 0 && config.dsf_bits <= 1)
    missing.emplace_back("several volumes (FSF)");
  if (needs.shadows && needs.lights > config.lights && config.linear_bits == 0)
    missing.push_back(needs.lights > most_lights()
                          ? fmt::format("shadows of {} lights (LINEAR_BITS; a table has LIGHTS {} at most)",
                                        needs.lights, most_lights())
                          : fmt::format("shadows of several lights (LIGHTS >= {})", needs.lights));
  // Without shadows a light shines from its samples, whatever a counter holds.
  if (config.dsf_bits > 0 && needs.samples > 1 && needs.samples >> config.count_bits != 0)
    missing.push_back(
        fmt::format("soft shadows (COUNT_BITS >= {})", std::bit_width(static_cast<unsigned>(needs.samples))));
  if (needs.smooth && config.smooth == 0) missing.emplace_back("smooth colour (SMOOTH)");
  if (needs.translucency && config.translucency == 0) missing.emplace_back("translucency (TRANSLUCENCY)");
  if (needs.color && config.channels == 1) missing.emplace_back("colour (CHANNELS = 3)");
  if (needs.width > config.max_width) missing.push_back(fmt::format("MAX_WIDTH >= {}", needs.width));
  return missing;
}

std::vector<std::string> approximates(const Config& config, const Needs& needs) {
  std::vector<std::string> rough;
  if (needs.near_light() && config.smooth == 0) rough.emplace_back("light within a face (SMOOTH)");
  if (needs.light_table() && !derived::has_table(config) && config.linear_bits == 0)
    rough.emplace_back("what shadows take (CLASS_BITS)");
  return rough;
}

namespace {

/// One line of YAML: `config` made as wide as `needs` asks, and with several lights for as many lights and samples; ""
/// if even that does not do.
std::string widened(Config config, const Needs& needs) {
  const auto width = static_cast<unsigned>(needs.width);
  config.max_width = std::max(config.max_width, needs.width);
  config.x_bits = std::max(config.x_bits, static_cast<int>(std::bit_width(width)));
  // ceil(log2 width) keeps the error in depth near half an LSB up to the end of a line.
  config.z_frac = std::max(config.z_frac, static_cast<int>(std::bit_width(width - 1)));
  if (config.lights > 1) config.lights = std::max(config.lights, needs.lights);
  if (config.lights > 1 || config.linear_bits > 0)
    config.count_bits =
        std::max(config.count_bits, static_cast<int>(std::bit_width(static_cast<unsigned>(needs.samples))));
  if (config.linear_bits > 0) config.color_frac = std::max(config.color_frac, derived::lane_level_bits(config) - 8);
  std::string line;
  for (const ParamInfo& p : kParams) {
    if (config.*(p.member) > p.max) return "";
    if (config.*(p.member) != Config{}.*(p.member))
      line += fmt::format("{}{}: {}", line.empty() ? "" : ", ", p.name, config.*(p.member));
  }
  return lacks(config, needs).empty() ? "{" + line + "}" : "";
}

}  // namespace

NamedConfig choose_config(const Needs& needs) {
  // Where several lack as much, the first is named that a file could make do: no table has more than its lights.
  const auto hopeless = [&](const Config& c) {
    return needs.shadows && needs.lights > most_lights() && c.linear_bits == 0 ? 1 : 0;
  };
  std::string nearest;
  std::vector<std::string> lacking;
  std::pair<std::size_t, int> least;
  for (const NamedConfig& n : named_configs()) {
    const auto missing = lacks(n.config, needs);
    if (missing.empty()) return n;
    const std::pair distance(missing.size(), hopeless(n.config));
    if (!nearest.empty() && distance >= least) continue;
    nearest = n.name;
    lacking = missing;
    least = distance;
  }
  throw Error(fmt::format("no named configuration (rtl/defs/configs.yaml) can draw this: the nearest, {}, lacks {}",
                          nearest, fmt::join(lacking, ", ")));
}

std::string widened_config(const Needs& needs) {
  for (const NamedConfig& n : named_configs())
    if (std::string line = widened(n.config, needs); !line.empty()) return line;
  return "";
}

}  // namespace kage
