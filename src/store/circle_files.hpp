#pragma once

#include <span>
#include <string>
#include <vector>

#include "clog/store/run_table.hpp"
#include "hdf5.hpp"

/// User-supplied circles in the file of a sweep. For each file of circles, the group /obstacles has a table
/// with the columns x, y and radius. The name of the table is the checksum of the circles.
namespace clog::store {

/// Group of the circles.
inline constexpr const char* circles_name = "obstacles";

/// @throws LibraryError
void write_circles(hid_t file, std::span<const CircleFile> circles);

/// Appends intact circles to `whole`. Appends a sentence to `damage` for each damaged file of circles.
void read_circles(hid_t file, std::vector<CircleFile>& whole, std::vector<std::string>& damage);

}  // namespace clog::store
