// Names in blocks of Sinumerik programs: commands that switch modes, and rejected names.
#include <algorithm>
#include <iterator>
#include <string>

#include "nc/read/sinumerik_interpreter.hpp"

namespace riffler::nc {

namespace {

/// Commands without motion: path control, display, look-ahead, limits.
constexpr std::string_view kQuiet[] = {
    "FFWON",      "FFWOF",     "SOFT",     "SOFTA",   "BRISK",    "BRISKA",    "DRIVE",    "DRIVEA",     "COMPON",
    "COMPCURV",   "COMPCAD",   "COMPSURF", "COMPOF",  "FNORM",    "FLIN",      "FCUB",     "DYNNORM",    "DYNROUGH",
    "DYNSEMIFIN", "DYNFINISH", "DYNPREC",  "DYNPOS",  "CPRECON",  "CPRECOF",   "CUT2D",    "CUT2DF",     "CUT3DC",
    "CUT3DCC",    "CUT3DF",    "CUT3DFF",  "CUT3DFS", "NORM",     "KONT",      "KONTC",    "KONTT",      "CDON",
    "CDOF",       "CDOF2",     "STOPRE",   "SBLON",   "SBLOF",    "DISPLON",   "DISPLOF",  "SAVE",       "FGROUP",
    "ORIEULER",   "ORIRPY",    "ORIRPY2",  "OSOF",    "OSC",      "OSS",       "OSSE",     "OSD",        "OST",
    "ORISON",     "ORISOF",    "UPATH",    "SPATH",   "RTLION",   "STARTFIFO", "STOPFIFO", "FIFOCTRL",   "WALIMON",
    "WALIMOF",    "CFC",       "CFIN",     "CFTCP",   "DIAMOF",   "CORROF",    "TOROTOF",  "TOFRAMEOF",  "SPCOF",
    "SPCON",      "PAROTOF",   "PTPOF",    "CP",      "CYCLE832", "WORKPIECE", "MSG",      "SETPIECE",   "FENDNORM",
    "LFOF",       "LFON",      "TOFFOF",   "SPIF1",   "SPIF2",    "ICYCOF",    "ICYCON",   "DELAYFSTON", "DELAYFSTOF"};

/// A name, or with * a prefix of names.
struct Refused {
  std::string_view name;
  const char* why;

