#pragma once

#include <cstdint>
#include <optional>

#include "clog/core/parameters/circles.hpp"
#include "clog/core/parameters/laboratory_text.hpp"
#include "clog/core/tools/words.hpp"

namespace clog {

/// Increase this number whenever equal parameters begin to give other results. Runs of different versions
/// must not be in one table.
inline constexpr int model_version = 12;

enum class Model { dp, sp };
template <>
struct Words<Model> {
  static constexpr Worded<Model> all[] = {{Model::dp, "dp"}, {Model::sp, "sp"}};
};
/// The springs of the edges. With `rest` (as in the paper), they pull each edge towards the rest length l0;
/// with `mean`, towards the current mean edge length. With `along`, they act only along the interface: they
/// space the vertices evenly, but carry no tension.
enum class PerimeterSpring { rest, mean, along };
template <>
struct Words<PerimeterSpring> {
  static constexpr Worded<PerimeterSpring> all[] = {
      {PerimeterSpring::along, "along"}, {PerimeterSpring::mean, "mean"}, {PerimeterSpring::rest, "rest"}};
};
/// Contact between different parts of one droplet's interface.
enum class SelfContact { off, on };
template <>
struct Words<SelfContact> {
  static constexpr Worded<SelfContact> all[] = {{SelfContact::on, "on"}, {SelfContact::off, "off"}};
};
/// Whether wall friction acts only on the part of the interface next to the wall, or also, through films, on
/// the layers of the interface above this part (see WallContacts).
enum class FilmFriction { off, on };
template <>
struct Words<FilmFriction> {
  static constexpr Worded<FilmFriction> all[] = {{FilmFriction::on, "on"}, {FilmFriction::off, "off"}};
};
/// Where the droplet's weight and the drag on its mean motion act: on the vertices in equal parts (the
/// paper), or on the area, as a pressure. A pressure has no component along the interface, so it does not
/// bunch the vertices.
enum class Gravity { vertex, area };
template <>
struct Words<Gravity> {
  static constexpr Worded<Gravity> all[] = {{Gravity::area, "area"}, {Gravity::vertex, "vertex"}};
};
/// Which points of the interface a wall pushes: its vertices (the paper), or the nearest point of every edge.
enum class WallContact { vertex, edge };
template <>
struct Words<WallContact> {
  static constexpr Worded<WallContact> all[] = {{WallContact::edge, "edge"}, {WallContact::vertex, "vertex"}};
};
/// The obstacles of a run: circles placed by random sequential addition, in a tilted lattice, or by the user;
/// the two wedges of a channel; a flat wall.
enum class ObstacleLayout { random, lattice, file, channel, wall };
template <>
struct Words<ObstacleLayout> {
  static constexpr Worded<ObstacleLayout> all[] = {{ObstacleLayout::random, "random"},
                                                   {ObstacleLayout::lattice, "lattice"},
                                                   {ObstacleLayout::file, "file"},
                                                   {ObstacleLayout::channel, "channel"},
                                                   {ObstacleLayout::wall, "wall"}};
};
/// Lattices, defined by two vectors in units of the pitch. The square lattice, (1, 0) and (0, 1), and the
/// triangular lattice, (1, 0) and (1/2, sqrt(3)/2), are rotated by the tilt t. The rhombic lattice, (1, tan
/// t) and (0, 1), is not rotated. It is the sheared array of deterministic lateral displacement, in which
/// each column of posts across the flow is shifted by tan t relative to the column before it (McGrath et al.,
/// Lab Chip 14, 4139 (2014)).
enum class LatticeKind { square, triangular, rhombic };
template <>
struct Words<LatticeKind> {
  static constexpr Worded<LatticeKind> all[] = {{LatticeKind::square, "square"},
                                                {LatticeKind::triangular, "triangular"},
                                                {LatticeKind::rhombic, "rhombic"}};
};
/// Where a droplet starts among user-supplied circles: in the void nearest to the centre of the array
/// (`centre`), or near a random place, which the seed determines. The random place is in the whole array
/// (`anywhere`) or on a line across the flow (`entrance`).
enum class Release { centre, anywhere, entrance };
template <>
struct Words<Release> {
  static constexpr Worded<Release> all[] = {
      {Release::centre, "centre"}, {Release::anywhere, "anywhere"}, {Release::entrance, "entrance"}};
};
/// Straight walls along the flow at both sides of user-supplied circles.
enum class SideWalls { off, on };
template <>
struct Words<SideWalls> {
  static constexpr Worded<SideWalls> all[] = {{SideWalls::off, "off"}, {SideWalls::on, "on"}};
};
/// The condition for a clog. `threshold`: the kinetic energy is below a threshold. `certified`: a stable
/// equilibrium is proved to exist nearby (equilibrium.hpp), which is usually long before the threshold is
/// reached.
enum class ClogDetection { threshold, certified };
template <>
struct Words<ClogDetection> {
  static constexpr Worded<ClogDetection> all[] = {{ClogDetection::certified, "certified"},
                                                  {ClogDetection::threshold, "threshold"}};
};

/// What follows when a droplet breaks up: the run ends, or continues with the daughters.
enum class BreakUp { end, daughters };
template <>
struct Words<BreakUp> {
  static constexpr Worded<BreakUp> all[] = {{BreakUp::end, "end"}, {BreakUp::daughters, "daughters"}};
};

/// Half a vertex diameter, and a vertex diameter, for the published number of 256 vertices [sigma].
inline constexpr double published_contact_range = 0.00614;
inline constexpr double published_vertex_diameter = 0.01227;

/// Width of the zone near a wall in which the tension changes from Gamma to that of the wetted wall, in
/// vertex diameters. With a width of one diameter, the contact angle is wrong for any number of vertices, and
/// droplets of 128 vertices are up to 5 % too tall. With widths of two to four diameters, the shapes agree.
inline constexpr double wetting_width = 3;

/// Deformable polygon, Cheng et al. Eqs. 1-6. Reduced units, see units.hpp.
struct DpParameters {
  double line_tension = 1.0;             ///< tension Gamma of the interface [g rho sigma^2]
  std::optional<double> area_stiffness;  ///< stiffness K_a of the area [g rho / sigma]; empty: automatic
  PerimeterSpring perimeter_spring = PerimeterSpring::along;
  std::optional<double> perimeter_stiffness;  ///< stiffness K_l [g rho sigma]; empty: automatic
  double perimeter_stiffness_ratio = 1e-3;    ///< K_l divided by Gamma, for springs to the rest length
  WallContact wall_contact = WallContact::edge;
  /// Distance from a wall's surface at which contact begins [sigma]. Empty: half a vertex diameter, as
  /// published; every gap is then effectively narrower by a vertex diameter.
  std::optional<double> contact_range = 0;
  /// Tension of the interface on a wall, divided by Gamma: (gamma_so - gamma_sw)/gamma_ow, which is minus the
  /// cosine of the contact angle (Young). It is 1 if a film of water covers all walls, as in the paper's
  /// figures. If it is empty, wall_tension() computes it from the contact angles.
  std::optional<double> wall_tension;
  /// Contact angles of the droplet's fluid at which the end of a wetted arc begins to recede or to advance
  /// [degrees]. If they are empty, both are Young's angle, and walls do not hold the ends. Angles require
  /// springs `along` the interface.
  std::optional<double> receding_angle, advancing_angle;
  double friction = 0;        ///< friction coefficient mu of walls; 0 with springs `along`
  double yield_traction = 0;  ///< tau_y, force per length up to which a wall holds the interface without a
                              ///< normal force [g rho sigma]
  SelfContact self_contact = SelfContact::on;
  /// Distance below which the interface repels itself: the thickness of a film between two parts of it
  /// [sigma].
  double self_contact_range = published_vertex_diameter;
  /// If it is empty, friction acts through films whenever friction and self-contact are both on.
  std::optional<FilmFriction> film_friction;
  Gravity gravity = Gravity::area;
  std::optional<int> vertices;  ///< number N_v of vertices; empty: automatic
  /// S, the factor that multiplies the inertial mass. With a larger S, the droplet's speed follows the forces
  /// more slowly, and time steps may be sqrt(S) times as long. Weight and drag do not depend on S.
  double inertia = 1;
  /// Width of a neck below which a droplet has broken up [sigma]; 0: droplets do not break up.
  double break_up_neck = 0;
  BreakUp break_up = BreakUp::end;
  double smallest_daughter = 0.2;  ///< smaller daughters are counted and not followed [sigma]
};

/// Smallest width of a box: in a narrower box a droplet could touch its own periodic image [sigma].
inline constexpr double narrowest_period = 5;

/// The rectangle that an array repeats. It consists of square boxes in a row along the flow, or of one box
/// with a separate length along the flow.
struct Period {
  double box = 0;  ///< [sigma]
  int boxes = 1;
  double length = 0;  ///< period along the flow; 0: boxes times box [sigma]
  double beside = 0;  ///< width of an empty strip beside the box, which keeps the droplet away from the next
                      ///< periodic image of the array [sigma]

