// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "generator/hidden/random.hpp"
#include "grid/observation/tape_distances.hpp"
#include "sealed/judge/holes_trial.hpp"
#include "sealed/judge/laws_trial.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Dice;
using generator::Hidden;
using generator::HiddenLaw;
using generator::HiddenMachine;
using generator::LawFamily;
using generator::TrueMachine;
using generator::Vec2;

constexpr std::size_t kColumns = 6;
constexpr std::size_t kRows = 5;
constexpr double kMotorMm = 3.0;  ///< stated sigmas of the classic machine's settings
constexpr double kZeroMm = 1.0;

/// Thirty holes row by row, each measured to its neighbours along, up and across, and four long distances.
grid::MeasuredHoles thirty_holes(Dice& dice) {
  grid::MeasuredHoles set = nine_holes();
  set.holes.clear();
  set.distances.clear();
  const auto at = [](std::size_t row, std::size_t column) { return row * kColumns + column; };
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t c = 0; c < kColumns; ++c) {
      set.holes.push_back({fmt::format("{}{}", static_cast<char>('A' + r), c + 1),
                           {-1100.0 + 440.0 * static_cast<double>(c) + dice.uniform(-15.0, 15.0),
                            -480.0 + 240.0 * static_cast<double>(r) + dice.uniform(-15.0, 15.0)}});
      if (c + 1 < kColumns) set.distances.push_back({at(r, c), at(r, c + 1)});
      if (r + 1 < kRows) set.distances.push_back({at(r, c), at(r + 1, c)});
      if (r + 1 < kRows && c + 1 < kColumns) {
        set.distances.push_back({at(r, c), at(r + 1, c + 1)});
        set.distances.push_back({at(r + 1, c), at(r, c + 1)});
      }
    }
  }
  constexpr std::size_t kTop = kRows - 1;
  constexpr std::size_t kRight = kColumns - 1;
  set.distances.push_back({at(0, 0), at(0, kRight)});
  set.distances.push_back({at(kTop, 0), at(kTop, kRight)});
  set.distances.push_back({at(0, 0), at(kTop, kRight)});
  set.distances.push_back({at(kTop, 0), at(0, kRight)});
  return set;
}

class HolesDraw {
 public:
  explicit HolesDraw(std::uint64_t seed)
      : dice_(seed, "holes with a law"),
        set_(thirty_holes(dice_)),
        truth_(generator::with_settings_off({}, 1.0, dice_)) {
    lengths_ = grid::observation::TapeDistances::in_given_order(set_)->places();
    for (std::size_t i = 0; i < set_.holes.size(); ++i) {
      const model::BedPoint& p = set_.holes[i].commanded;
      visits_.push_back({{p.x_mm, p.y_mm}, static_cast<int>(i)});
    }
    project_out_settings();
  }

  /// A law or a field of a strength of 12 to 40.
  generator::SizedLaw draw_law(LawFamily family) {
    const auto yardstick = generator::Yardstick::make(truth_, visits_, {}, {kMotorMm, kZeroMm});
    const std::vector<generator::Rival> rivals = rivals_at_usual_sizes();
    constexpr int kDraws = 200;
    for (int n = 0; n < kDraws; ++n) {
      HiddenLaw law = generator::draw_law(*yardstick, family, dice_).law;
      const double own =
          generator::unexplained(left_of(HiddenMachine(TrueMachine{}, truth_, {}), &law), rivals);
      const double times = generator::drawn_law_strength(dice_) / own;
      // A metre's rise, and what falls off within a hand's breadth of the border, where few holes are.
      const bool is_steep = is_slope(family) || family == LawFamily::drop_at_edge;
      if (!(std::abs(law.size_mm * times) < (is_steep ? 12.0 : 6.0))) continue;
      law.size_mm *= times;
      return {law, times * own};
    }
    throw std::runtime_error("holes: no law fits");
  }

  /// A cause of usual size and a strength of 3 at least.
  Hidden draw_cause() {
    constexpr int kDraws = 200;
    for (int n = 0; n < kDraws; ++n) {
      const auto& card = generator::cards()[dice_.below(generator::cards().size())];
      if (card.place != generator::Place::none) continue;
      const Hidden hidden{card.cause, card.sides[dice_.below(card.sides.size())], card.usual, 0.0};
      const HiddenMachine machine(TrueMachine{}, truth_, {hidden});
      if (left_of(machine).norm() > 3.0) return hidden;
    }
    throw std::runtime_error("holes: no cause shows");
  }

  /// Measured, with noise.
  grid::MeasuredHoles measure(const HiddenMachine& machine, const HiddenLaw* law) {
    std::vector<Vec2> places = cut(machine, law);
    for (Vec2& place : places) {
      place.x += set_.hole_sigma_mm * dice_.normal();
      place.y += set_.hole_sigma_mm * dice_.normal();
    }
    grid::MeasuredHoles set = set_;
    for (grid::HoleDistance& distance : set.distances) {
      const Vec2& a = places[distance.from];
      const Vec2& b = places[distance.to];
      distance.distance_mm = std::hypot(a.x - b.x, a.y - b.y) + set.tape.sigma_mm * dice_.normal();
    }
    return set;
  }

  const TrueMachine& truth() const { return truth_; }

 private:
  /// The law depends on the place where the hole would be without it: no place has the lengths within a step.
  std::vector<Vec2> cut(const HiddenMachine& machine, const HiddenLaw* law = nullptr) const {
    std::vector<Vec2> places;
    for (std::size_t i = 0; i < visits_.size(); ++i) {
      Vec2 place = place_reached(machine, lengths_[i].lengths, visits_[i].place);
      if (law != nullptr) {
        const std::vector<generator::Visit> visit = {{place, 0}};
        const generator::Site site =
            generator::sites_of(visit, *generator::rests(machine.truth(), visit)).front();
        const Vec2 added = generator::disturbance_of(*law).at(site);
        if (law->moves_tool) {
          place = {place.x - added.x, place.y - added.y};
        } else {
          model::ChainLengths paid_out = lengths_[i].lengths;
          paid_out.left_mm -= added.x;
          paid_out.right_mm -= added.y;
          place = place_reached(machine, paid_out, place);
        }
      }
      places.push_back(place);
    }
    return places;
  }

