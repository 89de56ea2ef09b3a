# cmake --install: programs, scripts, completion, and the libraries for find_package(clogsweep). Nothing of it knows
# where the source tree was.
include(CMakePackageConfigHelpers)

# Programs

install(TARGETS clogsweep clogrun clogfit RUNTIME COMPONENT programs)

# The Python module and jobs with their configs, which find each other from where they are. The build tree has links.

foreach(folder CMAKE_INSTALL_BINDIR CMAKE_INSTALL_DATADIR CLOG_PYTHON_DIR)
  if(IS_ABSOLUTE "${${folder}}")
    message(FATAL_ERROR "what is installed finds its parts from where it is: ${folder} has to be relative, here ${${folder}}")
  endif()
endforeach()
if(NOT CMAKE_INSTALL_BINDIR MATCHES "^[^/]+$")
  message(FATAL_ERROR "the build tree is laid out alike, with bin beside it: CMAKE_INSTALL_BINDIR has to be one folder, here ${CMAKE_INSTALL_BINDIR}")
endif()
set(shared "${CMAKE_INSTALL_DATADIR}/clogsweep")
file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/${shared}" "${PROJECT_BINARY_DIR}/${CLOG_PYTHON_DIR}")
file(CREATE_LINK "${PROJECT_SOURCE_DIR}/jobs" "${PROJECT_BINARY_DIR}/${shared}/jobs" SYMBOLIC)
file(CREATE_LINK "${PROJECT_SOURCE_DIR}/analysis/clogsweep" "${PROJECT_BINARY_DIR}/${CLOG_PYTHON_DIR}/clogsweep" SYMBOLIC)
install(DIRECTORY jobs DESTINATION "${shared}" USE_SOURCE_PERMISSIONS COMPONENT programs
  FILES_MATCHING PATTERN "*.cfg" PATTERN "figures/*.csv" PATTERN "*.sh" PATTERN "install-*.sh" EXCLUDE PATTERN "dependency-archive.sh" EXCLUDE PATTERN "laptop.sh" EXCLUDE)
install(DIRECTORY analysis/clogsweep DESTINATION "${CLOG_PYTHON_DIR}" COMPONENT programs
  FILES_MATCHING PATTERN "*.py" PATTERN "py.typed" PATTERN "page.*" PATTERN "__pycache__" EXCLUDE)
