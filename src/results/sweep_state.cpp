#include "clog/results/sweep_state.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <deque>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::results {
namespace {

/// Keeps `sessions` short, however often a sweep is resumed: the oldest lines are removed, and a long last
/// line is cut.
std::string latest_lines(std::string text) {
  constexpr std::size_t longest_line = 2000;
  constexpr std::size_t longest = 30'000;
  const std::size_t last = text.rfind('\n', text.size() - 2) + 1;  // 0 if there is only one line
  if (text.size() - last > longest_line) text = text.substr(0, last + longest_line) + "...\n";
  while (text.size() > longest) text.erase(0, text.find('\n') + 1);
  return text;
}

/// Resets a run to its release, except its parameters and its cost so far.
void restart(sweep::RunRow& row) {
  RunResult nothing;
  nothing.status = RunStatus::interrupted;
  sweep::record(nothing, row);
}

}  // namespace

SweepState::SweepState(std::string path, const sweep::Plan& plan, const sweep::Settings& settings,
                       store::Provenance provenance, std::int64_t num_wanted, std::int64_t attempts)
    : place_(store::OutputPath::resolve(store::require_regular(std::move(path)))),
      path_(place_.path()),
      plan_(&plan),
      provenance_(std::move(provenance)),
      attempts_(attempts),
      journal_(store::journal_place(place_), &place_),
      num_wanted_(num_wanted) {
  for (const auto& [name, circles] : plan.circle_files()) circles_.push_back({name, circles});
  session_time_ = attribute(provenance_, "start_time");
  std::string session;
  for (const char* name : {"start_time", "version", "git_describe", "num_ranks", "command_line"})
    session += attribute(provenance_, name) + ' ';
  session.back() = '\n';

  std::vector<sweep::RunRow> rows;
  const bool has_table = place_.exists();
  if (has_table) {
    store::SweepFile file = read_table();
    caution_ = store::caution(path_, file);
    adopt(file, settings);
    keep_circles(file);
    rows = std::move(file.rows);
  }
  std::vector<Entry> entries = journal_.take_entries();
  if (!has_table && !entries.empty())
    throw Error(
        "cannot resume " + path_ + " (its table is gone, but " + store::journal_path(path_) + " holds " +
        count_text(static_cast<std::int64_t>(entries.size()), "record") +
        " of an earlier sweep, maybe of finished runs); put the table back, or give another --output");
  Known known = recognise(std::move(rows), std::move(entries), settings);
  set_attribute(provenance_, "sessions", latest_lines(attribute(provenance_, "sessions") + session));
  find_tasks(std::move(known));
  publish();
  if (const std::string& fault = place_.sync_fault(); !fault.empty())
    caution_ += fmt::format(
        "{}the folder of {} cannot be synchronised ({}): after a power cut the newest rows may be lost",
        caution_.empty() ? "" : "\n", path_, fault);
  publication_begin_ = publication_end_ = Clock::now();
}

std::unique_ptr<SweepState::Entry>& SweepState::place_of(std::int64_t task) {
  const auto place = static_cast<std::size_t>(task);
  if (place >= runs_.size()) runs_.resize(place + 1);
  return runs_[place];
}

bool SweepState::is_over(const sweep::RunRow& row) const {
  if (row.status == RunStatus::failed) return !tries_again(row);
  return !sweep::is_unfinished(row.status);
}

void SweepState::want(const std::vector<std::int64_t>& tasks) {
  num_wanted_ += static_cast<std::int64_t>(tasks.size());
  set_attribute(provenance_, "num_wanted", std::to_string(num_wanted_));
  tasks_left_.clear();
  waiting_.clear();
  for (const std::int64_t task : tasks)
    if (const Entry* const run = entry(task); !run || !is_over(run->row)) request(task);
  is_published_ = false;
}

/// Requests a task, or lets it wait for its twin. Tasks are requested in increasing order.
void SweepState::request(std::int64_t task) {
  const std::optional<std::int64_t> twin = plan_->twin(task);
  const Entry* const run = twin ? entry(*twin) : nullptr;
  if (run && is_over(run->row))
    write_down(copy_to(task, *run));
  else if (twin && std::ranges::binary_search(tasks_left_, *twin))
    waiting_[*twin].push_back(task);
  else
    tasks_left_.push_back(task);
}

/// A copy costs nothing.
std::unique_ptr<SweepState::Entry> SweepState::copy_of(const Entry& twin) {
  auto copy = std::make_unique<Entry>(twin);
  copy->row.wall_seconds = copy->row.processor_seconds = 0;
  return copy;
}

