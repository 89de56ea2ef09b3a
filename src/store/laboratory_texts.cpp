#include "laboratory_texts.hpp"

#include <algorithm>
#include <optional>

#include "clog/core/tools/error.hpp"
#include "hdf5.hpp"

namespace clog::store {
namespace {

/// Reads a text; empty if the dataset is not a text of fixed length.
std::string read_text(hid_t group, const std::string& name) {
  const Dataset dataset(H5Dopen2(group, name.c_str(), H5P_DEFAULT));
  if (!dataset.valid()) return "";
  const Type stored(H5Dget_type(dataset));
  if (H5Tget_class(stored) != H5T_STRING || H5Tis_variable_str(stored) > 0 ||
      H5Sget_simple_extent_npoints(Space(H5Dget_space(dataset))) != 1)
    return "";
  std::string text(H5Tget_size(stored), '\0');
  if (H5Dread(dataset, stored, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) return "";
  return text.substr(0, text.find('\0'));
}

bool is_as_written(const std::string& name, const std::string& text) try {
  return LaboratoryText(text).check_sum() == name;
} catch (const Error&) {
  return false;
}

}  // namespace

void write_laboratories(hid_t file, const std::set<std::string>& check_sums) {
  if (check_sums.empty()) return;
  const Group group(H5Gcreate2(file, laboratories_name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  if (!group.valid()) throw LibraryError("create the laboratories");
  for (const std::string& name : check_sums) {
    const std::string text = LaboratoryText::from_check_sum(name).text();
    write_dataset(group, name, text_type(text.size()), Space(H5Screate(H5S_SCALAR)), text.data());
  }
}

void read_laboratories(hid_t file, std::vector<std::string>& damage) {
  if (H5Lexists(file, laboratories_name, H5P_DEFAULT) <= 0) return;
  const Group group(H5Gopen2(file, laboratories_name, H5P_DEFAULT));
  if (!group.valid()) {
    damage.emplace_back("its laboratories cannot be opened");
    return;
  }
  for (const std::string& name : names_in(group))
    if (!is_as_written(name, read_text(group, name)))
      damage.push_back("its laboratory " + name + " is not as it was written");
}

void adopt_laboratory_of_all(SweepFile& file) {
  const auto stored = std::ranges::find_if(
      file.provenance, [](const auto& attribute) { return attribute.first == "laboratory"; });
  if (stored == file.provenance.end() || stored->second.find('=') == std::string::npos) return;
  std::string text = stored->second;
  // Removes comments, because in a text of one line a comment would extend to the end of the text.
  for (auto hash = text.find('#'); hash != std::string::npos; hash = text.find('#'))
    text.erase(hash, std::min(text.find('\n', hash), text.size()) - hash);
  while (text.ends_with('\n')) text.pop_back();
  for (auto end = text.find('\n'); end != std::string::npos; end = text.find('\n', end))
    text.replace(end, 1, "; ");
  const LaboratoryText laboratory(text);
  for (sweep::RunRow& row : file.rows)
    if (!row.parameters.laboratory) row.parameters.laboratory = laboratory;
}

}  // namespace clog::store
