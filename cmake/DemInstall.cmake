# Installs the headers and the files that make `find_package(dem CONFIG)` work.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_DATADIR}/cmake/dem")

install(DIRECTORY include/dem TYPE INCLUDE FILES_MATCHING PATTERN "*.hpp" PATTERN "*.cuh" PATTERN "compiled.cpp")
install(FILES LICENSE TYPE DOC)

install(TARGETS dem dem_native EXPORT dem INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(EXPORT dem NAMESPACE dem:: FILE demTargets.cmake DESTINATION "${package_dir}")

configure_package_config_file(cmake/demConfig.cmake.in demConfig.cmake INSTALL_DESTINATION "${package_dir}")
# Before 1.0 a minor release may change the interface. There is nothing to link, so any word size will do.
write_basic_package_version_file(demConfigVersion.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/demConfig.cmake" "${CMAKE_CURRENT_BINARY_DIR}/demConfigVersion.cmake"
              cmake/DemCompiled.cmake
        DESTINATION "${package_dir}")
