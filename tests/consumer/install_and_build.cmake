# Installs BUILD into a new prefix, builds SOURCE against it in several ways and runs what comes out.
# cmake -DBUILD=... -DSOURCE=... -DWORK=... -DCXX=... -DFLAGS=... -DTYPE=... -DOBJDUMP=... -DVERSION=... -P this
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# configure(name example components option...): sets `configured` to the exit code, `messages`.
macro(configure name example components)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env --unset=CMAKE_GENERATOR ${CMAKE_COMMAND} -S ${SOURCE}
            -B ${WORK}/${name} -DCMAKE_BUILD_TYPE=${TYPE} -DCMAKE_CXX_COMPILER=${CXX}
            -DCMAKE_CXX_FLAGS=${FLAGS} -DVERSION=${VERSION} -DEXAMPLE=${example} "-DCOMPONENTS=${components}" ${ARGN}
    RESULT_VARIABLE configured OUTPUT_VARIABLE messages ERROR_VARIABLE messages)
endmacro()

# build_and_run(name example components option...)
function(build_and_run name example components)
  configure(${name} ${example} "${components}" ${ARGN})
  if(NOT configured EQUAL 0)
    message(FATAL_ERROR "${name}: cannot be configured:\n${messages}")
  endif()
  run(${CMAKE_COMMAND} --build ${WORK}/${name})
  execute_process(COMMAND ./consumer WORKING_DIRECTORY ${WORK}/${name} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
run(${prefix}/bin/needlework --version)
run(${prefix}/bin/needlework check ${prefix}/share/needlework/profiles/cooling-dilute.toml)

foreach(file man/man1/needlework.1 bash-completion/completions/needlework zsh/site-functions/_needlework
             fish/vendor_completions.d/needlework.fish)
  file(READ ${prefix}/share/${file} text)
  if(NOT text MATCHES "needlework")
    message(FATAL_ERROR "expected share/${file} to be about needlework")
  endif()
endforeach()

build_and_run(all_ninja needlework "" -G Ninja -DCMAKE_PREFIX_PATH=${prefix})
build_and_run(all_default needlework "needlework;core" -DCMAKE_PREFIX_PATH=${prefix})

# A build folder is not an installation, and says what to do.
foreach(components "" core c)
  configure(build_folder needlework "${components}" -DCMAKE_PREFIX_PATH=${BUILD})
  string(REGEX REPLACE "[ \n]+" " " messages "${messages}")
  if(configured EQUAL 0 OR NOT messages MATCHES "is a build folder.*install first.*--prefix PREFIX")
    message(FATAL_ERROR "from a build folder: expected an error that says what to do:\n${messages}")
  endif()
endforeach()

# The C interface needs the shared library alone, and no compiler of C++.
function(build_and_run_c name example components)
  set(SOURCE ${SOURCE}/c)
  build_and_run(${name} ${example} "${components}" -DCMAKE_C_FLAGS=${FLAGS} ${ARGN})
endfunction()
set(c_prefix ${WORK}/c_prefix)
file(COPY ${prefix}/ DESTINATION ${c_prefix})
file(GLOB_RECURSE rest ${c_prefix}/*/libneedlework*.a ${c_prefix}/*/NeedleworkTargets*.cmake
     ${c_prefix}/*/NeedleworkCoreTargets*.cmake ${c_prefix}/*/NeedleworkScenesTargets*.cmake
     ${c_prefix}/*/NeedleworkTheoryTargets*.cmake)
file(REMOVE ${rest} ${c_prefix}/bin/needlework)
foreach(example smallest own_arrays)
  build_and_run_c(c_${example} ${SOURCE}/../../examples/c/${example}.c c
                  -DCMAKE_PREFIX_PATH=${c_prefix})
endforeach()
execute_process(COMMAND ${OBJDUMP} -p ${WORK}/c_smallest/consumer OUTPUT_VARIABLE needed
                COMMAND_ERROR_IS_FATAL ANY)
if(NOT needed MATCHES "NEEDED +libneedlework\\.so\\.5\n" OR needed MATCHES "hdf5|libfmt")
  message(FATAL_ERROR "expected a program that needs libneedlework.so.5:\n${needed}")
endif()

# What the components core, scenes and theory need must be there without the rest of the library, and without HDF5.
set(core_prefix ${WORK}/core_prefix)
file(COPY ${prefix}/ DESTINATION ${core_prefix})
file(GLOB_RECURSE rest ${core_prefix}/*/libneedlework.a ${core_prefix}/*/NeedleworkTargets*.cmake)
list(LENGTH rest count)
if(count LESS 2)
  message(FATAL_ERROR "expected the component needlework in ${core_prefix}")
endif()
file(REMOVE ${rest})
foreach(generator "-GNinja" "")
  build_and_run(core${generator} core core ${generator} -DCMAKE_DISABLE_FIND_PACKAGE_HDF5=ON
                -DCMAKE_PREFIX_PATH=${core_prefix})
  execute_process(COMMAND ${OBJDUMP} -p ${WORK}/core${generator}/consumer OUTPUT_VARIABLE needed
                  COMMAND_ERROR_IS_FATAL ANY)
  if(needed MATCHES "hdf5" OR NOT needed MATCHES "libgomp|libomp|libfmt|libstdc")
    message(FATAL_ERROR "core${generator}: expected a program that needs no HDF5:\n${needed}")
  endif()
endforeach()

foreach(component scenes theory)
  build_and_run(${component} ${component} ${component} -DCMAKE_DISABLE_FIND_PACKAGE_HDF5=ON
                -DCMAKE_PREFIX_PATH=${core_prefix})
endforeach()

# Without HDF5 the component needlework says what is missing.
file(GLOB_RECURSE config ${prefix}/*/NeedleworkConfig.cmake)
file(READ ${config} text)
string(REPLACE "libhdf5" "libabsent" text "${text}")
file(WRITE ${config} "${text}")
configure(no_hdf5 needlework needlework -DCMAKE_PREFIX_PATH=${prefix})
string(REGEX REPLACE "[ \n]+" " " messages "${messages}")
if(configured EQUAL 0 OR NOT messages MATCHES "needs HDF5 as it was built with: [^ ]*libabsent")
  message(FATAL_ERROR "without HDF5: expected an error that names it:\n${messages}")
endif()
build_and_run(core_without_hdf5 core core -DCMAKE_PREFIX_PATH=${prefix})
