# cpack: Debian packages of what is installed. What they depend on is looked up in the programs themselves.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "the clogsweep developers")
set(CPACK_PACKAGE_CONTACT "the clogsweep developers <clogsweep@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL programs libraries)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME clogsweep)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS "openmpi-bin, python3, python3-h5py, python3-pandas, python3-tables, python3-matplotlib")
# Drawings and pictures of devices.
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS
  "python3-ezdxf, python3-gdspy, python3-svgelements, python3-skimage, python3-shapely")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "ffmpeg, slurm-client")
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION "Follows droplets that sink through a forest of obstacles until they clog, one by
one on as many cores as there are, and fits clogging lengths and speeds.")
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_NAME libclogsweep-dev)
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_DEPENDS
  "libeigen3-dev, libboost-dev, nlohmann-json3-dev, libhwy-dev, libfmt-dev, libnlopt-cxx-dev, libhdf5-dev, zlib1g-dev")
set(CPACK_COMPONENT_LIBRARIES_DESCRIPTION "Static libraries and headers for your own programs: find_package(clogsweep).")
include(CPack)