  Eigen::VectorXd distances(const HiddenMachine& machine, const HiddenLaw* law = nullptr) const {
    const std::vector<Vec2> places = cut(machine, law);
    Eigen::VectorXd all(static_cast<Eigen::Index>(set_.distances.size()));
    for (Eigen::Index k = 0; k < all.size(); ++k) {
      const grid::HoleDistance& own = set_.distances[static_cast<std::size_t>(k)];
      all(k) =
          std::hypot(places[own.from].x - places[own.to].x, places[own.from].y - places[own.to].y);
    }
    return all;
  }

  /// Distances are correlated where they share a hole.
  Eigen::LLT<Eigen::MatrixXd> noise() const {
    const auto n = static_cast<Eigen::Index>(set_.distances.size());
    Eigen::MatrixXd by_hole =
        Eigen::MatrixXd::Zero(n, 2 * static_cast<Eigen::Index>(visits_.size()));
    for (Eigen::Index k = 0; k < n; ++k) {
      const grid::HoleDistance& own = set_.distances[static_cast<std::size_t>(k)];
      const Vec2 a = visits_[own.from].place;
      const Vec2 b = visits_[own.to].place;
      const Eigen::Vector2d along = Eigen::Vector2d(b.x - a.x, b.y - a.y).normalized();
      by_hole.block<1, 2>(k, 2 * static_cast<Eigen::Index>(own.to)) = along.transpose();
      by_hole.block<1, 2>(k, 2 * static_cast<Eigen::Index>(own.from)) = -along.transpose();
    }
    Eigen::MatrixXd c = std::pow(set_.hole_sigma_mm, 2) * by_hole * by_hole.transpose();
    c.diagonal().array() += std::pow(set_.tape.sigma_mm, 2);
    return Eigen::LLT<Eigen::MatrixXd>(c);
  }

  void project_out_settings() {
    whitening_ = noise();
    plain_ = distances(HiddenMachine(TrueMachine{}, truth_, {}));
    constexpr double kStepMm = 0.5;
    Eigen::MatrixXd by_setting = Eigen::MatrixXd::Zero(plain_.size() + 6, 6);
    for (Eigen::Index k = 0; k < 6; ++k) {
      TrueMachine moved = truth_;
      const auto side = static_cast<std::size_t>(k % 2);
      const double sigma = k < 4 ? kMotorMm : kZeroMm;
      if (k < 2) moved.axis[side].x += kStepMm;
      if (k >= 2 && k < 4) moved.axis[side].y += kStepMm;
      if (k >= 4) moved.chain_zero_mm[side] += kStepMm;
      const Eigen::VectorXd change = distances(HiddenMachine(TrueMachine{}, moved, {})) - plain_;
      by_setting.col(k).head(plain_.size()) =
          whitening_.matrixL().solve(change) * (sigma / kStepMm);
      by_setting(plain_.size() + k, k) = 1.0;
    }
    settings_ = generator::Projection(by_setting);
  }

  /// In units of noise, a machine's change after projection on the settings.
  Eigen::VectorXd left_of(const HiddenMachine& machine, const HiddenLaw* law = nullptr) const {
    return settings_.left_of(whitening_.matrixL().solve(distances(machine, law) - plain_));
  }

  std::vector<generator::Rival> rivals_at_usual_sizes() const {
    std::vector<generator::Rival> rivals;
    for (const generator::CauseCard& card : generator::cards()) {
      if (card.place != generator::Place::none) continue;
      for (const generator::Where where : card.sides) {
        const HiddenMachine machine(TrueMachine{}, truth_, {{card.cause, where, card.usual, 0.0}});
        const Eigen::VectorXd left = left_of(machine);
        if (left.norm() > 1e-6) rivals.push_back({.basis = left.normalized()});
      }
    }
    return rivals;
  }

  Dice dice_;
  grid::MeasuredHoles set_;
  TrueMachine truth_;
  std::vector<grid::observation::Place> lengths_;
  std::vector<generator::Visit> visits_;
  Eigen::LLT<Eigen::MatrixXd> whitening_;
  Eigen::VectorXd plain_;
  generator::Projection settings_;
};

}  // namespace

Outcome run_holes_laws_trial(const std::string& kind, std::uint64_t seed) {
  HolesDraw draw(seed);
  std::vector<Hidden> causes;
  std::optional<generator::SizedLaw> law;
  if (kind == "causes") causes.push_back(draw.draw_cause());
  if (kind == "laws") law = draw.draw_law(static_cast<LawFamily>(seed % 9));
  if (kind == "two") law = draw.draw_law(LawFamily::product_of_two);
  if (kind == "gaussian") law = draw.draw_law(LawFamily::gaussian_field);
  const grid::MeasuredHoles set =
      draw.measure(HiddenMachine(TrueMachine{}, draw.truth(), causes), law ? &law->law : nullptr);
  const auto found = grid::diagnosis::diagnose(set, verdict_alone());
  Outcome outcome{.seed = seed, .points = static_cast<int>(set.distances.size())};
  for (const Hidden& cause : causes) outcome.hidden.push_back(id_of(cause));
  if (!found) outcome.fail();
  if (found) judge_laws(*found, law ? &*law : nullptr, kOfChains, outcome);
  return outcome;
}

}  // namespace chaintrue::sealed
