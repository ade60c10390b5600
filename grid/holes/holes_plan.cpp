// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation: x, unknowns (the machine's eight, then each hole's own error); S, their covariance; a,
/// a distance's derivative by x; M, d(place)/d(machine's unknowns); C, the criterion's matrix.
#include "grid/holes/holes_plan.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "grid/holes/seen_effects.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;
using ByMachine = Eigen::Matrix<double, 2, kHolesUnknowns>;

/// Holes nearer than this to each other weaken the sheet and tell little.
constexpr double kLeastApartMm = 150.0;
/// How far holes reach between rows and columns of places that are tried.
constexpr int kColumns = 9;
constexpr int kRows = 5;

/// M at a place; nothing where the machine has no pose.
std::optional<ByMachine> by_machine(const model::ReadingModel& model, BedPoint place) {
  const auto reading = model.at(place);
  if (!reading) return std::nullopt;
  ByMachine lengths;
  for (std::size_t i = 0; i < model::kMachineSettings.size(); ++i) {
    lengths.col(static_cast<Eigen::Index>(i)) =
        model.sensitivity(*reading, model::kMachineSettings[i]);
  }
  lengths.col(6) = Eigen::Vector2d(reading->lengths.left_mm, 0.0);
  lengths.col(7) = Eigen::Vector2d(0.0, reading->lengths.right_mm);
  return ByMachine(-reading->position_jacobian.inverse() * lengths);
}

/// C: mean squared motion of the tool over the bed, less what laying the sheet takes up.
Eigen::MatrixXd criterion(const model::Machine& machine) {
  constexpr int kAcross = 13;
  constexpr int kUp = 7;
  const model::ReadingModel model(machine);
  std::vector<ByMachine> rows;
  std::vector<BedPoint> places;
  for (int iy = 0; iy < kUp; ++iy) {
    for (int ix = 0; ix < kAcross; ++ix) {
      const BedPoint place{machine.bed.width_mm * ((ix + 0.5) / kAcross - 0.5),
                           machine.bed.height_mm * ((iy + 0.5) / kUp - 0.5)};
      if (const auto row = by_machine(model, place)) {
        rows.push_back(*row);
        places.push_back(place);
      }
    }
  }
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd motion(2 * count, kHolesUnknowns);
  Eigen::MatrixXd rigid = Eigen::MatrixXd::Zero(2 * count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    motion.middleRows(2 * i, 2) = rows[at];
    rigid(2 * i, 0) = rigid(2 * i + 1, 1) = 1.0;
    rigid(2 * i, 2) = -1e-3 * places[at].y_mm;
    rigid(2 * i + 1, 2) = 1e-3 * places[at].x_mm;
  }
  motion -= rigid * rigid.colPivHouseholderQr().solve(motion);
  return motion.transpose() * motion / static_cast<double>(std::max<Eigen::Index>(count, 1));
}

struct Candidate {
  BedPoint place;
  ByMachine by_machine;
};

using Pair = std::pair<std::size_t, std::size_t>;

/// Chooses distances between given holes.
class Chooser {
 public:
  Chooser(const HolesPlanRequest& request,
          const Eigen::MatrixXd& prior,
          const Eigen::MatrixXd& criterion)
      : request_(request), prior_(prior), criterion_(criterion) {}

  struct Choice {
    std::vector<Pair> pairs;
    Eigen::MatrixXd covariance;  ///< of the machine's unknowns
    double variance_mm2 = 0.0;
  };

  [[nodiscard]] Choice greedy(const std::vector<const Candidate*>& holes) const {
    const std::vector<Pair> all = pairs_of(holes);
    Eigen::MatrixXd s = covariance_before(holes.size());
    std::vector<Pair> chosen;
    std::vector<bool> taken(all.size(), false);
    std::vector<Eigen::VectorXd> rows;
    for (const Pair& pair : all) rows.push_back(row_of(holes, pair));
    const auto wanted = static_cast<std::size_t>(distances_of(request_));
    while (chosen.size() < std::min(wanted, all.size())) {
      std::size_t best = all.size();
      double best_gain = -1.0;
      for (std::size_t k = 0; k < all.size(); ++k) {
        if (taken[k]) continue;
        const Eigen::VectorXd sa = s * rows[k];
        const Eigen::VectorXd head = sa.head(kHolesUnknowns);
        const double gain = head.dot(criterion_ * head) / (tape2() + rows[k].dot(sa));
        if (gain <= best_gain) continue;
        best_gain = gain;
        best = k;
      }
      taken[best] = true;
      chosen.push_back(all[best]);
      measure(s, rows[best]);
    }
    return choice(std::move(chosen), s);
  }

