// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// road: measures the accuracy from readings to a cut, with and without the causes found in the
/// map. On hidden machines it compares each map's true error with its stated one; on a real scan it
/// draws marks and compares both maps with all the others. Not part of the test run; its tables are
/// in docs/map_rates.md. Same options, same table.
///
///   road --scan scan.json --draws 200           // chaintrue import optical wrote scan.json
///   road --zeros --sets 8                       // zeros that move: on the way, and between two sessions
///   road --start --sets 100                     // what the second visits of the list of start find
///   road --stated rows.txt --sets 40            // at usual sizes: stated errors against true ones
///   road --promised --sets 31                   // what owners are promised: rms, and at worst
///
/// The rows of --stated are kept: what the file has is not run again, so that a run may be stopped
/// and continued, and shards of --cause may share one file one after the other.
#include <Eigen/LU>
#include <cmath>

#include "generator/hidden/random.hpp"
#include "grid/diagnosis/causes_fit.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/observation/length_points.hpp"
#include "sealed/command/sets.hpp"
#include "sealed/judge/promised_errors.hpp"
#include "sealed/judge/stated_errors.hpp"
#include "sealed/judge/trial.hpp"

namespace {

using namespace chaintrue;

struct Arguments {
  sealed::Sets sets{.count = 40};
  bool zeros = false;
  bool start = false;
  bool promised = false;
  std::string cause;
  std::string scan;
  std::string stated;
  int draws = 200;
  int drawn_marks = 60;
};

/// Zeros that move by this much during a session; then a first session, plain, and it with a second
/// whose left zero is another, as with causes.
void print_zeros(const Arguments& arguments) {
  using generator::Cause;
  using generator::Where;
  struct Moved {
    const char* what;
    std::vector<generator::Hidden> hidden;
  };
  const Moved moved[] = {
      {"left zero by 6 mm from the 15th mark on", {{Cause::zero_shift, Where::left, 6.0, 15.0}}},
      {"left zero by 10 mm from visit 17 on", {{Cause::zero_shift, Where::left, 10.0, 17.0}}},
      {"right zero by -3 mm from visit 20 on", {{Cause::zero_shift, Where::right, -3.0, 20.0}}},
      {"nothing moves", {}}};
  std::vector<sealed::StatedRow> rows;
  const auto add = [&](const auto& run) {
    for (sealed::StatedRow& row : arguments.sets.each(run)) rows.push_back(std::move(row));
  };
  for (const Moved& own : moved) {
    generator::Recipe recipe = sealed::recipe_of_start();
    recipe.kind = own.hidden.empty() ? generator::Mix::nothing : generator::Mix::single;
    recipe.exactly = own.hidden;
    add([&](std::uint64_t seed) { return sealed::row_of_set(own.what, generator::draw_set(recipe, seed)); });
  }
  for (const double zero_mm : {5.0, 20.0, 0.0}) {
    generator::Recipe recipe = sealed::recipe_of_start();
    recipe.kind = generator::Mix::nothing;
    add([&](std::uint64_t seed) {
      const generator::SealedSet set = generator::draw_set(recipe, seed);
      const grid::MeasuredGrid first = grid::files::parse_grid(set.grid_text, "first.json").grid;
      const std::string text = sealed::another_session(set, zero_mm, seed);
      const grid::MeasuredGrid second = grid::files::parse_grid(text, "second.json").grid;
      sealed::StatedRow row;
      row.kind = fmt::format("first alone, with a second: {:g} mm", zero_mm);
      const auto alone = grid::joint_fit(first);
      const auto both = grid::joint_fit({{"first", first}, {"second", second}});
      if (alone) row.plain = sealed::map_errors(set, alone->map).value_or(sealed::MapErrors{});
      if (both) row.own = sealed::map_errors(set, both->map).value_or(sealed::MapErrors{});
      return row;
    });
  }
  fmt::print("{}", sealed::stated_table(rows));
}

/// How often changes during a session are found in readings of the list of start.
void print_start(const Arguments& arguments) {
  using generator::Cause;
  fmt::print("| hidden | strength | sessions | named alone | among those named | nothing named |\n"
             "|---|---|---|---|---|---|\n");
  for (const Cause cause : {Cause::zero_shift, Cause::drift, Cause::direction_hysteresis}) {
    if (!arguments.cause.empty() && generator::card(cause).id != arguments.cause) continue;
    for (const double strength : {7.0, 10.0, 15.0, 22.0}) {
      sealed::TrialOptions options;
      options.recipe = sealed::recipe_of_start();
      options.recipe.cause = cause;
      options.recipe.delta = strength;
      const auto trials = arguments.sets.each([&](std::uint64_t seed) { return run_trial(options, seed); });
      const auto count = [&](const auto& is_so) { return std::ranges::count_if(trials, is_so); };
      fmt::print("| {} | {:g} | {} | {} | {} | {} |\n",
                 generator::card(cause).id,
                 strength,
                 arguments.sets.count,
                 count([](const sealed::Trial& t) { return t.causes.size() == 1 && leads_right(t); }),
                 count(sealed::in_set),
                 count([](const sealed::Trial& t) { return !names_something(t); }));
      std::fflush(stdout);
    }
  }
  generator::Recipe nothing = sealed::recipe_of_start();
  nothing.kind = generator::Mix::nothing;
  const generator::SealedSet set = generator::draw_set(nothing, arguments.sets.first_seed);
  const auto yardstick =
      generator::Yardstick::make(set.machine.truth(), set.machine.visits(), set.noise, {});
  fmt::print("\n| usual size | side | strength |\n|---|---|---|\n");
  for (const generator::CauseCard& card : generator::cards()) {
    for (const generator::Where where : card.sides) {
      const generator::Hidden one[] = {
          {card.cause, where, card.usual, card.place == generator::Place::angle ? 0.8 : 16.0}};
      const auto signature = yardstick->signature(one);
      if (signature)
        fmt::print("| {} {:g} | {} | {:.1f} |\n",
                   card.id,
                   card.usual,
                   generator::word(where),
                   signature->norm());
    }
  }
}

void print_stated(const Arguments& arguments) {
  std::vector<sealed::StatedRow> rows;
  {
    std::ifstream file(arguments.stated);
    for (std::string line; std::getline(file, line);) {
      if (auto row = sealed::row_of(line)) rows.push_back(*std::move(row));
    }
  }
  std::ofstream file(arguments.stated, std::ios::app);
  for (const std::string& kind : sealed::stated_kinds()) {
    if (!arguments.cause.empty() && kind != arguments.cause) continue;
    for (int k = 0; k < arguments.sets.count; ++k) {
      const bool is_known = std::any_of(rows.begin(), rows.end(), [&](const auto& row) {
        return row.kind == kind && row.machine == k;
      });
      if (is_known) continue;
      rows.push_back(sealed::stated_row(kind, k));
      file << sealed::line_of(rows.back()) << std::endl;
    }
  }
  fmt::print("{}", sealed::stated_table(rows));
}

void print_promised(const Arguments& arguments) {
  std::vector<sealed::PromisedRow> rows;
  for (const sealed::PromisedSession& session : sealed::promised_sessions()) {
    for (auto& row : arguments.sets.each([&](std::uint64_t seed) { return sealed::promised_row(session, seed); })) {
      if (row)
        rows.push_back(*std::move(row));
      else
        fmt::print(stderr, "{}, {}: nothing is promised\n", session.machine, session.way);
    }
  }
  fmt::print("{}", sealed::promised_table(rows));
}

/// Tool's rms at the marks that a map was not made of.
double error_at(const grid::CompensationMap& map,
                const std::vector<grid::LengthPoint>& points,
                const std::vector<bool>& drawn) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (drawn[points[k].index]) continue;
    const auto answer = map.query(points[k].mark);
    if (!answer) continue;
    const Eigen::Vector2d missing(points[k].lengths.left_mm - answer->lengths.left_mm,
                                  points[k].lengths.right_mm - answer->lengths.right_mm);
    sum += (answer->mark_jacobian.inverse() * missing).squaredNorm();
    ++count;
  }
  return std::sqrt(sum / std::max(count, 1));
}

