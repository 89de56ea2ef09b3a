#include "clog/sweep/obstacle_arrays.hpp"

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "clog/core/run/resolve.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/sweep/run_job.hpp"
#include "shared_memory.hpp"
#include "support.hpp"

namespace clog::sweep {
namespace {

/// An array that is large enough to be shared.
const ObstacleParameters large{.gap = 0.2, .diameter = 0.3, .density = {}, .box = 160};
const ObstacleParameters small{.gap = 0.2, .diameter = 0.3, .density = {}, .box = 20};

RunParameters run_in(const ObstacleParameters& obstacles, std::uint32_t seed) {
  RunParameters run;
  run.obstacles = obstacles;
  run.seed = seed;
  return run;
}

/// A seed that no other test uses at the same time. The odd number after it is not used by other tests,
/// either.
std::uint32_t own_seed() { return 2 * static_cast<std::uint32_t>(getpid()); }

ObstacleParameters lattice() {
  RunParameters run;
  run.obstacles.box = 170;
  run.obstacles.layout = ObstacleLayout::lattice;
  run.obstacles.lattice_angle = 10;
  return resolve(run).obstacles;
}

void expect_identical(const ObstacleArray& one, const ObstacleArray& other) {
  EXPECT_EQ(one.period(), other.period());
  EXPECT_EQ(one.binned().largest_radius, other.binned().largest_radius);
  EXPECT_TRUE(std::ranges::equal(one.obstacles(), other.obstacles()));
  EXPECT_TRUE(std::ranges::equal(one.binned().cell_start, other.binned().cell_start));
}

/// The device and the inode of the file that is mapped at an address, as the kernel prints them. Memory of
/// the process itself has "00:00 0".
std::string file_behind(const void* address) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    unsigned long begin = 0, end = 0;
    char device[32] = "";
    unsigned long inode = 0;
    std::sscanf(line.c_str(), "%lx-%lx %*s %*s %31s %lu", &begin, &end, device, &inode);
    const auto place = reinterpret_cast<unsigned long>(address);
    if (place >= begin && place < end) return std::string(device) + ' ' + std::to_string(inode);
  }
  return "nowhere";
}

int num_sockets(pid_t process) {
  namespace fs = std::filesystem;
  int number = 0;
  for (const fs::directory_entry& file : fs::directory_iterator("/proc/" + std::to_string(process) + "/fd")) {
    std::error_code is_closed;
    if (fs::read_symlink(file.path(), is_closed).native().starts_with("socket:")) ++number;
  }
  return number;
}

/// A child process that works, reports, and then waits until the test kills it. In this way the process
/// cannot clean up.
class OtherProcess {
 public:
  /// @param work  returns the text that the process reports
  explicit OtherProcess(const std::function<std::string()>& work) {
    int ends[2];
    if (pipe(ends) != 0) std::abort();
    process_ = fork();
    if (process_ == 0) {
      const std::string report = work() + '\n';
      if (write(ends[1], report.data(), report.size()) < 0) _exit(1);
      for (;;) pause();
    }
    close(ends[1]);
    report_ = ends[0];
  }
  OtherProcess(const OtherProcess&) = delete;
  ~OtherProcess() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    close(report_);
  }

  std::string report() const {
    std::string text;
    for (char next = 0; read(report_, &next, 1) == 1 && next != '\n';) text += next;
    return text;
  }

 private:
  pid_t process_ = -1;
  int report_ = -1;
};

TEST(ObstacleArrays, KeepsTheLastOne) {
  ObstacleArrays arrays;
  EXPECT_EQ(arrays.get(run_in(small, 1)), arrays.get(run_in(small, 1)));
  EXPECT_EQ(arrays.num_built(), 1);
  arrays.get(run_in(small, 2));
  EXPECT_EQ(arrays.num_built(), 2);
}

TEST(ObstacleArrays, AreTheSameSharedOrNot) {
  for (const ObstacleParameters& parameters :
       {large, ObstacleParameters{.gap = 0.2, .diameter = 0.3, .density = 1, .box = 160},
        ObstacleParameters{.gap = 0.2, .diameter = 0.3, .diameter_spread = 0.3, .density = {}, .box = 160},
        lattice()}) {
    ObstacleArrays builder, reader;
    const auto built = builder.get(run_in(parameters, own_seed()));
    const auto found = reader.get(run_in(parameters, own_seed()));
    EXPECT_EQ(builder.num_built(), 1);
    EXPECT_EQ(reader.num_built(), 0);
    expect_identical(*found, *built);
    expect_identical(*found, scene_of(run_in(parameters, 1)).walls(run_in(parameters, own_seed())));
  }
}

TEST(ObstacleArrays, TakesNoOtherForTheSame) {
  ObstacleArrays builder, reader;
  const auto built = builder.get(run_in(large, own_seed()));
  reader.get(run_in(large, own_seed() + 1));
  ObstacleParameters wider = large;
  wider.gap = std::nextafter(wider.gap, 1);
  reader.get(run_in(wider, own_seed()));
  EXPECT_EQ(reader.num_built(), 2);
}

