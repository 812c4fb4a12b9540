# deal.II with PETSc and MPI as a target that keeps the project's own flags and signature; HDF5 in deal.II's flavour.
find_package(MPI COMPONENTS CXX)
find_package(deal.II 9.4 QUIET)
if(NOT MPI_FOUND OR NOT deal.II_FOUND)
  message(FATAL_ERROR "The finite element rooms need deal.II 9.4 and MPI: install libdeal.ii-dev and openmpi-bin, or take "
    "-D DENSIFY_FEM=OFF (preset dem-only)")
endif()
if(NOT DEAL_II_WITH_PETSC OR NOT DEAL_II_WITH_MPI)
  message(FATAL_ERROR "deal.II in ${DEAL_II_PATH} was built without PETSc or MPI: take Debian's libdeal.ii-dev, or "
    "-D DENSIFY_FEM=OFF")
endif()
include(${DEAL_II_TARGET_CONFIG})
add_library(densify_dealii INTERFACE)
target_include_directories(densify_dealii SYSTEM INTERFACE ${DEAL_II_INCLUDE_DIRS})
target_link_libraries(densify_dealii INTERFACE $<IF:$<CONFIG:Debug>,deal.ii.g,deal.ii> MPI::MPI_CXX)
target_link_options(densify_dealii INTERFACE -fuse-ld=gold)  # 1 s instead of 11
target_compile_definitions(densify_dealii INTERFACE BOOST_NO_AUTO_PTR $<$<CONFIG:Debug>:DEBUG>)
set(HDF5_PREFER_PARALLEL TRUE)
