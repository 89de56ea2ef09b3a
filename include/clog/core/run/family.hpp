#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "clog/core/droplet/hold.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/tools/byte_archive.hpp"
#include "clog/core/tools/words.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// How a member of a family ends. Most ends are those of a single droplet's run. A `small` member is smaller
/// than smallest-daughter and is not followed.
enum class MemberEnd { clogged, broken, passed, flowing, failed, small };
template <>
struct Words<MemberEnd> {
  static constexpr Worded<MemberEnd> all[] = {
      {MemberEnd::clogged, "clogged"}, {MemberEnd::broken, "broken"}, {MemberEnd::passed, "passed"},
      {MemberEnd::flowing, "flowing"}, {MemberEnd::failed, "failed"}, {MemberEnd::small, "small"}};
};

/// A place and a time relative to the release of the ancestor, in the ancestor's units.
struct FamilyPoint {
  double distance = 0;  ///< displacement along the flow [sigma]
  double lateral = 0;   ///< displacement across the flow [sigma]
  double time = 0;      ///< [t0]
};

/// A droplet of a family.
struct Member {
  /// Empty for the ancestor. A daughter's path is the path of its mother followed by 0 or 1.
  std::string path;
  double diameter = 1;  ///< sqrt(area of the member / area of the ancestor)
  FamilyPoint birth;
  FamilyPoint end;  ///< if the member failed: the last point where it was intact, with a `lateral` of NaN
  MemberEnd status = MemberEnd::failed;
  std::optional<ClogMechanism> mechanism = ClogMechanism::none;
};

/// Longest path of a member. Each break-up takes at least 2 % of the area, so real families stay far below
/// this limit. The parts of a droplet with a path of this length are not followed.
inline constexpr std::size_t longest_path = 64;

void save(const std::vector<Member>& members, ByteWriter& bytes);
/// @throws std::out_of_range at the end of the bytes
std::vector<Member> restore_members(ByteReader& bytes);

/// Smallest number of vertices of a daughter.
inline constexpr int fewest_vertices_of_a_daughter = 32;

/// The parameters of a daughter in its own units, in which it has the diameter 1. Lengths are divided by its
/// relative diameter d, durations by sqrt(d), and Gamma by d^2, but Gamma is at most nearly_rigid_tension.
/// The terminal speed of a droplet is proportional to its diameter to the power of speed-exponent n, so in
/// these units it is multiplied by d^(n - 1/2). The step and the stiffnesses are automatic.
/// @param ancestor  resolved
/// @param time_left  from the birth until the ancestor's max-time [t0 of the ancestor]
RunParameters daughter_parameters(const RunParameters& ancestor, double diameter, double time_left,
                                  int num_vertices);

/// The obstacles, converted to the units of a daughter.
ObstacleArray obstacles_in_units_of(const ObstacleArray& obstacles, double diameter);

/// A droplet, and with break-up=daughters all droplets into which it breaks up. They are run one after the
/// other: the ancestor, then its daughters in the order in which the program finds them.
///
/// A droplet that breaks up is cut along its neck. Each daughter takes its part of the interface, with the
/// velocities of this part. The mean distance between vertices is the same in daughter and mother. Daughters
/// do not feel each other. If the run of a daughter fails, the runs of the other members continue.
class FamilyRun {
 public:
  FamilyRun(const RunParameters& run, const std::shared_ptr<const ObstacleArray>& obstacles);
  /// @throws Error if the bytes are not a snapshot of such a run
  static FamilyRun resume(const RunParameters& run, const std::shared_ptr<const ObstacleArray>& obstacles,
                          std::span<const std::byte> snapshot);

  /// See DropletRun::advance(); the run is over when every member has ended.
  bool advance(int num_checks);
  /// The result of the ancestor.
  RunResult result() const { return ancestor_.result(); }
  /// The members that have ended; empty without break-up=daughters.
  const std::vector<Member>& members() const { return members_; }
  /// Empty before the first snapshot of the ancestor.
  std::vector<std::byte> snapshot() const;
  const DropletRun& ancestor() const { return ancestor_; }
  /// Returns the run of one member at its birth. Returns nullopt if there is no such member, or if it was not
  /// followed. Only members from which this member descends are run. This function and the next require a run
  /// that has not been advanced.
  std::optional<DropletRun> at_birth(const std::string& path) &&;
  /// Returns one member that has ended; nullopt if there is no such member.
  std::optional<Member> member(const std::string& path) &&;
  /// The droplet that moves at present, and its member.
  const DropletRun& present() const { return daughter_ ? *daughter_ : ancestor_; }
  const Member& present_member() const { return present_; }

 private:
  /// A daughter that has not begun to move.
  struct Birth {
    Member member;
    DropletState state;  ///< in the daughter's units
    int num_vertices = 0;
    double passing_distance = std::numeric_limits<double>::infinity();  ///< [sigma of the daughter]

    void save(ByteWriter& bytes) const;
    void restore(ByteReader& bytes);
  };

  RunParameters run_;
  std::shared_ptr<const ObstacleArray> obstacles_;
  DropletRun ancestor_;
  std::unique_ptr<DropletRun> daughter_;
  Member present_;
  std::optional<Birth> present_birth_;  // of the daughter
  std::deque<Birth> births_;
  std::vector<Member> members_;
  std::optional<std::string> only_;  // the wanted member

  FamilyRun(RunParameters run, std::shared_ptr<const ObstacleArray> obstacles, DropletRun ancestor);
  bool has_daughters() const { return run_.dp.break_up == BreakUp::daughters; }
  FamilyPoint point_of(const Eigen::Array2d& displacement, double time) const;
  FamilyPoint place_of_failure(const RunResult& result) const;
  bool is_followed(const std::string& path) const;
  template <class Work>
  bool succeeds(const Work& work);
  void end_present();
  void cut_present();
  bool begin_next();
  void begin(const Birth& birth, std::span<const std::byte> snapshot);
};

}  // namespace clog
