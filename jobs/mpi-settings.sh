# Sourced by the scripts that call mpirun: settings of Open MPI that let them run anywhere. A variable that is already
# set keeps its value. Since Open MPI 5 its launcher, PRRTE, has its own variables, PRTE_MCA_*; every version ignores
# the variables of other versions, and MPICH needs none.
# shellcheck shell=bash
# Containers run as root, which Open MPI refuses unless two variables allow it.
export OMPI_ALLOW_RUN_AS_ROOT="${OMPI_ALLOW_RUN_AS_ROOT:-1}"
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="${OMPI_ALLOW_RUN_AS_ROOT_CONFIRM:-1}"
# Ranks are not bound to cores, because on a shared machine they might be bound to busy cores.
export OMPI_MCA_hwloc_base_binding_policy="${OMPI_MCA_hwloc_base_binding_policy:-none}"
export PRTE_MCA_hwloc_default_binding_policy="${PRTE_MCA_hwloc_default_binding_policy:-none}"
# More ranks than cores are allowed, so that ranks can share the cores of a laptop or the only core of a machine. If
# this is allowed, PRRTE ignores the binding policy. So for a user who binds ranks it stays forbidden: Open MPI 5 then
# starts at most one rank per core.
export OMPI_MCA_rmaps_base_oversubscribe="${OMPI_MCA_rmaps_base_oversubscribe:-1}"
if [ "$PRTE_MCA_hwloc_default_binding_policy" = none ]; then
  export PRTE_MCA_rmaps_default_mapping_policy="${PRTE_MCA_rmaps_default_mapping_policy:-:oversubscribe}"
fi
# Containers forbid the kernel call that copies between processes (cross-memory attach); messages here are small anyway.
export OMPI_MCA_btl_vader_single_copy_mechanism="${OMPI_MCA_btl_vader_single_copy_mechanism:-none}"
export OMPI_MCA_smsc="${OMPI_MCA_smsc:-^cma}"
