// SPDX-License-Identifier: Apache-2.0
#include "rtl_options.hpp"

#include <fmt/format.h>

#include "kage/error.hpp"
#include "options.hpp"

namespace kage::cli {

void option_rtl(Command command, cosim::RtlRun& rtl) {
  command.add_option("--idle", rtl.idle, "percent of clocks at random in which no input is offered, default 0")
      .check(whole_number(0, 95))
      .type_name("P");
  command
      .add_option("--backpressure", rtl.backpressure,
                  "percent of clocks at random in which no output is taken, default 0")
      .check(whole_number(0, 95))
      .type_name("P");
  option_netlist(command, rtl.netlist);
  option_defect(command, rtl);
}

void option_netlist(Command command, std::string& netlist) {
  command
      .add_option("--netlist", netlist,
                  "in place of the RTL run the cells that yosys makes of it for a family of FPGAs, as models of "
                  "verif/cosim/model/cells (docs/gates.md)")
      .check(one_of({"ice40", "ecp5"}))
      .type_name("FAMILY");
}

void option_defect(Command command, cosim::RtlRun& rtl) {
  option_fault(command, rtl.fault);
  // Help leaves out an option without a group, and so does CLI11's message when a check of it fails: hence the name.
  const auto take = [&rtl](const std::string& text) {
    if (const std::string wrong = whole_number(1, 100000).fault(text); !wrong.empty())
      throw ValueError("--mutant", wrong);
    rtl.mutant = static_cast<int>(std::stoul(text));
  };
  command.add_option_function<std::string>("--mutant", take).type_name("N").hidden();
}

void refuse_rtl(const cosim::RtlRun& rtl, const std::string& why) {
  const char* const given = !rtl.fault.empty()      ? "--fault"
                            : rtl.idle != 0         ? "--idle"
                            : rtl.backpressure != 0 ? "--backpressure"
                            : rtl.mutant != 0       ? "--mutant"
                            : !rtl.netlist.empty()  ? "--netlist"
                                                    : nullptr;
  if (given != nullptr) throw Error(fmt::format("{}: {}", given, why));
}

}  // namespace kage::cli
