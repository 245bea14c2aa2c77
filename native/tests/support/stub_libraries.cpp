// The one source that knows where the stubs of makers' libraries, and the program that loads them, are built.
#include "support/stub_libraries.hpp"

namespace riffler::test {

const char* stub_dhd_path() {
  return RIFFLER_STUB_DHD;
}

const char* stub_hd_path() {
  return RIFFLER_STUB_HD;
}

const char* arm_program_path() {
  return RIFFLER_ARM;
}

}  // namespace riffler::test
