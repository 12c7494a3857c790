# The Python package needlework: the module _core and python/needlework/. In the build tree it lies
# in python/, so that PYTHONPATH=build/release/python is enough. The build goes on without it where
# pybind11 or NumPy are missing.
set(NEEDLEWORK_PYTHON /usr/bin/python3 CACHE FILEPATH
    "Python that the package is built for and the tests run with")

if(EXISTS ${NEEDLEWORK_PYTHON})
  set(Python_EXECUTABLE ${NEEDLEWORK_PYTHON})
  find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module NumPy)
  find_package(pybind11 2.10 QUIET CONFIG)
endif()
if(NOT Python_Development.Module_FOUND OR NOT Python_NumPy_FOUND OR NOT pybind11_FOUND)
  message(STATUS "No Python package: expected pybind11 and NumPy for ${NEEDLEWORK_PYTHON} "
                 "(section [python] of packages.txt)")
  return()
endif()

file(GLOB sources CONFIGURE_DEPENDS src/python/*.cpp)
pybind11_add_module(needlework_python MODULE NO_EXTRAS ${sources})
set(package ${PROJECT_BINARY_DIR}/python/needlework)
set_target_properties(needlework_python PROPERTIES OUTPUT_NAME _core
                      LIBRARY_OUTPUT_DIRECTORY ${package} CXX_VISIBILITY_PRESET hidden)
target_compile_options(needlework_python PRIVATE -Wall -Wextra -Wpedantic
                       # It waits for the library nearly all the time.
                       $<$<CONFIG:Release>:-O1>)
target_compile_definitions(needlework_python PRIVATE NEEDLEWORK_VERSION="${PROJECT_VERSION}")
target_link_libraries(needlework_python PRIVATE needlework fmt::fmt)
# Only what Python looks for is visible, so that nothing meets symbols of other modules.
target_link_options(needlework_python PRIVATE -Wl,--exclude-libs,ALL)

# What is Python, and the scenes, grids and claims of the paper, which needlework.reproduce reads.
set(copies)
function(copy_to_package from to)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/${from}/)
  file(GLOB_RECURSE files RELATIVE ${PROJECT_SOURCE_DIR}/${from} CONFIGURE_DEPENDS ${ARGN})
  foreach(file ${files})
    add_custom_command(OUTPUT ${to}/${file}
                       COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/${from}/${file}
                               ${to}/${file}
                       DEPENDS ${PROJECT_SOURCE_DIR}/${from}/${file} VERBATIM)
    list(APPEND copies ${to}/${file})
  endforeach()
  set(copies ${copies} PARENT_SCOPE)
endfunction()
copy_to_package(python/needlework ${package} *.py *.pyi py.typed)
copy_to_package(profiles/paper ${package}/reproduce/paper *.toml)
add_custom_target(needlework_python_files ALL DEPENDS ${copies})
add_dependencies(needlework_python needlework_python_files)
# For `needlework --version`.
target_compile_definitions(needlework_program PRIVATE
  NEEDLEWORK_PYTHON_VERSION="${Python_VERSION}")

# Debian's Python looks into dist-packages below /usr/local, others into site-packages.
execute_process(COMMAND ${NEEDLEWORK_PYTHON} -c "import sys, sysconfig
print('lib/python%d.%d/' % sys.version_info[:2]
      + ('dist' if 'deb_system' in sysconfig.get_scheme_names() else 'site') + '-packages', end='')"
                OUTPUT_VARIABLE python_folder COMMAND_ERROR_IS_FATAL ANY)
set(NEEDLEWORK_PYTHON_FOLDER ${python_folder} CACHE STRING
    "Where the Python package is installed, below the prefix")
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME python)
install(TARGETS needlework_python DESTINATION ${NEEDLEWORK_PYTHON_FOLDER}/needlework)
install(DIRECTORY python/needlework DESTINATION ${NEEDLEWORK_PYTHON_FOLDER}
        FILES_MATCHING PATTERN *.py PATTERN *.pyi PATTERN py.typed)
install(DIRECTORY profiles/paper/ DESTINATION ${NEEDLEWORK_PYTHON_FOLDER}/needlework/reproduce/paper
        FILES_MATCHING PATTERN *.toml)