  Period() = default;
  // The constructor is implicit, because every box is a period of one box.
  Period(double edge, int number = 1) : box(edge), boxes(number) {}

  double along() const { return length > 0 ? length : boxes * box; }
  double across() const { return box + beside; }
  double area() const { return along() * box; }
  bool operator==(const Period&) const = default;
};

/// Density of a random array.
struct ObstacleDensity {
  std::optional<double> per_area;  ///< obstacles per sigma^2
  /// Fraction of the mean density of saturated arrays; resolve() converts it to per_area.
  std::optional<double> share;

  /// A saturated array: obstacles are added until no further one fits.
  ObstacleDensity() = default;
  // The constructor is implicit, because every number of obstacles per sigma^2 is a density.
  ObstacleDensity(double number_per_area) : per_area(number_per_area) {}
  static ObstacleDensity share_of_saturated(double share) {
    ObstacleDensity density;
    density.share = share;
    return density;
  }
  bool is_saturated() const { return !per_area && !share; }
  bool operator==(const ObstacleDensity&) const = default;
};

/// The share of the saturated density that reproduces lambda = 24 +- 1, which Cheng et al. publish for Gamma
/// = 1.09 and a gap of 0.2 without a density (docs/explanation/density.md).
inline constexpr double published_share_of_saturated = 0.125;

/// Periodic array of circular obstacles, Cheng et al., "Geometry".
struct ObstacleParameters {
  double gap = 0.2;            ///< smallest surface-to-surface distance w_ob [sigma]
  double diameter = 0.3;       ///< sigma_ob; for a mixture, the mean of the drawn diameters [sigma]
  double diameter_spread = 0;  ///< drawn diameters are uniform in diameter * (1 -+ spread)
  /// The density of random arrays. The density of a lattice or of user-supplied circles is not stored here.
  ObstacleDensity density = ObstacleDensity::share_of_saturated(published_share_of_saturated);
  double box = 500;  ///< period L across the flow [sigma]
  int boxes = 1;     ///< period along the flow divided by the period across it
  ObstacleLayout layout = ObstacleLayout::random;
  LatticeKind lattice = LatticeKind::square;
  double pitch = 0;                    ///< pitch of a lattice, instead of its gap; 0: diameter + gap [sigma]
  double lattice_angle = 0;            ///< angle of the lattice's rows, from +x to +y [degrees]
  std::optional<OwnCircles> own = {};  ///< circles of the layout `file`; they determine gap and density
  Release release = Release::centre;
  double length = 0;  ///< period along the flow; 0: boxes times box [sigma]
  // The members from here on apply to user-supplied circles, and use the coordinates of these circles.
  SideWalls side_walls = SideWalls::off;  ///< straight walls at y = 0 and y = box
  double entrance = 0;                    ///< x of the line on which droplets are released [sigma]
  double entrance_from = 0;               ///< y at which the line begins [sigma]
  double entrance_to = 0;                 ///< y at which the line ends; 0: at y = box [sigma]
  double exit = 0;                        ///< x at which a droplet has passed; 0: there is no exit [sigma]