set(module "${CMAKE_INSTALL_PREFIX}/${CLOG_PYTHON_DIR}/clogsweep")
file(RELATIVE_PATH PROGRAMS_FOLDER "${module}" "${CMAKE_INSTALL_FULL_BINDIR}")
file(RELATIVE_PATH JOBS_FOLDER "${module}" "${CMAKE_INSTALL_PREFIX}/${shared}/jobs")
configure_file(cmake/_installed.py.in "${PROJECT_BINARY_DIR}/_installed.py" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/_installed.py" DESTINATION "${CLOG_PYTHON_DIR}/clogsweep" COMPONENT programs)
install(FILES README.md CHANGELOG.md CITATION.cff LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT programs)
# Messages name pages of the handbook.
install(DIRECTORY docs DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT programs
  FILES_MATCHING PATTERN "*.md" PATTERN "*.csv" PATTERN "*.png" PATTERN "*.ipynb" PATTERN "CMakeLists.txt" PATTERN "*.cpp" PATTERN "first-curve/sweep.h5" PATTERN "paper" EXCLUDE)

# What a shell completes, from what the programs say of themselves

set(has_python OFF)
if(CLOG_PYTHON)
  set(has_python ON)
endif()
option(CLOG_COMPLETION "Install completion for bash and zsh; needs python3" ${has_python})
if(CLOG_COMPLETION)
  set(completion "${PROJECT_BINARY_DIR}/completion")
  add_custom_command(OUTPUT "${completion}/clogsweep" "${completion}/_clogsweep"
    # Open MPI leaves memory allocated at exit, which is nothing that a build with sanitizers has to say.
    COMMAND "${CMAKE_COMMAND}" -E env ASAN_OPTIONS=detect_leaks=0
      "${CLOG_PYTHON}" "${PROJECT_SOURCE_DIR}/cmake/completion.py" "$<TARGET_FILE_DIR:clogsweep>" "${completion}"
    DEPENDS clogsweep clogrun clogfit "${PROJECT_SOURCE_DIR}/cmake/completion.py"
      "${PROJECT_SOURCE_DIR}/cmake/completion.bash.in" "${PROJECT_SOURCE_DIR}/cmake/completion.zsh.in"
      "${PROJECT_SOURCE_DIR}/analysis/clogsweep/commands/report.py"
    VERBATIM)
  add_custom_target(completion ALL DEPENDS "${completion}/clogsweep" "${completion}/_clogsweep")
  # bash loads the file that is called as the command is; mpirun's own is none.
  foreach(program clogsweep clogrun clogfit mpirun mpiexec)
    install(FILES "${completion}/clogsweep" RENAME ${program}
      DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" COMPONENT programs)
  endforeach()
  # Where zsh looks below /usr in Debian, and below any other prefix.
  foreach(folder vendor-completions site-functions)
    install(FILES "${completion}/_clogsweep" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/${folder}" COMPONENT programs)
  endforeach()
endif()

# The handbook, as man pages and as a site: for packages, since no program needs it

option(CLOG_HANDBOOK "Build and install the handbook, as man pages and as a site (jobs/install-dependencies.sh docs)" OFF)
if(CLOG_HANDBOOK)
  find_program(CLOG_SPHINX NAMES sphinx-build PATHS /usr/bin NO_DEFAULT_PATH DOC "Debian's Sphinx, which has MyST" REQUIRED)
  find_program(CLOG_PANDOC pandoc DOC "for the notebook of the site" REQUIRED)
  execute_process(COMMAND "${CLOG_PYTHON}" -c "import myst_parser, sphinx_copybutton, nbsphinx, furo" RESULT_VARIABLE lacks_extensions ERROR_QUIET)
  if(lacks_extensions)
    message(FATAL_ERROR "the handbook needs extensions of Sphinx that ${CLOG_PYTHON} lacks: ./jobs/install-dependencies.sh docs installs them; or configure with -DCLOG_HANDBOOK=OFF")
  endif()
  file(GLOB_RECURSE handbook CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/*.md" "${PROJECT_SOURCE_DIR}/docs/*.png"
    "${PROJECT_SOURCE_DIR}/docs/*.ipynb" "${PROJECT_SOURCE_DIR}/docs/_static/*")
  list(APPEND handbook "${PROJECT_SOURCE_DIR}/docs/conf.py" "${PROJECT_SOURCE_DIR}/docs/mended_theme.py")

  set(manual "${PROJECT_BINARY_DIR}/man")
  set(pages clogsweep.1 clogrun.1 clogfit.1 clogsweep-keys.5 clogsweep-files.5 clogsweep-exit-codes.7 clogsweep-python.7)
  list(TRANSFORM pages PREPEND "${manual}/")
  # Warnings are reported by docs/build.sh.
  add_custom_command(OUTPUT ${pages}
    COMMAND "${CLOG_SPHINX}" -Q -b man -d "${PROJECT_BINARY_DIR}/man-doctrees" "${PROJECT_SOURCE_DIR}/docs" "${manual}"
    DEPENDS ${handbook}
    VERBATIM)
  set(site "${PROJECT_BINARY_DIR}/html")
  add_custom_command(OUTPUT "${site}/index.html"
    COMMAND "${CLOG_SPHINX}" -Q -t site -b html -d "${PROJECT_BINARY_DIR}/html-doctrees" "${PROJECT_SOURCE_DIR}/docs" "${site}"
    DEPENDS ${handbook}
    VERBATIM)
  add_custom_target(handbook ALL DEPENDS ${pages} "${site}/index.html")
  foreach(page ${pages})
    string(REGEX MATCH ".$" section "${page}")
    install(FILES "${page}" DESTINATION "${CMAKE_INSTALL_MANDIR}/man${section}" COMPONENT programs)
  endforeach()
  install(DIRECTORY "${site}" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT programs PATTERN ".buildinfo" EXCLUDE PATTERN "_sources" EXCLUDE)
endif()

# Libraries: what a program needs that runs droplets, plans sweeps, reads their files, fits them

set(libraries core sweep fit store)
foreach(library ${libraries})
  set_target_properties(clog_${library} PROPERTIES EXPORT_NAME ${library})
endforeach()
set_target_properties(clog_flags PROPERTIES EXPORT_NAME flags)
list(TRANSFORM libraries PREPEND clog_ OUTPUT_VARIABLE targets)
set(package "${CMAKE_INSTALL_LIBDIR}/cmake/clogsweep")
install(TARGETS ${targets} clog_flags EXPORT clogsweep ARCHIVE COMPONENT libraries)
install(EXPORT clogsweep NAMESPACE clogsweep:: FILE clogsweepTargets.cmake DESTINATION "${package}" COMPONENT libraries)
foreach(library ${libraries})
  install(DIRECTORY "include/clog/${library}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/clog" COMPONENT libraries)
endforeach()
configure_package_config_file(cmake/clogsweepConfig.cmake.in "${PROJECT_BINARY_DIR}/clogsweepConfig.cmake"
  INSTALL_DESTINATION "${package}" NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Minor versions may change the headers.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/clogsweepConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/clogsweepConfig.cmake" "${PROJECT_BINARY_DIR}/clogsweepConfigVersion.cmake"
  DESTINATION "${package}" COMPONENT libraries)
