# Installs the library with its public headers, the program, and a CMake package, so that
#   find_package(Needlework)
#   target_link_libraries(mine PRIVATE needlework::needlework)
# and #include <needlework/engine/simulation.h> work elsewhere.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# In the tree headers include each other as "src/..."; installed, as "needlework/...".
set(needlework_public_headers error.h engine/counters.h engine/simulation.h io/h5md.h physics/predict.h
                              scene/parse.h scene/scene.h theory/theory.h)
foreach(header IN LISTS needlework_public_headers)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${header})
  file(READ src/${header} text)
  string(REPLACE "#include \"src/" "#include \"needlework/" text "${text}")
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/include/needlework/${header} CONTENT "${text}" @ONLY)
endforeach()
install(DIRECTORY ${PROJECT_BINARY_DIR}/include/needlework TYPE INCLUDE)

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