/// Gives a task the row of its twin.
SweepState::Entry& SweepState::copy_to(std::int64_t task, const Entry& twin) {
  std::unique_ptr<Entry> copy = copy_of(twin);
  copy->row.parameters.laboratory = plan_->task(task).laboratory;
  copy->row.task = task;
  std::unique_ptr<Entry>& run = place_of(task);
  const std::lock_guard lock(changing_);
  if (!run) run = std::make_unique<Entry>();
  *run = std::move(*copy);
  return *run;
}

void SweepState::pass_on(const Entry& twin) {
  if (const auto waiting = waiting_.find(twin.row.task); waiting != waiting_.end())
    for (const std::int64_t task : waiting->second) write_down(copy_to(task, twin));
}

std::int64_t SweepState::num_waiting() const {
  std::int64_t number = 0;
  for (const auto& [twin, tasks] : waiting_) number += std::ssize(tasks);
  return number;
}

std::vector<std::int64_t> SweepState::tasks_begun() const {
  std::vector<std::int64_t> tasks;
  for (const auto& run : runs_)
    if (run && !is_over(run->row)) tasks.push_back(run->row.task);
  return tasks;
}

std::int64_t SweepState::num_resumed() const {
  return std::count_if(tasks_left_.begin(), tasks_left_.end(), [this](std::int64_t task) {
    const Entry* const run = entry(task);
    return run && !run->snapshot.empty();
  });
}

sweep::RunRow SweepState::new_row(std::int64_t task) const {
  return sweep::begun_row(plan_->task(task), task);
}

void SweepState::watch_ranks(int num_ranks) {
  earlier_activity_ = attribute(provenance_, "activity");
  activity_.emplace(num_ranks);
  begin_ = Clock::now();
}

void SweepState::rank_is_free() {
  if (activity_) activity_->ended(seconds_so_far());
}

sweep::Start SweepState::start(std::int64_t task, int rank) {
  if (activity_) activity_->started(seconds_so_far());
  std::unique_ptr<Entry>& run = place_of(task);
  const bool is_new = !run;
  if (is_new) run = std::make_unique<Entry>();
  std::unique_lock lock(changing_);
  Entry& entry = *run;
  sweep::Start start{entry.snapshot, entry.row.attempt};
  const bool failed = !is_new && entry.row.status == RunStatus::failed;
  if (failed) start = {{}, entry.row.attempt + 1};
  if (const auto past = past_.find(task); past != past_.end())
    past->second.instruction_set = start.snapshot.empty() ? "" : entry.row.instruction_set;
  if (is_new || failed) {
    entry.snapshot.clear();
    entry.row = new_row(task);
  }
  entry.row.attempt = start.attempt;
  entry.row.status = RunStatus::running;
  entry.row.rank = rank;
  is_published_ = false;
  lock.unlock();
  pass_on(entry);
  return start;
}

void SweepState::restarted(std::int64_t task) {
  if (activity_) activity_->restarted();
  past_[task].instruction_set.clear();
}

void SweepState::report(const sweep::Report& report) {
  Entry* const run = entry(report.row.task);
  if (!run || sweep::identity(report.row) != sweep::identity(run->row))
    throw Error(fmt::format(
        "cannot continue with {} (rank {} returned a run with other parameters than those of task {}); "
        "earlier results are in the file; please report this",
        path_, report.row.rank, report.row.task));
  std::unique_lock lock(changing_);
  Entry& entry = *run;
  entry = report;
  if (const auto past = past_.find(report.row.task); past != past_.end()) {
    entry.row.wall_seconds += past->second.wall_seconds;
    entry.row.processor_seconds += past->second.processor_seconds;
    const std::string& before = past->second.instruction_set;
    if (!before.empty() && before != entry.row.instruction_set)
      entry.row.instruction_set = sweep::mixed_instruction_sets;
  }
  if (entry.row.status == RunStatus::failed) past_[entry.row.task].take_costs(entry.row);
  lock.unlock();
  write_down(entry);
  pass_on(entry);
}

const sweep::RunRow* SweepState::first_if_all_failed() const {
  const sweep::RunRow* first = nullptr;
  for (const auto& run : runs_) {
    if (run && run->row.status != RunStatus::failed) return nullptr;
    if (run && !first) first = &run->row;
  }
  return first;
}

