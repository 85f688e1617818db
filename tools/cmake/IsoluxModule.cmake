# One call per module. A module builds, tests and benches alone (cmake -S modules/NAME -B DIR) or as a member of the workspace.
#
#   isolux_module(NAME [STAGE Stage CATALOGUE function [DEFAULT key]]
#                 [DEPENDS modules...]              # ours, public
#                 [PUBLIC_PACKAGES packages...]     # seen in our public headers
#                 [PACKAGES packages...]            # used in .cpp files only
#                 [BACKEND_PACKAGES key:Package...] # a backend that is left out, with a word, where its package is missing
#                 [LOADED keys...]                  # of those, whose package is linked by a shared library alone (src/loaded/KEY)
#                 [TEST_PACKAGES packages...] [BENCH_PACKAGES packages...])
#
# Sources are src/*.cpp; each file of src/backends is one backend: its key is its file name, and the generated catalogue calls
# its isolux::backends::KEY(Registry<Stage>&). tests/*.cpp become one GoogleTest program, each benches/*.cpp and examples/*.cpp
# a program of its own.
include_guard(DIRECTORY)  # variables below are a folder's own: modules side by side in somebody's project each need them
include(${CMAKE_CURRENT_LIST_DIR}/IsoluxPackages.cmake)
include(GNUInstallDirs)
get_filename_component(ISOLUX_ROOT ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)
set(ISOLUX_BUILD_ROOT ${PROJECT_BINARY_DIR})

set(ISOLUX_VERSION 0.1.0)
include(${CMAKE_CURRENT_LIST_DIR}/IsoluxLoaded.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/IsoluxPrograms.cmake)
# In somebody's project nothing but the libraries is built and installed, unless it asks for more.
option(ISOLUX_INSTALL "Install the libraries, their headers and the package, and the programs that are built" ${PROJECT_IS_TOP_LEVEL})
option(ISOLUX_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(ISOLUX_BENCHES "Build the kernel benchmarks" OFF)
option(ISOLUX_EXAMPLES "Build the examples of the modules' READMEs" ${PROJECT_IS_TOP_LEVEL})
option(ISOLUX_UNITY "Compile several sources of a library or program as one: half of the time, as headers cost most of it" OFF)
option(ISOLUX_WERROR "Treat warnings as errors" OFF)
set(ISOLUX_TEST_FLAGS "" CACHE STRING "Compiler flags of test programs alone, such as -O1: their own code takes longer to compile than to run")
set(ISOLUX_TEST_SHARDS "" CACHE STRING "Run each program of tests in so many processes, instead of one for each test")
set(ISOLUX_SANITIZE "" CACHE STRING "Sanitizers, such as address,undefined or thread")
set(ISOLUX_WITHOUT "" CACHE STRING "Packages to do without even where they are installed, such as CGAL;ITK")

# How many sources are compiled as one: the more, the less there is to compile, and the less there is to do for many processors at once. Few
# divide many, so that what compiles in the largest batches compiles in all.
cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
if(processors LESS 4)
  set(ISOLUX_UNITY_BATCH 24)
elseif(processors LESS 8)
  set(ISOLUX_UNITY_BATCH 12)
else()
  set(ISOLUX_UNITY_BATCH 6)
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_VERIFY_INTERFACE_HEADER_SETS ON)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
  endif()
endif()

