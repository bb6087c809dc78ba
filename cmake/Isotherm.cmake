# The two helpers every folder uses. One target per folder: isotherm_<name> with the alias isotherm::<name>.

# With ccache, a second clone or build tree compiles from the first one's cache: paths count relative to the root. It remembers
# what a file's content was by the file's inode: reading 170 MB of precompiled headers for each source took 0.9 of 0.93 s.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(ccache_launcher env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 CCACHE_INODECACHE=1
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime)
  # Others than ninja run compilers elsewhere.
  if(CMAKE_GENERATOR STREQUAL "Ninja")
    file(REAL_PATH ${PROJECT_BINARY_DIR} real_build_folder)
    file(REAL_PATH ${PROJECT_SOURCE_DIR} real_root)
    file(RELATIVE_PATH path_to_root ${real_build_folder} ${real_root})
    cmake_path(SET path_to_root NORMALIZE "./${path_to_root}.")
    list(APPEND ccache_launcher ${PROJECT_SOURCE_DIR}/cmake/compile_cached.sh ${PROJECT_SOURCE_DIR} ${path_to_root})
  endif()
  list(APPEND ccache_launcher ${CCACHE_PROGRAM})
  set(CMAKE_C_COMPILER_LAUNCHER ${ccache_launcher})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${ccache_launcher})
endif()

# Warnings for our own code only; generated and third-party headers come in as SYSTEM. GCC 12 takes
# `"text" + std::string` for overlapping copies (its bug 105651), hence -Wno-restrict; and a moved std::string for a copy
# out of bounds when headers are precompiled, hence the three after it.
add_library(isotherm_warnings INTERFACE)
target_compile_options(isotherm_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-stringop-overread;-Wno-stringop-overflow>)

# On arm64 Highway compiles for NEON only and picks nothing at run time, as it does where a C library cannot tell
# processors apart: GCC 12 takes no SVE vectors as members of structures, and where functions are compiled for more than
# the baseline it refuses implicit constructors of structures of vectors.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  target_compile_definitions(isotherm_warnings INTERFACE TOOLCHAIN_MISS_SYS_AUXV_H)
endif()

# Headers of others that half of the sources include, compiled once for libraries and once for tests: parsing them is
# most of the work of a clean build. Sources still include what they use (the preset clang builds without this).
option(ISOTHERM_PRECOMPILE "Precompile the headers of others" ON)
if(ISOTHERM_PRECOMPILE AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # Else ccache never finds it again; and it preprocesses the headers for sources that do not use Eigen, too.
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>")
  link_libraries(Eigen3::Eigen)
endif()

# Kernels are compiled for each instruction set, and under sanitizers take longest of all to compile. The release build tests
# all of them; sanitizers watch the newest ones and the portable one.
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize" AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  add_compile_definitions("HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4)")
endif()

# Tests spend their time in the libraries, which are optimised.
set(isotherm_test_options $<$<COMPILE_LANGUAGE:CXX>:-O1>)
# The preset asan leaves out the undefined-behaviour sanitizer's checks of null and of an object's size: the address sanitizer
# finds both, and they take a fifth of the time to compile. Tests themselves do without that of alignment too.
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=address,undefined")
  list(APPEND isotherm_test_options -fno-sanitize=vptr,null,alignment)
endif()

# isotherm_precompile(<target> <headers>): the target whose headers others reuse.
function(isotherm_precompile target)
  file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/${target}.cc CONTENT "// Only its headers count.\n")
  add_library(${target} OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/${target}.cc)
  target_link_libraries(${target} PRIVATE isotherm_warnings fmt::fmt Eigen3::Eigen)
  target_precompile_headers(${target} PRIVATE <algorithm> <array> <atomic> <cmath> <cstdint> <filesystem> <fstream>
    <functional> <limits> <map> <memory> <numbers> <optional> <span> <string> <string_view> <thread> <utility> <vector>
    <Eigen/Core> <Eigen/Geometry> <fmt/format.h> ${ARGN})
endfunction()

# The sources of a library or a test compiled several at once: a build from nothing takes less time, one after a change more.
# What is local to a source must then have a name that the target's other sources do not use: ALONE for a source that uses
# one all the same, NO_UNITY where all are of one kind and do so on purpose.
option(ISOTHERM_UNITY "Compile several sources at once (continuous integration does)" OFF)

