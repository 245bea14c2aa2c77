// The one source that knows where the stubs of makers' libraries are built.
#include "support/stub_libraries.hpp"

namespace riffler::test {

const char* stub_dhd_path() {
  return RIFFLER_STUB_DHD;
}

}  // namespace riffler::test
