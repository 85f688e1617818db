# The package as others see it: everything installed, moved to another folder, and a program outside the tree built and run on it, without
# the packages of which only headers are used.
set(prefix ${BUILD}/consumer/moved/prefix)
file(REMOVE_RECURSE ${BUILD}/consumer)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${BUILD}/consumer/prefix OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(MAKE_DIRECTORY ${BUILD}/consumer/moved)
file(RENAME ${BUILD}/consumer/prefix ${prefix})

# The licence asks to go with every copy, and so do those of the libraries in it.
set(sources ${SOURCE}/../..)
file(GLOB notes RELATIVE ${sources} ${sources}/third_party_notes/*)
if(NOT notes)
  message(FATAL_ERROR "no third_party_notes in ${sources}")
endif()
foreach(file IN LISTS notes ITEMS LICENSE)
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${sources}/${file} ${prefix}/share/doc/isolux/${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()

execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BUILD}/consumer/build -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX}
                -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=Release
                -D CMAKE_DISABLE_FIND_PACKAGE_CGAL=ON -D CMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${BUILD}/consumer/build OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

# A file of a format whose library is loaded when it is first needed, where it was built in.
file(GLOB_RECURSE loaded ${prefix}/*isolux_volume_io_itk*)
if(WITH_ITK AND NOT loaded)
  message(FATAL_ERROR "the library that reads with ITK is not installed")
endif()
set(volume gen:sphere:8)
if(loaded)
  set(volume ${BUILD}/consumer/eight.mha)
  file(WRITE ${volume} "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n12345678")
endif()
execute_process(COMMAND ${BUILD}/consumer/build/consumer ${volume} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${BUILD}/consumer/build/consumer RESULT_VARIABLE status ERROR_VARIABLE says)
if(NOT status EQUAL 2 OR NOT says MATCHES "usage")
  message(FATAL_ERROR "without a volume: exit status ${status}, ${says}")
endif()
execute_process(COMMAND ${prefix}/bin/isolux info ${volume} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
if(loaded)
  file(REMOVE ${loaded})
  execute_process(COMMAND ${prefix}/bin/isolux info ${volume} RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE says)
  if(NOT status EQUAL 1 OR NOT says MATCHES "eight.mha: the library that reads it cannot be loaded: .*itk")
    message(FATAL_ERROR "without its library: exit status ${status}, ${says}")
  endif()
endif()

# What is found by a program that is missing itself says so.
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BUILD}/consumer/without -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX}
                -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON
                RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE says)
if(status EQUAL 0 OR NOT says MATCHES "pkg-config")
  message(FATAL_ERROR "without pkg-config: exit status ${status}, ${says}")
endif()

file(GLOB_RECURSE module ${prefix}/*isolux-raytrace_flat-targets.cmake)
file(REMOVE ${module})
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE}/parts -B ${BUILD}/consumer/parts -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX}
                -D CMAKE_PREFIX_PATH=${prefix} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
