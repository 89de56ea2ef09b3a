# Sourced by the scripts that call mpirun: Open MPI settings that let them run anywhere.
# shellcheck shell=bash
# Containers run as root, which Open MPI refuses unless told twice that it is meant.
export OMPI_ALLOW_RUN_AS_ROOT=1
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# More ranks than cores: the ranks of a laptop or a one-core machine share what there is.
export OMPI_MCA_rmaps_base_oversubscribe=1
# Ranks are not tied to cores: on a shared machine they would be tied to busy ones.
export OMPI_MCA_hwloc_base_binding_policy=none
# Containers forbid the kernel call that copies between processes; messages here are small anyway.
export OMPI_MCA_btl_vader_single_copy_mechanism=none