  /// Exchanges single distances as long as one helps.
  [[nodiscard]] Choice exchange(const std::vector<const Candidate*>& holes, Choice choice_) const {
    const std::vector<Pair> all = pairs_of(holes);
    constexpr int kSweeps = 5;
    constexpr double kWorthwhile = 1e-6;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      bool moved = false;
      for (std::size_t i = 0; i < choice_.pairs.size(); ++i) {
        for (const Pair& other : all) {
          if (std::find(choice_.pairs.begin(), choice_.pairs.end(), other) != choice_.pairs.end())
            continue;
          std::vector<Pair> pairs = choice_.pairs;
          pairs[i] = other;
          Choice next = evaluate(holes, std::move(pairs));
          if (next.variance_mm2 >= choice_.variance_mm2 * (1.0 - kWorthwhile)) continue;
          choice_ = std::move(next);
          moved = true;
        }
      }
      if (!moved) break;
    }
    return choice_;
  }

 private:
  [[nodiscard]] double tape2() const { return request_.tape_sigma_mm * request_.tape_sigma_mm; }

  [[nodiscard]] Eigen::MatrixXd covariance_before(std::size_t holes) const {
    const Eigen::Index size = kHolesUnknowns + 2 * static_cast<Eigen::Index>(holes);
    Eigen::MatrixXd s = Eigen::MatrixXd::Zero(size, size);
    s.diagonal().setConstant(request_.hole_sigma_mm * request_.hole_sigma_mm);
    s.topLeftCorner(kHolesUnknowns, kHolesUnknowns) = prior_;
    return s;
  }

  [[nodiscard]] std::vector<Pair> pairs_of(const std::vector<const Candidate*>& holes) const {
    std::vector<Pair> pairs;
    for (std::size_t a = 0; a < holes.size(); ++a) {
      for (std::size_t b = a + 1; b < holes.size(); ++b) {
        const double way = std::hypot(holes[a]->place.x_mm - holes[b]->place.x_mm,
                                      holes[a]->place.y_mm - holes[b]->place.y_mm);
        if (way <= request_.longest_mm) pairs.emplace_back(a, b);
      }
    }
    return pairs;
  }

  [[nodiscard]] Eigen::VectorXd row_of(const std::vector<const Candidate*>& holes,
                                       const Pair& pair) const {
    const Candidate& a = *holes[pair.first];
    const Candidate& b = *holes[pair.second];
    Eigen::RowVector2d unit(a.place.x_mm - b.place.x_mm, a.place.y_mm - b.place.y_mm);
    unit.normalize();
    Eigen::VectorXd row =
        Eigen::VectorXd::Zero(kHolesUnknowns + 2 * static_cast<Eigen::Index>(holes.size()));
    row.head(kHolesUnknowns) = (unit * (a.by_machine - b.by_machine)).transpose();
    row.segment<2>(kHolesUnknowns + 2 * static_cast<Eigen::Index>(pair.first)) = unit.transpose();
    row.segment<2>(kHolesUnknowns + 2 * static_cast<Eigen::Index>(pair.second)) = -unit.transpose();
    return row;
  }

  void measure(Eigen::MatrixXd& s, const Eigen::VectorXd& row) const {
    const Eigen::VectorXd sa = s * row;
    s -= sa * sa.transpose() / (tape2() + row.dot(sa));
  }

  [[nodiscard]] Choice choice(std::vector<Pair> pairs, const Eigen::MatrixXd& s) const {
    Choice result;
    result.pairs = std::move(pairs);
    result.covariance = s.topLeftCorner(kHolesUnknowns, kHolesUnknowns);
    result.variance_mm2 = (criterion_ * result.covariance).trace();
    return result;
  }

  [[nodiscard]] Choice evaluate(const std::vector<const Candidate*>& holes,
                                std::vector<Pair> pairs) const {
    Eigen::MatrixXd s = covariance_before(holes.size());
    for (const Pair& pair : pairs) measure(s, row_of(holes, pair));
    return choice(std::move(pairs), s);
  }

  const HolesPlanRequest& request_;
  const Eigen::MatrixXd& prior_;
  const Eigen::MatrixXd& criterion_;
};

