// Paths of the stubs of makers' libraries.
#pragma once

namespace riffler::test {

const char* stub_dhd_path();
const char* stub_hd_path();

}  // namespace riffler::test
