/// The program `soundness` tests whether every droplet stays physically possible. See
/// docs/explanation/trust.md.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/signals.hpp"
#include "clog/core/droplet/release.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/sweep/plan.hpp"
#include "ending.hpp"
#include "findings.hpp"
#include "polygon/forces/reference_forces.hpp"

namespace {

using namespace clog;
using soundness::Findings;
using soundness::Tail;

constexpr const char* program = "soundness";
constexpr const char* usage =
    R"(soundness looks after droplets while they run, and says whether all stayed sound.

  soundness                                            # the whole grid
  soundness line-tension=0.02,1 obstacle-gap=0.2 obstacle-density=saturated seeds=1 max-time=300
  soundness --releases 1000                            # only releases droplets

The exit code is 0 when all were sound, 1 when one was not, 75 when it was stopped before it knew.
)";

/// Number of checks of a run between two examinations of its droplet. These checks take 2 t0 at the default
/// time step.
constexpr int checks_per_look = 32;
/// The ending of a run is judged in the last part of the run, which is this fraction of max-time.
constexpr double tail_part = 0.2;

/// CPU time of this thread [s], which excludes other work on the machine.
double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct CaseReport {
  RunParameters run;
  bool done = false;
  std::string refusal;  ///< the reason why the droplet was not released
  Findings worst;
  double unsound_since = -1;  ///< time [t0], or negative if the droplet was always sound
  RunResult result;
  /// Largest component of the force after a release, without the weight [weight of a vertex].
  double release_force = 0;
  std::optional<Tail> tail;
  double seconds = 0;  ///< CPU time of the integration, or of the release [s]

  bool is_given_up() const { return refusal.empty() && ending() == "given up"; }
  bool is_sound() const {
    return refusal.empty() && result.status != RunStatus::failed && soundness::is_sound(worst) &&
           release_force <=
               1.01 * release_force_tolerance;  // sums may be taken in another order than in the release
  }
  /// Describes the ending in a few words.
  std::string ending() const {
    if (!refusal.empty()) return "refused";
    if (result.status == RunStatus::running) return result.time > 0 ? "given up" : "released";
    if (result.status != RunStatus::flowing) return name(result.status);
    return tail ? name(tail->ending()) : "too short to tell";
  }
};

void look(const DropletRun& run, double substeps, CaseReport& report) {
  Findings findings = soundness::look_at(run.droplet().state(), run.obstacles());
  findings.substeps = substeps;
  if (report.unsound_since < 0 && !soundness::is_sound(findings)) report.unsound_since = run.time();
  report.worst.keep_worst(findings);
}

/// @param longest  limit of the CPU time, after which the run is abandoned [s]
void follow(DropletRun& run, double longest, CaseReport& report) {
  const RunParameters& parameters = report.run;
  const double check_time = DropletRun::steps_per_check * *parameters.time_step;
  soundness::TailRecorder recorder(parameters.drag.terminal_speed);
  look(run, 1, report);
  for (bool over = false; !over && report.seconds < longest && !console::stop_signalled();) {
    const bool in_tail = run.time() > (1 - tail_part) * parameters.max_time;
    const double begin_time = run.time();
    const std::int64_t begin_steps = run.droplet().num_integrated_steps();
    if (in_tail) recorder.add_place(run.droplet().state());
    for (int i = 0; i < checks_per_look && !over; ++i) {
      const double begin = cpu_seconds();
      over = run.advance(1);
      report.seconds += cpu_seconds() - begin;
      if (in_tail) recorder.add_energy(run.kinetic_energy_ratio(), check_time);
    }
    const double steps = (run.time() - begin_time) / *parameters.time_step;
    look(run, static_cast<double>(run.droplet().num_integrated_steps() - begin_steps) / steps, report);
  }
  report.tail = recorder.tail();
}

CaseReport run_case(const RunParameters& parameters, double longest) {
  CaseReport report;
  report.run = parameters;
  try {
    DropletRun run(parameters);
    follow(run, longest, report);
    report.result = run.result();
  } catch (const Error& error) {
    report.refusal = error.what();
  }
  report.done = true;
  return report;
}

/// Checks only the release and the force that remains after it.
CaseReport release_case(const RunParameters& parameters) {
  CaseReport report;
  report.run = parameters;
  const double begin = cpu_seconds();
  try {
    const ObstacleArray obstacles = sample_obstacles(parameters.obstacles, parameters.seed);
    const DropletState state = model_of(parameters).release(parameters, obstacles);
    report.worst = soundness::look_at(state, obstacles);
    test::ReferenceForces forces(parameters, obstacles);
    forces.set_weight(0);
    forces.update_contacts(state, {});
    Eigen::ArrayXd force(state.position.size());
    forces.evaluate(state, force);
    const double vertex_weight = units::droplet_mass * units::gravity / *parameters.dp.vertices;
    report.release_force = force.abs().maxCoeff() / vertex_weight;
  } catch (const Error& error) {
    report.refusal = error.what();
  }
  report.seconds = cpu_seconds() - begin;
  report.done = true;
  return report;
}

