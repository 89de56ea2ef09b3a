#include "clog/cli/command_line.hpp"

#include <fmt/core.h>

#include "clog/cli/obstacle_file.hpp"
#include "clog/cli/python_command.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "clog/console/csv.hpp"
#include "clog/console/text_file.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/excerpt.hpp"
#include "clog/core/tools/instruction_set.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::cli {
namespace {

namespace po = boost::program_options;

bool is_key(const std::string& name) {
  return std::ranges::any_of(sweep::keys(), [&](const sweep::Key& key) { return key.name == name; });
}

/// Name of the option that collects surplus words. The name contains a blank, so a user cannot give this
/// option.
constexpr const char* surplus_words = "surplus words";

/// Keys that a newcomer needs, in a useful order.
constexpr std::string_view usual_keys[] = {
    "line-tension", "obstacle-gap",  "obstacle-density", "obstacle-diameter", "seeds",          "max-time",
    "box",          "boxes",         "obstacles",        "release",           "terminal-speed", "vertices",
    "model",        "wall-stiffness"};

/// Whether this is a word like `key=value`.
bool is_assignment(const std::string& word) {
  const auto equals = word.find('=');
  return equals != std::string::npos && equals > 0 && word[0] != '-' &&
         word.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == equals;
}

/// Whether a word looks like `Key=value` with an unknown key, and is not the name of a file.
bool begins_like_key(const std::string& word) {
  const auto equals = word.find('=');
  return equals != std::string::npos && equals > 0 && word.find_first_of("./ ") > equals;
}

/// The command with this name that another program has; empty if there is none.
std::string command_elsewhere(const std::string& word) {
  static const std::map<std::string_view, std::string_view> programs = {
      {"compare", "clogfit"},   {"curve", "clogfit"},     {"lengths", "clogfit"},  {"units", "clogfit"},
      {"calibrate", "clogfit"}, {"deviation", "clogfit"}, {"drag", "clogfit"},     {"report", "clogfit"},
      {"merge", "clogsweep"},   {"select", "clogsweep"},  {"status", "clogsweep"}, {"verify", "clogsweep"},
      {"salvage", "clogsweep"}, {"replay", "clogsweep"},  {"doctor", "clogsweep"}};
  if (const auto known = programs.find(word); known != programs.end())
    return fmt::format("{} {}", known->second, word);
  return is_python_command(word) ? "python3 -m clogsweep " + word : "";
}

}  // namespace

CommandLine::CommandLine(std::string program, std::string usage, SweepKeys sweep_keys)
    : program_(std::move(program)), usage_(std::move(usage)), sweep_keys_(sweep_keys) {
  flag("help,h", "print this and leave").flag("version", "print versions and leave");
  if (sweep_keys == SweepKeys::none) return;
  option("config", "file with lines `key = value`")
      .option(
          "instruction-set",
          "of the processor, for the polygon: avx512, avx2 or baseline (the widest that the processor has). "
          "Results of different sets differ by round-off");
  const auto add = [](po::options_description& group, const sweep::Key& key) {
    group.add_options()(key.name.c_str(), po::value<std::string>(),
                        (key.help + " (" + key.default_text + ")").c_str());
  };
  for (const std::string_view name : usual_keys) add(usual_keys_, sweep::find_key(name));
  for (const sweep::Key& key : sweep::keys())
    if (std::ranges::find(usual_keys, key.name) == std::end(usual_keys)) add(keys_, key);
}

CommandLine& CommandLine::flag(const char* name, const char* help) {
  own_.add_options()(name, help);
  return *this;
}

CommandLine& CommandLine::option(const char* name, const char* help, const char* otherwise) {
  auto* const value = po::value<std::string>();
  if (otherwise) value->default_value(otherwise);
  own_.add_options()(name, value, help);
  return *this;
}

CommandLine& CommandLine::word(const char* name, const char* help) {
  words_.insert(name);
  positional_.add(name, 1);
  return option(name, help);
}

CommandLine& CommandLine::words(const char* name, const char* help) {
  words_.insert(name);
  positional_.add(name, -1);
  own_.add_options()(name, po::value<std::vector<std::string>>(), help);
  return *this;
}