  bool matches(std::string_view other) const {
    return name.ends_with('*') ? other.starts_with(name.substr(0, name.size() - 1)) : other == name;
  }
};
/// Statements with blocks of their own.
constexpr std::string_view kBlocks[] = {"TRANS", "ATRANS", "ROT",  "AROT",  "CYCLE800", "HOLES1", "HOLES2",
                                        "MCALL", "CALL",   "GOTO", "GOTOF", "GOTOB",    "IF",     "DEF"};
constexpr const char* kWriteMoves = "have the CAM system write its moves";
constexpr Refused kRefused[] = {
    {"ASPLINE", "splines are not read: have the CAM system write G1 and G2"},
    {"BSPLINE", "splines are not read: have the CAM system write G1 and G2"},
    {"CSPLINE", "splines are not read: have the CAM system write G1 and G2"},
    {"SPLINEPATH", "splines are not read: have the CAM system write G1 and G2"},
    {"POLY", "polynomials are not read: have the CAM system write G1 and G2"},
    {"INVC*", "involutes are not read: have the CAM system write G1 and G2"},
    {"TRACYL", "a cylinder's transformation is not read: have the CAM system write the moves of a machine with TRAORI"},
    {"TRANSMIT", "face transformation is not read: have the CAM system write the moves of a machine with TRAORI"},
    {"TRAANG", "an inclined axis is not read: have the CAM system write X, Y and Z"},
    {"TRACON", "chained transformations are not read: have the CAM system write TRAORI alone"},
    {"TOFRAME*", "a frame by the tool's direction is not read: have the CAM system write ROT or CYCLE800"},
    {"TOROT*", "a frame by the tool's direction is not read: have the CAM system write ROT or CYCLE800"},
    {"PAROT*", "a frame by the table is not read: have the CAM system write ROT or CYCLE800"},
    {"TCOABS", "a tool carrier is not read: have the CAM system write CYCLE800 or TRAORI"},
    {"TCOFR*", "a tool carrier is not read: have the CAM system write CYCLE800 or TRAORI"},
    {"ORICON*", "the tool's axis on a cone is not read: have the CAM system write ORIVECT or ORIAXES"},
    {"ORICURVE", "the tool's axis by a second curve is not read: have the CAM system write ORIVECT or ORIAXES"},
    {"ORIPATH*", "the tool's axis by the path is not read: have the CAM system write ORIVECT or ORIAXES"},
    {"ORIROT*", "turns of the tool about its axis are not read: have the CAM system write ORIVECT or ORIAXES"},
    {"ORIRESET", "it turns the tool as the machine is set up: have the CAM system write the rotary axes"},
    {"ORIVIRT", "virtual angles of the tool are not read: have the CAM system write A3= B3= C3="},
    {"PTP", "point-to-point moves are not read: have the CAM system write G0 or G1"},
    {"DIAM*", "diameters (turning) are not read"},
    {"SCALE", "scaling is not read: have the CAM system write the final moves"},
    {"ASCALE", "scaling is not read: have the CAM system write the final moves"},
    {"MIRROR", "mirroring is not read: have the CAM system write the final moves"},
    {"AMIRROR", "mirroring is not read: have the CAM system write the final moves"},
    {"ROTS", "solid angles are not read: have the CAM system write ROT and AROT"},
    {"AROTS", "solid angles are not read: have the CAM system write ROT and AROT"},
    {"CROTS", "solid angles are not read: have the CAM system write ROT and AROT"},
    {"PRESET*", "it sets the machine's coordinates: have the CAM system write TRANS"},
    {"TOFFON", "a tool offset that changes along the path is not read: take it out"},
    {"CLGON", "centreless grinding is not read"},
    {"WHEN*", "synchronised actions (WHEN ... DO) are not read: what they do depends on the machine; take it out"},
    {"EVERY", "synchronised actions (EVERY ... DO) are not read: what they do depends on the machine; take it out"},
    {"DO", "synchronised actions (DO) are not read: what they do depends on the machine; take it out"},
    {"IDS", "synchronised actions (IDS=) are not read: what they do depends on the machine; take it out"},
    {"ID", "synchronised actions (ID=) are not read: what they do depends on the machine; take it out"},
    {"SETAL", "it stops the program with an alarm: what it checks is not met"},
    {"POCKET*", kWriteMoves},
    {"SLOT*", kWriteMoves},
    {"LONGHOLE", kWriteMoves},
    {"CYCLE6*", kWriteMoves},
    {"CYCLE7*", kWriteMoves},
    {"CYCLE8*", kWriteMoves},
    {"CYCLE9*", kWriteMoves},
    {"CONTPRON*", kWriteMoves},
    {"HOLES*", kWriteMoves},
};

}  // namespace

/// A name in a block that is no variable, with or without brackets after it.
void SinumerikInterpreter::named(const std::string& name, SinumerikCursor& cursor, const SinumerikWords& words) {
  if (switches(name)) {
    if (cursor.take_if("(")) cursor.skip_brackets();
    return;
  }
  if (std::ranges::find(kQuiet, name) != std::end(kQuiet)) {
    if (cursor.take_if("(")) cursor.skip_brackets();
    return;
  }
  if (name == "SETMS") {
    master_ = 1;
    if (!cursor.take_if("(")) return;
    if (cursor.peek() != ')') master_ = values_.whole(cursor, "SETMS");
    if (!cursor.take_if(")")) cursor.fail("a bracket that is not closed");
    return;
  }
  if (name == "RET") {
    cursor.skip_all();
    returns_ = true;
    return;
  }
  const bool alone = words.empty();
  SinumerikCursor ahead = cursor;
  if (std::ranges::find(kBlocks, name) != std::end(kBlocks) || is_sinumerik_hole(number_of_cycle(name)))
    cursor.fail(name + " needs a block of its own");
  refuse(name);
  if (!alone) cursor.fail(name + " needs a block of its own, or is not a supported word: correct it");
  int times = 1;
  if (ahead.peek() == 'P' && ahead.at_address()) {
    ahead.take();
    ahead.take_if("=");
    times = values_.whole(ahead, "P");
    cursor = ahead;
  }
  call(name, cursor, times);
}

/// Commands that affect later blocks.
bool SinumerikInterpreter::switches(const std::string& name) {
  if (name == "TRAORI")
    keep_tip(true);
  else if (name == "TRAFOOF")
    keep_tip(false);
  else if (name == "SUPA")
    by_machine_ = true;
  else if (name == "CIP")
    motion_ = Motion::Through;
  else if (name == "CT")
    motion_ = Motion::Tangent;
  else if (name == "ORIAXES")
    turning_way_ = Turning::Axes;
  else if (name == "ORIVECT" || name == "ORIPLANE")
    turning_way_ = Turning::GreatCircle;
  else if (name == "ORIWKS")
    by_system_ = Turning::GreatCircle, machine_vectors_ = false;
  else if (name == "ORIMKS")
    by_system_ = Turning::Axes, machine_vectors_ = true;
  else if (name == "RTLIOF")
    note_once(-10, "rapid", "RTLIOF: each axis goes at its own rate in rapids, which are taken as straight lines");
  else
    return false;
  return true;
}

void SinumerikInterpreter::refuse(const std::string& name) const {
  const auto found = std::ranges::find_if(kRefused, [&](const Refused& refused) { return refused.matches(name); });
  if (found == std::end(kRefused)) return;
  place_.fail(name + ": " + (found->why == kWriteMoves ? std::string("this cycle is not read: ") : std::string()) +
              found->why);
}

/// "DEF REAL A, B=2*3", "DEF STRING[20] NAME".
void SinumerikInterpreter::define(SinumerikCursor& cursor) {
  std::string type = cursor.name();
  while (type == "CHAN" || type == "NCK" || type == "SYNR" || type == "SYNW" || type == "SYNRW" || type == "PHU")
    type = cursor.name();
  const auto kind = SinumerikValues::kind_of(type);
  if (!kind)
    place_.fail("DEF " + type +
                " is not read: REAL, INT, BOOL, CHAR and STRING are; have the CAM system write TRANS and "
                "AROT for frames");
  if (cursor.take_if("[")) cursor.skip_brackets();
  do {
    const std::string name = cursor.name();
    if (name.empty()) cursor.fail_unexpected();
    if (cursor.take_if("[")) cursor.skip_brackets();
    const bool has_value = cursor.take_if("=");
    if (has_value && (cursor.take_word("SET") || cursor.peek() == '('))
      place_.fail("lists of values behind DEF are not read: assign them one by one");
    if (*kind == SinumerikValues::Kind::Text)
      values_.define_text(name, has_value ? cursor.quoted() : "");
    else
      values_.define(name, *kind, has_value ? values_.expression(cursor) : 0.0);
  } while (cursor.take_if(","));
  cursor.expect_end();
}

}  // namespace riffler::nc
