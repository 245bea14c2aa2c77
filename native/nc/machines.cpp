// The list of machines: a new one is its own file and one line here (and its factory in machine.hpp).
#include <stdexcept>

#include "nc/machine.hpp"

namespace riffler {

namespace {

constexpr MachineEntry kMachines[] = {
    {"tcp", "five axes, the control keeps the tip (G43.4): X Y Z tip in part coordinates, axis = Rz(C) Rx(A) ez",
     make_tcp},
    {"linuxcnc-xyzac",
     "LinuxCNC, tilting table A under rotary table C (xyzac-trt-kins): X Y Z A C where the axes stand",
     make_linuxcnc_xyzac},
    {"linuxcnc-xyzbc",
     "LinuxCNC, tilting table B under rotary table C (xyzbc-trt-kins): X Y Z B C where the axes stand",
     make_linuxcnc_xyzbc},
    {"3-axis", "three axes, the tool stands upright (G43): X Y Z tip in part coordinates", make_three_axis},
};

}  // namespace

std::span<const MachineEntry> machines() {
  return kMachines;
}

std::unique_ptr<Machine> make_machine(std::string_view name, OptionReader& options) {
  std::string known;
  for (const MachineEntry& entry : kMachines) {
    if (entry.name == name) return entry.make(options);
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw std::invalid_argument("unknown " + options.owner() + "; known: " + known);
}

}  // namespace riffler
