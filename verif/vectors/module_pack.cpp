// SPDX-License-Identifier: Apache-2.0
#include "vectors/module_pack.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <sstream>

#include "cosim/model/sha256.hpp"
#include "file/output_file.hpp"
#include "file/read_file.hpp"
#include "json/json_text.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"
#include "kage/stream.hpp"
#include "number/counted.hpp"
#include "vectors/pack.hpp"

namespace kage::vectors {
namespace {

constexpr const char* kLine = "kage_ports ";
constexpr const char* kModuleBench = "kage_module_tb.v";
constexpr const char* kModuleHeader = "kage_module.vh";

bool banked(const Config& c) { return c.arrangement == 1; }
bool systolic(const Config& c) { return c.arrangement == 0; }
bool always(const Config&) { return true; }
bool units(const Config& c) { return c.units > 0; }
bool tree(const Config& c) { return c.units > 1; }

/// Bits of a hexadecimal number, by their place from the right.
bool bit(const std::string& hex, int place) {
  const std::size_t digit = hex.size() - 1 - static_cast<std::size_t>(place / 4);
  const char c = hex.at(digit);
  const int value = c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10;
  return (value >> place % 4 & 1) != 0;
}

std::string hex_of(const std::vector<bool>& bits) {
  std::string hex;
  for (std::size_t at = (bits.size() + 3) / 4; at-- > 0;) {
    int value = 0;
    for (std::size_t b = 0; b < 4; ++b) value |= 4 * at + b < bits.size() && bits[4 * at + b] ? 1 << b : 0;
    hex += fmt::format("{:x}", value);
  }
  return hex;
}

/// The first word of a port.
std::uint32_t word_of(const std::string& hex, const PortsRecord::Port& port) {
  std::uint32_t value = 0;
  for (int b = 0; b < 32; ++b) value |= bit(hex, port.lsb + b) ? std::uint32_t{1} << b : 0;
  return value;
}

const PortsRecord::Port& port_of(const std::vector<PortsRecord::Port>& ports, std::string_view name) {
  for (const PortsRecord::Port& p : ports)
    if (p.name == name) return p;
  throw Error(fmt::format("the module has no port {}: its RTL is not this kage's", name));
}

}  // namespace

const std::vector<PackModule>& pack_modules() {
  static const std::vector<PackModule> modules{
      {"token_reader", always, "", {{"token_o", "token_valid_o"}, {"token_flags_o", "token_valid_o"}}},
      {"pixel_banked", banked, "ARRANGEMENT 1", {{"exit_last_o", "exit_valid_o"}, {"exit_data_o", "exit_valid_o"}}},
      {"pixel_systolic", systolic, "ARRANGEMENT 0", {{"exit_last_o", "exit_valid_o"}, {"exit_data_o", "exit_valid_o"}}},
      {"expansion_unit", units, "UNITS > 0", {{"px_data_o", "px_valid_o"}, {"px_last_o", "px_valid_o"}}},
      {"compare_tree", tree, "UNITS > 1", {{"out_data_o", "out_valid_o"}, {"out_last_o", "out_valid_o"}}},
      {"line_out",
       always,
       "",
       {{"load_o", "load_valid_o"},
        {"m_axis_tdata_o", "m_axis_tvalid_o"},
        {"m_axis_tuser_o", "m_axis_tvalid_o"},
        {"m_axis_tlast_o", "m_axis_tvalid_o"}}}};
  return modules;
}

const PackModule& pack_module(const std::string& name, const Config& config) {
  std::string names;
  for (const PackModule& m : pack_modules()) {
    if (m.name == name) {
      if (!m.is_there(config)) throw Error(fmt::format("--module {}: a core has one with {}", name, m.lacks));
      return m;
    }
    names += fmt::format("{}{}", names.empty() ? "" : ", ", m.name);
  }
  throw Error(fmt::format("--module {}: not one of {}", name, names));
}

std::string PortsRecord::text(std::string_view piece) {
  std::string rest;
  held_ += piece;
  for (std::size_t end = held_.find('\n'); end != std::string::npos; end = held_.find('\n')) {
    const std::string whole = held_.substr(0, end);
    held_.erase(0, end + 1);
    if (whole.rfind(kLine, 0) == 0)
      line(whole.substr(std::string_view(kLine).size()));
    else
      rest += whole + "\n";
  }
  return rest;
}

void PortsRecord::line(const std::string& text) {
  std::istringstream in(text);
  std::string instance, what, name, value;
  in >> instance >> what >> name >> value;
  // All instances write in each clock, in any order: the first by name is kept.
  if (instance_.empty() || instance < instance_) {
    instance_ = instance;
    in_.clear();
    out_.clear();
    parameters_.clear();
    inputs_.clear();
    outputs_.clear();
  }
  if (instance != instance_) return;
  if (what == "clock") {
    inputs_.push_back(name);
    outputs_.push_back(value);
    return;
  }
  if (what == "parameter") {
    parameters_.emplace_back(name, value);
    return;
  }
  // The first port has the uppermost bits.
  std::vector<Port>& ports = what == "in" ? in_ : out_;
  for (Port& p : ports) p.lsb += std::stoi(value);
  ports.push_back({name, std::stoi(value), 0});
}

/// Output bits that mean something in a clock: of a token those of its words.
std::string PortsRecord::care(const std::string& outputs) const {
  const int all = std::accumulate(out_.begin(), out_.end(), 0, [](int sum, const Port& p) { return sum + p.bits; });
  std::vector<bool> bits(static_cast<std::size_t>(all), true);
  const auto ignore = [&](const Port& p, int from) {
    std::fill(bits.begin() + p.lsb + from, bits.begin() + p.lsb + p.bits, false);
  };
  for (const PackModule::Qualified& q : module_->qualified)
    if (!bit(outputs, port_of(out_, q.by).lsb)) ignore(port_of(out_, q.port), 0);
  if (module_->name == "token_reader") {
    const Port& token = port_of(out_, "token_o");
    const Port& flags = port_of(out_, "token_flags_o");
    // flags_t: header, lacking, cut, ends, at_last, the uppermost bit first.
    const bool header = bit(outputs, flags.lsb + flags.bits - 1);
    const bool lacking = bit(outputs, flags.lsb + flags.bits - 2);
    const bool cut = bit(outputs, flags.lsb + flags.bits - 3);
    const std::size_t words = cut       ? 0
                              : header  ? kHeaderWords
                              : lacking ? 1
                                        : Layout(config_).words_of(word_of(outputs, token));
    ignore(token, std::min(token.bits, static_cast<int>(32 * words)));
  }
  return hex_of(bits);
}

std::string PortsRecord::header() const {
  const auto total = [](const std::vector<Port>& ports) {
    return std::accumulate(ports.begin(), ports.end(), 0, [](int sum, const Port& p) { return sum + p.bits; });
  };
  std::string text = fmt::format(
      "// SPDX-License-Identifier: Apache-2.0\n// {}: the module, its parameters and ports, and the clocks of the "
      "pack.\n"
      "`define KAGE_MODULE {}\n`define KAGE_MODULE_IN_BITS {}\n`define KAGE_MODULE_OUT_BITS {}\n"
      "`define KAGE_MODULE_CLOCKS {}\n",
      kModuleHeader, module_->name, total(in_), total(out_), clocks());
  std::string list;
  for (const auto& [name, value] : parameters_) list += fmt::format("{}.{}({})", list.empty() ? "" : ", ", name, value);
  text += "`define KAGE_MODULE_PARAMETERS " + list + "\n";
  text += fmt::format("`define KAGE_MODULE_RESET {}\n", port_of(in_, "rst_ni").lsb);
  list = ".clk_i(clk)";
  for (const Port& p : in_) list += fmt::format(", .{}(in[{}:{}])", p.name, p.lsb + p.bits - 1, p.lsb);
  for (const Port& p : out_) list += fmt::format(", .{}(out[{}:{}])", p.name, p.lsb + p.bits - 1, p.lsb);
  text += "`define KAGE_MODULE_PORTS " + list + "\n";
  list.clear();
  for (const Port& p : out_)
    list += fmt::format(
        " if ((((out ^ wanted) & care) >> {0}) & ((`KAGE_MODULE_OUT_BITS'd1 << {1}) - 1'b1)) "
        "$display(\"  {2}: expected %h, got %h\", wanted[{3}:{0}], out[{3}:{0}]);",
        p.lsb, p.bits, p.name, p.lsb + p.bits - 1);
  return text + "`define KAGE_MODULE_TELL" + list + "\n";
}

void PortsRecord::write(const std::filesystem::path& folder, TempFiles& files, const std::string& scene, int frames,
                        const std::string& made_by) {
  if (clocks() == 0) throw Error(fmt::format("{}: the RTL told nothing of its ports", module_->name));
  Json manifest{{"schema", "kage.module-pack/1"}, {"module", module_->name}, {"scene", scene}, {"frames", frames}};
  manifest["made_by"] = made_by;
  manifest["config"] = report::to_json(config_);
  manifest["clocks"] = clocks();
  manifest["files"] = Json::array();
  const auto put = [&](const std::string& name, const auto& write) {
    OutputFile out(files, folder / name);
    cosim::Sha256 hash;
    std::uint64_t bytes = 0;
    write([&](const std::string& text) {
      out << text;
      hash.add_piece(std::span<const char>(text.data(), text.size()));
      bytes += text.size();
    });
    out.close();
    manifest["files"].push_back({{"name", name}, {"bytes", bytes}, {"sha256", hash.take()}});
  };
  const auto lines = [&](const char* name, const auto& of) {
    put(name, [&](const auto& write) {
      for (std::size_t i = 0; i < clocks(); ++i) write(of(i) + "\n");
    });
  };
  lines("inputs.hex", [&](std::size_t i) { return inputs_[i]; });
  lines("outputs.hex", [&](std::size_t i) { return outputs_[i]; });
  lines("care.hex", [&](std::size_t i) { return care(outputs_[i]); });
  put(kModuleHeader, [&](const auto& write) { write(header()); });
  put(kModuleBench,
      [&](const auto& write) { write(read_file(data_directory() / "verif/vectors/bench" / kModuleBench)); });
  put("README.md", [&](const auto& write) {
    write(fmt::format(
        "# Test vectors of {0}\n\nWhat passes at its ports in {1} while the core draws {2} of {3}. Run it in this "
        "folder; RTL\n"
        "is the core's folder `rtl`:\n\n```sh\n"
        "iverilog -g2012 -IRTL/include -o module.vvp {4} RTL/*.sv && vvp module.vvp\n```\n\n"
        "The one line that begins with `kage_module_tb: ` says `passed`, or `FAILED` with the clock, and which ports.\n"
        "`inputs.hex`, `outputs.hex` and `care.hex` have a line a clock, the first port of `{5}` in the uppermost "
        "bits;\n"
        "outputs count where `care.hex` is 1. Another latency is another module: these vectors are not for it.\n",
        module_->name, counted(clocks(), "clock"), counted(static_cast<std::uint64_t>(frames), "frame"), scene,
        kModuleBench, kModuleHeader));
  });
  manifest["license"] = "Apache-2.0";
  write_text(files, (folder / kManifest).string(), json_text(manifest, 2) + "\n");
}

}  // namespace kage::vectors
