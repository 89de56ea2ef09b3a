#pragma once

#include <hdf5.h>

#include <span>
#include <string>
#include <vector>

#include "clog/sweep/run_row.hpp"

/// The table of the members of families, with break-up=daughters: one line per droplet.
namespace clog::store {

inline constexpr const char* droplets_name = "droplets";
inline constexpr const char* droplet_sums_name = "droplet_checksums";

/// A family, and the task of its row.
struct StoredFamily {
  std::int64_t task;
  std::vector<Member> members;
};

/// Writes no table if there is no family. @throws LibraryError
void write_droplets(hid_t file, std::span<const StoredFamily> families);

/// Assigns the families to the rows, without damaged droplets. Appends a sentence to `damage` for each
/// damaged droplet, or one sentence if the table cannot be read. A family that lacks a droplet is a fault of
/// its row (sweep::fault_of).
void read_droplets(hid_t file, std::vector<sweep::RunRow>& rows, std::vector<std::string>& damage);

}  // namespace clog::store
