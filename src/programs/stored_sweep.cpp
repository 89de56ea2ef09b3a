#include "stored_sweep.hpp"

#include <algorithm>

#include "clog/core/error.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog {
namespace {

/// What `read` makes of an attribute's text; says where the text is from if it cannot be read.
template <class Read>
auto read_attribute(const std::string& path, const store::Provenance& provenance, const std::string& name,
                    const Read& read) {
  try {
    return read(attribute(provenance, name));
  } catch (const Error& error) {
    throw Error("cannot read " + path + " (its attribute " + name + ": " + error.what() +
                "); the file is damaged, or of another version of the program");
  }
}

sweep::Settings settings_from(const std::string& config) {
  if (config.empty()) throw Error("it is missing, or empty");
  return sweep::Settings::from_config(config);
}

}  // namespace

std::string attribute(const store::Provenance& provenance, const std::string& name) {
  const auto found = std::find_if(provenance.begin(), provenance.end(),
                                  [&](const auto& attribute) { return attribute.first == name; });
  return found == provenance.end() ? "" : found->second;
}

sweep::Settings stored_settings(const std::string& path, const store::Provenance& provenance) {
  return read_attribute(path, provenance, "config", settings_from);
}

sweep::Plan stored_plan(const std::string& path, const store::Provenance& provenance) {
  return read_attribute(path, provenance, "config",
                        [](const std::string& config) { return sweep::Plan(settings_from(config)); });
}

std::int64_t stored_num_wanted(const std::string& path, const store::Provenance& provenance,
                               const sweep::Plan& plan) {
  return read_attribute(path, provenance, "num_wanted", [&](const std::string& number) {
    return number.empty() ? plan.size() : sweep::to_integer(number);
  });
}

}  // namespace clog
