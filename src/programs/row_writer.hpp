#pragma once

#include <chrono>
#include <vector>

#include "clog/store/run_table.hpp"

namespace clog {

/// Writes rows at once, but at most once a second: writing takes milliseconds, and a thousand ranks may send
/// as many rows in a second.
class RowWriter {
 public:
  explicit RowWriter(store::RunTable& table) : table_(table) {}
  void add(const sweep::RunRow& row) {
    rows_.push_back(row);
    tick();
  }
  /// Writes what waits if it is time to.
  void tick() {
    if (Clock::now() - last_write_ >= std::chrono::seconds(1)) finish();
  }
  void finish() {
    if (rows_.empty()) return;
    table_.append(rows_);
    rows_.clear();
    last_write_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;
  store::RunTable& table_;
  std::vector<sweep::RunRow> rows_;
  Clock::time_point last_write_ = Clock::now() - std::chrono::hours(1);
};

}  // namespace clog
