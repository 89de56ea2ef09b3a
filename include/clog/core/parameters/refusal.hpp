#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "clog/core/tools/error.hpp"

namespace clog {

/// The error that refuses the value of a key. Callers that know more about the settings can extend the text.
class Refusal : public Error {
 public:
  struct About {
    std::string key = {};                 ///< key with the refused value; if empty, `excluded` has the keys
    std::vector<std::string> named = {};  ///< other keys whose values the text contains
    std::vector<std::string> excluded = {};  ///< given keys that contradict the refused value, or each other
    std::string added = {};                  ///< key that the remedy adds
    std::vector<double> nearest = {};        ///< possible values next to the refused one, if there are few
  };

  /// `invalid KEY=VALUE (REASON) REMEDY`
  Refusal(const About& about, const std::string& value, const std::string& reason, const std::string& remedy);
  /// @param text  the text up to the remedy
  Refusal(About about, std::string text, const std::string& remedy = "");

  const About& about() const { return about_; }
  const std::string& without_remedy() const { return text_; }
  /// Whether the text contains the value of this key in addition to the refused value.
  bool names(std::string_view other) const;
  /// The refusal with more text around it.
  Refusal between(const std::string& before, const std::string& after) const;

 private:
  About about_;
  std::string text_, remedy_;
};

}  // namespace clog