void CommandLine::parse(int argc, const char* const* argv) {
  std::vector<std::string> words;
  text_ = program_;
  const int first = 1 + static_cast<int>(std::ranges::count(program_, ' '));
  for (int i = first; i < argc; ++i) {
    // `key=value` means `--key=value`, unless the option before it takes it as its value: --output a=1.h5.
    const bool is_setting = sweep_keys_ == SweepKeys::accepted && is_assignment(argv[i]) &&
                            !(i > first && awaits_value(argv[i - 1]));
    words.push_back((is_setting ? "--" : "") + std::string(argv[i]));
    text_ += std::string(" ") + argv[i];
  }
  if (!words.empty()) refuse_misspelt_command(words.front());
  po::options_description all;
  all.add(own_)
      .add(usual_keys_)
      .add(keys_)
      .add_options()(surplus_words, po::value<std::vector<std::string>>());
  po::positional_options_description places = positional_;
  if (places.max_total_count() < std::numeric_limits<unsigned>::max()) places.add(surplus_words, -1);
  try {
    const int style = po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
    po::store(po::command_line_parser(words).options(all).positional(places).style(style).run(), values_);
  } catch (const po::unknown_option& error) {
    refuse_unknown(error.get_option_name(), {argv, static_cast<std::size_t>(argc)});
  } catch (const po::error& error) {
    throw Error(std::string(error.what()) + "; see " + program_ + " --help");
  }
  if (has(surplus_words)) refuse_surplus_words();
  if (sweep_keys_ == SweepKeys::none) return;
  if (has("instruction-set")) use_instruction_set(get("instruction-set"));
  if (has("config")) read_config(get("config"));
  for (const auto& [name, value] : values_)
    if (is_key(name)) set_key(name, value.as<std::string>());
  if (has("lab")) return;  // use_laboratories() reads the circles
  for (const std::string& file : settings_.missing_files()) settings_.attach(file, read_circles(file));
}

void CommandLine::set_key(const std::string& name, const std::string& text) try {
  settings_.set(name, text);
  texts_with_units_.erase(name);
} catch (const sweep::NumberWithUnit& error) {
  if (!sweep::find_key(name).has_unit() || own_.find_nothrow("lab", false) == nullptr) throw;
  if (!has("lab"))
    throw Error(
        fmt::format("{}; --lab FILE with the droplet's diameter would give it a meaning", error.what()));
  texts_with_units_[name] = text;
}

bool CommandLine::awaits_value(const std::string& word) const {
  if (!word.starts_with("--") || word.find('=') != std::string::npos) return false;
  for (const auto* group : {&own_, &usual_keys_, &keys_}) {
    const auto* option = group->find_nothrow(word.substr(2), false);
    if (option) return option->semantic()->min_tokens() > 0;
  }
  return false;
}

void CommandLine::refuse_misspelt_command(const std::string& word) const {
  const bool is_command = std::find(commands_.begin(), commands_.end(), word) != commands_.end();
  std::error_code none;  // a word may be too long for a file's name
  if (is_command || word.starts_with('-') || std::filesystem::exists(word, none)) return;
  if (const std::string near = did_you_mean(excerpt(word), commands_); !near.empty())
    throw Error(fmt::format("unknown command '{}'; did you mean {} {}?", word, program_, near));
  if (const std::string command = commands_.empty() ? "" : command_elsewhere(word); !command.empty())
    throw Error(fmt::format("unknown command '{}'; did you mean {}?", word, command));
}

void CommandLine::refuse_surplus_words() const {
  std::string all;
  for (const std::string& word : get_all(surplus_words)) {
    // Columns have the names of keys, with `_` in place of `-`.
    const std::size_t equals = std::min(word.find('='), word.size());
    std::string key = word.substr(0, equals);
    std::replace(key.begin(), key.end(), '_', '-');
    if (sweep_keys_ == SweepKeys::accepted && is_key(key))
      throw Error(fmt::format("no place for '{}'; did you mean {}{}?", word, key,
                              equals < word.size() ? word.substr(equals) : "=VALUE"));
    if (sweep_keys_ == SweepKeys::accepted && begins_like_key(word)) refuse_unknown(word, {});
    if (sweep_keys_ == SweepKeys::accepted && word.ends_with(".cfg") && !has("config"))
      throw Error(fmt::format("no place for '{0}'; a config needs its option, --config {0}", word));
    all += (all.empty() ? "'" : ", '") + excerpt(word) + "'";
  }
  throw Error(fmt::format("no place for {} ({}); see {} --help", all, surplus_remedy_, program_));
}

void CommandLine::refuse_unknown(const std::string& word, std::span<const char* const> typed) const {
  std::vector<std::string> names;
  for (const auto* group : {&own_, &usual_keys_, &keys_})
    for (const auto& known : group->options()) names.push_back(known->long_name());
  const std::string option = excerpt(word.substr(0, word.find('=')));
  const std::string bare = option.substr(std::min(option.find_first_not_of('-'), option.size()));
  if (bare.size() < option.size() && !bare.empty() &&
      bare.find_first_not_of("0123456789.") == std::string::npos)
    throw Error(
        fmt::format("invalid {} (a negative number, and words that begin with - are options) give 0 or "
                    "more; see {} --help",
                    option, program_));
  // If the user typed no word with this beginning, parse() added the dashes to `key=value`. The message then
  // omits the dashes.
  const bool has_dashes =
      std::any_of(typed.begin(), typed.end(), [&](std::string_view one) { return one.starts_with(word); });
  std::vector<std::string> meant = sweep::meant_names(bare, names);
  if (has_dashes)
    for (std::string& name : meant) name.insert(0, "--");
  throw Error((has_dashes ? "unknown option " + option : "unknown key " + bare) +
              (meant.empty() ? fmt::format("; {} --help lists the options", program_)
                             : fmt::format("; did you mean {}?", joined(meant, " or "))));
}

