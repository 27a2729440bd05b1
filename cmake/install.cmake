# cmake --install: the libraries with their headers, the files for find_package(crescent) and, if they are built, the
# program and the experiments.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(crescent_config ${CMAKE_INSTALL_LIBDIR}/cmake/crescent)
set(crescent_of_run "")
if(CRESCENT_RUN)
  set(crescent_of_run ${crescent_targets} crescent)
  list(REMOVE_ITEM crescent_of_run ${crescent_of_check})
endif()
foreach(target IN LISTS crescent_of_check crescent_of_run)
  string(REPLACE crescent_ "" short ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${short})
endforeach()
foreach(part check run)
  if(crescent_of_${part})
    install(TARGETS ${crescent_of_${part}} EXPORT crescent_${part} ARCHIVE
      DESTINATION ${CMAKE_INSTALL_LIBDIR}/crescent)
    install(EXPORT crescent_${part} NAMESPACE crescent:: FILE crescent-${part}.cmake DESTINATION ${crescent_config})
  endif()
endforeach()
install(CODE "include(\"${PROJECT_SOURCE_DIR}/cmake/public_headers.cmake\")
crescent_public_headers(\"${PROJECT_SOURCE_DIR}\" \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}\")")
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(TARGET crescent_cli)
  install(TARGETS crescent_cli crescent_plugin_host RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  if(TARGET crescent_import)
    install(TARGETS crescent_import RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
  install(DIRECTORY experiments DESTINATION ${CMAKE_INSTALL_DATADIR}/crescent)
endif()

configure_package_config_file(cmake/crescentConfig.cmake.in ${PROJECT_BINARY_DIR}/crescentConfig.cmake
  INSTALL_DESTINATION ${crescent_config})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/crescentConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/crescentConfig.cmake ${PROJECT_BINARY_DIR}/crescentConfigVersion.cmake
  cmake/xxhash.cmake DESTINATION ${crescent_config})
