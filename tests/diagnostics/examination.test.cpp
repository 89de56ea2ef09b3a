#include "clog/diagnostics/examination.hpp"

#include <gtest/gtest.h>

namespace clog::diagnostics {
namespace {

TEST(HowToUnbind, NamesTheVariableThatTheVersionOfOpenMpiReads) {
  EXPECT_EQ(how_to_unbind("Open MPI v4.1.4"), "set OMPI_MCA_hwloc_base_binding_policy=none");
  EXPECT_EQ(how_to_unbind("Open MPI v5.0.7"), "set PRTE_MCA_hwloc_default_binding_policy=none");
  EXPECT_EQ(how_to_unbind("Open MPI v10.0.0"), "set PRTE_MCA_hwloc_default_binding_policy=none");
}

TEST(HowToUnbind, IsAnOptionOfMpichsMpirun) {
  EXPECT_EQ(how_to_unbind("MPICH 4.2.1"), "mpirun -bind-to none");
}

}  // namespace
}  // namespace clog::diagnostics
