# Every library that the core stands on, found once, gathered in one interface target.
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(glm CONFIG REQUIRED)
pkg_check_modules(OPENMESH REQUIRED IMPORTED_TARGET openmesh)
pkg_check_modules(HIDAPI REQUIRED IMPORTED_TARGET hidapi-hidraw)
# Descriptions of machines. Used as headers, so that nothing is left to load at run time.
find_path(TOMLPLUSPLUS_INCLUDE toml++/toml.h REQUIRED)
# Vector instructions, chosen at run time.
pkg_check_modules(HIGHWAY REQUIRED IMPORTED_TARGET libhwy)

add_library(riffler_dependencies INTERFACE)
# Headers of others are system headers: their warnings are not ours.
get_target_property(glm_include glm::glm INTERFACE_INCLUDE_DIRECTORIES)
target_include_directories(riffler_dependencies SYSTEM INTERFACE ${glm_include} ${TOMLPLUSPLUS_INCLUDE})
target_link_libraries(riffler_dependencies INTERFACE Threads::Threads ZLIB::ZLIB PkgConfig::OPENMESH
                                                     PkgConfig::HIDAPI PkgConfig::HIGHWAY)
