#pragma once

#include <hdf5.h>

#include <span>
#include <string>

#include "clog/sweep/run_row.hpp"

namespace clog::store {

/// Makes the dataset /runs with these rows in an open file. @throws Error naming the path that it is to have
void write_rows(hid_t file, std::span<const sweep::RunRow> rows, const std::string& path);

}  // namespace clog::store