std::vector<Candidate> candidates(const model::Machine& machine, double margin_mm) {
  const model::ReadingModel model(machine);
  const double half_width = 0.5 * machine.bed.width_mm - margin_mm;
  const double half_height = 0.5 * machine.bed.height_mm - margin_mm;
  std::vector<Candidate> result;
  for (int iy = 0; iy < kRows; ++iy) {
    for (int ix = 0; ix < kColumns; ++ix) {
      // Whole millimetres: that is what is typed and drilled.
      const BedPoint place{std::trunc(half_width * (2.0 * ix / (kColumns - 1) - 1.0)),
                           std::trunc(half_height * (2.0 * iy / (kRows - 1) - 1.0))};
      if (const auto row = by_machine(model, place)) result.push_back({place, *row});
    }
  }
  return result;
}

bool is_free(const std::vector<const Candidate*>& holes, std::size_t moving, BedPoint place) {
  for (std::size_t i = 0; i < holes.size(); ++i) {
    if (i == moving) continue;
    if (std::hypot(holes[i]->place.x_mm - place.x_mm, holes[i]->place.y_mm - place.y_mm) <
        kLeastApartMm)
      return false;
  }
  return true;
}

/// Spread: each next hole as far as can be from those before, the first in a corner.
std::vector<const Candidate*> spread(const std::vector<Candidate>& places, std::size_t count) {
  std::vector<const Candidate*> holes = {&places.front()};
  while (holes.size() < count) {
    const Candidate* best = nullptr;
    double best_way = -1.0;
    for (const Candidate& candidate : places) {
      double way = 1e9;
      for (const Candidate* hole : holes) {
        way = std::min(way,
                       std::hypot(hole->place.x_mm - candidate.place.x_mm,
                                  hole->place.y_mm - candidate.place.y_mm));
      }
      if (way <= best_way) continue;
      best_way = way;
      best = &candidate;
    }
    holes.push_back(best);
  }
  return holes;
}

/// Moves single holes as long as one helps.
Chooser::Choice move_holes(const Chooser& chooser,
                           const std::vector<Candidate>& places,
                           std::vector<const Candidate*>& holes) {
  constexpr int kSweeps = 4;
  constexpr double kWorthwhile = 1e-4;
  Chooser::Choice best = chooser.greedy(holes);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    bool moved = false;
    for (std::size_t i = 0; i < holes.size(); ++i) {
      for (const Candidate& place : places) {
        if (&place == holes[i] || !is_free(holes, i, place.place)) continue;
        const Candidate* before = holes[i];
        holes[i] = &place;
        Chooser::Choice next = chooser.greedy(holes);
        if (next.variance_mm2 < best.variance_mm2 * (1.0 - kWorthwhile)) {
          best = std::move(next);
          moved = true;
        } else {
          holes[i] = before;
        }
      }
    }
    if (!moved) break;
  }
  return best;
}

/// Holes in the order of a walk, row by row from the top left, named A, B, C, ...
MeasuredHoles set_of(const model::Machine& machine,
                     const HolesPlanRequest& request,
                     const std::vector<const Candidate*>& holes,
                     const std::vector<Pair>& pairs) {
  std::vector<std::size_t> order(holes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const BedPoint p = holes[a]->place;
    const BedPoint q = holes[b]->place;
    return p.y_mm != q.y_mm ? p.y_mm > q.y_mm : p.x_mm < q.x_mm;
  });
  std::vector<std::size_t> number(holes.size());
  MeasuredHoles set;
  set.name = "plan";
  set.machine = machine;
  set.tape.sigma_mm = request.tape_sigma_mm;
  set.hole_sigma_mm = request.hole_sigma_mm;
  for (std::size_t i = 0; i < order.size(); ++i) {
    number[order[i]] = i;
    set.holes.push_back({std::string(1, static_cast<char>('A' + i)), holes[order[i]]->place});
  }
  for (const Pair& pair : pairs) {
    const auto [from, to] = std::minmax(number[pair.first], number[pair.second]);
    set.distances.push_back({.from = from, .to = to});
  }
  std::sort(set.distances.begin(), set.distances.end(), [](const auto& a, const auto& b) {
    return std::pair(a.from, a.to) < std::pair(b.from, b.to);
  });
  for (HoleDistance& distance : set.distances) distance.distance_mm = commanded_mm(set, distance);
  return set;
}

