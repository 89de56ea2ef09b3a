#pragma once

#include <hdf5.h>

#include <set>
#include <string>
#include <vector>

#include "clog/store/run_table.hpp"

namespace clog::store {

/// Group of the laboratories.
inline constexpr const char* laboratories_name = "laboratories";

/// Writes descriptions of laboratories to a file of runs. The group /laboratories has a text for each
/// description. The name of a text is its checksum; rows contain this checksum. @throws LibraryError
void write_laboratories(hid_t file, const std::set<std::string>& check_sums);
/// Makes the texts known to this process (LaboratoryText::text()). Appends a sentence to `damage` for each
/// damaged text.
void read_laboratories(hid_t file, std::vector<std::string>& damage);
/// Files before format 10 have one description for all rows, in an attribute.
void adopt_laboratory_of_all(SweepFile& file);

}  // namespace clog::store