  double smallest_diameter() const { return diameter * (1 - diameter_spread); }
  double spacing() const { return pitch > 0 ? pitch : diameter + gap; }
  double largest_diameter() const { return diameter * (1 + diameter_spread); }
  Period period() const {
    Period period(box, boxes);
    if (length != period.along()) period.length = length;
    return period;
  }
  bool operator==(const ObstacleParameters&) const = default;
};

/// Two wedges, tip to tip across the flow (Cheng et al., Fig. 1a). h is the distance of the centre of mass
/// from the line through the tips, positive downstream.
struct ChannelParameters {
  double orifice = 0.7;      ///< w, distance between the tips [sigma]
  double wedge_angle = 45;   ///< angle between the wedges' flanks and the flow [degrees]; 0: parallel walls
  double tip_radius = 0.03;  ///< radius of the wedges' rounded tips [sigma]
  double start = -10;        ///< h at release [sigma]
  double end = 3;            ///< h at which the run is over [sigma]
};

/// The drag on a vertex is -(zeta v + (c - 1) b_inf (v - v_cm))/N_v, with zeta = b_inf (1 + (b_0/b_inf)
/// (sigma/d)^alpha). For c = 1 this is Cheng et al. Eq. 7. The second term damps only changes of shape. The
/// drag coefficient of motion relative to the centre of mass is c b_inf.
struct DragParameters {
  double terminal_speed = 0.03;         ///< V_t [sqrt(sigma g)]; gives b_inf = M g / V_t
  double speed_exponent = 0;            ///< n: a daughter of diameter d has d^n times the V_t of the ancestor
  double near_wall = 0;                 ///< near-wall drag b_0/b_inf of polygons; soft disks have none
  double near_wall_exponent = 4.0 / 3;  ///< exponent alpha; 4/3 is calibrated in Appendix A of Cheng et al.
  double near_wall_cutoff = published_contact_range;  ///< smaller d are raised to this value [sigma]
  double relative = 1;  ///< c, the relative drag divided by b_inf; only for polygons
};

/// Everything that determines the course of one run: two runs with equal parameters are equal bit for bit.
struct RunParameters {
  Model model = Model::dp;
  DpParameters dp;
  std::optional<double> wall_stiffness;  ///< E_w [g rho sigma^3]; empty: stiffest stable value (polygons)
  ObstacleParameters obstacles;
  ChannelParameters channel;  ///< parameters of the layout `channel`
  DragParameters drag;
  std::optional<double> time_step;  ///< length of a time step [t0]; empty: automatic
  double max_time = 2e5;            ///< time at which the run ends [t0]
  std::optional<LaboratoryText> laboratory = {};
  double dwell_length = 0.05;  ///< a droplet that advances by less than this counts as resting [sigma]
  double clog_energy = 1e-17;  ///< E_k/E_t below which a droplet counts as clogged
  ClogDetection clog_detection = ClogDetection::certified;
  std::uint32_t seed = 1;
};

/// Contact stiffness k_c, force divided by overlap [g rho sigma]. The wall energy U_w = (E_w/2)(1 -
/// 2d/size)^2 gives k_c = 4 E_w / size^2, where `size` is the vertex diameter (DP) or sigma (SP).
/// wall_stiffness() is the inverse function.
inline double contact_stiffness(double wall_stiffness, double size) {
  return 4 * wall_stiffness / (size * size);
}
inline double wall_stiffness(double contact_stiffness, double size) {
  return contact_stiffness * size * size / 4;
}

}  // namespace clog
