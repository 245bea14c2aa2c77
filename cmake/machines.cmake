# Writes the machines that come with Riffler into a source file: one file in native/nc/machines and one line here.
set(RIFFLER_MACHINES tcp linuxcnc-xyzac linuxcnc-xyzbc head-head head-table 3-axis heidenhain apt)
set(entries "")
foreach(name IN LISTS RIFFLER_MACHINES)
  set(file ${PROJECT_SOURCE_DIR}/native/nc/machines/${name}.toml)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(READ ${file} text)
  string(APPEND entries "    {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/shipped_machines.cpp @ONLY CONTENT
"// Made by cmake/machines.cmake.
#include \"nc/shipped_machines.hpp\"

namespace riffler {

std::span<const ShippedMachine> shipped_machines() {
  static constexpr ShippedMachine kMachines[] = {
@entries@  };
  return kMachines;
}

}  // namespace riffler
")
