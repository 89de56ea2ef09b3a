#include "clog/results/sweep_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <deque>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/results/stored_sweep.hpp"

namespace clog::results {
namespace {

/// Limits the length of the attribute `sessions` of a sweep that is resumed often. Removes the oldest lines,
/// and cuts a long last line.
std::string latest_lines(std::string text) {
  constexpr std::size_t longest_line = 2000;
  constexpr std::size_t longest = 30'000;
  const std::size_t last = text.rfind('\n', text.size() - 2) + 1;  // 0 if there is only one line
  if (text.size() - last > longest_line) text = text.substr(0, last + longest_line) + "...\n";
  while (text.size() > longest) text.erase(0, text.find('\n') + 1);
  return text;
}

}  // namespace

SweepFiles::SweepFiles(std::string path, const sweep::Plan& plan, store::Provenance provenance,
                       const SweepRuns& runs)
    : place_(store::OutputPath::resolve(store::require_regular(std::move(path)))),
      journal_(store::journal_place(place_), &place_),
      runs_(runs),
      provenance_(std::move(provenance)),
      session_time_(attribute(provenance_, "start_time")) {
  for (const auto& [name, circles] : plan.circle_files()) circles_.push_back({name, circles});
  std::string session = attribute(provenance_, "sessions");
  for (const char* name : {"start_time", "version", "git_describe", "num_ranks", "command_line"})
    session += attribute(provenance_, name) + ' ';
  session.back() = '\n';
  set_attribute(provenance_, "sessions", latest_lines(session));
}

SweepFiles::Earlier SweepFiles::take_earlier() {
  store::SweepFile table = read_table();  // comes first, because records without a table are refused
  return {std::move(table), take_records()};
}

store::SweepFile SweepFiles::read_table() {
  if (!place_.exists()) return {};
  stamp_ = place_.stamp();
  store::SweepFile table = store::read_sweep(path());
  // Readers use the path, the sweep uses the open folder.
  if (place_.stamp() != stamp_ || store::OutputPath::resolve(path()).stamp() != stamp_)
    throw Error("cannot resume " + path() +
                " (it was replaced or moved while it was read); try again when it stays in place");
  store::refuse_foreign_objects(path(), table);
  caution_ = store::caution(path(), table);
  store::Provenance all = table.provenance;
  for (const char* name : {"config", "stopping_rule", "num_wanted"})
    set_attribute(all, name, attribute(provenance_, name));
  set_attribute(all, "sessions",
                latest_lines(attribute(all, "sessions") + attribute(provenance_, "sessions")));
  provenance_ = std::move(all);
  for (const store::CircleFile& one : table.circles)
    if (std::ranges::none_of(circles_, [&](const auto& known) { return known.circles == one.circles; }))
      circles_.push_back({"", one.circles});  // circles of runs outside this plan
  return table;
}

std::vector<SweepFiles::Entry> SweepFiles::take_records() {
  std::vector<Entry> records = journal_.take_entries();
  if (stamp_.empty() && !records.empty())
    throw Error(
        "cannot resume " + path() + " (its table is gone, but " + journal_.path() + " holds " +
        count_text(std::ssize(records), "record") +
        " of an earlier sweep, maybe of finished runs); put the table back, or give another --output");
  return records;
}

void SweepFiles::begin_session() {
  publish();
  if (const std::string& fault = place_.sync_fault(); !fault.empty())
    caution_ += fmt::format(
        "{}the folder of {} cannot be synchronised ({}): after a power cut the newest rows may be lost",
        caution_.empty() ? "" : "\n", path(), fault);
  publication_begin_ = publication_end_ = Clock::now();
}

void SweepFiles::set(const std::string& name, const std::string& text) {
  set_attribute(provenance_, name, text);
  is_published_ = false;
}

void SweepFiles::watch_ranks(int num_ranks) {
  earlier_activity_ = attribute(provenance_, "activity");
  activity_.emplace(num_ranks);
  begin_ = Clock::now();
}

void SweepFiles::rank_is_busy() {
  if (activity_) activity_->started(seconds_so_far());
  is_published_ = false;
}

void SweepFiles::write_down(const Entry& entry) {
  if (!journal_.is_there()) publish();
  journal_.add(entry.row, entry.snapshot);
  is_published_ = false;
}

void SweepFiles::tick() {
  // Writing the whole table and rewriting the journal take longer with more runs. Together, they may take two
  // per cent of the time.
  const Clock::time_point now = Clock::now();
  if (publication_.valid()) {
    if (publication_.wait_for(std::chrono::seconds(0)) == std::future_status::timeout) return;
    end_publication();
    if (journal_.is_prepared()) journal_.replace();
    publication_end_ = Clock::now();
    return;
  }
  const Clock::duration pause =
      std::max<Clock::duration>(std::chrono::seconds(1), 50 * (publication_end_ - publication_begin_));
  if (is_published_ || now - publication_end_ < pause) return;
  publication_begin_ = now;
  begin_publication();
}

/// The row that readers see. If the run will be tried again, the row is that of a run at its release, because
/// the failed attempt has no result.
sweep::RunRow SweepFiles::published(sweep::RunRow row) const {
  if (!runs_.tries_again(row)) return row;
  reset_to_release(row);
  ++row.attempt;
  return row;
}

/// Publishes all rows, including those of runs outside the plan.
std::optional<std::string> SweepFiles::publish_to(const store::OutputPath& place, const std::string& stamp,
                                                  const std::vector<const Entry*>& all,
                                                  const store::Provenance& provenance) const {
  const auto row = [&](std::size_t i) {
    const std::lock_guard lock(runs_.changing);
    return published(all[i]->row);
  };
  return store::publish_sweep(place, stamp, {all.size(), row}, provenance, circles_);
}

void SweepFiles::publish() {
  end_publication();
  begin_publication();
  end_publication();
}

/// Starts to write the table in another thread. If the table was removed, writes it again. If the table was
/// replaced, writes it under another name and ends the sweep. If the journal was removed, makes a new
/// journal, writes the table, and ends the sweep.
void SweepFiles::begin_publication() {
  const std::string there = place_.stamp();
  if (!there.empty() && there != stamp_) rescue();
  const bool has_journal = journal_.is_there();
  if (!has_journal) {
    if (!journal_.recreate(place_)) rescue();
    journal_.rewrite(runs_.all());
  }
  journal_.begin();
  if (activity_)
    set_attribute(provenance_, "activity",
                  with_session(earlier_activity_, activity_->line(session_time_, seconds_so_far())));
  is_published_ = true;
  publication_ =
      std::async(std::launch::async, [this, all = runs_.all(), provenance = provenance_,
                                      end = journal_.num_bytes(), is_long = journal_.is_to_be_rewritten()] {
        journal_.flush();
        std::optional<std::string> stamp = publish_to(place_, stamp_, all, provenance);
        if (stamp && is_long) prepare_journal(all, end);
        return stamp;
      });
  if (has_journal) return;
  end_publication();
  throw Error(
      "cannot continue with " + journal_.path() +
      " (it was removed while the sweep was running); nothing is lost; the same command resumes the sweep");
}

void SweepFiles::end_publication() {
  if (!publication_.valid()) return;
  std::optional<std::string> published = publication_.get();
  if (!published) rescue();
  stamp_ = *std::move(published);
}

/// Writes the table under another name, so that the file that has replaced it stays.
void SweepFiles::rescue() {
  if (journal_.is_there()) journal_.rewrite(runs_.all());
  int number = 1;
  const auto rescued = [&] { return place_.beside(fmt::format(".rescued{}", number)); };
  while (!publish_to(rescued(), "", runs_.all(), provenance_)) ++number;
  throw Error(fmt::format(
      "cannot continue with {} (somebody has replaced it or its journal while the sweep was "
      "running); all runs are in {}: move it to where it belongs, then the same command resumes the sweep",
      path(), rescued().path()));
}

/// Prepares a shorter journal while the table is being written. The shorter journal contains only the
/// unfinished runs and the records from `place` on. It replaces the journal when the table contains the
/// results of all records before `place`.
void SweepFiles::prepare_journal(const std::vector<const Entry*>& all, std::uint64_t place) {
  std::deque<Entry> unfinished;
  std::vector<const Entry*> needed;
  for (const Entry* entry : all) {
    const std::lock_guard lock(runs_.changing);
    if (!runs_.is_over(entry->row)) needed.push_back(&unfinished.emplace_back(*entry));
  }
  journal_.prepare(needed, place);
}

void SweepFiles::publish_last() {
  publish();
  if (place_.stamp() != stamp_) publish();  // somebody has moved or removed the table
}

void SweepFiles::stop() {
  publish_last();
  prepare_journal(runs_.all(), journal_.num_bytes());
  journal_.replace();
}

std::string SweepFiles::complete() {
  publish_last();
  const std::error_code reason = journal_.remove();
  if (!reason) return "";
  return fmt::format("cannot remove {} ({}); the sweep is complete without it: remove it", journal_.path(),
                     reason.message());
}

}  // namespace clog::results
