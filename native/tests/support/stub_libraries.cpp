// The one source that knows where the stubs of makers' libraries are built.
#include "support/stub_libraries.hpp"

namespace riffler::test {

const char* stub_dhd_path() {
  return RIFFLER_STUB_DHD;
}

const char* stub_hd_path() {
  return RIFFLER_STUB_HD;
}

}  // namespace riffler::test
