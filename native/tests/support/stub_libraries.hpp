// Paths of the stubs of makers' libraries, and of the program that loads them.
#pragma once

namespace riffler::test {

const char* stub_dhd_path();
const char* stub_hd_path();
const char* arm_program_path();

}  // namespace riffler::test
