#pragma once

#include <hdf5.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clog/store/run_table.hpp"

/// Attributes of a file's root. One attribute contains the checksums of all other attributes and of the
/// table. A text that is too long for one attribute is stored in several attributes.
namespace clog::store {

using NamedCheckSum = std::pair<std::string, std::uint32_t>;

/// @param table  the list's entry about the table. @throws LibraryError
void write_attributes(hid_t file, const NamedCheckSum& table, const Provenance& attributes);

/// An attribute's text. If the stored text is damaged, the function returns the candidate that matches the
/// checksum.
std::string text_as_written(hid_t file, const std::string& name,
                            std::span<const std::string_view> candidates);
/// An attribute's text; empty if it is missing or damaged.
std::string intact_text(hid_t file, const std::string& name);

/// Appends the intact attributes to `whole`. Appends to `damage` a sentence for each damaged attribute, and
/// one for the table if its checksum differs.
void compare_attributes(hid_t file, const NamedCheckSum& table, Provenance& whole,
                        std::vector<std::string>& damage);

/// Names of the attributes that are not in the list of checksums. Another program has added them.
std::vector<std::string> unlisted_attributes(hid_t file);

}  // namespace clog::store
