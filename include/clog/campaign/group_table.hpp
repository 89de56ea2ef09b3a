#pragma once

#include <optional>
#include <string>
#include <vector>

#include "clog/campaign/groups.hpp"
#include "clog/store/run_table.hpp"

namespace clog::campaign {

/// Which of the parameters that all groups share are named above their table.
enum class SharedParameters { unusual, all };

/// The model's units in a laboratory; NaN where they are not known.
struct LaboratoryScale {
  double length = 0;   ///< of sigma [mm]
  double time = 0;     ///< of t0 [s]
  double speed = 0;    ///< of v_t [mm/s]
  double tension = 0;  ///< interfacial tension of a droplet with Gamma = 1 [mN/m]
};

/// One line per group, with what the groups differ in, for people.
/// @param lab  if it is given, here and below, lengths, speeds and times are in its units, too
std::string to_text(const std::vector<Group>& groups, double confidence, SharedParameters shared,
                    const std::optional<LaboratoryScale>& lab = {});
/// All fields of every group.
std::string to_csv(const std::vector<Group>& groups, const std::optional<LaboratoryScale>& lab = {});
/// All fields of every group, its P(r), and where the rows came from.
/// @param provenance  of the sweep
std::string to_json(const std::vector<Group>& groups, double confidence, const store::Provenance& provenance,
                    const std::optional<LaboratoryScale>& lab = {});

}  // namespace clog::campaign
