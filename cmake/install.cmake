# cmake --install: the program, the libraries with their headers, the experiments, and what find_package(crescent)
# reads.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(crescent_config ${CMAKE_INSTALL_LIBDIR}/cmake/crescent)
foreach(target IN LISTS crescent_folders ITEMS crescent_face)
  string(REPLACE crescent_ "" short ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${short})
endforeach()
install(TARGETS crescent crescent_face ${crescent_folders} EXPORT crescent ARCHIVE
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/crescent)
install(TARGETS crescent_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY src/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/crescent FILES_MATCHING PATTERN "*.h" PATTERN "*_test.h"
  EXCLUDE PATTERN "test_*.h" EXCLUDE)
install(DIRECTORY experiments DESTINATION ${CMAKE_INSTALL_DATADIR}/crescent)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT crescent NAMESPACE crescent:: FILE crescentTargets.cmake DESTINATION ${crescent_config})
configure_package_config_file(cmake/crescentConfig.cmake.in ${PROJECT_BINARY_DIR}/crescentConfig.cmake
  INSTALL_DESTINATION ${crescent_config})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/crescentConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/crescentConfig.cmake ${PROJECT_BINARY_DIR}/crescentConfigVersion.cmake
  DESTINATION ${crescent_config})
