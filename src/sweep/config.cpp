#include <fmt/core.h>

#include <charconv>
#include <sstream>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/sweep/settings.hpp"
#include "clog/sweep/value_list.hpp"

/// Settings as text, in a config file and in messages to other ranks.
namespace clog::sweep {
namespace {

constexpr const char* point_keys_line = "point-keys";
constexpr const char* point_line = "point";
constexpr const char* shard_line = "shard";
constexpr const char* usual_text = "*";  // stands for an empty text in a point
// In messages, the files of circles follow the config. For each file there is a line with its name and number
// of circles, then a line for each circle.
constexpr const char* file_mark = "#circles ";

/// The text with escaped blanks, because blanks separate texts.
std::string word_of(const std::string& text) {
  if (text.empty()) return usual_text;
  if (text == usual_text) return "\\x2a";
  std::string word;
  for (const char c : escaped(text)) word += c == ' ' ? std::string("\\x20") : std::string(1, c);
  return word;
}

std::string line_of(const char* name, const std::vector<std::string>& texts) {
  std::string line = fmt::format("{} =", name);
  for (const std::string& text : texts) line += ' ' + word_of(text);
  return line + '\n';
}

/// The texts of a line that word_of() escaped.
std::vector<std::string> texts_of_line(const std::string& line) {
  std::vector<std::string> texts;
  std::istringstream words(line);
  for (std::string word; words >> word;) texts.push_back(word == usual_text ? "" : unescaped(word));
  return texts;
}

}  // namespace

std::string escaped(const std::string& text) {
  constexpr unsigned char last_control = 0x1f, delete_character = 0x7f;
  std::string all;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const auto byte = static_cast<unsigned char>(c);
    const bool is_at_end = i == 0 || i + 1 == text.size();
    const bool is_plain =
        byte > last_control && byte != delete_character && c != '\\' && c != '#' && !(c == ' ' && is_at_end);
    all += is_plain ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
  }
  return all;
}

std::string unescaped(const std::string& text) {
  constexpr std::size_t length = 4;  // length of an escape such as \x0a
  std::string all;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    bool is_escape = text.compare(i, 2, "\\x") == 0 && text.size() - i >= length;
    if (is_escape) {
      const char* const end = text.data() + i + length;
      is_escape = std::from_chars(end - 2, end, byte, 16).ptr == end;
    }
    all += is_escape ? static_cast<char>(byte) : text[i];
    if (is_escape) i += length - 1;
  }
  return all;
}

bool Settings::is_plan_line(const std::string& name) {
  return name == point_keys_line || name == point_line || name == shard_line;
}

void Settings::set_line(const std::string& name, const std::string& text) {
  if (name == point_keys_line) {
    points_.begin(texts_of_line(text));
  } else if (name == point_line) {
    if (points_.empty())
      throw Error("a point stands before the line `point-keys = ...`, which names its keys");
    points_.add(texts_of_line(text));
  } else if (name == shard_line) {
    shard_ = Shard::from(text);
  } else {
    set(name, unescaped(text));
  }
}

Settings Settings::from_config(const std::string& text) {
  Settings settings;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const auto equals = line.find(" = ");
    if (equals == std::string::npos) throw Error(fmt::format("'{}' is not key = value", line.substr(0, 60)));
    settings.set_line(line.substr(0, equals), line.substr(equals + 3));
  }
  return settings;
}

std::string Settings::to_config(Comments comments) const {
  std::string config;
  const std::set<std::string> following = keys_that_follow();
  for (const Key& key : keys()) {
    const bool follows = following.contains(key.name);
    if (comments == Comments::help)
      config +=
          follows ? fmt::format("# {} follows from other keys\n", key.name) : fmt::format("# {}\n", key.help);
    if (!follows) config += fmt::format("{} = {}\n", key.name, escaped(text(key.name)));
  }
  if (!points_.empty()) config += line_of(point_keys_line, points_.keys);
  for (const std::vector<std::string>& row : points_.rows) config += line_of(point_line, row);
  return shard_.is_whole() ? config : config + fmt::format("{} = {}\n", shard_line, shard_.text());
}

std::string Settings::packed() const {
  std::string text = to_config();
  for (const auto& [file, circles] : circle_files_) {
    text += file_mark + escaped(file) + '\n';
    for (const Obstacle& circle : circles.circles())
      text += fmt::format("#{} {} {}\n", shortest(circle.x), shortest(circle.y), shortest(circle.radius));
  }
  return text;
}

Settings Settings::from_packed(const std::string& text) {
  Settings settings = from_config(text);
  std::istringstream in(text);
  std::string file;
  std::vector<Obstacle> circles;
  const auto finish = [&] {
    if (!file.empty()) settings.attach(file, OwnCircles(std::exchange(circles, {}), file));
  };
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(file_mark)) {
      finish();
      file = unescaped(line.substr(std::string_view(file_mark).size()));
    } else if (line.starts_with('#') && !file.empty()) {
      std::istringstream numbers(line.substr(1));
      std::string x, y, radius;
      numbers >> x >> y >> radius;
      circles.push_back({to_number(x), to_number(y), to_number(radius)});
    }
  }
  finish();
  return settings;
}

}  // namespace clog::sweep