std::vector<const SweepState::Entry*> SweepState::entries() const {
  std::vector<const Entry*> all;
  all.reserve(runs_.size() + other_runs_.size());
  for (const Entries* runs : {&runs_, &other_runs_})
    for (const auto& run : *runs)
      if (run) all.push_back(run.get());
  return all;
}

void SweepState::write_down(const Entry& entry) {
  if (!journal_.is_there()) publish();
  journal_.add(entry.row, entry.snapshot);
  is_published_ = false;
}

void SweepState::withdraw_failure(std::int64_t task) {
  Entry& entry = *runs_.at(task);
  {
    const std::lock_guard lock(changing_);
    restart(entry.row);  // the broken rank's result does not count as progress
  }
  write_down(entry);
  pass_on(entry);
}

void SweepState::tick() {
  // Writing the whole table takes longer with more runs, and the journal must be rewritten now and then.
  // Together, these two tasks may take two per cent of the time.
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

/// The row that readers see: a run that will be tried again is not failed yet, and its failed attempt has no
/// distance.
sweep::RunRow SweepState::published(const sweep::RunRow& row) const {
  if (row.status != RunStatus::failed || is_over(row)) return row;
  sweep::RunRow next = row;
  restart(next);
  ++next.attempt;
  return next;
}

std::optional<std::string> SweepState::publish_to(const store::OutputPath& place, const std::string& stamp,
                                                  const std::vector<const Entry*>& all,
                                                  const store::Provenance& provenance) {
  const auto row = [&](std::size_t i) {
    const std::lock_guard lock(changing_);
    return published(all[i]->row);
  };
  return store::publish_sweep(place, stamp, {all.size(), row}, provenance, circles_);
}

void SweepState::publish() {
  end_publication();
  begin_publication();
  end_publication();
}

/// Starts to write the table in another thread. If the table was replaced or the journal removed, writes
/// everything once more and ends the sweep. A removed table is written again.
void SweepState::begin_publication() {
  const std::string there = place_.stamp();
  if (!there.empty() && there != stamp_) rescue();
  const bool has_journal = journal_.is_there();
  if (!has_journal) {
    if (!journal_.make_anew(place_)) rescue();
    journal_.rewrite(entries());
  }
  journal_.begin();
  if (activity_)
    set_attribute(provenance_, "activity",
                  with_session(earlier_activity_, activity_->line(session_time_, seconds_so_far())));
  is_published_ = true;
  publication_ =
      std::async(std::launch::async, [this, all = entries(), provenance = provenance_,
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

void SweepState::end_publication() {
  if (!publication_.valid()) return;
  std::optional<std::string> published = publication_.get();
  if (!published) rescue();
  stamp_ = *std::move(published);
}

/// Writes the table under another name, so that a foreign file keeps its place.
void SweepState::rescue() {
  if (journal_.is_there()) journal_.rewrite(entries());
  int number = 1;
  const auto rescued = [&] { return place_.beside(fmt::format(".rescued{}", number)); };
  while (!publish_to(rescued(), "", entries(), provenance_)) ++number;
  throw Error(fmt::format(
      "cannot continue with {} (somebody has replaced it or its journal while the sweep was "
      "running); all runs are in {}: move it to where it belongs, then the same command resumes the sweep",
      path_, rescued().path()));
}

/// Rewrites the journal for the time when the table will have the results of all records before `place`. The
/// journal then needs only the unfinished runs, and the records from `place` on.
void SweepState::prepare_journal(const std::vector<const Entry*>& all, std::uint64_t place) {
  std::deque<Entry> unfinished;
  std::vector<const Entry*> needed;
  for (const Entry* entry : all) {
    const std::lock_guard lock(changing_);
    if (!is_over(entry->row)) needed.push_back(&unfinished.emplace_back(*entry));
  }
  journal_.prepare(needed, place);
}

std::string SweepState::finish() {
  publish();
  if (place_.stamp() != stamp_) publish();  // somebody has moved or removed the table
  const std::vector<const Entry*> all = entries();
  const bool is_complete =
      std::ssize(all) - std::ssize(other_runs_) >= num_wanted_ &&
      std::ranges::all_of(all, [this](const Entry* entry) { return is_over(entry->row); });
  if (!is_complete) {
    prepare_journal(all, journal_.num_bytes());
    journal_.replace();
    return "";
  }
  const std::error_code reason = journal_.remove();
  if (!reason) return "";
  return fmt::format("cannot remove {} ({}); the sweep is complete without it: remove it", journal_.path(),
                     reason.message());
}

}  // namespace clog::results
