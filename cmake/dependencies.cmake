# Every library that the core stands on, found once. Headers of others are system headers: their warnings are not ours.
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)
find_package(PkgConfig REQUIRED)
# In the public headers; all others are in sources alone.
find_package(glm CONFIG REQUIRED)
pkg_check_modules(OPENMESH REQUIRED IMPORTED_TARGET openmesh)
if(WIN32)
  pkg_check_modules(HIDAPI REQUIRED IMPORTED_TARGET hidapi)
else()
  pkg_check_modules(HIDAPI REQUIRED IMPORTED_TARGET hidapi-hidraw)
endif()
# Vector instructions, chosen at run time.
pkg_check_modules(HIGHWAY REQUIRED IMPORTED_TARGET libhwy)
# Descriptions of machines. Used as headers, so that nothing is left to load at run time.
find_path(TOMLPLUSPLUS_INCLUDE toml++/toml.h REQUIRED)
add_library(riffler_toml INTERFACE)
target_include_directories(riffler_toml SYSTEM INTERFACE ${TOMLPLUSPLUS_INCLUDE})

# cmake/riffler-config.cmake.in finds those of them again that are linked.
set(RIFFLER_PRIVATE_LIBRARIES Threads::Threads ZLIB::ZLIB PkgConfig::OPENMESH PkgConfig::HIDAPI PkgConfig::HIGHWAY
                              $<BUILD_INTERFACE:riffler_toml>)
if(WIN32)
  # Of Windows itself: threads that wait for a word, timers, sockets.
  list(APPEND RIFFLER_PRIVATE_LIBRARIES api-ms-win-core-synch-l1-2-0 winmm ws2_32)
endif()
