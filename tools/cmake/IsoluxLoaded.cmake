# Libraries that a backend loads when it is first needed, and how programs find them. Part of IsoluxModule.cmake.
# Where they are installed, how programs installed beside them get there, and the folder that the same way leads to from the build tree's apps.
set(ISOLUX_LOADED_DIR ${CMAKE_INSTALL_LIBDIR}/isolux)
file(RELATIVE_PATH ISOLUX_TO_LOADED ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/isolux)
get_filename_component(ISOLUX_LOADED_BUILD_DIR ${ISOLUX_BUILD_ROOT}/apps/any/${ISOLUX_TO_LOADED} ABSOLUTE)

# A program that is installed. It finds libraries that are loaded by where it is itself, so that an installation can be moved.
function(isolux_install_program target)
  set(path $ORIGIN/${ISOLUX_TO_LOADED} ${CMAKE_INSTALL_RPATH})
  set_target_properties(${target} PROPERTIES INSTALL_RPATH "${path}")
  if(ISOLUX_INSTALL)
    install(TARGETS ${target} COMPONENT isolux)
  endif()
endfunction()

# The shared library of src/loaded/KEY, which the backend KEY loads by its file name, ISOLUX_KEY_LIBRARY, when it is first needed: programs
# begin without its package. It is found by the program's RUNPATH: isolux_flags and isolux_install_program give it to ours, the module to
# others'. It is installed with ISOLUX_INSTALL off too: it is a part of the programs that link the module.
function(_isolux_loaded_library name id key package)
  set(library isolux_${id}_${key})
  file(GLOB sources CONFIGURE_DEPENDS src/loaded/${key}/*.cpp)
  add_library(${library} MODULE ${sources})
  set_target_properties(${library} PROPERTIES OUTPUT_NAME ${library}-${ISOLUX_VERSION}
    LIBRARY_OUTPUT_DIRECTORY $<1:${ISOLUX_LOADED_BUILD_DIR}>)
  target_link_libraries(${library} PRIVATE isolux::core)
  isolux_flags(${library})
  set_target_properties(${library} PROPERTIES INSTALL_RPATH "${CMAKE_INSTALL_RPATH}")
  if(NOT ISOLUX_SANITIZE)
    target_link_options(${library} PRIVATE LINKER:-z,defs)  # what is missing is missing now, not when it is loaded
  endif()
  isolux_link(${library} PRIVATE fmt ${package})
  string(TOUPPER ${key} macro)
  target_include_directories(${library} PRIVATE include)
  target_compile_definitions(isolux_${id} PRIVATE ISOLUX_${macro}_LIBRARY="$<TARGET_FILE_NAME:${library}>")
  target_link_libraries(isolux_${id} PRIVATE ${CMAKE_DL_LIBS})
  add_dependencies(isolux_${id} ${library})
  set(installed ${ISOLUX_LOADED_DIR})
  if(NOT IS_ABSOLUTE ${installed})
    set(installed $<INSTALL_PREFIX>/${installed})
  endif()
  target_link_options(isolux_${id} INTERFACE "$<INSTALL_INTERFACE:LINKER:-rpath,${installed}>")
  # CMake puts folders to link from into the RUNPATH of programs in the build tree; where they are installed it gives them their own
  # INSTALL_RPATH instead, which somebody's project sets (README.md).
  target_link_directories(isolux_${id} INTERFACE $<BUILD_INTERFACE:${ISOLUX_LOADED_BUILD_DIR}>)
  install(TARGETS ${library} LIBRARY DESTINATION ${ISOLUX_LOADED_DIR} COMPONENT ${name})
endfunction()
