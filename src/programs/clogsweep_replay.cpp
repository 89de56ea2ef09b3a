#include <fmt/ostream.h>

#include <cmath>
#include <iostream>
#include <optional>
#include <string>

#include "clog/console/exit_codes.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/results/repetition.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clogsweep_commands.hpp"
#include "file_command.hpp"

namespace clog::programs {
namespace {

/// The outcome in words. Excludes the distance of a run that diverged, because it is unknown.
std::string outcome(const sweep::RunRow& row) {
  const std::string status(name(row.status));
  return std::isfinite(row.distance) ? fmt::format("{}, distance {:.17g}", status, row.distance) : status;
}

/// Repeats one member of a family. Returns the exit code.
int replay_droplet(const sweep::RunRow& row, const std::string& path) {
  const Member& known = results::member_of(row, path);
  const std::optional<Member> again = results::family_of(row).member(path);
  const auto print = [&](const char* who, const Member& member) {
    fmt::print(std::cout, "{}: {}, distance {:.17g}, diameter {:.17g}\n", who, name(member.status),
               member.end.distance, member.diameter);
  };
  const std::string who = fmt::format("task {}, droplet {}", row.task, path);
  if (again)
    print(who.c_str(), *again);
  else
    fmt::print(std::cout, "{}: does not occur\n", who);
  if (again && results::are_equal(*again, known)) {
    std::cout << "the same bits as in the file\n";
    return console::exit_success;
  }
  print("differs from the file, which has", known);
  return console::exit_internal_fault;
}

}  // namespace

int clogsweep_replay(int argc, const char* const* argv) {
  cli::CommandLine line(
      "clogsweep replay",
      R"(clogsweep replay runs one task of a sweep again and compares the results bit for bit.

  clogsweep replay sweep.h5 12
  clogsweep replay sweep.h5 12 --droplet 01     one daughter, and those from which it descends

With break-up=daughters, all daughters are compared, too. The exit code is 0 if all bits are the same, 1 if
results differ, and 2 if the run cannot be replayed. The run uses the row's instruction set; a run that was
resumed with another instruction set cannot be repeated.
)");
  line.word("file", "sweep file")
      .word("task", "task, the number of a row")
      .option("droplet", "path of a daughter, as in the table of droplets");
  if (!parse_file_command(line, argc, argv)) return console::exit_success;
  const std::string path = line.require("file"), task = line.require("task");
  const store::SweepFile file = results::read_with_caution(path);
  const sweep::RunRow row = results::replayable_row(file, task);
  results::use_instruction_set_of(row);
  if (line.has("droplet")) return replay_droplet(row, line.get("droplet"));
  const auto [again, differing] = results::repeat(row);
  fmt::print(std::cout, "task {}: {}, {:.3g} s\n", task, outcome(again), again.wall_seconds);
  if (differing.empty()) {
    std::cout << "the same bits as the row's\n";
    return console::exit_success;
  }
  if (sweep::may_succeed_later(row) && again.status != RunStatus::failed)
    fmt::print(std::cout, "the row's run did not come to its end: {}\n", row.message);
  else
    fmt::print(std::cout, "differs from the row in: {}\nthe row has {}\n", joined(differing, " "),
               outcome(row));
  return console::exit_internal_fault;
}

}  // namespace clog::programs
