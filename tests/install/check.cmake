# Installs into a scratch folder, moves it, builds the consumer against it and runs both programs.
set(prefix ${SCRATCH}/moved)
file(REMOVE_RECURSE ${SCRATCH})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE text)
  set(text ${text} PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${SCRATCH}/installed)
file(RENAME ${SCRATCH}/installed ${prefix})

run(${prefix}/bin/densify --version)
if(NOT text MATCHES "${VERSION}")
  message(FATAL_ERROR "the installed program says '${text}', not ${VERSION}")
endif()

file(GLOB shipped RELATIVE ${LIBRARY} ${LIBRARY}/*.toml)
file(GLOB installed RELATIVE ${prefix}/share/densify/materials ${prefix}/share/densify/materials/*.toml)
if(NOT shipped STREQUAL installed)
  message(FATAL_ERROR "materials in the sources: '${shipped}', in the installation: '${installed}'")
endif()

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${SCRATCH}/consumer -G ${GENERATOR} -D CMAKE_BUILD_TYPE=Debug
    -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_FLAGS=${FLAGS} -D CMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${SCRATCH}/consumer)
run(${SCRATCH}/consumer/consumer)
if(NOT text STREQUAL "${VERSION} 24\n")
  message(FATAL_ERROR "the consumer says '${text}', not '${VERSION} 24'")
endif()