/// Works on the cases 0 .. num_cases - 1 in this order, on several threads.
template <class Work>
void for_all(std::size_t num_cases, unsigned num_threads, Work work) {
  std::atomic<std::size_t> next = 0;
  const auto work_on = [&] {
    for (std::size_t index = next++; index < num_cases && !console::stop_signalled(); index = next++)
      work(index);
  };
  std::vector<std::jthread> threads;
  for (unsigned i = 1; i < num_threads; ++i) threads.emplace_back(work_on);
  work_on();
}

double density_of(const RunParameters& run) { return run.obstacles.density.per_area.value_or(0); }

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string density_text(const RunParameters& run) {
  return run.obstacles.density.is_saturated() ? "saturated" : text("%g", density_of(run));
}

std::string describe(const CaseReport& report) {
  std::string line = "Gamma=" + text("%g", report.run.dp.line_tension) +
                     " gap=" + text("%g", report.run.obstacles.gap) + " density=" + density_text(report.run) +
                     " seed=" + std::to_string(report.run.seed) + ": " + report.ending();
  if (!report.refusal.empty()) return line + ": " + report.refusal;
  if (!report.result.message.empty()) line += ": " + report.result.message;
  if (report.unsound_since >= 0) line += "; unsound since t=" + text("%.4g", report.unsound_since);
  return line;
}

/// A Markdown table. All entries of a column have the same width.
class Table {
 public:
  explicit Table(std::vector<std::string> heads) { rows_.push_back(std::move(heads)); }
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  void print() const {
    std::vector<std::size_t> width(rows_[0].size(), 3);
    for (const auto& row : rows_)
      for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      for (std::size_t c = 0; c < width.size(); ++c)
        std::printf("| %*s ", static_cast<int>(width[c]), rows_[r][c].c_str());
      std::printf("|\n");
      if (r > 0) continue;
      for (const std::size_t w : width) std::printf("|%s:", std::string(w + 1, '-').c_str());
      std::printf("|\n");
    }
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};

std::size_t count(const std::vector<const CaseReport*>& cell, const char* ending) {
  return std::count_if(cell.begin(), cell.end(), [&](const CaseReport* r) { return r->ending() == ending; });
}

std::vector<std::string> table_row(const std::vector<const CaseReport*>& cell) {
  Findings worst;
  double seconds = 0, vertex_steps = 0;
  bool is_sound = true;
  for (const CaseReport* report : cell) {
    worst.keep_worst(report->worst);
    seconds += report->seconds;
    vertex_steps += static_cast<double>(report->result.steps) * *report->run.dp.vertices;
    is_sound = is_sound && report->is_sound();
  }
  const RunParameters& run = cell.front()->run;
  std::vector<std::string> row{text("%g", run.dp.line_tension),
                               text("%g", run.obstacles.gap),
                               density_text(run),
                               is_sound ? "yes" : "NO",
                               std::to_string(count(cell, "refused")),
                               std::to_string(count(cell, "failed")),
                               std::to_string(worst.crossings),
                               std::to_string(worst.enclosed),
                               text("%.3f", worst.overlap),
                               text("%.2g", 100 * worst.area_error),
                               text("%.1f", worst.edge_ratio),
                               text("%.2f", worst.perimeter),
                               text("%.1f", worst.shape),
                               text("%.1f", worst.substeps)};
  for (const char* ending : {"clogged", "moving", "decaying", "steady", "chattering", "given up"})
    row.push_back(std::to_string(count(cell, ending)));
  row.push_back(text("%.1f", seconds / static_cast<double>(cell.size())));
  row.push_back(vertex_steps > 0 ? text("%.1f", 1e9 * seconds / vertex_steps) : "-");
  return row;
}

/// The finished cases of each cell. @param num_groups  case i belongs to cell i % num_groups
std::vector<std::vector<const CaseReport*>> cells_of(const std::vector<CaseReport>& reports,
                                                     std::size_t num_groups) {
  std::vector<std::vector<const CaseReport*>> cells(num_groups);
  for (std::size_t i = 0; i < reports.size(); ++i)
    if (reports[i].done) cells[i % num_groups].push_back(&reports[i]);
  std::erase_if(cells, [](const auto& cell) { return cell.empty(); });
  return cells;
}

