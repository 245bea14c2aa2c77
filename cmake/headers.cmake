# Every header stands alone. Where a source of its name includes it first (tools/check_layers.py looks), compiling that
# shows it; what `headers` has beside those, `make lint` compiles by itself: target all_verify_interface_header_sets.
function(verify_headers target headers)
  set(alone "")
  foreach(header IN LISTS headers)
    string(REGEX REPLACE "hpp$" "cpp" source ${header})
    if(NOT EXISTS ${source})
      list(APPEND alone ${header})
    endif()
  endforeach()
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/native FILES ${alone})
  set_target_properties(${target} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
endfunction()
