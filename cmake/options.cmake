# Compiler options of our own code, in one interface target.
add_library(riffler_options INTERFACE)
target_compile_options(
  riffler_options
  INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
            # Results decide topology and must agree between machines: no contraction into fused multiply-adds.
            -ffp-contract=off
            # Nobody reads errno after a square root or traps a comparison; without both they become vector
            # instructions. Results are the same to the bit.
            -fno-math-errno -fno-trapping-math)
# Highway's sources are compiled for each set of instructions. A processor with SSSE3 and without SSE4 (of 2006) takes the
# scalar ones: Blender 4.2 and later need SSE 4.2.
target_compile_definitions(riffler_options INTERFACE HWY_DISABLED_TARGETS=HWY_SSSE3)
# A shared library is loaded only where something of it is called.
if(NOT WIN32)
  target_link_options(riffler_options INTERFACE LINKER:--as-needed)
endif()
if(RIFFLER_WERROR)
  target_compile_options(riffler_options INTERFACE -Werror)
endif()