void print_table(const std::vector<CaseReport>& reports, std::size_t num_groups) {
  Table table({"Gamma",      "gap",       "density",       "sound",         "refused",       "failed",
               "crossings",  "enclosed",  "overlap/delta", "area error %",  "edges max/min", "P/(pi sigma)",
               "A",          "sub-steps", "clogged",       "moving",        "decaying",      "steady",
               "chattering", "given up",  "s/run",         "ns/vertex-step"});
  for (const auto& cell : cells_of(reports, num_groups)) table.add(table_row(cell));
  table.print();
}

void print_release_table(const std::vector<CaseReport>& reports, std::size_t num_groups) {
  Table table({"Gamma", "gap", "density", "releases", "sound", "refused", "crossings", "enclosed",
               "overlap/delta", "area error %", "edges max/min", "P/(pi sigma)", "force/tolerance",
               "s/release"});
  for (const auto& cell : cells_of(reports, num_groups)) {
    Findings worst;
    double seconds = 0, force = 0;
    for (const CaseReport* report : cell) {
      worst.keep_worst(report->worst);
      seconds += report->seconds;
      force = std::max(force, report->release_force);
    }
    const bool sound = std::all_of(cell.begin(), cell.end(), [](const auto* r) { return r->is_sound(); });
    const RunParameters& run = cell.front()->run;
    table.add({text("%g", run.dp.line_tension), text("%g", run.obstacles.gap), density_text(run),
               std::to_string(cell.size()), sound ? "yes" : "NO", std::to_string(count(cell, "refused")),
               std::to_string(worst.crossings), std::to_string(worst.enclosed), text("%.3f", worst.overlap),
               text("%.2g", 100 * worst.area_error), text("%.1f", worst.edge_ratio),
               text("%.2f", worst.perimeter), text("%.3f", force / release_force_tolerance),
               text("%.2f", seconds / static_cast<double>(cell.size()))});
  }
  table.print();
}

/// Writes a CSV file with one line for each run, for users who need more than the table.
void write_runs(std::ofstream& out, const std::string& path, const std::vector<CaseReport>& all) {
  std::vector<CaseReport> reports;
  std::copy_if(all.begin(), all.end(), std::back_inserter(reports), [](const auto& r) { return r.done; });
  out << "line_tension,gap,density,seed,ending,sound,unsound_since,crossings,enclosed,overlap,area_error,"
         "edge_ratio,perimeter,shape,substeps,distance,time,energy_ratio,tail_speed,tail_level,tail_fall,"
         "tail_band,tail_coherence,steps,seconds\n";
  for (const CaseReport& r : reports) {
    const Tail tail = r.tail.value_or(Tail{});
    out << r.run.dp.line_tension << ',' << r.run.obstacles.gap << ',' << density_text(r.run) << ','
        << r.run.seed << ',' << r.ending() << ',' << r.is_sound() << ',' << r.unsound_since << ','
        << r.worst.crossings << ',' << r.worst.enclosed << ',' << r.worst.overlap << ',' << r.worst.area_error
        << ',' << r.worst.edge_ratio << ',' << r.worst.perimeter << ',' << r.worst.shape << ','
        << r.worst.substeps << ',' << r.result.distance << ',' << r.result.time << ','
        << r.result.kinetic_energy_ratio << ',' << tail.mean_speed << ',' << tail.level << ',' << tail.fall
        << ',' << tail.band << ',' << tail.coherence << ',' << r.result.steps << ',' << r.seconds << '\n';
  }
  if (!out.flush()) throw Error("cannot write " + path);
}