if(ISOLUX_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
  enable_testing()
endif()
if(ISOLUX_BENCHES)
  find_package(benchmark REQUIRED)
endif()

# Flags shared by everything of ours, tests and applications included.
function(isolux_flags target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-qual -Wundef -Wimplicit-fallthrough
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # GCC 12: false positive on "x" + std::string
    -ffp-contract=off                        # the same bits with and without FMA instructions
    -fno-fast-math                           # NaN and infinity mean something, whatever flags the project around has
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${ISOLUX_UNITY}>>:-Wno-subobject-linkage>  # a source's own names, though it is included
    $<$<BOOL:${ISOLUX_WERROR}>:-Werror>)
  # Instruction sets that no kernel is compiled for: SSSE3, which few machines have without SSE4; AVX3_DL, which adds nothing that kernels use
  # to AVX3 and is a machine's own with -march=native; and those whose vectors have no fixed size.
  target_compile_definitions(${target} PRIVATE
    "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_AVX3_DL|HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128|HWY_RVV)")
  # Every 64-bit Arm has NEON, the one set left to it, so nothing is to be chosen at run time. Where Highway can choose, it compiles NEON for Arms
  # with AES, and GCC refuses structs of its vectors: their implicit constructors are for any Arm.
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
    target_compile_definitions(${target} PRIVATE TOOLCHAIN_MISS_SYS_AUXV_H)  # Highway's word for what it needs in order to choose
  endif()
  # One search path for where it is built and where it is installed: CMake pads those it edits, and an empty entry means the current folder.
  set(path ${ISOLUX_LOADED_BUILD_DIR} ${CMAKE_BUILD_RPATH} ${CMAKE_INSTALL_RPATH})
  set_target_properties(${target} PROPERTIES BUILD_WITH_INSTALL_RPATH ON INSTALL_RPATH_USE_LINK_PATH ON INSTALL_RPATH "${path}")
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${ISOLUX_UNITY} UNITY_BUILD_BATCH_SIZE ${ISOLUX_UNITY_BATCH})
  if(target MATCHES "_tests$")
    target_compile_options(${target} PRIVATE ${ISOLUX_TEST_FLAGS})
  endif()
  if(ISOLUX_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${ISOLUX_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
      $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # GCC 12: false positives in the standard library's own headers
    # AddressSanitizer loads libraries in the program's place, and a RUNPATH serves its owner alone; an RPATH serves all.
    target_link_options(${target} PRIVATE -fsanitize=${ISOLUX_SANITIZE} LINKER:--disable-new-dtags)
  endif()
endfunction()

# Of these nothing is left to link: where .cpp files alone use them, who links our libraries does not need them.
set(ISOLUX_HEADER_PACKAGES CGAL nlohmann_json)

# Links packages; missing ones end the configuration with the Debian package's name left to the README.
function(isolux_link target visibility)
  foreach(package IN LISTS ARGN)
    isolux_find_package(${package} found)
    if(NOT found)
      message(FATAL_ERROR "${target} needs the package ${package}${found_why}; see tools/packages.txt")
    endif()
    if(visibility STREQUAL "PRIVATE" AND package IN_LIST ISOLUX_HEADER_PACKAGES)
      set(found $<BUILD_INTERFACE:${found}>)
    endif()
    target_link_libraries(${target} ${visibility} ${found})
  endforeach()
endfunction()

# Module names have hyphens as their folders do; targets and C++ names have underscores.
function(isolux_need_module name)
  string(REPLACE "-" "_" id ${name})
  if(NOT TARGET isolux_${id})
    add_subdirectory(${ISOLUX_ROOT}/modules/${name} ${ISOLUX_BUILD_ROOT}/modules/${name})
  endif()
endfunction()

# "key:Package", apart.
macro(_isolux_pair pair out_key out_package)
  string(REGEX REPLACE ":.*" "" ${out_key} ${pair})
  string(REGEX REPLACE ".*:" "" ${out_package} ${pair})
endmacro()

# Writes the function that fills a registry: one call per file of src/backends.
function(_isolux_catalogue name id stage catalogue default optional out_sources out_found)
  file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/backends/*.cpp)
  list(SORT files)
  set(declarations "")
  set(calls "")
  set(sources "")
  set(found_pairs "")
  foreach(file IN LISTS files)
    get_filename_component(key ${file} NAME_WE)
    set(missing "")
    foreach(pair IN LISTS optional)
      _isolux_pair(${pair} pair_key package)
      if(pair_key STREQUAL key)
        if(package IN_LIST ISOLUX_WITHOUT)
          set(missing "switched off: ${package} is in ISOLUX_WITHOUT")
        else()
          isolux_find_package(${package} found)
          if(found)
            list(APPEND found_pairs ${pair})
          else()
            set(missing "package ${package} was not found when isolux was built")
          endif()
        endif()
      endif()
    endforeach()
    if(missing)
      string(APPEND calls "  registry.add_unavailable(\"${key}\", \"${missing}\");\n")
    else()
      list(APPEND sources ${file})
      string(APPEND declarations "void ${key}(Registry<${stage}>& registry);\n")
      string(APPEND calls "  backends::${key}(registry);\n")
    endif()
  endforeach()
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/catalogue.cpp)
  file(CONFIGURE OUTPUT ${generated} @ONLY CONTENT
"// Generated by isolux_module() from the files of src/backends.
#include <isolux/@id@.h>

namespace isolux {
namespace backends {
@declarations@}  // namespace backends

Registry<@stage@> @catalogue@() {
  Registry<@stage@> registry;
@calls@  registry.set_default(\"@default@\");
  return registry;
}

}  // namespace isolux
")
  set(${out_sources} ${sources} ${generated} PARENT_SCOPE)
  set(${out_found} ${found_pairs} PARENT_SCOPE)
endfunction()

# Highway compiles a file once for each instruction set by including it again, clang 14 refuses to parse ITK 5.2, and a warning is silenced
# before any header: such files stay translation units of their own.
macro(_isolux_keep_special_sources_alone)
  file(GLOB_RECURSE all_sources CONFIGURE_DEPENDS src/*.cpp tests/*.cpp)
  foreach(source IN LISTS all_sources)
    file(STRINGS ${source} is_special REGEX "hwy/foreach_target|include <itk|pragma GCC diagnostic ignored" LIMIT_COUNT 1)
    if(is_special)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
endmacro()

function(isolux_module name)
  cmake_parse_arguments(M "" "STAGE;CATALOGUE;DEFAULT"
    "DEPENDS;PUBLIC_PACKAGES;PACKAGES;BACKEND_PACKAGES;LOADED;TEST_PACKAGES;BENCH_PACKAGES" ${ARGN})
  if(M_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "isolux_module(${name}): unknown arguments ${M_UNPARSED_ARGUMENTS}")
  endif()
  string(REPLACE "-" "_" id ${name})
  foreach(module IN LISTS M_DEPENDS)
    isolux_need_module(${module})
  endforeach()

  file(GLOB sources CONFIGURE_DEPENDS src/*.cpp)
  _isolux_keep_special_sources_alone()
  set(backends "")
  if(M_STAGE)
    _isolux_catalogue(${name} ${id} ${M_STAGE} ${M_CATALOGUE} "${M_DEFAULT}" "${M_BACKEND_PACKAGES}" backend_sources backends)
    list(APPEND sources ${backend_sources})
  endif()
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS include/*.h)
  set(lib isolux_${id})
  add_library(${lib} STATIC ${sources})
  add_library(isolux::${id} ALIAS ${lib})
  # Hidden: a shared library of somebody's that links this one exports none of it.
  set_target_properties(${lib} PROPERTIES EXPORT_NAME ${id} CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_sources(${lib} PUBLIC FILE_SET HEADERS BASE_DIRS include FILES ${headers})
  target_include_directories(${lib} PRIVATE src)
  target_compile_features(${lib} PUBLIC cxx_std_20)
  isolux_flags(${lib})
  isolux_link(${lib} PUBLIC ${M_PUBLIC_PACKAGES})
  set(backend_packages "")
  foreach(pair IN LISTS backends)
    _isolux_pair(${pair} key package)
    if(key IN_LIST M_LOADED)
      _isolux_loaded_library(${name} ${id} ${key} ${package})
    else()
      list(APPEND backend_packages ${package})
    endif()
  endforeach()
  isolux_link(${lib} PRIVATE ${M_PACKAGES} ${backend_packages})
  foreach(module IN LISTS M_DEPENDS)
    string(REPLACE "-" "_" dep ${module})
    target_link_libraries(${lib} PUBLIC isolux::${dep})
  endforeach()

  # A module's tests, benches and examples are built where it is configured alone, and all modules' in the workspace.
  if(PROJECT_IS_TOP_LEVEL OR ISOLUX_WORKSPACE)
    _isolux_programs(${name} ${id} "${M_TEST_PACKAGES}" "${M_BENCH_PACKAGES}")
  endif()
  if(ISOLUX_INSTALL)
    set(needs ${M_PACKAGES} ${backend_packages})
    list(REMOVE_ITEM needs ${ISOLUX_HEADER_PACKAGES})
    _isolux_install(${name} ${id} "${M_DEPENDS}" "${M_PUBLIC_PACKAGES};${needs}")
  endif()
endfunction()

# Each module is a component of the package: its targets file, and a list of what must be found before it is read.
function(_isolux_install name id depends packages)
  set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/isolux)
  install(TARGETS isolux_${id} EXPORT isolux-${id} ARCHIVE COMPONENT ${name} FILE_SET HEADERS COMPONENT ${name})
  install(EXPORT isolux-${id} NAMESPACE isolux:: FILE isolux-${id}-targets.cmake DESTINATION ${package_dir} COMPONENT ${name})
  string(REPLACE "-" "_" depends "${depends}")
  list(REMOVE_ITEM packages "")
  set(needs ${CMAKE_CURRENT_BINARY_DIR}/isolux-${id}-needs.cmake)
  file(CONFIGURE OUTPUT ${needs} @ONLY CONTENT "set(isolux_needs_modules \"@depends@\")\nset(isolux_needs_packages \"@packages@\")\n")
  set(config ${CMAKE_CURRENT_BINARY_DIR}/isolux-config.cmake)
  configure_file(${ISOLUX_ROOT}/tools/cmake/isolux-config.cmake.in ${config} @ONLY)
  include(CMakePackageConfigHelpers)
  write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/isolux-config-version.cmake
    VERSION ${ISOLUX_VERSION} COMPATIBILITY SameMinorVersion)
  install(FILES ${needs} ${config} ${CMAKE_CURRENT_BINARY_DIR}/isolux-config-version.cmake
    ${ISOLUX_ROOT}/tools/cmake/IsoluxPackages.cmake DESTINATION ${package_dir} COMPONENT ${name})
endfunction()
