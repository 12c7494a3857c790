# Installs the library with its public headers, the program, and a CMake package, so that
#   find_package(Needlework)
#   target_link_libraries(mine PRIVATE needlework::needlework)
# and #include <needlework/simulation.h> work elsewhere.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(DIRECTORY include/needlework TYPE INCLUDE)

install(TARGETS needlework_program)
install(TARGETS needlework EXPORT NeedleworkTargets)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Needlework)
install(EXPORT NeedleworkTargets NAMESPACE needlework:: DESTINATION ${package_folder})
configure_package_config_file(cmake/NeedleworkConfig.cmake.in NeedleworkConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(NeedleworkConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/NeedleworkConfig.cmake
              ${PROJECT_BINARY_DIR}/NeedleworkConfigVersion.cmake
        DESTINATION ${package_folder})
