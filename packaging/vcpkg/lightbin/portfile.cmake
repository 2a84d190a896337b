# An overlay port for the sources that it lies in: vcpkg install lightbin --overlay-ports=LIGHTBIN/packaging/vcpkg
# vcpkg looks for changes in this folder alone: when the sources have changed, remove lightbin, and install it again
# with --no-binarycaching.
set(VCPKG_BUILD_TYPE release)  # headers: a debug build has the same
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS -DLIGHTBIN_TESTS=OFF -DLIGHTBIN_EXAMPLES=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH share/cmake/lightbin)

file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
