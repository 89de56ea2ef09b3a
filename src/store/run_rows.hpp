#pragma once

#include <hdf5.h>

#include <span>

#include "clog/sweep/run_row.hpp"

namespace clog::store {

/// Makes the dataset /runs with these rows in an open file. @throws Error
void write_rows(hid_t file, std::span<const sweep::RunRow> rows);

}  // namespace clog::store
