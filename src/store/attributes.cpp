#include "attributes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <set>
#include <sstream>

#include "check_sum.hpp"
#include "hdf5.hpp"

namespace clog::store {
namespace {

/// Name of the attribute that lists the checksums. It has a line for the table and for every other attribute,
/// with checksum and name.
constexpr const char* list_name = "checksums";

std::string line_of(const NamedCheckSum& one) { return fmt::format("{:08x} {}\n", one.second, one.first); }

/// A line of the list; nullopt if it is malformed.
std::optional<NamedCheckSum> check_sum_in(const std::string& line) {
  constexpr std::size_t num_digits = 8;
  if (line.size() <= num_digits + 1) return std::nullopt;
  std::uint32_t sum = 0;
  const char* end = line.data() + num_digits;
  if (std::from_chars(line.data(), end, sum, 16).ptr != end) return std::nullopt;
  return NamedCheckSum(line.substr(num_digits + 1), sum);
}

std::vector<std::optional<NamedCheckSum>> read_list(hid_t file) {
  std::vector<std::optional<NamedCheckSum>> all;
  std::istringstream lines(read_attribute(file, list_name));
  for (std::string line; std::getline(lines, line);) all.push_back(check_sum_in(line));
  return all;
}

std::optional<std::uint32_t> listed_check_sum(hid_t file, const std::string& name) {
  for (const auto& listed : read_list(file))
    if (listed && listed->first == name) return listed->second;
  return std::nullopt;
}

/// An attribute holds less than 64 KiB. The rest of a longer text is in further attributes: `config.2` and so
/// on.
constexpr std::size_t longest_part = 60'000;

std::string name_of_part(const std::string& name, std::size_t part) {
  return part == 0 ? name : fmt::format("{}.{}", name, part + 1);
}

/// Joins the parts that name_of_part() names.
void join_parts(Provenance& provenance) {
  for (std::size_t i = 0; i < provenance.size(); ++i)
    for (std::size_t part = 1;; ++part) {
      const std::string name = name_of_part(provenance[i].first, part);
      const auto next = std::ranges::find(provenance, name, [](const auto& one) { return one.first; });
      if (next == provenance.end()) break;
      provenance[i].second += next->second;
      provenance.erase(next);
    }
}

/// Drops an attribute with a damaged part, because its other parts are useless.
void drop_attribute(const std::string& part, Provenance& provenance) {
  const std::string name = part.substr(0, part.find('.'));
  std::erase_if(provenance,
                [&](const auto& one) { return one.first.substr(0, one.first.find('.')) == name; });
}

}  // namespace

void write_attributes(hid_t file, const NamedCheckSum& table, const Provenance& attributes) {
  std::string lines = line_of(table);
  for (const auto& [name, text] : attributes)
    for (std::size_t part = 0; part == 0 || part * longest_part < text.size(); ++part) {
      const NamedCheckSum one(name_of_part(name, part),
                              check_sum(std::string_view(text).substr(part * longest_part, longest_part)));
      write_attribute(file, one.first, text.substr(part * longest_part, longest_part));
      lines += line_of(one);
    }
  write_attribute(file, list_name, lines);
}

std::string text_as_written(hid_t file, const std::string& name,
                            std::span<const std::string_view> candidates) {
  std::string text = read_attribute(file, name);
  if (std::ranges::find(candidates, text) != candidates.end()) return text;
  const std::optional<std::uint32_t> listed = listed_check_sum(file, name);
  for (const std::string_view candidate : candidates)
    if (listed == check_sum(candidate)) return std::string(candidate);
  return text;
}

std::string intact_text(hid_t file, const std::string& name) {
  std::string text = read_attribute(file, name);
  return listed_check_sum(file, name) == check_sum(text) ? text : "";
}

std::vector<std::string> unlisted_attributes(hid_t file) {
  std::vector<std::string> names = attributes_of(file);
  std::set<std::string> known = {list_name};
  for (const auto& listed : read_list(file))
    if (listed) known.insert(listed->first);
  std::erase_if(names, [&](const std::string& name) { return known.contains(name); });
  return names;
}

void compare_attributes(hid_t file, const NamedCheckSum& table, Provenance& whole,
                        std::vector<std::string>& damage) {
  bool has_table = false;
  std::vector<std::string> damaged;
  for (const auto& listed : read_list(file)) {
    if (!listed) {
      damage.emplace_back("a line of its attribute checksums is not as it was written");
    } else if (*listed == table) {
      has_table = true;
    } else if (std::string text = read_attribute(file, listed->first); check_sum(text) == listed->second) {
      whole.emplace_back(listed->first, std::move(text));
    } else {
      damage.push_back("its attribute " + listed->first + " is not as it was written");
      damaged.push_back(listed->first);
    }
  }
  for (const std::string& name : damaged) drop_attribute(name, whole);
  join_parts(whole);
  if (!has_table)
    damage.emplace_back("its table is not the one that was written: rows are missing, or exchanged");
}

}  // namespace clog::store
