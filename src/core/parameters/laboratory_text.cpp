#include "clog/core/parameters/laboratory_text.hpp"

#include <map>
#include <mutex>
#include <optional>
#include <span>

#include "clog/core/tools/check_sum64.hpp"
#include "clog/core/tools/error.hpp"

namespace clog {
namespace {

std::mutex known_mutex;
std::map<std::uint64_t, std::string>& known_texts() {
  static std::map<std::uint64_t, std::string> all;
  return all;
}

std::uint64_t check_sum_of(const std::string& text) { return check_sum64(std::as_bytes(std::span(text))); }

}  // namespace

LaboratoryText::LaboratoryText(const std::string& text) : check_sum_(check_sum_of(text)) {
  if (text.find('=') == std::string::npos) throw Error("is no description of a laboratory");
  const std::lock_guard lock(known_mutex);
  known_texts().emplace(check_sum_, text);
}

LaboratoryText LaboratoryText::from_check_sum(std::string_view check_sum) {
  const std::optional<std::uint64_t> sum = from_hexadecimal(check_sum);
  if (!sum) throw Error("is no description of a laboratory; give a file by --lab");
  return LaboratoryText(*sum);
}

std::string LaboratoryText::check_sum() const { return hexadecimal(check_sum_); }

std::string LaboratoryText::text() const {
  const std::lock_guard lock(known_mutex);
  const auto known = known_texts().find(check_sum_);
  return known == known_texts().end() ? "" : known->second;
}

}  // namespace clog
