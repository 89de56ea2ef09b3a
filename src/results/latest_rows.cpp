#include "clog/results/latest_rows.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>

namespace clog::results {
namespace {

template <class Key>
std::vector<LatestRow> join(std::span<sweep::RunRow> rows, std::span<store::Journal::Entry> records,
                            Key (*key)(const sweep::RunRow&)) {
  std::vector<LatestRow> runs;
  runs.reserve(rows.size());
  std::unordered_map<Key, std::size_t> places;
  for (sweep::RunRow& row : rows) {
    if (!records.empty()) places.emplace(key(row), runs.size());
    runs.push_back({&row});
  }
  for (store::Journal::Entry& record : records) {
    const auto [place, is_new] = places.emplace(key(record.row), runs.size());
    if (is_new)
      runs.push_back({nullptr, &record});
    else if (LatestRow& run = runs[place->second]; sweep::is_final(record.row) || !sweep::is_final(run.row()))
      run.record = &record;
  }
  return runs;
}

}  // namespace

std::vector<LatestRow> latest_rows(std::span<sweep::RunRow> rows, std::span<store::Journal::Entry> records,
                                   RunKey key) {
  if (key == RunKey::identity) return join(rows, records, sweep::identity);
  return join<std::int64_t>(rows, records, [](const sweep::RunRow& row) { return row.task; });
}

}  // namespace clog::results