void print_scan(const Arguments& arguments) {
  const grid::MeasuredGrid whole = grid::files::read_grid(arguments.scan).grid;
  const auto points = grid::length_points(whole);
  if (!points) throw std::runtime_error(points.error().sentence());
  std::vector<double> ratios;
  int built = 0;
  for (int draw = 0; draw < arguments.draws; ++draw) {
    generator::Dice dice(arguments.sets.first_seed + static_cast<std::uint64_t>(draw), "marks of a scan");
    std::vector<bool> drawn(whole.points.size(), false);
    grid::MeasuredGrid few = whole;
    few.points.clear();
    while (static_cast<int>(few.points.size()) < arguments.drawn_marks) {
      const std::size_t k = dice.below(drawn.size());
      if (drawn[k]) continue;
      drawn[k] = true;
      few.points.push_back(whole.points[k]);
    }
    const auto plain = grid::joint_fit(few);
    const auto own = grid::diagnosis::fit_with_causes(few);
    if (!plain || !own) continue;
    built += own->built_on.empty() ? 0 : 1;
    ratios.push_back(error_at(own->fit.map, *points, drawn) / error_at(plain->map, *points, drawn));
  }
  std::sort(ratios.begin(), ratios.end());
  fmt::print("{} draws of {} marks, {} built on causes; error at the other marks over the plain map's: "
             "median {:.3f}, worst {:.3f}, best {:.3f}\n",
             ratios.size(),
             arguments.drawn_marks,
             built,
             ratios.empty() ? 0.0 : ratios[ratios.size() / 2],
             ratios.empty() ? 0.0 : ratios.back(),
             ratios.empty() ? 0.0 : ratios.front());
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Holds maps against the machines that they were measured on.");
  arguments.sets.offer(app);
  app.add_option("--cause", arguments.cause, "this effect alone");
  app.add_flag("--zeros", arguments.zeros, "zeros that move");
  app.add_flag("--start", arguments.start, "what the list of start finds, in place of maps");
  app.add_flag("--promised", arguments.promised, "errors that owners are promised");
  app.add_option("--scan", arguments.scan, "a chaintrue_grid of a real scan, in place of machines");
  app.add_option("--draws", arguments.draws, "of its marks")->check(CLI::Range(1, 100000));
  app.add_option("--drawn-marks", arguments.drawn_marks, "in each draw")->check(CLI::Range(12, 400));
  app.add_option("--stated", arguments.stated, "a file of rows, which is continued");
  app.require_option();
  return sealed::run_command(app, argc, argv, [&] {
    if (arguments.zeros) print_zeros(arguments);
    if (arguments.start) print_start(arguments);
    if (arguments.promised) print_promised(arguments);
    if (!arguments.stated.empty()) print_stated(arguments);
    if (!arguments.scan.empty()) print_scan(arguments);
  });
}
