# `cmake --install`: the core as a library, for find_package(riffler). Wheels have none of it.
set_target_properties(riffler_core PROPERTIES EXPORT_NAME core)
set_target_properties(riffler_device PROPERTIES EXPORT_NAME device)
add_library(riffler::core ALIAS riffler_core)
if(SKBUILD)
  return()
endif()
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/riffler)
install(TARGETS riffler_core riffler_device EXPORT riffler-targets ARCHIVE FILE_SET HEADERS)
install(EXPORT riffler-targets NAMESPACE riffler:: DESTINATION ${package_folder})
# Before version 1 a new minor version may change interfaces.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/riffler-config-version.cmake COMPATIBILITY SameMinorVersion)
# What was compiled by one GCC may need the standard library of that one; older ones than 12 were never tried.
set(RIFFLER_LEAST_GNU 12)
string(REGEX MATCH "^[0-9]+" compiler_major ${CMAKE_CXX_COMPILER_VERSION})
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND compiler_major GREATER RIFFLER_LEAST_GNU)
  set(RIFFLER_LEAST_GNU ${compiler_major})
endif()
configure_package_config_file(cmake/riffler-config.cmake.in ${PROJECT_BINARY_DIR}/package/riffler-config.cmake
                              INSTALL_DESTINATION ${package_folder})
install(FILES ${PROJECT_BINARY_DIR}/package/riffler-config.cmake ${PROJECT_BINARY_DIR}/package/riffler-config-version.cmake
        DESTINATION ${package_folder})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/licenses/riffler)
