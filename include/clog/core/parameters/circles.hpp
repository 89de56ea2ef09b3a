#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clog {

/// Circular obstacle: centre and radius [sigma].
struct Obstacle {
  double x = 0;
  double y = 0;
  double radius = 0;

  bool operator==(const Obstacle&) const = default;
};

/// Whether two circles have the same centre. Lists of contacts may give one centre with different rounding
/// errors; the centres of different obstacles differ by much more.
inline bool share_centre(const Obstacle& one, const Obstacle& other) {
  constexpr double rounding = 1e-6;  // [sigma]
  return std::abs(one.x - other.x) < rounding && std::abs(one.y - other.y) < rounding;
}

/// User-supplied circles. Two objects are equal if their circles are equal, whatever the names of their
/// files. A result row contains only the checksum of the circles.
class OwnCircles {
 public:
  /// @param circles  a radius of 0 means half of obstacle-diameter
  /// @param source  the origin of the circles, for messages
  /// @param droplet  diameter of the droplet for which the circles were drawn, if the source gives it [m]
  explicit OwnCircles(std::vector<Obstacle> circles, std::string source = "",
                      std::optional<double> droplet = {});
  /// Circles known only by their checksum. @throws Error  if the text does not have the form of check_sum()
  static OwnCircles from_check_sum(std::string_view text);

  /// CRC-64/XZ of the circles' coordinates and radii, in their order: 16 hexadecimal digits.
  std::string check_sum() const;
  const std::string& source() const { return source_; }
  std::optional<double> droplet() const { return droplet_; }
  bool are_known() const { return circles_ != nullptr; }
  /// @throws Error if only their checksum is known
  const std::vector<Obstacle>& circles() const;
  /// The circles, each with a radius.
  /// @param missing  radius for circles that have none [sigma]
  /// @throws Error if only their checksum is known
  std::vector<Obstacle> with_radii(double missing) const;

  bool operator==(const OwnCircles& other) const { return check_sum_ == other.check_sum_; }

 private:
  std::uint64_t check_sum_;
  std::shared_ptr<const std::vector<Obstacle>> circles_;
  std::string source_;
  std::optional<double> droplet_;

  explicit OwnCircles(std::uint64_t check_sum) : check_sum_(check_sum) {}
};

}  // namespace clog
