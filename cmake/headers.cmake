# Every header stands alone: the target all_verify_interface_header_sets (`make lint`) compiles each by itself, for in a
# batch (cmake/batches.cmake) another source may have included what it lacks. Without batches a header that its own source
# includes first (tools/check_layers.py looks) is shown by that.
function(verify_headers target headers)
  set(alone "")
  foreach(header IN LISTS headers)
    string(REGEX REPLACE "hpp$" "cpp" source ${header})
    if(RIFFLER_BATCHES OR NOT EXISTS ${source})
      list(APPEND alone ${header})
    endif()
  endforeach()
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/native FILES ${alone})
  set_target_properties(${target} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
endfunction()
