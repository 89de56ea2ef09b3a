#pragma once

#include <hdf5.h>

#include <string>

#include "clog/store/run_table.hpp"

namespace clog::store {

inline constexpr const char* trajectory_kind = "clogsweep trajectory";

/// Makes the dataset /runs with these rows in an open file. Also writes the root attributes: kind, format
/// version, provenance, and the checksums of rows and attributes. @throws LibraryError
void write_runs(hid_t file, const std::string& kind, const Rows& rows, const Provenance& provenance);

}  // namespace clog::store
