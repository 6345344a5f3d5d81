// SPDX-License-Identifier: Apache-2.0
//
// A pack for one module of the RTL: what passes at its ports, clock by clock, while the whole core draws a pack's
// frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cosim/report/run_record.hpp"
#include "file/temp_file.hpp"
#include "kage/config.hpp"

namespace kage::vectors {

/// A module that has packs, and which outputs mean something only while another one is high.
struct PackModule {
  std::string_view name;
  bool (*is_there)(const Config&);  ///< whether a core of this configuration has one
  std::string_view lacks;           ///< what it takes to have one
  struct Qualified {
    std::string_view port, by;
  };
  std::vector<Qualified> qualified;
};

/// All of them.
const std::vector<PackModule>& pack_modules();

/// The module of that name. Throws Error that names all, or what the configuration lacks to have it.
const PackModule& pack_module(const std::string& name, const Config& config);

/// Takes the text of a model with ModelOptions::ports, and keeps what its first instance by name says.
class PortsRecord {
 public:
  struct Port {
    std::string name;
    int bits = 0;
    int lsb = 0;  ///< of all ports of its direction
  };

  explicit PortsRecord(const Config& config, const PackModule& module) : config_(config), module_(&module) {}

  /// A piece of text. Returns what is not of the record, for others to tell.
  std::string text(std::string_view piece);

  /// Writes the pack into `folder`; the manifest names `scene` and `frames`.
  void write(const std::filesystem::path& folder, TempFiles& files, const std::string& scene, int frames,
             const std::string& made_by);

  [[nodiscard]] std::size_t clocks() const { return inputs_.size(); }
  [[nodiscard]] const std::vector<Port>& inputs() const { return in_; }
  [[nodiscard]] const std::vector<Port>& outputs() const { return out_; }

 private:
  void line(const std::string& text);
  [[nodiscard]] std::string care(const std::string& outputs) const;
  [[nodiscard]] std::string header() const;

  Config config_;
  const PackModule* module_;
  std::string instance_;  // the first by name
  std::string held_;      // a line that is not whole
  std::vector<Port> in_, out_;
  std::vector<std::pair<std::string, std::string>> parameters_;
  std::vector<std::string> inputs_, outputs_;  // of each clock, hexadecimal
};

}  // namespace kage::vectors
