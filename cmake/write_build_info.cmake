# Writes OUTPUT from TEMPLATE, with what git says of the sources in SOURCE_DIR: v0.2.0 at the tag of a release,
# v0.2.0-5-g0123456789ab five commits behind it, 0123456789ab where no tag is known; -dirty where files were changed.
# An archive that git made has no repository, but archive_version.txt, which git has filled in.
set(GIT_DESCRIBE "unknown")
set(GIT_HASH "unknown")

# The archive may lie within another repository, so only one that begins here is asked.
if(EXISTS "${SOURCE_DIR}/.git")
  macro(ask variable)
    execute_process(COMMAND git -C "${SOURCE_DIR}" describe --always --dirty --abbrev=12 ${ARGN}
      OUTPUT_VARIABLE answer OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    if(NOT failed AND answer)
      set(${variable} "${answer}")
    endif()
  endmacro()
  ask(GIT_DESCRIBE --tags)
  ask(GIT_HASH --exclude "*")
else()
  file(READ "${SOURCE_DIR}/cmake/archive_version.txt" archive)
  if(archive MATCHES "hash: ([0-9a-f]+)")
    string(SUBSTRING "${CMAKE_MATCH_1}" 0 12 GIT_HASH)
    set(GIT_DESCRIBE "${GIT_HASH}")
  endif()
  # Nothing stands there if there is no tag, and the format itself if git is older than 2.36.
  if(archive MATCHES "describe: ([^$%\n]+)\n")
    set(GIT_DESCRIBE "${CMAKE_MATCH_1}")
  endif()
endif()
configure_file("${TEMPLATE}" "${OUTPUT}" @ONLY)
