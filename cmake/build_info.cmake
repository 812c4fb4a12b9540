# What a binary knows of its origin: release number, git revision, where the shipped data lie in this build tree.
# Included by CMakeLists.txt; run as a script (cmake -P) by every build, because only then is "-dirty" the truth.  The
# header is rewritten only when it changes.
if(CMAKE_SCRIPT_MODE_FILE)
  set(DENSIFY_REVISION unknown)
  find_package(Git QUIET)
  if(GIT_FOUND AND EXISTS ${SOURCE_DIR}/.git)  # not the revision of another repository that this one lies in
    execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --tags --dirty --abbrev=12
                    WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE
                    RESULT_VARIABLE failed ERROR_QUIET)
    if(NOT failed)
      set(DENSIFY_REVISION ${described})
    endif()
  endif()
  configure_file(${SOURCE_DIR}/cmake/build_info.h.in ${HEADER})
  return()
endif()

# The build tree has the layout of an installation, so that a program finds its data in both alike.
set(data_root ${PROJECT_BINARY_DIR}/share/densify)
file(MAKE_DIRECTORY ${data_root})
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/dem/material/library ${data_root}/materials SYMBOLIC)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/examples/benchmark ${data_root}/benchmark SYMBOLIC)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/examples/tools ${data_root}/tools SYMBOLIC)

set(header ${PROJECT_BINARY_DIR}/generated/base/build_info.h)
add_custom_target(densify_build_info
  COMMAND ${CMAKE_COMMAND} -D SOURCE_DIR=${PROJECT_SOURCE_DIR} -D HEADER=${header} -D DATA_ROOT=${data_root}
          -D VERSION=${PROJECT_VERSION} -P ${CMAKE_CURRENT_LIST_FILE}
  BYPRODUCTS ${header}
  COMMENT "Looking up the git revision"
  VERBATIM
)
add_dependencies(densify_base densify_build_info)
target_include_directories(densify_base PRIVATE ${PROJECT_BINARY_DIR}/generated)
