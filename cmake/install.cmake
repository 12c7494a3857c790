# Installs the library with its public headers, the program, and a CMake package, so that
#   find_package(Needlework)
#   target_link_libraries(mine PRIVATE needlework::needlework)
# and #include <needlework/engine/simulation.h> work elsewhere.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# In the tree headers include each other as "src/..." or "kernels/..."; installed, as
# "needlework/..." or "needlework/kernels/...".
set(needlework_public_headers kernels/accuracy.h src/error.h src/engine/counters.h src/engine/simulation.h
                              src/io/h5md.h src/physics/predict.h src/scene/parse.h src/scene/scene.h
                              src/theory/theory.h)
foreach(header IN LISTS needlework_public_headers)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${header})
  file(READ ${header} text)
  string(REPLACE "#include \"src/" "#include \"needlework/" text "${text}")
  string(REPLACE "#include \"kernels/" "#include \"needlework/kernels/" text "${text}")
  string(REGEX REPLACE "^src/" "" installed ${header})
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/include/needlework/${installed} CONTENT "${text}" @ONLY)
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
