#include <iostream>
#include <string>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/cli/program.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/printable.hpp"
#include "clog/diagnostics/examination.hpp"
#include "clog/store/output_path.hpp"
#include "clogsweep_commands.hpp"

namespace clog::programs {
namespace {

using diagnostics::Finding;
using diagnostics::RankFacts;

constexpr const char* doctor_name = "clogsweep doctor";
constexpr const char* doctor_usage =
    R"(clogsweep doctor checks this machine for problems of sweeps, and prints remedies.

  clogsweep doctor
  mpirun -np 4 clogsweep doctor --output results/sweep.h5    for a sweep that you will start in this way

The exit code is 1 if there is a problem.
)";

/// Returns the exit code.
int print_findings(const std::vector<Finding>& findings) {
  bool is_well = true;
  for (const Finding& finding : findings) {
    std::cout << (finding.remedy.empty() ? "ok    " : "MEND  ") << console::printable(finding.what) << '\n';
    if (!finding.remedy.empty()) std::cout << "      " << console::printable(finding.remedy) << '\n';
    is_well = is_well && finding.remedy.empty();
  }
  return is_well ? console::exit_success : console::exit_internal_fault;
}

}  // namespace

int clogsweep_doctor(const scheduler::Communicator& ranks, int argc, const char* const* argv) {
  // Rank 0 reads the command line; the other ranks wait for its result.
  cli::CommandLine line(doctor_name, doctor_usage);
  line.option("output", "file that the sweep will write", "sweep.h5");
  bool is_answered = false;
  int exit_code = console::exit_success;
  if (ranks.rank() == 0)
    exit_code = cli::run_program(doctor_name, [&] {
      is_answered = !cli::parse_command(line, argc, argv);
      store::require_regular(line.get("output"));
      return console::exit_success;
    });
  const bool is_over = is_answered || exit_code != console::exit_success;
  if (ranks.broadcast(int{is_over}) != 0) return exit_code;

  constexpr double seconds_of_steps = 0.5;
  const std::vector<std::string> texts =
      ranks.gather(to_text(diagnostics::find_rank_facts(ranks.rank(), seconds_of_steps)));
  if (ranks.rank() != 0) return console::exit_success;
  std::vector<RankFacts> facts;
  facts.reserve(texts.size());
  for (const std::string& text : texts) facts.push_back(diagnostics::rank_facts_from(text));
  return cli::run_program(doctor_name,
                          [&] { return print_findings(diagnostics::examine(facts, line.get("output"))); });
}

}  // namespace clog::programs
