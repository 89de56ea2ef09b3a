#include "clog/cli/points_file.hpp"

#include <fmt/core.h>

#include <vector>

#include "clog/console/csv.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/settings.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::cli {
namespace {

void check_header(const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) try {
      sweep::find_key(cell);
    } catch (const Error& error) {
      const bool has_unit = cell.find_first_of(" [(") != std::string::npos;
      throw Error(std::string(error.what()) + (has_unit ? "; the first line names keys alone, without units"
                                                        : "; the first line names keys"));
    }
}

void check_row(const std::vector<std::string>& keys, const std::vector<std::string>& cells) {
  if (cells.size() != keys.size())
    throw Error(fmt::format("has {}, but the first line names {}",
                            sweep::counted(static_cast<std::int64_t>(cells.size()), "cell"),
                            sweep::counted(static_cast<std::int64_t>(keys.size()), "key")));
  static const sweep::Settings defaults;
  sweep::Settings scratch = defaults;
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (!cells[i].empty()) scratch.set(keys[i], cells[i]);
}

}  // namespace

sweep::Points read_points(const std::string& path) {
  sweep::Points points;
  console::read_csv(
      path,
      [&](int, const std::vector<std::string>& cells) {
        if (points.keys.empty()) {
          check_header(cells);
          points.keys = cells;
        } else {
          check_row(points.keys, cells);
          points.rows.push_back(cells);
        }
      },
      console::EmptyEnd::kept);
  if (points.rows.empty())
    throw Error(path +
                " holds no points; its first line names keys, each line that follows has a value for each");
  return points;
}

}  // namespace clog::cli
