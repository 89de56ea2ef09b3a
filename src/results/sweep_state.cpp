#include "clog/results/sweep_state.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/settings.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::results {
namespace {

/// An empty text removes the attribute.
void set_attribute(store::Provenance& provenance, const std::string& name, const std::string& text) {
  std::erase_if(provenance, [&](const auto& attribute) { return attribute.first == name; });
  if (!text.empty()) provenance.emplace_back(name, text);
}

/// Keeps `sessions` short, however often a sweep is resumed: the oldest lines go, and a long last one is cut.
std::string latest_lines(std::string text) {
  constexpr std::size_t longest_line = 2000;
  constexpr std::size_t longest = 30'000;
  const std::size_t last = text.rfind('\n', text.size() - 2) + 1;  // 0 if there is only one line
  if (text.size() - last > longest_line) text = text.substr(0, last + longest_line) + "...\n";
  while (text.size() > longest) text.erase(0, text.find('\n') + 1);
  return text;
}

/// Resets a run to its release: only its parameters and its cost so far stay.
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
        sweep::counted(static_cast<std::int64_t>(entries.size()), "record") +
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

/// Is it the run that the plan has by its number? Usually all are: the sweep is resumed as it was begun.
bool SweepState::is_of_its_task(const sweep::RunRow& row) const {
  return row.task >= 0 && row.task < plan_->size() &&
         sweep::identity(row) == sweep::identity(sweep::describe(plan_->task(row.task)));
}

/// Rows of the table, and records of the journal in its order, become runs: in runs_ if all are of their
/// tasks, otherwise in the list that it returns. Each goes from one place to the other, since a large sweep
/// has memory for each row just once.
SweepState::Known SweepState::recognise(std::vector<sweep::RunRow> rows, std::vector<Entry> records,
                                        const sweep::Settings& settings) {
  Known known;
  const bool is_usual =
      std::ranges::all_of(rows, [&](const auto& row) { return is_of_its_task(row); }) &&
      std::ranges::all_of(records, [&](const auto& record) { return is_of_its_task(record.row); });
  const auto place = [&](const sweep::RunRow& row) -> std::unique_ptr<Entry>& {
    return is_usual ? place_of(row.task) : known[sweep::identity(row)];
  };
  for (sweep::RunRow& row : rows) {
    std::unique_ptr<Entry>& run = place(row);
    run = std::make_unique<Entry>(Entry{std::move(row), {}});
  }
  std::optional<FixedValues> fixed;
  for (Entry& record : records) {
    std::unique_ptr<Entry>& run = place(record.row);
    if (!run && !fixed) fixed.emplace(*plan_, settings);
    if (!run) refuse_foreign(record.row, *fixed);
    // If a run's last record was lost from the journal, the table has its result and the journal only an
    // earlier state: keep the table's row.
    if (!run || sweep::is_result(record.row.status) || !sweep::is_result(run->row.status))
      run = std::make_unique<Entry>(std::move(record));
  }
  const auto is_faulty = [](const std::unique_ptr<Entry>& run) {
    return run && !sweep::fault_of(run->row).empty();
  };
  num_faulty_ =
      std::ranges::count_if(runs_, is_faulty) +
      static_cast<std::int64_t>(std::erase_if(known, [&](const auto& one) { return is_faulty(one.second); }));
  std::ranges::replace_if(runs_, is_faulty, nullptr);
  return known;
}

/// Reads the table, and checks that its path, which readers use, leads to the same file as the open folder,
/// which the sweep uses.
store::SweepFile SweepState::read_table() {
  stamp_ = place_.stamp();
  store::SweepFile file = store::read_sweep(path_);
  if (place_.stamp() != stamp_ || store::OutputPath::resolve(path_).stamp() != stamp_)
    throw Error("cannot resume " + path_ +
                " (it was replaced or moved while it was read); try again when it stays in place");
  return file;
}

/// A salvaged file may lack its config: then compare its rows.
std::string SweepState::settings_that_differ(const store::SweepFile& file,
                                             const sweep::Settings& settings) const {
  if (!attribute(file.provenance, "config").empty())
    return differing_keys(stored_settings(path_, file.provenance), settings);
  const FixedValues fixed(*plan_, settings);
  for (const sweep::RunRow& row : file.rows)
    if (std::string differing = fixed.differing_keys(row); !differing.empty()) return differing;
  return "";
}

/// Adopts an existing file if its runs belong to this sweep, and keeps the file's provenance.
void SweepState::adopt(const store::SweepFile& file, const sweep::Settings& settings) {
  const std::string remedy = "; give another --output";
  for (const sweep::RunRow& row : file.rows)
    if (row.model_version != model_version)
      throw Error(
          fmt::format("cannot resume {} (its runs are of model version {}, this program's is {}: the "
                      "same parameters would give other results){}",
                      path_, row.model_version, model_version, remedy));
  const std::string differing = settings_that_differ(file, settings);
  if (!differing.empty())
    throw Error(
        fmt::format("cannot resume {} (it holds runs with other settings: {}){}", path_, differing, remedy));
  store::Provenance all = file.provenance;
  for (const char* name : {"config", "stopping_rule", "num_wanted"})
    set_attribute(all, name, attribute(provenance_, name));
  provenance_ = std::move(all);
}

/// Another sweep may have left its journal here.
void SweepState::refuse_foreign(const sweep::RunRow& record, const FixedValues& fixed) const {
  const std::string differing = fixed.differing_keys(record);
  if (!differing.empty())
    throw Error(
        fmt::format("cannot resume {} (its journal {} is of another sweep: {}); move the journal to "
                    "the table that it belongs to, or give another --output",
                    path_, journal_.path(), differing));
}

std::unique_ptr<SweepState::Entry>& SweepState::place_of(std::int64_t task) {
  const auto place = static_cast<std::size_t>(task);
  if (place >= runs_.size()) runs_.resize(place + 1);
  return runs_[place];
}

/// Runs that are not of this plan may be among other circles.
void SweepState::keep_circles(const store::SweepFile& file) {
  for (const store::CircleFile& one : file.circles)
    if (std::ranges::none_of(circles_, [&](const auto& known) { return known.circles == one.circles; }))
      circles_.push_back({"", one.circles});
}

bool SweepState::is_over(const sweep::RunRow& row) const {
  if (row.status == RunStatus::failed) return row.attempt >= attempts_;
  return !sweep::is_unfinished(row.status);
}

void SweepState::find_tasks(Known known) {
  std::int64_t last_seed = -1;
  for (const auto& [run, entry] : known)
    last_seed = std::max(last_seed, std::int64_t{entry->row.parameters.seed});
  for (std::int64_t task = 0; task < plan_->size(); ++task) {
    // Seeds that may be added later follow in increasing order: none beyond has begun yet.
    if (task >= std::max(num_wanted_, std::ssize(runs_)) &&
        (known.empty() || plan_->task(task).seed > last_seed))
      break;
    if (!known.empty())
      if (auto found = known.extract(sweep::identity(sweep::describe(plan_->task(task)))); !found.empty())
        place_of(task) = std::move(found.mapped());
    if (Entry* const run = entry(task)) {
      run->row.task = task;
      if (is_over(run->row)) continue;
      if (run->row.status == RunStatus::running) run->row.status = RunStatus::interrupted;
      past_[task].take_costs(run->row);
    }
    if (task < num_wanted_) tasks_left_.push_back(task);
  }
  for (auto& [run, entry] : known) other_runs_.push_back(std::move(entry));
  std::ranges::sort(other_runs_, {}, [](const auto& run) { return run->row.task; });
  for (std::size_t i = 0; i < other_runs_.size(); ++i) {
    sweep::RunRow& row = other_runs_[i]->row;
    row.task = plan_->size() + static_cast<std::int64_t>(i);
    if (row.status == RunStatus::running) row.status = RunStatus::interrupted;
  }
}

void SweepState::want(const std::vector<std::int64_t>& tasks) {
  num_wanted_ += static_cast<std::int64_t>(tasks.size());
  set_attribute(provenance_, "num_wanted", std::to_string(num_wanted_));
  tasks_left_.clear();
  for (const std::int64_t task : tasks)
    if (const Entry* const run = entry(task); !run || !is_over(run->row)) tasks_left_.push_back(task);
  is_published_ = false;
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
  sweep::RunRow row = sweep::describe(plan_->task(task));
  row.task = task;
  row.clogged_by = sweep::FoundBy::not_clogged;
  row.mechanism = ClogMechanism::none;
  return row;
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
  const std::lock_guard lock(changing_);
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
  changed_.insert(task);
  is_published_ = false;
  return start;
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
  changed_.insert(entry.row.task);
  is_published_ = false;
}

void SweepState::withdraw_failure(std::int64_t task) {
  Entry& entry = *runs_.at(task);
  {
    const std::lock_guard lock(changing_);
    restart(entry.row);  // a broken rank's result does not count as progress
  }
  write_down(entry);
}

void SweepState::tick() {
  // Writing the whole table takes longer the more runs there are, and the journal must be rewritten now and
  // then; they may take two percent of the time.
  const Clock::time_point now = Clock::now();
  if (publication_.valid()) {
    if (publication_.wait_for(std::chrono::seconds(0)) == std::future_status::timeout) return;
    end_publication();
    if (journal_.is_to_be_rewritten()) rewrite_journal(Records::of_unfinished_runs);
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

/// If the journal was removed or the table replaced, writes everything once more and ends the sweep. A
/// removed table is written again.
void SweepState::begin_publication() {
  const std::string there = place_.stamp();
  if (!there.empty() && there != stamp_) rescue();
  const bool has_journal = journal_.is_there();
  if (!has_journal) {
    if (!journal_.make_anew(place_)) rescue();
    rewrite_journal(Records::all);
  }
  journal_.begin();
  if (activity_)
    set_attribute(provenance_, "activity",
                  with_session(earlier_activity_, activity_->line(session_time_, seconds_so_far())));
  is_published_ = true;
  changed_.clear();
  publication_ = std::async([this, all = entries(), provenance = provenance_] {
    journal_.flush();
    return publish_to(place_, stamp_, all, provenance);
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

/// Writes the table under another name, to keep the file that somebody else has put in its place.
void SweepState::rescue() {
  if (journal_.is_there()) rewrite_journal(Records::all);
  int number = 1;
  const auto rescued = [&] { return place_.beside(fmt::format(".rescued{}", number)); };
  while (!publish_to(rescued(), "", entries(), provenance_)) ++number;
  throw Error(fmt::format(
      "cannot continue with {} (somebody has replaced it or its journal while the sweep was "
      "running); all runs are in {}: move it to where it belongs, then the same command resumes the sweep",
      path_, rescued().path()));
}

void SweepState::rewrite_journal(Records records) {
  std::vector<const Entry*> needed = entries();
  if (records == Records::of_unfinished_runs)
    std::erase_if(needed, [this](const Entry* entry) {
      return is_over(entry->row) && !changed_.contains(entry->row.task);
    });
  journal_.rewrite(needed);
}

std::string SweepState::finish() {
  publish();
  if (place_.stamp() != stamp_) publish();  // somebody has moved or removed it meanwhile
  const std::vector<const Entry*> all = entries();
  const bool is_complete =
      std::ssize(all) - std::ssize(other_runs_) >= num_wanted_ &&
      std::ranges::all_of(all, [this](const Entry* entry) { return is_over(entry->row); });
  if (!is_complete) {
    rewrite_journal(Records::of_unfinished_runs);
    return "";
  }
  const std::error_code reason = journal_.remove();
  if (!reason) return "";
  return fmt::format("cannot remove {} ({}); the sweep is complete without it: remove it", journal_.path(),
                     reason.message());
}

}  // namespace clog::results
