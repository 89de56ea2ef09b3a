# One target per layer: what a layer may use is what it links. See docs/developer/architecture.md.

# Flags of all our own code, and of nothing else. What uses the installed libraries gets the first part only.
add_library(clog_flags INTERFACE)
target_compile_features(clog_flags INTERFACE cxx_std_20)
target_include_directories(clog_flags INTERFACE
  "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>" "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
# Eigen would add up products of matrices in an order that fits the processor's caches. And it would align arrays by the
# instructions that a file is compiled for, of which your own program may have others than these libraries.
target_compile_definitions(clog_flags INTERFACE EIGEN_NO_CPUID EIGEN_MAX_ALIGN_BYTES=16)
# The namespace has the name of a C library function (complex logarithm) that g++ treats as built in.
target_compile_options(clog_flags INTERFACE -fno-builtin-clog)
set(own_flags
  -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion
  # What is installed knows nothing of where it was built.
  "-ffile-prefix-map=${PROJECT_SOURCE_DIR}/="
  # Loops marked `omp simd` are vectorised (no OpenMP runtime). errno and floating-point traps are never read,
  # and would forbid vector square roots. Nothing here reorders sums beyond the marked reductions.
  -fopenmp-simd -fno-math-errno -fno-trapping-math)
if(NOT CMAKE_UNITY_BUILD)  # which would report that names of one source hide those of another
  list(APPEND own_flags -Wshadow)
endif()
if(CLOG_SANITIZE)
  list(APPEND own_flags -fsanitize=${CLOG_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(clog_flags INTERFACE "$<BUILD_INTERFACE:-fsanitize=${CLOG_SANITIZE}>")
endif()
if(CLOG_FUZZ)
  list(APPEND own_flags -fsanitize=fuzzer-no-link)  # main is libFuzzer's in its targets only
endif()
target_compile_options(clog_flags INTERFACE "$<BUILD_INTERFACE:${own_flags}>")

# clog_layer(<name> SOURCES <files...> USES <public dependencies...> USES_PRIVATE <private dependencies...>)
function(clog_layer name)
  cmake_parse_arguments(LAYER "" "" "SOURCES;USES;USES_PRIVATE" ${ARGN})
  add_library(clog_${name} STATIC ${LAYER_SOURCES})
  # Text is put together by fmt, everywhere, but in no header: docs/developer/architecture.md.
  target_link_libraries(clog_${name} PUBLIC clog_flags ${LAYER_USES} PRIVATE fmt::fmt ${LAYER_USES_PRIVATE})
endfunction()

# clog_program(<name> <files...> USES <libraries...>): <name>.cpp has the main.
function(clog_program name)
  cmake_parse_arguments(PROGRAM "" "" "USES" ${ARGN})
  list(TRANSFORM PROGRAM_UNPARSED_ARGUMENTS PREPEND "programs/")
  add_executable(${name} programs/${name}.cpp ${PROGRAM_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE fmt::fmt ${PROGRAM_USES})
endfunction()
