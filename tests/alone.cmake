# Configures every module alone; builds and tests the smallest, since the workspace builds the same sources anyway.
file(GLOB folders LIST_DIRECTORIES true ${MODULES}/*)
foreach(folder IN LISTS folders)
  get_filename_component(name ${folder} NAME)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${folder} -B ${WORK}/${name} -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX}
                  -D CMAKE_BUILD_TYPE=Debug -D CMAKE_CXX_FLAGS_DEBUG=-O0 -D ISOLUX_UNITY=ON -D CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE=TRUE
                  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()
foreach(name IN ITEMS core)
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/${name} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/${name} --output-on-failure COMMAND_ERROR_IS_FATAL ANY)
endforeach()
