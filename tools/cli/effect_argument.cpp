// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/effect_argument.hpp"

#include <fmt/format.h>

#include <charconv>

#include "grid/containers.hpp"
#include "grid/files/number_text.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::cli {
namespace {

constexpr std::string_view kForm = "id:side:key=value,key=value, with - for no side";

// Cuts `text` at its first `mark`; the rest is empty if there is none.
std::string_view take_until(std::string_view& text, char mark) {
  const std::size_t end = text.find(mark);
  const std::string_view taken = text.substr(0, end);
  text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  return taken;
}

std::optional<AppliedEffect> parse_form(const std::string& argument, OptionProblems& problems) {
  std::string_view rest = argument;
  AppliedEffect effect;
  effect.effect = take_until(rest, ':');
  effect.side = take_until(rest, ':');
  if (effect.side == "-") effect.side.clear();
  if (rest.empty()) {
    problems.add("--effect", argument, std::string(kForm), ProblemKind::bad_syntax);
    return std::nullopt;
  }
  while (!rest.empty()) {
    std::string_view value = take_until(rest, ',');
    const std::string key(take_until(value, '='));
    const auto number = files::number_of(value);
    if (!number) {
      problems.add("--effect", argument, fmt::format("a number after {}=, as in {}", key, kForm),
                   ProblemKind::not_a_number);
      return std::nullopt;
    }
    if (!effect.parameters.emplace(key, *number).second) {
      problems.add("--effect", argument, fmt::format("{} once", key), ProblemKind::repeated_key);
      return std::nullopt;
    }
  }
  return effect;
}

}  // namespace

std::vector<AppliedEffect> parse_effect_words(const Words& arguments, OptionProblems& problems) {
  std::vector<AppliedEffect> effects;
  for (const std::string& argument : arguments) {
    effects.push_back(parse_form(argument, problems).value_or(AppliedEffect{}));
  }
  return effects;
}

std::vector<AppliedEffect> parse_effects(const Words& arguments, const Machine& machine,
                                         OptionProblems& problems) {
  std::vector<AppliedEffect> effects;
  Machine with = machine;
  std::vector<const std::string*> origin(machine.effects.size(), nullptr);
  for (const std::string& argument : arguments) {
    const auto effect = parse_form(argument, problems);
    if (!effect) continue;
    effects.push_back(*effect);
    with.effects.push_back(*effect);
    origin.push_back(&argument);
  }
  for (const model::MachineProblem& problem : model::effects::problems_of_effects(with)) {
    // "/effects/3/side": 3 is the argument's number.
    std::string_view place =
        std::string_view(problem.parameter).substr(std::string_view("/effects/").size());
    const std::string_view index_text = take_until(place, '/');
    std::size_t index = 0;
    std::from_chars(index_text.data(), index_text.data() + index_text.size(), index);
    if (index < origin.size() && origin[index] != nullptr) {
      const std::string what = place.empty() ? "" : fmt::format(" ({})", place);
      problems.add("--effect",
                   problem.value.empty() ? *origin[index]
                                         : fmt::format("{} in {}", problem.value, *origin[index]),
                   problem.expected + what, ProblemKind::impossible);
    }
  }
  return effects;
}

std::optional<NamedNumber> named_number(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  const auto value = files::number_of(text.substr(equals + 1));
  if (!value) return std::nullopt;
  return NamedNumber{std::string(text.substr(0, equals)), *value};
}

}  // namespace chaintrue::cli
