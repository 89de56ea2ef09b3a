execute_process(COMMAND git -C "${SOURCE_DIR}" describe --always --dirty --abbrev=12 --match no-tag
  OUTPUT_VARIABLE GIT_HASH OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR GIT_HASH STREQUAL "")
  set(GIT_HASH "unknown")
endif()
configure_file("${TEMPLATE}" "${OUTPUT}" @ONLY)