TEST(ObstacleArrays, AreInMemoryOnceForAllProcesses) {
  const auto get = [seed = own_seed()] {
    ObstacleArrays arrays;
    static std::shared_ptr<const ObstacleArray> array;  // the process keeps the array until its end
    array = arrays.get(run_in(large, seed));
    return std::to_string(arrays.num_built()) + " built, in " + file_behind(array->obstacles().data());
  };
  // All processes begin at once. One of them builds the array, and the others wait for it.
  std::vector<std::unique_ptr<OtherProcess>> others(4);
  for (auto& other : others) other = std::make_unique<OtherProcess>(get);
  std::vector<std::string> reports;
  reports.reserve(others.size());
  for (const auto& other : others) reports.push_back(other->report());
  std::ranges::sort(reports);
  EXPECT_EQ(reports[0].substr(0, 2), "0 ");
  EXPECT_EQ(reports[3], '1' + reports[0].substr(1));
  EXPECT_EQ(reports[1], reports[0]);
  EXPECT_EQ(reports[2], reports[0]);
  EXPECT_EQ(reports[0].find("00:00 0"), std::string::npos) << reports[0];
}

TEST(ObstacleArrays, StayWhenTheirBuilderIsKilledAndGoWithTheLastReader) {
  const std::uint32_t seed = own_seed();
  ObstacleArrays first, second, third;
  auto builder = std::make_unique<OtherProcess>([seed] {
    static ObstacleArrays arrays;
    arrays.get(run_in(large, seed));
    return std::to_string(arrays.num_built());
  });
  ASSERT_EQ(builder->report(), "1");
  auto array = first.get(run_in(large, seed));
  builder.reset();
  second.get(run_in(large, seed));
  EXPECT_EQ(first.num_built() + second.num_built(), 0);
  expect_identical(*array, sample_obstacles(large, seed));

  array.reset();
  first.get(run_in(small, 1));
  second.get(run_in(small, 1));
  third.get(run_in(large, seed));
  EXPECT_EQ(third.num_built(), 1) << "nothing was left of it";
}

