#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace clog {

/// `1 run`, `2 runs`.
inline std::string count_text(std::int64_t number, const std::string& noun) {
  return std::to_string(number) + ' ' + noun + (number == 1 ? "" : "s");
}

/// The candidate nearest to a mistyped word, or empty if none is near.
inline std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const auto distance = [](std::string_view a, std::string_view b) {  // Levenshtein
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (const char letter : a) {
      std::size_t diagonal = row[0]++;
      for (std::size_t j = 0; j < b.size(); ++j) {
        const std::size_t substituted = diagonal + (letter != b[j]);
        diagonal = row[j + 1];
        row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substituted});
      }
    }
    return row.back();
  };
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates)
    if (const std::size_t d = distance(word, candidate); d < best_distance) {
      best_distance = d;
      best = candidate;
    }
  return best;
}

/// The candidates that end with the word, as wall-contact ends with contact. If there are none, the
/// candidates that contain the word between dashes.
inline std::vector<std::string> with_part(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string end = '-' + std::string(word);
  const auto all_that = [&](const auto& holds) {
    std::vector<std::string> all;
    std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(all), holds);
    return all;
  };
  if (word.empty()) return {};
  auto ending = all_that([&](const std::string& candidate) { return candidate.ends_with(end); });
  if (!ending.empty()) return ending;
  return all_that([&](const std::string& candidate) {
    return ('-' + candidate + '-').find(end + '-') != std::string::npos;
  });
}

}  // namespace clog
