# build_info.cpp: version, what git says of the sources, compiler. Git is asked at every build, and the file is only
# rewritten, and so recompiled, when something changed.
set(CLOG_BUILD_INFO "${PROJECT_BINARY_DIR}/generated/build_info.cpp")
add_custom_target(clog_build_info_file
  COMMAND "${CMAKE_COMMAND}"
    -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DOUTPUT=${CLOG_BUILD_INFO}
    -DTEMPLATE=${PROJECT_SOURCE_DIR}/cmake/build_info.cpp.in
    -DVERSION=${PROJECT_VERSION} -DCOMPILER=${CMAKE_CXX_COMPILER_ID}\ ${CMAKE_CXX_COMPILER_VERSION}
    -DBUILD_TYPE=${CMAKE_BUILD_TYPE}
    -P "${PROJECT_SOURCE_DIR}/cmake/write_build_info.cmake"
  BYPRODUCTS "${CLOG_BUILD_INFO}"
  VERBATIM)