/// Refuses lines of a config without a value. Boost would report them, too, but Boost 1.74 replaces %names%
/// in its message, and this replacement never ends if the line itself contains %name%.
static void refuse_lines_without_value(const std::string& path, const std::string& text) {
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::string words = console::trimmed(line.substr(0, line.find('#')));
    const bool is_section = words.starts_with('[') && words.ends_with(']');
    if (!words.empty() && !is_section && words.find('=') == std::string::npos)
      throw Error(fmt::format("{} line {}: '{}' is not key = value; comments start with #", path, number,
                              excerpt(words)));
  }
}

void CommandLine::read_config(const std::string& path) {
  const std::string text = console::read_text(path);
  refuse_lines_without_value(path, text);
  std::istringstream file(text);
  try {
    po::options_description all;
    all.add(usual_keys_).add(keys_);
    const po::parsed_options parsed = po::parse_config_file(file, all, true);
    std::set<std::string> seen;
    for (const po::option& option : parsed.options) {
      if (sweep::Settings::is_plan_line(option.string_key)) {
        settings_.set_line(option.string_key, option.value.empty() ? "" : option.value.front());
        continue;
      }
      if (!seen.insert(option.string_key).second)
        throw Error("the key " + option.string_key + " is given twice");
      if (option.value.empty() || option.value.front().empty())
        throw Error("invalid " + option.string_key + "= (has no value)");
      set_key(option.string_key, sweep::unescaped(option.value.front()));
    }
  } catch (const po::error& error) {
    throw Error(path + ": " + error.what() + "; lines are `key = value`, comments start with #");
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
}

std::vector<std::string> CommandLine::get_all(const std::string& option) const {
  return has(option) ? values_.at(option).as<std::vector<std::string>>() : std::vector<std::string>();
}

void CommandLine::refuse_missing(const std::string& option) const {
  const std::string name = words_.contains(option) ? own_.find(option, false).description() : "--" + option;
  throw Error(fmt::format("missing {}; see {} --help", name, program_));
}

std::string CommandLine::require(const std::string& option) const {
  if (!has(option)) refuse_missing(option);
  return get(option);
}

std::vector<std::string> CommandLine::require_all(const std::string& option, std::size_t least) const {
  std::vector<std::string> all = get_all(option);
  if (all.size() < least) refuse_missing(option);
  return all;
}

std::string CommandLine::get_word(const std::string& option, const std::vector<std::string>& words) const {
  std::string word = get(option);
  if (std::ranges::find(words, word) != words.end()) return word;
  throw Error(fmt::format("invalid --{}={} (is not one of {})", option, word, joined(words)));
}

double CommandLine::get_share(const std::string& option) const {
  if (const double value = get_positive(option); value < 1) return value;
  throw Error(fmt::format("invalid --{}={} (must lie between 0 and 1)", option, get(option)));
}

double CommandLine::get_positive(const std::string& option) const {
  if (const double value = number(option); value > 0) return value;
  throw Error(fmt::format("invalid --{}={} (must be a positive number)", option, get(option)));
}

std::vector<double> CommandLine::get_positives(const std::string& option, const Reworded& reworded) const {
  std::vector<double> values;
  if (!has(option)) return values;
  try {
    const std::string text = reworded ? reworded(get(option)) : get(option);
    for (const std::string& item : sweep::expand_values(text, ValueKind::number, {}))
      values.push_back(sweep::to_number(item));
  } catch (const Error& error) {
    throw Error(fmt::format("invalid --{}={} ({})", option, get(option), error.what()));
  }
  if (std::ranges::all_of(values, [](double value) { return value > 0; })) return values;
  throw Error(fmt::format("invalid --{}={} (must be positive numbers)", option, get(option)));
}

std::int64_t CommandLine::get_whole(const std::string& option, std::int64_t otherwise, std::int64_t least,
                                    std::int64_t most) const {
  if (!has(option)) return otherwise;
  const double value = number(option);
  if (value >= static_cast<double>(least) && value <= static_cast<double>(most) && value == std::floor(value))
    return static_cast<std::int64_t>(value);
  throw Error(
      fmt::format("invalid --{}={} (must be a whole number, {}..{})", option, get(option), least, most));
}

double CommandLine::number(const std::string& option) const {
  try {
    return sweep::to_number(get(option));
  } catch (const Error& error) {
    throw Error(fmt::format("invalid --{}={} ({})", option, excerpt(get(option)), error.what()));
  }
}

std::string CommandLine::help() const {
  std::ostringstream out;
  out << usage_ << "\n" << own_;
  if (sweep_keys_ == SweepKeys::accepted) out << '\n' << usual_keys_ << '\n' << keys_;
  return out.str();
}

}  // namespace clog::cli
