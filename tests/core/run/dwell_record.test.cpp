#include "clog/core/run/dwell_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace clog {
namespace {

constexpr double dwell_length = 0.05;
constexpr double speed = 0.5;  // at this speed, dwells of more than 1 t0 are recorded

/// A part of a droplet's course: the droplet rests at a place for a time. The run has one check per unit of
/// time.
struct Stand {
  double place;
  int time;
};

class Course {
 public:
  explicit Course(const std::vector<Stand>& stands) {
    for (const auto& [place, time] : stands)
      for (int i = 0; i < time; ++i) record_.add(++time_, place);
  }
  Dwells found(bool has_clogged = false) const { return record_.found(time_, has_clogged); }
  const DwellRecord& record() const { return record_; }

 private:
  DwellRecord record_{dwell_length, speed};
  double time_ = 0;
};

std::vector<double> lengths(const Dwells& dwells) {
  std::vector<double> all;
  for (const Dwell& dwell : dwells.longest)
    if (!std::isnan(dwell.length)) all.push_back(dwell.length);
  return all;
}

TEST(DwellRecord, FindsWhereAndWhenTheDropletStoodAndForHowLong) {
  // The first dwell begins at the release. Each dwell ends when the next one begins.
  const Dwells dwells = Course({{0, 3}, {1, 20}, {2, 5}, {3, 40}, {4, 7}}).found();
  EXPECT_EQ(lengths(dwells), (std::vector<double>{40, 20, 4}));
  EXPECT_EQ(dwells.longest[0].distance, 3);
  EXPECT_EQ(dwells.longest[0].begin, 29);
  EXPECT_EQ(dwells.longest[1].distance, 1);
  EXPECT_EQ(dwells.longest[1].begin, 4);
  EXPECT_EQ(dwells.longest[2].distance, 0);
  EXPECT_EQ(dwells.longest[2].begin, 0);
  EXPECT_EQ(dwells.last_distance, 4);
  EXPECT_EQ(dwells.last_begin, 69);
  EXPECT_EQ(dwells.known_from, 1);
}

TEST(DwellRecord, TellsTheFirstDwellThatWasLonger) {
  const Dwells dwells = Course({{0, 3}, {1, 20}, {2, 5}, {3, 40}, {4, 7}}).found();
  for (const auto& [time, place] : {std::pair{1.0, 0.0}, {4, 1}, {19.5, 1}, {20, 3}, {39, 3}}) {
    ASSERT_NE(dwells.first_longer(time), nullptr) << time;
    EXPECT_EQ(dwells.first_longer(time)->distance, place) << time;
  }
  EXPECT_EQ(dwells.first_longer(40), nullptr);
}

TEST(DwellRecord, CountsTheDwellUnderWayUnlessItIsAClogs) {
  const Course course({{1, 20}, {2, 500}});
  EXPECT_EQ(lengths(course.found()), (std::vector<double>{499, 20}));
  EXPECT_EQ(lengths(course.found(true)), std::vector<double>{20});
  EXPECT_EQ(course.found(true).last_distance, 2);
  EXPECT_EQ(course.found(true).last_begin, 21);
}

TEST(DwellRecord, SeesADropletThatCreepsAsStandingUntilItHasCrept) {
  DwellRecord record(dwell_length, speed);
  for (int time = 1; time <= 1000; ++time) record.add(time, time / 1024.0);
  // The droplet moves by more than 0.05 in each time of 52, so all its dwells have this length.
  EXPECT_EQ(lengths(record.found(1000, false)), std::vector<double>{52});
  EXPECT_EQ(record.found(1000, false).last_distance, 19 * 52 / 1024.0);
}

TEST(DwellRecord, ADropletThatIsPushedBackStandsWhereItWas) {
  const Dwells dwells = Course({{1, 5}, {0.5, 30}, {1.04, 10}, {2, 3}}).found();
  EXPECT_EQ(dwells.longest[0].length, 45);
  EXPECT_EQ(dwells.longest[0].distance, 1);
}

TEST(DwellRecord, OfTooManyRecordsTheEarliestAreNoLongerKnown) {
  std::vector<Stand> stands;
  for (int i = 1; i <= 11; ++i) stands.push_back({.place = 1.0 * i, .time = 10 * i});
  const Dwells dwells = Course(stands).found();  // the last dwell is unfinished
  ASSERT_EQ(lengths(dwells).size(), Dwells::most);
  EXPECT_EQ(dwells.longest.front().length, 109);
  EXPECT_EQ(dwells.longest.back().length, 40);
  EXPECT_EQ(dwells.known_from, 30);
  EXPECT_EQ(dwells.first_longer(30)->distance, 4);
}

TEST(DwellRecord, AFreeDropletHasNone) {
  DwellRecord record(dwell_length, speed);
  for (int i = 1; i <= 10'000; ++i) record.add(0.01 * i, speed * 0.01 * i);
  EXPECT_TRUE(lengths(record.found(100, false)).empty());
  EXPECT_EQ(record.found(100, false).known_from, DwellRecord::shortest * dwell_length / speed);
}

/// For any course and any time, the record must give the same answer as a list of all dwells.
TEST(DwellRecord, AgreesWithAListOfAllDwells) {
  std::mt19937 random(7);
  std::geometric_distribution<int> draw(0.02);
  for (int course = 0; course < 50; ++course) {
    DwellRecord record(dwell_length, speed);
    std::vector<Dwell> all;
    double time = 0, begin = 0;
    for (int i = 0; i < 300; ++i) {
      const double place = 0.1 * i;
      for (int stay = draw(random); stay >= 0; --stay) record.add(++time, place);
      const double end = time + 1;  // a dwell ends at the next check, except for the last dwell
      all.push_back({.length = end - begin, .distance = place, .begin = begin});
      begin = end;
    }
    all.back().length -= 1;
    const Dwells dwells = record.found(time, false);
    for (double wanted = dwells.known_from; wanted < 600; wanted += 0.5) {
      const auto first = std::ranges::find_if(all, [=](const Dwell& dwell) { return dwell.length > wanted; });
      const Dwell* found = dwells.first_longer(wanted);
      ASSERT_EQ(found != nullptr, first != all.end()) << wanted;
      if (!found) break;
      EXPECT_EQ(found->length, first->length);
      EXPECT_EQ(found->distance, first->distance);
      EXPECT_EQ(found->begin, first->begin);
    }
  }
}

TEST(DwellRecord, GoesOnFromItsBytes) {
  const Course course({{1, 20}, {2, 5}});
  ByteWriter writer;
  course.record().save(writer);
  const std::vector<std::byte> bytes = writer.take();
  ByteReader reader(bytes);
  DwellRecord restored(dwell_length, speed);
  restored.restore(reader);
  EXPECT_TRUE(reader.at_end());
  DwellRecord whole = course.record();
  for (DwellRecord* record : {&whole, &restored})
    for (int time = 26; time <= 60; ++time) record->add(time, time < 60 ? 2 : 3);
  const Dwells expected = whole.found(60, false), found = restored.found(60, false);
  EXPECT_EQ(lengths(found), lengths(expected));
  EXPECT_EQ(found.longest[0].length, 39);  // this dwell began before the bytes were written
  EXPECT_EQ(found.last_begin, expected.last_begin);
}

}  // namespace
}  // namespace clog
