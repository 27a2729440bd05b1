# crescent::check from the checkout that this port is in. In a port outside it, vcpkg_from_git() takes its place:
#   vcpkg_from_git(OUT_SOURCE_PATH SOURCE_PATH URL <address> REF <commit>)
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../.." ABSOLUTE)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS -DCRESCENT_RUN=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME crescent CONFIG_PATH lib/cmake/crescent)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