/// The cases in the order of their expected duration, longest first. Runs with small line tension and narrow
/// gaps take longest, because the steps of a stretched droplet are split.
std::vector<std::size_t> longest_first(const std::vector<CaseReport>& reports) {
  std::vector<std::size_t> order(reports.size());
  std::iota(order.begin(), order.end(), 0);
  const auto cost = [&](std::size_t i) {
    const RunParameters& run = reports[i].run;
    return std::tuple(run.dp.line_tension, run.obstacles.gap, density_of(run));
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
  return order;
}

/// Runs every case and reports it on the error stream. Long cases come first.
template <class DoCase>
void do_all(std::vector<CaseReport>& reports, unsigned num_threads, DoCase do_case) {
  const std::vector<std::size_t> order = longest_first(reports);
  std::mutex mutex;
  std::size_t num_done = 0;
  for_all(order.size(), num_threads, [&](std::size_t place) {
    CaseReport report = do_case(reports[order[place]].run);
    const std::scoped_lock lock(mutex);
    std::fprintf(stderr, "%zu/%zu  %s  (%.1f s)\n", ++num_done, order.size(), describe(report).c_str(),
                 report.seconds);
    reports[order[place]] = std::move(report);
  });
}

/// Plans releases. The parameter sets take turns, and release k has the seed k + 1.
std::vector<CaseReport> planned_releases(const sweep::Plan& plan, std::int64_t num_releases) {
  std::vector<CaseReport> reports(num_releases);
  for (std::int64_t k = 0; k < num_releases; ++k) {
    reports[k].run = plan.task(k % plan.num_groups());
    reports[k].run.seed = static_cast<std::uint32_t>(k + 1);
  }
  return reports;
}

std::vector<CaseReport> planned_runs(const sweep::Plan& plan) {
  std::vector<CaseReport> reports(plan.size());
  for (std::int64_t task = 0; task < plan.size(); ++task) reports[task].run = plan.task(task);
  return reports;
}

/// Sets the default grid of cases, and parses the options.
bool parse(cli::CommandLine& line, int argc, char** argv) {
  line.option("releases", "only release so many droplets, each with a new seed")
      .option("threads", "threads to use (all cores)")
      .option("runs", "CSV file to write, one line for each run")
      .option("longest", "give a run up after so many seconds of computing");
  sweep::Settings& settings = line.settings();
  settings.set("line-tension", "0.02,0.03,0.05,0.1,0.3,1,3,10");
  settings.set("obstacle-gap", "0.2,0.35,0.5,1");
  settings.set("obstacle-density", "saturated,0.35");
  settings.set("seeds", "1..4");
  settings.set("max-time", "2000");
  settings.set("box", "100");
  if (!cli::parse_command(line, argc, argv)) return false;
  if (line.has("releases")) {  // the most difficult gap, in small boxes, which are quickly filled
    if (!line.has("obstacle-gap")) settings.set("obstacle-gap", "0.2");
    if (!line.has("obstacle-density")) settings.set("obstacle-density", "saturated");
    if (!line.has("box")) settings.set("box", "20");
  }
  for (const sweep::Key& key : sweep::keys())
    if (settings.values(key.name).size() > 1 && key.name != "line-tension" && key.name != "obstacle-gap" &&
        key.name != "obstacle-density" && key.name != "seeds")
      throw Error("invalid " + key.name + "=" + settings.text(key.name) +
                  " (the table has no column for it) " + "give one value");
  if (settings.text("model") != "dp")
    throw Error("invalid model=sp (a soft disk cannot become unsound) use dp");
  return true;
}

/// Prints how many droplets were sound. @return the exit code
int conclude(const std::vector<CaseReport>& reports) {
  const auto done = std::count_if(reports.begin(), reports.end(), [](const auto& r) { return r.done; });
  const auto sound =
      std::count_if(reports.begin(), reports.end(), [](const auto& r) { return r.done && r.is_sound(); });
  std::printf("\n%td of %td were sound", sound, done);
  const auto given_up =
      std::count_if(reports.begin(), reports.end(), [](const auto& r) { return r.done && r.is_given_up(); });
  const bool is_complete = static_cast<std::size_t>(done) == reports.size() && given_up == 0;
  if (given_up > 0) std::printf(", %td of them given up before their time", given_up);
  if (static_cast<std::size_t>(done) < reports.size())
    std::printf(", %zu were not looked at", reports.size() - done);
  std::printf(".\n");
  if (sound < done) return 1;
  return is_complete ? console::exit_success : console::exit_incomplete;
}

int body(int argc, char** argv) {
  cli::CommandLine line(program, usage, cli::CommandLine::SweepKeys::accepted);
  if (!parse(line, argc, argv)) return console::exit_success;
  const auto num_threads = static_cast<unsigned>(
      line.get_whole("threads", std::max(1U, std::thread::hardware_concurrency()), 1, 1000));
  const double longest =
      line.has("longest") ? line.get_positive("longest") : std::numeric_limits<double>::infinity();
  const sweep::Plan plan(line.settings());
  std::ofstream runs;
  if (line.has("runs")) {
    runs.open(line.get("runs"));
    if (!runs) throw Error("cannot write " + line.get("runs"));
  }
  console::catch_stop_signals();  // after a signal only finished cases are reported
  std::vector<CaseReport> reports;
  if (line.has("releases")) {
    reports = planned_releases(plan, line.get_whole("releases", 0, 1, 10'000'000));
    do_all(reports, num_threads, release_case);
    print_release_table(reports, plan.num_groups());
  } else {
    reports = planned_runs(plan);
    do_all(reports, num_threads, [=](const RunParameters& run) { return run_case(run, longest); });
    print_table(reports, plan.num_groups());
  }
  if (line.has("runs")) write_runs(runs, line.get("runs"), reports);
  return conclude(reports);
}

}  // namespace

int main(int argc, char** argv) {
  return clog::cli::run_program(program, [&] { return body(argc, argv); });
}
