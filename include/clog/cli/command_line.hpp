#pragma once

#include <boost/program_options.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "clog/sweep/settings.hpp"

namespace clog::cli {

/// Command line of one program. It has the program's own options and, in a program that runs droplets, an
/// option for every key of the config file: `--key=value` or `key=value`. Settings come from the defaults,
/// then the --config file, then the command line.
class CommandLine {
 public:
  enum class SweepKeys { none, accepted };

  /// @param program  the program's name as it was called, followed by the command if there is one, as in
  /// `clogsweep merge`
  CommandLine(std::string program, std::string usage, SweepKeys sweep_keys = SweepKeys::none);

  /// Declares an option without a value. All declarations must precede parse().
  CommandLine& flag(const char* name, const char* help);
  /// Declares an option with a value. @param otherwise  the default value; nullptr: none
  CommandLine& option(const char* name, const char* help, const char* otherwise = nullptr);
  /// Declares an option whose value may also be given as a word without dashes. If several options are
  /// declared in this way, the words are assigned to them in the order of the declarations.
  CommandLine& word(const char* name, const char* help);
  /// Declares an option for all further words without dashes.
  CommandLine& words(const char* name, const char* help);
  /// Declares the commands that the first word may name instead of a file; the message about a misspelt word
  /// suggests these commands.
  void add_commands(std::vector<std::string> names) { commands_ = std::move(names); }
  /// Declares the remedy in the message about surplus words, e.g. "one sweep file is read at a time".
  void explain_surplus_words(std::string remedy) { surplus_remedy_ = std::move(remedy); }

  /// Parses the rest of the command line. @throws Error for anything that is not understood
  void parse(int argc, const char* const* argv);

  bool has(const std::string& option) const { return values_.count(option) > 0; }
  std::string get(const std::string& option) const { return values_.at(option).as<std::string>(); }
  /// All values of an option declared by words().
  std::vector<std::string> get_all(const std::string& option) const;
  /// @throws Error if the option was not given
  std::string require(const std::string& option) const;
  /// @throws Error if there are fewer values than `least`
  std::vector<std::string> require_all(const std::string& option, std::size_t least = 1) const;
  /// @throws Error if the option's value is none of these words
  std::string get_word(const std::string& option, const std::vector<std::string>& words) const;
  /// @throws Error if the option's value is not a number between 0 and 1
  double get_share(const std::string& option) const;
  /// @throws Error if the option's value is not a number above zero
  double get_positive(const std::string& option) const;
  using Reworded = std::function<std::string(const std::string& text)>;
  /// The positive numbers of an option that takes a list. The list is written like the list of a key:
  /// `0.1,0.2` or `log(0.1,1,5)`. Empty if the option was not given.
  /// @param reworded  changes the text before it is read, for instance its units; may throw Error
  /// @throws Error if a number is not above zero
  std::vector<double> get_positives(const std::string& option, const Reworded& reworded = {}) const;
  /// The option's value, or its default. @throws Error if it is not a whole number in the range
  std::int64_t get_whole(const std::string& option, std::int64_t otherwise, std::int64_t least,
                         std::int64_t most) const;
  const std::string& program() const { return program_; }
  const sweep::Settings& settings() const { return settings_; }
  sweep::Settings& settings() { return settings_; }
  /// Texts of keys with numbers that have units. settings() does not contain these texts, because their
  /// conversion needs the laboratory of --lab.
  const std::map<std::string, std::string>& texts_with_units() const { return texts_with_units_; }
  /// The command that the user gave, in one line.
  const std::string& text() const { return text_; }
  std::string help() const;

 private:
  std::string program_;
  std::string usage_;
  SweepKeys sweep_keys_;
  boost::program_options::options_description own_{"Options"};
  boost::program_options::options_description usual_keys_{
      "Keys that most sweeps set, in the config file, as key=value or as options. Numbers take a list: "
      "0.2,0.3  1..50  'lin(a,b,n)'  'log(a,b,n)'  (quotes, since shells read parentheses)"};
  boost::program_options::options_description keys_{"Keys of all else"};
  boost::program_options::positional_options_description positional_;
  std::set<std::string> words_;  // options whose value may be a word without dashes
  std::vector<std::string> commands_;
  std::string surplus_remedy_ = "options start with --, settings are key=value";
  boost::program_options::variables_map values_;
  sweep::Settings settings_;
  std::map<std::string, std::string> texts_with_units_;
  std::string text_;

  double number(const std::string& option) const;
  [[noreturn]] void refuse_missing(const std::string& option) const;
  /// Whether the word is an option that takes the next word as its value.
  bool awaits_value(const std::string& word) const;
  void refuse_misspelt_command(const std::string& word) const;
  [[noreturn]] void refuse_surplus_words() const;
  [[noreturn]] void refuse_unknown(const std::string& word, std::span<const char* const> typed) const;
  void read_config(const std::string& path);
  void set_key(const std::string& name, const std::string& text);
};

}  // namespace clog::cli