void check(const model::Machine& machine, const HolesPlanRequest& request) {
  const double half = 0.5 * std::min(machine.bed.width_mm, machine.bed.height_mm);
  const bool sound = request.holes >= kFewestPlannedHoles && request.holes <= kMostPlannedHoles &&
                     request.distances >= 0 && request.tape_sigma_mm > 0.0 &&
                     request.hole_sigma_mm >= 0.0 && request.margin_mm >= 0.0 &&
                     request.margin_mm < half - kLeastApartMm &&
                     request.longest_mm > 2.0 * kLeastApartMm;
  if (sound) return;
  throw std::invalid_argument(
      fmt::format("a plan of {} holes and {} distances, {} mm from the edges, with a tape of {} mm "
                  "and sigmas of {} and {} mm",
                  request.holes,
                  request.distances,
                  request.margin_mm,
                  request.longest_mm,
                  request.tape_sigma_mm,
                  request.hole_sigma_mm));
}

}  // namespace

int distances_of(const HolesPlanRequest& request) {
  const int all = request.holes * (request.holes - 1) / 2;
  return std::min(all, request.distances > 0 ? request.distances : 2 * request.holes + 2);
}

double tool_sigma_mm(const model::Machine& machine, const Eigen::MatrixXd& covariance) {
  return std::sqrt(std::max(0.0, (criterion(machine) * covariance).trace()));
}

std::vector<PlannedKnowledge> knowledge_of(const Eigen::MatrixXd& before,
                                           const Eigen::MatrixXd& after) {
  using Row = Eigen::Matrix<double, 1, kHolesUnknowns>;
  struct Known {
    const char* what;
    const char* unit;
    double factor;
    Row combination;
  };
  // left x, left y, right x, right y, zero left, zero right, scale left, scale right
  const Known rows[] = {
      {"motor spacing", "mm", 1.0, (Row() << -1, 0, 1, 0, 0, 0, 0, 0).finished()},
      {"height of the motors", "mm", 1.0, (Row() << 0, 0.5, 0, 0.5, 0, 0, 0, 0).finished()},
      {"rise of the beam", "mm", 1.0, (Row() << 0, -1, 0, 1, 0, 0, 0, 0).finished()},
      {"both chain zeros together", "mm", 1.0, (Row() << 0, 0, 0, 0, 0.5, 0.5, 0, 0).finished()},
      {"left chain zero less right", "mm", 1.0, (Row() << 0, 0, 0, 0, 1, -1, 0, 0).finished()},
      {"left chain scale", "%", 100.0, (Row() << 0, 0, 0, 0, 0, 0, 1, 0).finished()},
      {"right chain scale", "%", 100.0, (Row() << 0, 0, 0, 0, 0, 0, 0, 1).finished()},
      {"left chain scale less right", "%", 100.0, (Row() << 0, 0, 0, 0, 0, 0, 1, -1).finished()},
  };
  std::vector<PlannedKnowledge> result;
  for (const Known& row : rows) {
    const auto sigma = [&](const Eigen::MatrixXd& covariance) {
      return row.factor *
             std::sqrt(
                 std::max(0.0, (row.combination * covariance * row.combination.transpose())(0)));
    };
    result.push_back({row.what, row.unit, sigma(before), sigma(after)});
  }
  return result;
}

tl::expected<HolesPlan, PlanFailure> plan_holes(const model::Machine& machine,
                                                const HolesPlanRequest& request) {
  check(machine, request);
  const std::vector<Candidate> places = candidates(machine, request.margin_mm);
  if (places.size() < static_cast<std::size_t>(request.holes)) {
    return tl::unexpected(PlanFailure{fmt::format(
        "the machine can cut at {} of the places tried only; a wider margin leaves out those it "
        "cannot reach",
        places.size())});
  }
  const Eigen::MatrixXd prior = stated_prior(machine).covariance;
  const Eigen::MatrixXd c = criterion(machine);
  const Chooser chooser(request, prior, c);
  auto holes = spread(places, static_cast<std::size_t>(request.holes));
  Chooser::Choice choice = move_holes(chooser, places, holes);
  choice = chooser.exchange(holes, std::move(choice));
  HolesPlan plan;
  plan.set = set_of(machine, request, holes, choice.pairs);
  plan.expected_rms_mm = std::sqrt(choice.variance_mm2);
  plan.expected_before_mm = std::sqrt((c * prior).trace());
  plan.knowledge = knowledge_of(prior, choice.covariance);
  plan.effects = seen_effects(plan.set);
  return plan;
}

}  // namespace chaintrue::grid
