# Installs the program with its manual, completions and profiles, and the library with its public
# headers and a CMake package, so that
#   find_package(Needlework)                        find_package(Needlework COMPONENTS core)
#   target_link_libraries(mine needlework::needlework)            ... needlework::core
# (or `scenes` or `theory`, which add those to the core)
# and #include <needlework/simulation.h> work elsewhere; with COMPONENTS c, needlework::c and
# #include <needlework.h> do, in C too, as they do by pkg-config.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Where the program finds the Python package once both are installed; beside it in the build tree.
set(python_from_program "")
if(NEEDLEWORK_PYTHON_FOLDER)
  file(RELATIVE_PATH python_from_program ${CMAKE_INSTALL_FULL_BINDIR}
       ${CMAKE_INSTALL_PREFIX}/${NEEDLEWORK_PYTHON_FOLDER})
endif()
target_compile_definitions(needlework_program PRIVATE
  NEEDLEWORK_PYTHON="${NEEDLEWORK_PYTHON}" NEEDLEWORK_PYTHON_FROM_PROGRAM="${python_from_program}")

# Manual and completions are printed by the program itself.
set(reference ${PROJECT_BINARY_DIR}/reference)
file(MAKE_DIRECTORY ${reference})
foreach(form_and_file "man needlework.1" "bash needlework" "zsh _needlework" "fish needlework.fish")
  separate_arguments(form_and_file)
  list(GET form_and_file 0 form)
  list(GET form_and_file 1 file)
  add_custom_command(TARGET needlework_program POST_BUILD
                     COMMAND needlework_program --print-reference ${form} > ${reference}/${file}
                     BYPRODUCTS ${reference}/${file} VERBATIM)
endforeach()
install(TARGETS needlework_program)
install(FILES ${reference}/needlework.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${reference}/needlework DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${reference}/_needlework DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${reference}/needlework.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(DIRECTORY profiles DESTINATION ${CMAKE_INSTALL_DATADIR}/needlework
        FILES_MATCHING PATTERN *.toml)

install(DIRECTORY include/needlework TYPE INCLUDE)
install(FILES include/needlework.h TYPE INCLUDE)
install(DIRECTORY examples TYPE DOC)
# The man page names documents as docs/NAME.md.
install(DIRECTORY docs TYPE DOC FILES_MATCHING PATTERN *.md)
install(TARGETS needlework_core EXPORT NeedleworkCoreTargets)
install(TARGETS needlework_scenes EXPORT NeedleworkScenesTargets)
install(TARGETS needlework_theory EXPORT NeedleworkTheoryTargets)
install(TARGETS needlework EXPORT NeedleworkTargets)
install(TARGETS needlework_c EXPORT NeedleworkCTargets)
file(RELATIVE_PATH needlework_pc_to_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
     ${CMAKE_INSTALL_PREFIX})
configure_file(cmake/needlework.pc.in needlework.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/needlework.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Needlework)
foreach(targets NeedleworkCoreTargets NeedleworkScenesTargets NeedleworkTheoryTargets NeedleworkTargets NeedleworkCTargets)
  install(EXPORT ${targets} NAMESPACE needlework:: DESTINATION ${package_folder})
endforeach()
configure_package_config_file(cmake/NeedleworkConfig.cmake.in NeedleworkConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(NeedleworkConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/NeedleworkConfig.cmake
              ${PROJECT_BINARY_DIR}/NeedleworkConfigVersion.cmake
        DESTINATION ${package_folder})

# A Debian package: cmake --preset package, cmake --build --preset package, cpack --preset package.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME needlework)
set(CPACK_PACKAGE_CONTACT "Needlework developers <needlework@localhost>")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
# The Python package loads without h5py, which only reading files needs, and Matplotlib, which only
# pictures and `needlework reproduce` need.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy, python3-h5py, python3-matplotlib")
include(CPack)
