# Writes the descriptions that come with Riffler into source files, listed in shipped_sources.
set(shipped_sources)

# `function`() of `header` gives the texts of all `folder`/*.toml. Lists of them begin with the names that are given here.
function(ship_texts function header folder)
  file(GLOB others CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.toml)
  list(TRANSFORM others REPLACE "^.*/|[.]toml$" "")
  list(REMOVE_ITEM others ${ARGN})
  string(REGEX REPLACE "/.*" "" topic ${header})
  set(entries "")
  foreach(name IN LISTS ARGN others)
    set(file ${PROJECT_SOURCE_DIR}/${folder}/${name}.toml)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} text)
    string(APPEND entries "    {\"${name}\", R\"toml(${text})toml\"},\n")
  endforeach()
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${function}.cpp @ONLY CONTENT
"// Made by cmake/shipped.cmake.
#include \"@header@\"

namespace riffler::@topic@ {

std::span<const base::ShippedText> @function@() {
  static constexpr base::ShippedText kTexts[] = {
@entries@  };
  return kTexts;
}

}  // namespace riffler::@topic@
")
  set(shipped_sources ${shipped_sources} ${PROJECT_BINARY_DIR}/${function}.cpp PARENT_SCOPE)
endfunction()

# A new description is one file in its folder.
ship_texts(shipped_machines nc/machine/shipped_machines.hpp native/nc/machine/shipped
           tcp tcp-bc linuxcnc-xyzac linuxcnc-xyzbc head-head head-table 3-axis heidenhain heidenhain-bc
           sinumerik sinumerik-bc apt)
ship_texts(shipped_pens pen/arms/shipped_pens.hpp device/geometry riffler)
