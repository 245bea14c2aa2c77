// "linuxcnc-xyzac", "linuxcnc-xyzbc": LinuxCNC's tilting rotary tables (xyzac-trt-kins and xyzbc-trt-kins of its 2.9).
// A positive angle turns the part right-handed about the machine's +X, +Y or +Z, the opposite of what ISO 841 says of
// tables; option `direction` = "iso" reverses both. Options are named as the pins of its HAL components.
#include "nc/chain.hpp"

namespace riffler {

namespace {

std::unique_ptr<Machine> make(OptionReader& options, char tilt, const char* name) {
  const double sign = options.word("direction", {"linuxcnc", "iso"}, "linuxcnc") == "iso" ? -1 : 1;
  const Vec3 centre = options.vector("rot_point", Vec3(0)), offset = options.vector("offset", Vec3(0));
  const double tool_offset = options.number("tool_offset", 0);
  const bool tcp = options.flag("tcp", false);
  Chain chain;
  chain.name = name;
  // Table C turns about a line through rot_point; the tilting axis passes rot_point at the offset across its own
  // direction and along Z.
  const bool a = tilt == 'A';
  const Vec3 apart = a ? Vec3(0, offset.y, offset.z + tool_offset) : Vec3(offset.x, 0, offset.z + tool_offset);
  chain.rotary[0] = {'C', {0, 0, sign}, centre};
  chain.rotary[1] = {tilt, a ? Vec3(sign, 0, 0) : Vec3(0, sign, 0), centre + apart};
  chain.tip_words = tcp;
  const std::string axes = std::string("tables ") + tilt + ", C turn the part " +
                           (sign > 0 ? "right-handed about +" : "left-handed about +") + (a ? "X" : "Y") + ", +Z";
  chain.meaning = tcp ? "X Y Z: tip in part coordinates, kinematics on [M428]; " + axes
                      : "X Y Z: joints, kinematics off [M429]; " + axes;
  return std::make_unique<ChainMachine>(std::move(chain));
}

}  // namespace

std::unique_ptr<Machine> make_linuxcnc_xyzac(OptionReader& options) {
  return make(options, 'A', "linuxcnc-xyzac");
}

std::unique_ptr<Machine> make_linuxcnc_xyzbc(OptionReader& options) {
  return make(options, 'B', "linuxcnc-xyzbc");
}

}  // namespace riffler
