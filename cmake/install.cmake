# `cmake --install` and what `find_package(Densify)` reads: densify::base, densify::dem, headers, program, data.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Densify)
set(include_dir ${CMAKE_INSTALL_INCLUDEDIR}/densify)

foreach(name flags base dem)
  set_target_properties(densify_${name} PROPERTIES EXPORT_NAME ${name})
endforeach()
install(TARGETS densify_flags densify_base densify_dem EXPORT DensifyTargets INCLUDES DESTINATION ${include_dir})
install(EXPORT DensifyTargets NAMESPACE densify:: DESTINATION ${package_dir})
install(TARGETS densify)
if(DENSIFY_FEM)
  install(TARGETS densify-press densify-tabulate densify-voxel-moduli)
endif()
install(DIRECTORY base dem DESTINATION ${include_dir} FILES_MATCHING PATTERN *.h)
install(DIRECTORY dem/material/library/ DESTINATION ${CMAKE_INSTALL_DATADIR}/densify/materials OPTIONAL
        FILES_MATCHING PATTERN *.toml)  # OPTIONAL: tests/install counts what arrives
install(DIRECTORY examples/benchmark/packings DESTINATION ${CMAKE_INSTALL_DATADIR}/densify/benchmark
        FILES_MATCHING PATTERN *.data)
install(FILES examples/tools/plot_moduli.py examples/tools/plot_stresses.py examples/tools/plot_trade.py DESTINATION ${CMAKE_INSTALL_DATADIR}/densify/tools)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(cmake/DensifyConfig.cmake.in ${PROJECT_BINARY_DIR}/DensifyConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/DensifyConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/DensifyConfig.cmake ${PROJECT_BINARY_DIR}/DensifyConfigVersion.cmake
              cmake/voro++.cmake
        DESTINATION ${package_dir})
