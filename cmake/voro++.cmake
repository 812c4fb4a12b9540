# The target voro++::voro++, which the library brings no package file for.
find_path(VORO_INCLUDE_DIR voro++/voro++.hh REQUIRED)
find_library(VORO_LIBRARY voro++ REQUIRED)
mark_as_advanced(VORO_INCLUDE_DIR VORO_LIBRARY)
if(NOT TARGET voro++::voro++)
  add_library(voro++::voro++ UNKNOWN IMPORTED)
  set_target_properties(voro++::voro++ PROPERTIES
    IMPORTED_LOCATION ${VORO_LIBRARY}
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${VORO_INCLUDE_DIR})
endif()