# isotherm_unity(<target> <number>): so many at once. CMake's own UNITY_BUILD names sources by absolute paths, so that no
# other clone's cache would have them.
function(isotherm_unity target number)
  if(ISOTHERM_UNITY)  # At the end of the folder, when all is said of its sources.
    cmake_language(EVAL CODE "cmake_language(DEFER CALL isotherm_unite [[${target}]] [[${number}]])")
  endif()
endfunction()

# isotherm_unite(<target> <number>): replaces the sources of a target by files that include so many of them each. Those with
# properties of their own stay alone, and so do kernels, which include themselves once for each instruction set.
function(isotherm_unite target number)
  get_target_property(sources ${target} SOURCES)
  set(alone)
  set(together)
  foreach(source IN LISTS sources)
    set(keep NOT_UNITED)
    if(source MATCHES "\\.cc$" AND EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${source})
      file(STRINGS ${source} includes_itself REGEX "define HWY_TARGET_INCLUDE" LIMIT_COUNT 1)
      get_source_file_property(skipped ${source} SKIP_UNITY_BUILD_INCLUSION)
      get_source_file_property(options ${source} COMPILE_OPTIONS)
      get_source_file_property(definitions ${source} COMPILE_DEFINITIONS)
      if(NOT (includes_itself OR skipped OR options OR definitions))
        set(keep)
      endif()
    endif()
    if(keep)
      list(APPEND alone ${source})
    else()
      file(RELATIVE_PATH source ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${source})
      list(APPEND together ${source})
    endif()
  endforeach()
  set(index 0)
  while(together)
    list(SUBLIST together 0 ${number} batch)
    list(REMOVE_ITEM together ${batch})
    list(TRANSFORM batch REPLACE "(.+)" "#include \"\\1\"\n")
    list(JOIN batch "" content)
    file(CONFIGURE OUTPUT ${target}_unity_${index}.cc CONTENT "${content}" @ONLY)
    list(APPEND alone ${CMAKE_CURRENT_BINARY_DIR}/${target}_unity_${index}.cc)
    math(EXPR index "${index} + 1")
  endwhile()
  set_property(TARGET ${target} PROPERTY SOURCES ${alone})
endfunction()

# isotherm_library(NAME <name> [NO_UNITY] SRCS <files> [DEPS <public targets>] [PRIVATE_DEPS <targets>])
function(isotherm_library)
  cmake_parse_arguments(ARG "NO_UNITY" "NAME" "SRCS;DEPS;PRIVATE_DEPS" ${ARGN})
  set(target isotherm_${ARG_NAME})
  add_library(${target} STATIC ${ARG_SRCS})
  add_library(isotherm::${ARG_NAME} ALIAS ${target})
  if(ISOTHERM_KERNEL_OPTIONS)  # Of presets whose instrumented kernels take minutes to optimise.
    set(kernels ${ARG_SRCS})
    list(FILTER kernels INCLUDE REGEX "kernel\\.cc$")
    set_property(SOURCE ${kernels} APPEND PROPERTY COMPILE_OPTIONS ${ISOTHERM_KERNEL_OPTIONS})
  endif()
  if(NOT ARG_NO_UNITY)
    isotherm_unity(${target} 6)
  endif()
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PUBLIC ${ARG_DEPS} PRIVATE isotherm_warnings ${ARG_PRIVATE_DEPS})
  if(ISOTHERM_PRECOMPILE)
    if(NOT TARGET isotherm_headers)
      isotherm_precompile(isotherm_headers)
    endif()
    target_link_libraries(${target} PRIVATE fmt::fmt)
    target_precompile_headers(${target} REUSE_FROM isotherm_headers)
  endif()
endfunction()

# A program loads the shared libraries that it uses, not those that a static library on its way names.
add_link_options(-Wl,--as-needed)
# Links three times as fast as the default linker, which does it where this one is not installed.
include(CheckLinkerFlag)
check_linker_flag(CXX -fuse-ld=lld ISOTHERM_HAS_LLD)
if(ISOTHERM_HAS_LLD AND NOT CMAKE_CROSSCOMPILING)
  add_link_options(-fuse-ld=lld)
endif()

# Tests of what has several threads: the thread sanitizer watches these (tests/lint says which are missing).
set(isotherm_threaded_tests backfill_test base_test block_spiller_test camera_process_test clock_link_test concurrency_test
  edge_monitor_test edge_pipeline_test edge_source_test endpoints_test flow_window_test frame_counters_test ground_pipeline_test hostile_test
  link_emulator_test link_test live_scan_test nuc_control_test openni_test process_test reconstruction_loop_test recording_loop_test
  result_writer_test rig_clock_test rig_commander_test rig_gate_test service_test spool_test thermal_test trust_test
  tsdf_test two_grounds_test wire_version_test)

