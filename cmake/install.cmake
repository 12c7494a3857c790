# Installs the program with its manual, completions and profiles, and the library with its public
# headers and a CMake package, so that
#   find_package(Needlework)                        find_package(Needlework COMPONENTS core)
#   target_link_libraries(mine needlework::needlework)            ... needlework::core
# (or `scenes` or `theory`, which add those to the core)
# and #include <needlework/simulation.h> work elsewhere; with COMPONENTS c, needlework::c and
# #include <needlework.h> do, in C too, as they do by pkg-config. The target `uninstall` removes what
# the last installation wrote.
#
# Components are Debian's packages: `program`, `library` (the shared one), `devel` (what programs are
# compiled with) and, in python.cmake, `python`.
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
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
install(TARGETS needlework_program)
install(FILES ${reference}/needlework.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${reference}/needlework DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${reference}/_needlework DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${reference}/needlework.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(DIRECTORY profiles DESTINATION ${CMAKE_INSTALL_DATADIR}/needlework
        FILES_MATCHING PATTERN *.toml)
# The man page names documents as docs/NAME.md.
install(DIRECTORY docs TYPE DOC FILES_MATCHING PATTERN *.md)
install(FILES LICENSE COMPATIBILITY.md CITATION.cff TYPE DOC)

install(TARGETS needlework_c EXPORT NeedleworkCTargets
        LIBRARY COMPONENT library NAMELINK_COMPONENT devel)

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME devel)
install(DIRECTORY include/needlework TYPE INCLUDE)
install(FILES include/needlework.h TYPE INCLUDE)
install(DIRECTORY examples TYPE DOC)
install(TARGETS needlework_core EXPORT NeedleworkCoreTargets)
install(TARGETS needlework_scenes EXPORT NeedleworkScenesTargets)
install(TARGETS needlework_theory EXPORT NeedleworkTheoryTargets)
install(TARGETS needlework EXPORT NeedleworkTargets)
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
write_basic_package_version_file(NeedleworkConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/NeedleworkConfig.cmake
              ${PROJECT_BINARY_DIR}/NeedleworkConfigVersion.cmake
        DESTINATION ${package_folder})

configure_file(cmake/uninstall.cmake.in uninstall.cmake @ONLY)
if(PROJECT_IS_TOP_LEVEL)
  add_custom_target(uninstall COMMAND ${CMAKE_COMMAND} -P ${PROJECT_BINARY_DIR}/uninstall.cmake)
endif()

# Packages of Debian, one for each component: packaging/build.sh makes them.
get_target_property(soname needlework_c SOVERSION)
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program library devel)
set(CPACK_PACKAGE_NAME needlework)
set(CPACK_PACKAGE_CONTACT "Needlework developers <needlework@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME needlework)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS python3-needlework)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "The program needlework, its manual, documents and scenes.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libneedlework${soname})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "The shared library of the C interface.")

# What the CMake package looks for, which static libraries are linked with.
set(CPACK_DEBIAN_DEVEL_PACKAGE_NAME libneedlework-dev)
set(CPACK_DEBIAN_DEVEL_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVEL_PACKAGE_DEPENDS "libfmt-dev, libhdf5-dev, libhwy-dev, libtomlplusplus-dev")
set(CPACK_COMPONENT_DEVEL_DEPENDS library)
set(CPACK_COMPONENT_DEVEL_DESCRIPTION
    "Headers and static libraries for C++ and C, with a CMake package and pkg-config.")

# Loads without h5py, which only reading files needs, and Matplotlib, which only pictures and
# `needlework reproduce` need.
if(NEEDLEWORK_PYTHON_FOLDER)
  list(APPEND CPACK_COMPONENTS_ALL python)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-needlework)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-h5py, python3-matplotlib")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/debian/postinst
                                                ${PROJECT_SOURCE_DIR}/packaging/debian/prerm)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python package needlework.")
endif()
include(CPack)