TEST(ObstacleArrays, AreBuiltByTheNextWhenTheirBuilderIsKilledAtWork) {
  const std::uint32_t seed = own_seed();
  const ObstacleParameters slow{.gap = 0.2, .diameter = 0.3, .density = {}, .box = 600};
  {
    const OtherProcess builder([&] {
      if (fork() == 0) {  // the child reports that it has begun, and is killed while it works
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        ObstacleArrays().get(run_in(slow, seed));
        _exit(0);
      }
      usleep(100'000);
      return std::string("at work");
    });
    ASSERT_EQ(builder.report(), "at work");
  }
  ObstacleArrays arrays;
  EXPECT_GT(arrays.get(run_in(slow, seed))->obstacles().size(), 900000u);
  EXPECT_EQ(arrays.num_built(), 1);
}

TEST(ObstacleArrays, AreNotWaitedForAgainAfterAWaitForNothing) {
  const std::uint32_t seed = own_seed();
  const ObstacleParameters slow{.gap = 0.2, .diameter = 0.3, .density = {}, .box = 400};
  const auto start_and_stop_builder = [&] {
    const pid_t builder = fork();
    if (builder == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      ObstacleArrays builds;
      builds.get(run_in(slow, seed));
      for (;;) pause();
    }
    // Waits until the builder has the lock.
    while (num_sockets(builder) <= num_sockets(getpid())) usleep(1000);
    kill(builder, SIGSTOP);
    return builder;
  };
  const auto get_and_signal = [&](ObstacleArrays& arrays, pid_t builder, int signal) {
    std::thread later([&] {
      usleep(300'000);
      kill(builder, signal);
    });
    arrays.get(run_in(slow, seed));
    later.join();
    kill(builder, SIGKILL);
    waitpid(builder, nullptr, 0);
  };
  ObstacleArrays arrays;
  get_and_signal(arrays, start_and_stop_builder(), SIGKILL);
  EXPECT_EQ(arrays.num_built(), 1);

  // After it has waited in vain, this process builds the next arrays itself, although their builder would
  // finish them later.
  arrays.get(run_in(small, 1));
  get_and_signal(arrays, start_and_stop_builder(), SIGCONT);
  EXPECT_EQ(arrays.num_built(), 3);

  // The process still finds a shared array that exists already. After it has found one, it waits for other
  // processes again.
  ObstacleArrays other;
  other.get(run_in(large, seed));
  arrays.get(run_in(large, seed));
  EXPECT_EQ(arrays.num_built(), 3);
  get_and_signal(arrays, start_and_stop_builder(), SIGCONT);
  EXPECT_EQ(arrays.num_built(), 3);
}

TEST(ObstacleArrays, AreWaitedForAsLongAsTheyTake) {
  using std::chrono::seconds;
  EXPECT_EQ(ObstacleArrays::longest_wait(small), seconds(10));
  ObstacleParameters huge = large;
  huge.box = 2200;
  EXPECT_GT(ObstacleArrays::longest_wait(huge), seconds(190));  // the array takes 10 s of CPU time
  ObstacleParameters huger = huge;
  huger.box = 4400;
  EXPECT_EQ(ObstacleArrays::longest_wait(huger), 4 * ObstacleArrays::longest_wait(huge));
  ObstacleParameters mixture = huge;
  mixture.diameter_spread = 0.9;
  EXPECT_GT(ObstacleArrays::longest_wait(mixture), seconds(4500));  // the array takes about 450 s
}

TEST(ObstacleArrays, AreBuiltAtOnceWhereNothingCanBeLocked) {
  ObstacleArrays other;
  const auto held = other.get(run_in(large, own_seed()));
  const OtherProcess without_files([seed = own_seed()] {
    rlimit usual;
    getrlimit(RLIMIT_NOFILE, &usual);
    // A thread lifts the limit after half a second. If the process waited that long, it would find the array
    // of the other process. The thread must begin before the limit is set, because sanitizers open a file to
    // inspect a new thread.
    std::atomic<bool> has_begun = false;
    std::thread later([&] {
      has_begun = true;
      has_begun.notify_one();
      usleep(500'000);
      setrlimit(RLIMIT_NOFILE, &usual);
    });
    has_begun.wait(false);
    const rlimit none{0, usual.rlim_max};
    setrlimit(RLIMIT_NOFILE, &none);
    const bool is_possible = NameLock("x").state() != NameLock::State::impossible;
    ObstacleArrays arrays;
    arrays.get(run_in(large, seed));
    later.join();
    return std::to_string(is_possible) + " possible, " + std::to_string(arrays.num_built()) + " built";
  });
  EXPECT_EQ(without_files.report(), "0 possible, 1 built");
}

TEST(NameLock, IsHeldByOneAtATime) {
  const std::string name = "test " + std::to_string(own_seed());
  {
    const NameLock lock(name);
    EXPECT_EQ(lock.state(), NameLock::State::held);
    EXPECT_EQ(NameLock(name).state(), NameLock::State::held_by_another);
  }
  EXPECT_EQ(NameLock(name).state(), NameLock::State::held);
}

TEST(NameLock, TellsWhetherAnotherUserHasTakenItsAddress) {
  const std::string name = "test of users " + std::to_string(own_seed());
  const auto take = [&](bool as_another) {
    return std::make_unique<OtherProcess>([&name, as_another] {
      static const NameLock lock(name);
      // /proc shows whether a process belongs to another user. Only root can start a process of another user.
      // Without root the test makes its own process look like a process of another user.
      const bool is_root = geteuid() == 0;
      constexpr uid_t nobody = 65534;
      if (as_another && is_root && setuid(nobody) != 0) return std::string("cannot become another");
      if (as_another) prctl(PR_SET_DUMPABLE, is_root ? 1 : 0);
      return std::string(lock.state() == NameLock::State::held ? "held" : "not held");
    });
  };
  for (const bool as_another : {false, true}) {
    const auto other = take(as_another);
    ASSERT_EQ(other->report(), "held");
    const NameLock lock(name);
    EXPECT_EQ(lock.state(), NameLock::State::held_by_another);
    EXPECT_EQ(lock.is_taken_by_another_user(), as_another);
  }
  EXPECT_FALSE(NameLock(name).is_taken_by_another_user()) << "nobody has it but this process";
}

TEST(RunJob, GivesTheSameRowInASharedArray) {
  // The droplet of this run travels far among obstacles, and rounding errors do not change its final state.
  const Plan plan(settings_of({{"line-tension", "0.1"},
                               {"obstacle-density", "1"},
                               {"vertices", "64"},
                               {"box", "160"},
                               {"max-time", "60"},
                               {"seeds", "1"}}));
  ObstacleArrays builder;
  const auto built = builder.get(plan.task(0));
  const auto reader = std::make_shared<ObstacleArrays>();
  RunJob job(plan.task(0), 0, {}, reader);
  while (!job.advance()) {
  }
  EXPECT_EQ(reader->num_built(), 0);
  DropletRun run(plan.task(0));
  while (!run.advance(100)) {
  }
  EXPECT_EQ(job.row().distance, run.result().distance);
  EXPECT_EQ(job.row().lateral, run.result().lateral);
  EXPECT_EQ(job.row().steps, run.result().steps);
  EXPECT_GT(run.result().distance, 1);
  EXPECT_GT(std::abs(run.result().lateral), 0.01);
}

}  // namespace
}  // namespace clog::sweep
