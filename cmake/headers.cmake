# Every header stands alone: the target all_verify_interface_header_sets (`make lint`) compiles each by itself, for in a
# batch (cmake/batches.cmake) another source may have included what it lacks. Without batches a header that its own source
# includes first (tools/check_layers.py looks) is shown by that.
function(verify_headers target folder headers)
  set(alone "")
  foreach(header IN LISTS headers)
    string(REGEX REPLACE "hpp$" "cpp" source ${header})
    if(RIFFLER_BATCHES OR NOT EXISTS ${source})
      list(APPEND alone ${header})
    endif()
  endforeach()
  target_sources(${target} INTERFACE FILE_SET HEADERS BASE_DIRS ${folder} FILES ${alone})
  set_target_properties(${target} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
endfunction()

# Headers that are installed: each is compiled as whoever installs it compiles it, without what is private to the target.
function(public_headers target folder headers)
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${folder} FILES ${headers})
  set_target_properties(${target} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
endfunction()
