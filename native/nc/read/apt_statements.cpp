#include "nc/read/apt_statements.hpp"

#include <algorithm>
#include <iterator>

namespace riffler::nc {

namespace {

constexpr std::string_view kPassedOver[] = {
    "PARTNO", "PPRINT", "COOLNT", "END",    "STOP",   "OPSTOP",  "MACHIN",   "MODE",    "DELAY",
    "SEQNO",  "TOOLNO", "OPSKIP", "PREFUN", "AUXFUN", "DISPLAY", "TOOLPATH", "PAINT",   "END-OF-PATH",
    "LEADER", "REWIND", "CLEARP", "LPRINT", "CLPRNT", "NOPOST",  "ROTREF",   "SELECTL", "TPNAME",
    "OP",     "LINTOL", "SELECT", "TPRINT", "BOX",    "SETUP",
};

constexpr std::string_view kMoving[] = {
    "ROTABL", "ROTHED", "ROTATE", "TRANS",  "ORIGIN", "TRACUT", "COPY",   "COORD",  "GOFWD", "GOBACK",
    "GOLFT",  "GORGT",  "GOUP",   "GODOWN", "INDIRV", "INDIRP", "OFFSET", "FROMTO", "MACRO", "CALL",
    "LOOPST", "JUMPTO", "PIVOTZ", "SPLINE", "NURBS",  "ARCSLP", "HELIX",  "REPEAT",
};

}  // namespace

bool apt_says_nothing(std::string_view major) {
  return major.starts_with("CSI_") || major.starts_with("OPFEAT") ||
         std::ranges::find(kPassedOver, major) != std::end(kPassedOver);
}

bool apt_moves(std::string_view major) {
  return std::ranges::find(kMoving, major) != std::end(kMoving);
}

}  // namespace riffler::nc
