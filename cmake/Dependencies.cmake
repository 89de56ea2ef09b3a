# Reads dependencies.txt. For each name there: CLOG_<name>_MINIMUM and CLOG_<name>_DEBIAN, a list of packages.
file(STRINGS "${CMAKE_CURRENT_LIST_DIR}/dependencies.txt" lines REGEX "^[A-Za-z]")
foreach(line ${lines})
  string(REGEX REPLACE " +" ";" words "${line}")
  list(POP_FRONT words name minimum)
  set(CLOG_${name}_MINIMUM "${minimum}")
  list(REMOVE_ITEM words "-")
  set(CLOG_${name}_DEBIAN "${words}")
endforeach()
