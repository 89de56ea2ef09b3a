#pragma once

#include <boost/program_options.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "clog/sweep/settings.hpp"

namespace clog::cli {

/// Command line of one program: its own options, and, if it runs droplets, every key of the config file as an
/// option, `--key=value` or `key=value`. Settings come from the defaults, then the --config file, then the
/// command line.
class CommandLine {
 public:
  enum class SweepKeys { none, accepted };

  CommandLine(std::string program, std::string usage, SweepKeys sweep_keys);

  /// Declares the program's own options; to be called before parse().
  boost::program_options::options_description_easy_init add_options() { return own_.add_options(); }
  /// Declares what a word without dashes means; at most `most` of them.
  void add_positional(const std::string& option, int most) { positional_.add(option.c_str(), most); }
  /// Declares what the first word may be instead of a file: a near miss is answered with the command meant.
  void add_commands(std::vector<std::string> names) { commands_ = std::move(names); }
  /// Declares what to say of words for which there is no place, e.g. "one sweep file is read at a time".
  void explain_surplus_words(std::string remedy) { surplus_remedy_ = std::move(remedy); }

  /// @throws Error for anything that is not understood
  void parse(int argc, const char* const* argv);

  bool has(const std::string& option) const { return values_.count(option) > 0; }
  std::string get(const std::string& option) const { return values_.at(option).as<std::string>(); }
  /// All values of an option that may be given several times.
  std::vector<std::string> get_all(const std::string& option) const;
  /// @throws Error if the option was not given
  std::string require(const std::string& option) const;
  /// @throws Error if the option's value is none of these words
  std::string get_word(const std::string& option, const std::vector<std::string>& words) const;
  /// @throws Error if the option's value is not a number between 0 and 1
  double get_share(const std::string& option) const;
  /// @throws Error if the option's value is not a number above zero
  double get_positive(const std::string& option) const;
  /// All values of a list, as of a key: `0.1,0.2` or `log(0.1,1,5)`; none if the option was not given.
  std::vector<double> get_positives(const std::string& option) const;
  /// The option's value, or the default if it was not given. @throws Error if it is not a finite number
  double get_number(const std::string& option, double fallback) const;
  const std::string& program() const { return program_; }
  const sweep::Settings& settings() const { return settings_; }
  sweep::Settings& settings() { return settings_; }
  /// The command as it was given, in one line.
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
  std::vector<std::string> commands_;
  std::string surplus_remedy_ = "options start with --, settings are key=value";
  boost::program_options::variables_map values_;
  sweep::Settings settings_;
  std::string text_;

  double number(const std::string& option) const;
  /// Is this an option whose value is the next word?
  bool awaits_value(const std::string& word) const;
  void refuse_misspelt_command(const std::string& word) const;
  [[noreturn]] void refuse_surplus_words() const;
  [[noreturn]] void refuse_unknown(const std::string& word, std::span<const char* const> typed) const;
  void read_config(const std::string& path);
};

}  // namespace clog::cli
