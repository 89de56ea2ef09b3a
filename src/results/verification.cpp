#include "clog/results/verification.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "clog/core/tools/wording.hpp"
#include "clog/results/salvage.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/store/journal.hpp"
#include "clog/store/run_table.hpp"

namespace clog::results {
namespace {

std::string to_text(const store::Journal::Contents& journal, bool is_alive) {
  const auto num_snapshots = std::count_if(journal.entries.begin(), journal.entries.end(),
                                           [](const auto& entry) { return !entry.snapshot.empty(); });
  const std::string text = fmt::format(
      "{}, {} of them with snapshots, {}",
      count_text(static_cast<std::int64_t>(journal.entries.size()), "record"), num_snapshots,
      journal.num_unreadable == 0 ? "all undamaged" : fmt::format("{} more damaged", journal.num_unreadable));
  if (is_alive) return text + "; a sweep is writing to it";
  return text + (journal.has_torn_end ? "; the last one is torn, as after a kill, and will be dropped" : "");
}

}  // namespace

Verification verify(const std::string& path) {
  store::Examination found = store::examine_sweep(path);
  store::SweepFile& file = found.whole;
  const bool has_config = !attribute(file.provenance, "config").empty();
  RunCount runs;  // not queried if the file is damaged
  if (found.damage.empty() && has_config) runs = stored_num_runs(path, file, stored_plan(path, file));
  Verification result{.findings = found.damage};
  for (std::string& fault : drop_faulty(file.rows)) result.findings.push_back(std::move(fault));
  if (found.is_refused_by_others && found.damage.empty())
    result.findings.emplace_back(
        "a checksum of HDF5 is damaged: h5py, pandas and other readers refuse the file; `clogsweep salvage` "
        "writes a file that they accept");
  result.num_faults = static_cast<std::int64_t>(result.findings.size());
  const auto num_rows = static_cast<std::int64_t>(file.rows.size());
  if (result.num_faults > 0)
    result.findings.push_back(fmt::format("{}: {}, {}", path, count_text(num_rows, "undamaged row"),
                                          count_text(result.num_faults, "fault")));
  else if (has_config)
    result.findings.push_back(fmt::format("{}: {} of {}{}, all undamaged", path, count_text(num_rows, "row"),
                                          count_text(runs.num_runs, "run"), runs.text_of_beyond()));
  else
    result.findings.push_back(
        fmt::format("{}: {}, all undamaged; its config is missing: the sweep's own command "
                    "restores it",
                    path, count_text(num_rows, "row")));
  if (std::string words = store::caution(path, file); !words.empty())
    result.findings.push_back(std::move(words));
  const std::string journal = store::journal_path(path);
  if (const auto contents = store::Journal::look(journal)) {
    result.findings.push_back(journal + ": " + to_text(*contents, store::Journal::is_open(journal)));
    result.num_faults += contents->num_unreadable;
  }
  return result;
}

}  // namespace clog::results
