// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The attacks on the command, drawn one after the other from a seed, and their counts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/inputs/help.hpp"
#include "torture/mutation.hpp"
#include "torture/run.hpp"

namespace chaintrue::torture {

struct Tally {
  std::uint64_t runs = 0;
  std::uint64_t answered = 0;  ///< exit codes 0 and 1
  std::uint64_t refused = 0;   ///< 2, 3 and 4
  std::uint64_t stopped = 0;   ///< by a signal from this program
  std::uint64_t failures = 0;
  double slowest_s = 0.0;
};

class Campaign {
 public:
  /// \param failures where the inputs of a failed run are kept
  Campaign(Command command,
           std::filesystem::path fixtures,
           std::filesystem::path failures,
           std::uint64_t seed);

  /// One attack of a kind chosen by the seed.
  void attack();
  [[nodiscard]] const std::map<std::string, Tally>& tallies() const { return tallies_; }

 private:
  struct Case {
    std::string kind;
    std::vector<std::string> arguments;
    std::vector<std::string> inputs;   ///< must be unchanged afterwards
    std::vector<std::string> outputs;  ///< may exist afterwards
    bool must_be_refused = false;
  };

  void prepare(const std::filesystem::path& fixtures);
  [[nodiscard]] Case damaged_input();
  [[nodiscard]] Case tampered_file();
  [[nodiscard]] Case odd_options();
  /// A value that a user or a script may give to such an option.
  [[nodiscard]] std::string any_text(const inputs::Option& option);
  [[nodiscard]] std::string any_output(const Case& what);
  void add(const inputs::Option& option, Case& what);
  void resume_a_damaged_sweep();
  void kill_while_writing();
  void kill_a_sweep();
  void script_in_a_page();

  [[nodiscard]] std::filesystem::path at(const std::string& name) const {
    return command_.folder() / name;
  }
  void write(const std::string& name, const std::string& text) const;
  void judge(const Case& what);
  void fail(const Case& what, const std::string& why, const Ended& ended);
  void count(const std::string& kind, const Ended& ended);
  /// All files in the folder except the permanent ones.
  [[nodiscard]] std::vector<std::string> strays() const;
  void clean() const;

  Command command_;
  std::filesystem::path failures_;
  std::uint64_t seed_;
  std::uint64_t number_ = 0;
  Mutator mutate_;
  std::map<std::string, std::string> permanent_;        ///< name and content
  std::map<std::string, std::vector<inputs::Option>> options_;  ///< by verb
  std::string sweep_results_;
  std::map<std::string, Tally> tallies_;
};

}  // namespace chaintrue::torture