# isotherm_test(NAME <name> [NO_UNITY] SRCS <files> [ALONE <some of them>] [DEPS <targets>] [LABELS <labels>] [TIMEOUT <seconds>]
#   [SHARDS <number>])
# SHARDS: the program's cases are run by so many of ctest's tests, which may run at the same time: NAME, NAME_2, ...
# Labels: unit (default), integration, system, hardware, lint; experiment (figures of the thesis) and scan (figures of whole
# scans), which sanitizers need not assess; threads is added to what isotherm_threaded_tests names.
function(isotherm_test)
  cmake_parse_arguments(ARG "NO_UNITY" "NAME;TIMEOUT;SHARDS" "SRCS;ALONE;DEPS;LABELS" ${ARGN})
  if(NOT BUILD_TESTING)
    return()
  endif()
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  if(ARG_NAME IN_LIST isotherm_threaded_tests)
    list(APPEND ARG_LABELS threads)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(CMAKE_CROSSCOMPILING)  # An emulator runs the test.
    math(EXPR ARG_TIMEOUT "10 * ${ARG_TIMEOUT}")
  endif()
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    math(EXPR ARG_TIMEOUT "5 * ${ARG_TIMEOUT}")
  endif()
  add_executable(${ARG_NAME} ${ARG_SRCS})
  if(NOT ARG_NO_UNITY)
    isotherm_unity(${ARG_NAME} 4)
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  target_link_libraries(${ARG_NAME} PRIVATE ${ARG_DEPS} isotherm_warnings GTest::gmock GTest::gtest_main)
  target_include_directories(${ARG_NAME} PRIVATE ${PROJECT_SOURCE_DIR})
  # Only for sources that use it: the others compile from another clone's cache.
  foreach(source IN LISTS ARG_SRCS)
    file(STRINGS ${source} uses_source_dir REGEX "ISOTHERM_SOURCE_DIR|dataset_folder.h|bad_input.h|two_hosts.h" LIMIT_COUNT 1)
    if(uses_source_dir)
      target_compile_definitions(${ARG_NAME} PRIVATE ISOTHERM_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
      break()
    endif()
  endforeach()
  target_compile_options(${ARG_NAME} PRIVATE ${isotherm_test_options})
  if(ISOTHERM_PRECOMPILE)
    if(NOT TARGET isotherm_test_headers)
      isotherm_precompile(isotherm_test_headers <gmock/gmock.h> <gtest/gtest.h>)
      target_link_libraries(isotherm_test_headers PRIVATE GTest::gmock)
      target_compile_options(isotherm_test_headers PRIVATE ${isotherm_test_options})
    endif()
    target_link_libraries(${ARG_NAME} PRIVATE fmt::fmt)
    target_precompile_headers(${ARG_NAME} REUSE_FROM isotherm_test_headers)
  endif()
  if(NOT ARG_SHARDS)
    set(ARG_SHARDS 1)
  endif()
  foreach(shard RANGE 1 ${ARG_SHARDS})
    set(test ${ARG_NAME})
    if(shard GREATER 1)
      string(APPEND test _${shard})
    endif()
    math(EXPR index "${shard} - 1")
    add_test(NAME ${test} COMMAND ${ARG_NAME})
    set_tests_properties(${test} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT})
    if(ARG_SHARDS GREATER 1)
      set_tests_properties(${test} PROPERTIES
        ENVIRONMENT "GTEST_TOTAL_SHARDS=${ARG_SHARDS};GTEST_SHARD_INDEX=${index}")
    endif()
    # Whole scans keep both cores busy: what mostly waits beside them must not starve.
    if(ARG_LABELS MATCHES "scan")
      set_tests_properties(${test} PROPERTIES PROCESSORS 2)
    endif()
    # The longest begin first, so that none is left alone at the end.
    if(ARG_LABELS MATCHES "integration|scan" OR ARG_TIMEOUT GREATER_EQUAL 300)
      set_tests_properties(${test} PROPERTIES COST ${ARG_TIMEOUT})
    endif()
  endforeach()
  foreach(label IN LISTS ARG_LABELS)  # What deploy/test.sh builds for a label.
    if(NOT TARGET tests_${label})
      add_custom_target(tests_${label})
    endif()
    add_dependencies(tests_${label} ${ARG_NAME})
  endforeach()
endfunction()
