#include "clog/results/events.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "clog/sweep/plan.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::results {
namespace {

using nlohmann::json;

/// A sweep's file that is read again and again. Between the readings the test advances the runs.
class EventsTest : public testing::Test {
 protected:
  store::SweepFile file_ = file_of("1..3");
  Events events_{"s.h5"};

  static sweep::Settings settings_of(const std::string& seeds) {
    sweep::Settings settings;
    settings.set("seeds", seeds);
    return settings;
  }
  /// A file that contains all runs of these seeds. None of the runs has started.
  static store::SweepFile file_of(const std::string& seeds) {
    const sweep::Settings settings = settings_of(seeds);
    const sweep::Plan plan(settings);
    store::SweepFile file;
    file.provenance = {{"config", settings.to_config()}};
    for (std::int64_t task = 0; task < plan.size(); ++task) {
      file.rows.push_back(sweep::describe(plan.task(task)));
      file.rows.back().task = task;
      file.rows.back().status = RunStatus::interrupted;
    }
    return file;
  }

  void set(std::size_t task, RunStatus status, std::int64_t attempt = 1) {
    file_.rows[task].status = status;
    file_.rows[task].attempt = attempt;
    file_.rows[task].distance = 2.5;
  }
  std::vector<json> look() {
    std::vector<json> all;
    for (const std::string& line : events_.look(file_)) all.push_back(json::parse(line));
    return all;
  }
  /// The only event since the last call. Null if there is no event or more than one.
  json only() {
    const std::vector<json> all = look();
    return all.size() == 1 ? all.front() : json();
  }
  std::vector<std::string> names() {
    std::vector<std::string> all;
    for (const json& one : look()) all.push_back(one["event"]);
    return all;
  }
};

TEST_F(EventsTest, BeginWithTheNumberOfRuns) {
  set(1, RunStatus::clogged);
  const json first = only();
  ASSERT_TRUE(first.is_object());
  EXPECT_EQ(first["event"], "begin");
  EXPECT_EQ(first["runs"], 3);
  EXPECT_EQ(first["finished"], 1);
  EXPECT_TRUE(look().empty());
}

TEST_F(EventsTest, AreAStartAndAnInterruptionOfARunThatIsStopped) {
  look();
  set(0, RunStatus::running);
  EXPECT_EQ(names(), std::vector<std::string>{"start"});
  set(0, RunStatus::interrupted);
  const json stopped = only();
  ASSERT_TRUE(stopped.is_object());
  EXPECT_EQ(stopped["event"], "interrupt");
  EXPECT_EQ(stopped["task"], 0);
  EXPECT_EQ(stopped["attempt"], 1);
  EXPECT_EQ(stopped["distance"], 2.5);
  EXPECT_TRUE(look().empty());
  set(0, RunStatus::running);
  EXPECT_EQ(names(), std::vector<std::string>{"start"});
}

TEST_F(EventsTest, AreARetryAndAStartOfARunThatIsTriedAgain) {
  look();
  set(2, RunStatus::running);
  look();
  set(2, RunStatus::running, 2);
  const std::vector<json> again = look();
  ASSERT_EQ(again.size(), 2u);
  EXPECT_EQ(again[0]["event"], "retry");
  EXPECT_EQ(again[0]["task"], 2);
  EXPECT_EQ(again[0]["attempt"], 2);
  EXPECT_EQ(again[0]["seed"], 3);
  EXPECT_EQ(again[1]["event"], "start");
  set(2, RunStatus::failed, 2);
  EXPECT_EQ(names(), std::vector<std::string>{"end"});
}

TEST_F(EventsTest, AreARetryOfAFailedRunToo) {
  set(0, RunStatus::failed);
  look();
  set(0, RunStatus::clogged, 2);
  EXPECT_EQ(names(), (std::vector<std::string>{"retry", "start", "end"}));
}

TEST_F(EventsTest, AreARoundWhenTheSweepGrows) {
  look();
  set(0, RunStatus::clogged);
  look();
  const store::SweepFile larger = file_of("1..5");
  file_.provenance = larger.provenance;
  file_.rows.insert(file_.rows.end(), larger.rows.begin() + 3, larger.rows.end());
  const json grown = only();
  ASSERT_TRUE(grown.is_object());
  EXPECT_EQ(grown["event"], "round");
  EXPECT_EQ(grown["runs"], 5);
  EXPECT_EQ(grown["finished"], 1);
  EXPECT_TRUE(look().empty());
}

TEST_F(EventsTest, EndWithWhetherTheSweepIsComplete) {
  look();
  EXPECT_EQ(json::parse(events_.end())["complete"], false);
  for (const std::size_t task : {0, 1, 2}) set(task, RunStatus::flowing);
  look();
  const json end = json::parse(events_.end());
  EXPECT_EQ(end["event"], "done");
  EXPECT_EQ(end["finished"], 3);
  EXPECT_EQ(end["complete"], true);
}

}  // namespace
}  // namespace clog::results
