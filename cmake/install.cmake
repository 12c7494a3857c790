# Installs the program with its manual, completions and profiles, and the library with its public
# headers and a CMake package, so that
#   find_package(Needlework)                        find_package(Needlework COMPONENTS core)
#   target_link_libraries(mine needlework::needlework)            ... needlework::core
# and #include <needlework/simulation.h> work elsewhere.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS needlework_program)
install(DIRECTORY profiles DESTINATION ${CMAKE_INSTALL_DATADIR}/needlework
        FILES_MATCHING PATTERN *.toml)

install(DIRECTORY include/needlework TYPE INCLUDE)
install(TARGETS needlework_core EXPORT NeedleworkCoreTargets)
install(TARGETS needlework EXPORT NeedleworkTargets)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Needlework)
foreach(targets NeedleworkCoreTargets NeedleworkTargets)
  install(EXPORT ${targets} NAMESPACE needlework:: DESTINATION ${package_folder})
endforeach()
configure_package_config_file(cmake/NeedleworkConfig.cmake.in NeedleworkConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(NeedleworkConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/NeedleworkConfig.cmake
              ${PROJECT_BINARY_DIR}/NeedleworkConfigVersion.cmake
        DESTINATION ${package_folder})
