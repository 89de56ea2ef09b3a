#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace clog::console {

/// The text without blanks at its ends.
std::string trimmed(std::string_view text);

enum class EmptyEnd { dropped, kept };
/// Goes through a CSV file line by line; blank lines and those that begin with # say nothing. Cells are
/// without the blanks around them; an empty one at a line's end counts only if it is kept.
/// @param each  called with the number of the line, from 1, and its cells; an Error from there gets path and
/// number
/// @throws Error as read_text()
void read_csv(const std::string& path,
              const std::function<void(int number, const std::vector<std::string>& cells)>& each,
              EmptyEnd end = EmptyEnd::dropped);

}  // namespace clog::console
