#pragma once

#include <string>
#include <vector>

namespace clog::results {

struct Group;

/// Doubts about a group's clogging length; doubt_texts explains each of them.
enum class Doubt {
  few_clogs,
  not_exponential,
  equal_distances,
  censored_by_time,
  incomplete,
  damaged,
  held_by_mesh,
  near_friction_limit,
  wetted_mesh,
  array_repeats,
  met_none,
  below_spacing,
  failures_matter,
  untested
};
/// The texts of a doubt: a letter for tables, a word for files, and a sentence for readers.
struct DoubtText {
  Doubt doubt;
  char letter;
  const char* word;
  const char* sentence;
};
inline constexpr DoubtText doubt_texts[] = {
    {Doubt::few_clogs, 'f', "few_clogs", "fewer than 5 clogs: more droplets are needed"},
    {Doubt::not_exponential, 'x', "not_exponential",
     "P(r) is not exponential (p < 0.05, corrected by Holm's method for all groups with ten clogs or more): "
     "one length does not describe these runs"},
    {Doubt::equal_distances, 'e', "equal_distances",
     "at least half of the clogs are at the distance of another clog, or at one place: copies of a droplet "
     "count as independent droplets, so the interval is too narrow (distances may also have been rounded "
     "coarsely, or one place stops most droplets)"},
    {Doubt::censored_by_time, 't', "censored_by_time",
     "runs ended by max-time: lambda is right only if slow droplets clog as often per distance as fast ones"},
    {Doubt::incomplete, 'i', "incomplete",
     "some runs are in progress or interrupted (they count as not clogged so far), or failed at an unknown "
     "distance (excluded)"},
    {Doubt::damaged, 'd', "damaged", "damaged rows were excluded (clogsweep verify lists them)"},
    {Doubt::held_by_mesh, 'm', "held_by_mesh",
     "in a tenth of the clogs or more, the polygon's edges are so long that its corners may hold the droplet "
     "(corner pinning, column mesh_hold): use more vertices"},
    {Doubt::near_friction_limit, 'h', "near_friction_limit",
     "more than 15 % of the clogs use almost all of the available friction (column friction_use), so these "
     "droplets might pass with a finer mesh; compare with twice the vertices"},
    {Doubt::wetted_mesh, 'w', "wetted_mesh",
     "the droplet wets walls (contact angle below 180 degrees): the mesh decides where some droplets clog; "
     "compare with twice the vertices"},
    {Doubt::array_repeats, 'r', "array_repeats",
     "runs went farther than boxes times box, where the array repeats: obstacles that let a droplet pass "
     "once let it pass again"},
    {Doubt::met_none, 'n', "met_none",
     "droplets met no obstacle: lambda includes their paths; lambda_met is the length of the other droplets, "
     "from their first obstacle on"},
    {Doubt::below_spacing, 'v', "below_spacing",
     "lambda is below one obstacle spacing (diameter + gap): it reflects the release void, not how often "
     "gaps clog droplets (for user-supplied circles the spacing is 1/sqrt(circles per area))"},
    {Doubt::failures_matter, 'c', "failures_matter",
     "lambda would be below its interval if all failed runs had clogged where they failed"},
    {Doubt::untested, 'u', "untested",
     "line tension, preset, vertices or obstacles are outside the range tested for soundness: droplets may "
     "cross themselves or obstacles (handbook, How far to trust it)"}};
const DoubtText& text_of(Doubt doubt);
/// These functions return the letters, the words with a space between them, and a legend. The legend is a
/// blank line, followed by a line for each kind of doubt that occurs, in the order of doubt_texts. It is
/// empty without doubts.
std::string letters_of(const std::vector<Doubt>& doubts);
std::string words_of(const std::vector<Doubt>& doubts);
std::string legend_of(const std::vector<Doubt>& doubts);

/// All doubts except Doubt::not_exponential, which depends on all groups.
std::vector<Doubt> doubts_about(const Group& group);
/// Adds Doubt::not_exponential. Copies of runs in several laboratories count as one test.
void doubt_exponentiality(std::vector<Group>& groups);

}  // namespace clog::results
