// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/next_measurements.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "grid/diagnosis/normal.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr std::size_t kMostAlternatives = 6;
constexpr double kLeastProbability = 0.01;
constexpr int kColumns = 20;
constexpr int kRows = 12;
constexpr double kEnough = 0.97;
constexpr double kPays = 0.002;  // a measurement that helps less is not worth the way

/// One candidate: some rows of the candidate session.
struct Candidate {
  NextMeasurement measurement;
  std::vector<Eigen::Index> rows;
  int times = 1;  ///< it may be chosen
};

/// Readings of the machine, with the sigma that care with usual tools reaches.
struct MachineReading {
  const char* what;
  const char* side;
  double sigma;
};
constexpr double kLinkPitchSigmaMm = 0.001;     // 100 links to 0.1 mm
constexpr double kTapeErrorSigmaMmPerM = 0.15;  // two metres to 0.3 mm, a good tape's tolerance
constexpr MachineReading kReadings[] = {
    {"motor_spacing_mm", "", 1.0},
    {"beam_rise_mm", "", 1.0},
    {"ring_radius_mm", "", 0.5},
    {"link_pitch_mm", "left", kLinkPitchSigmaMm},
    {"link_pitch_mm", "right", kLinkPitchSigmaMm},
    {"chain_mass_kg_per_m", "", 0.002},
    {"tape_error_mm_per_m", "x", kTapeErrorSigmaMmPerM},
    {"tape_error_mm_per_m", "y", kTapeErrorSigmaMmPerM},
};

struct Alternative {
  std::vector<int> directions;
  double probability = 0.0;
  Eigen::VectorXd mean;    ///< of all candidate rows
  Eigen::MatrixXd spread;  ///< rows x unknowns: a square root of the covariance but for the noise
};

/// The sets of causes, as many as the verdict speaks of, that the contest leaves; each with its
/// best places. Members of one class count as one.
std::vector<Alternative> leading(const Analysis& a) {
  const auto class_of = [&](const CauseId& cause) {
    for (std::size_t k = 0; k < a.judgement.classes.size(); ++k) {
      const CauseClass& members = a.judgement.classes[k];
      if (std::find(members.begin(), members.end(), cause) != members.end()) return k;
    }
    return a.judgement.classes.size();
  };
  std::map<std::vector<std::size_t>, Alternative> groups;
  const std::size_t together = std::max<std::size_t>(a.judgement.directions.size(), 1);
  for (const Model& model : a.contest.models) {
    if (model.directions.size() != together) continue;
    std::vector<std::size_t> key;
    for (const int k : model.directions) {
      key.push_back(class_of(a.rows.directions[static_cast<std::size_t>(k)].cause));
    }
    std::sort(key.begin(), key.end());
    Alternative& one = groups[key];
    if (one.probability == 0.0) one.directions = model.directions;
    one.probability += a.contest.probability(model);
  }
  std::vector<Alternative> result;
  double all = 0.0;
  for (const auto& [key, one] : groups) all += one.probability;
  for (auto& [key, one] : groups) {
    if (one.probability >= kLeastProbability * all) result.push_back(std::move(one));
  }
  std::stable_sort(result.begin(), result.end(), [](const Alternative& x, const Alternative& y) {
    return x.probability > y.probability;
  });
  if (result.size() > kMostAlternatives) result.resize(kMostAlternatives);
  double sum = 0.0;
  for (const Alternative& h : result) sum += h.probability;
  for (Alternative& h : result) h.probability /= sum;
  return result;
}

/// The reading that tells members of one class apart which no points can: a chain's links.
void add_link_reading(const Session& session,
                      const Analysis& a,
                      std::vector<NextMeasurement>& list) {
  if (a.judgement.listed.empty() || list.size() >= kMostNextMeasurements) return;
  const CauseClass& members = a.judgement.classes[a.judgement.listed.front()];
  const bool pitch = std::any_of(members.begin(), members.end(), [](const CauseId& c) {
    return c.effect->elongation != nullptr;
  });
  const auto is_pitch = [](const auto& x) { return x.what == "link_pitch_mm"; };
  if (members.size() < 2 || !pitch || std::any_of(list.begin(), list.end(), is_pitch) ||
      std::any_of(session.readings.begin(), session.readings.end(), is_pitch)) {
    return;
  }
  NextMeasurement reading{
      MeasurementKind::reading, "link_pitch_mm", "left", std::nullopt, kLinkPitchSigmaMm};
  for (const ClassProbability& one : a.judgement.marginal) {
    if (one.index == a.judgement.listed.front()) reading.raises_probability_to = one.probability;
  }
  if (!list.empty()) reading.raises_probability_to = list.back().raises_probability_to;
  list.push_back(std::move(reading));
}

/// A session of everything that might be measured, as one more visit each.
class CandidateSession {
 public:
  CandidateSession(const Session& session, const Analysis& a) : session_(session) {
    session_.points.clear();
    session_.readings.clear();
    const model::ReadingModel model(a.state.machine);
    int last = 0;
    for (const SessionPoint& p : session.points) last = std::max(last, p.order);
    add_points(session, a, model, last + 1);
    add_revisits(session, last + 1);
    session_.ordered = false;  // each is a next visit; only their order among them is arbitrary
    add_readings(session);
  }

  [[nodiscard]] const Session& session() const { return session_; }
  [[nodiscard]] std::vector<Candidate>& all() { return candidates_; }

 private:
  void add(model::BedPoint mark, int order, MeasurementKind kind, std::string what) {
    const auto row = 2 * static_cast<Eigen::Index>(session_.points.size());
    session_.points.push_back({0, mark, {}, order});
    candidates_.push_back({{kind, std::move(what), "", mark, 0.0}, {row, row + 1}, 2});
  }

  /// Over the bed, as far as the sheet was measured and a little beyond.
  void add_points(const Session& session,
                  const Analysis& a,
                  const model::ReadingModel& model,
                  int order) {
    double x = 0.0;
    double y = 0.0;
    for (const SessionPoint& p : session.points) {
      x = std::max(x, std::abs(p.mark.x_mm));
      y = std::max(y, std::abs(p.mark.y_mm));
    }
    x = std::min(1.1 * x, 0.49 * session.stated.bed.width_mm);
    y = std::min(1.1 * y, 0.49 * session.stated.bed.height_mm);
    for (int j = 0; j < kRows; ++j) {
      for (int i = 0; i < kColumns; ++i) {
        // Whole millimetres: the list is for a person with a tape.
        const model::BedPoint mark{std::round(x * (2.0 * i / (kColumns - 1) - 1.0)),
                                   std::round(y * (2.0 * j / (kRows - 1) - 1.0))};
        if (model.at(a.state.sheet.to_bed(mark))) {
          add(mark, order, MeasurementKind::point, "a new point");
        }
      }
    }
  }

  void add_revisits(const Session& session, int order) {
    if (!session.ordered) return;
    const SessionPoint& first = session.points.front();
    add(first.mark,
        order,
        MeasurementKind::revisit,
        fmt::format("point {}, the first of the session, once more", first.index + 1));
    const SessionPoint& middle = session.points[session.points.size() / 2];
    add(middle.mark,
        order,
        MeasurementKind::revisit,
        fmt::format("point {} once more, coming from the other side", middle.index + 1));
  }

  void add_readings(const Session& session) {
    Eigen::Index row = session_.point_rows();
    for (const MachineReading& r : kReadings) {
      const bool done =
          std::any_of(session.readings.begin(), session.readings.end(), [&](const ExtraReading& x) {
            return x.what == r.what && x.side == r.side;
          });
      const bool ring = std::holds_alternative<model::Ring>(session.stated.attachment);
      if (done || (std::string_view(r.what) == "ring_radius_mm" && !ring)) continue;
      session_.readings.push_back({r.what, r.side, 0.0, r.sigma});
      candidates_.push_back(
          {{MeasurementKind::reading, r.what, r.side, std::nullopt, r.sigma}, {row++}, 1});
    }
  }

  Session session_;
  std::vector<Candidate> candidates_;
};

/// What a hypothesis expects of every candidate.
void predict(const Session& session,
             const Analysis& a,
             const Session& next,
             const Rows& rows,
             Alternative& h) {
  const Space& space = a.contest.spaces[a.judgement.space];
  const Estimate fitted = estimate(session, a.rows, space, h.directions, -1);
  h.mean = rows.by_setting * fitted.setting_change;
  const Eigen::Index settings = fitted.setting_change.size();
  const auto free = static_cast<Eigen::Index>(fitted.free.size());
  Eigen::MatrixXd design(rows.by_setting.rows(), settings + free);
  design.leftCols(settings) = rows.by_setting;
  Eigen::Index column = settings;
  for (std::size_t k = 0; k < fitted.directions.size(); ++k) {
    const Direction& d = a.rows.directions[static_cast<std::size_t>(fitted.directions[k])];
    const auto g = signature(next, a.state, rows, d.cause, d.values);
    const Eigen::VectorXd column_of =
        g ? *g : Eigen::VectorXd(Eigen::VectorXd::Zero(rows.by_setting.rows()));
    h.mean += column_of * fitted.coefficient(static_cast<Eigen::Index>(k));
    if (std::find(fitted.free.begin(), fitted.free.end(), k) != fitted.free.end()) {
      design.col(column++) = column_of;
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(fitted.covariance);
  h.spread = design * Eigen::MatrixXd(llt.matrixL());
}

/// D over these rows, for two alternatives.
double distance(const Alternative& k, const Alternative& l, const std::vector<Eigen::Index>& rows) {
  const Eigen::VectorXd difference = k.mean(rows) - l.mean(rows);
  const Eigen::MatrixXd of_k = k.spread(rows, Eigen::all);
  const Eigen::MatrixXd of_l = l.spread(rows, Eigen::all);
  Eigen::MatrixXd covariance = 0.5 * (of_k * of_k.transpose() + of_l * of_l.transpose());
  covariance.diagonal().array() += 1.0;
  return difference.dot(covariance.llt().solve(difference));
}

/// Bound on confusion, and the probability that the right one is named alone.
struct Outlook {
  double confusion = 0.0;
  double named_alone = 0.0;
};

Outlook outlook(const std::vector<Alternative>& alternatives,
                const std::vector<Eigen::Index>& rows) {
  Outlook result;
  const double odds = std::log(kNamedAlone / (1.0 - kNamedAlone));
  const auto count = alternatives.size();
  std::vector<std::vector<double>> d(count, std::vector<double>(count, 0.0));
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      d[k][l] = d[l][k] = rows.empty() ? 0.0 : distance(alternatives[k], alternatives[l], rows);
      result.confusion += std::sqrt(alternatives[k].probability * alternatives[l].probability) *
                          std::exp(-d[k][l] / 8.0);
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    double p = 1.0;
    for (std::size_t l = 0; l < count; ++l) {
      if (l == k) continue;
      const double ahead = 0.5 * d[k][l] +
                           std::log(alternatives[k].probability / alternatives[l].probability) -
                           odds;
      p *= d[k][l] > 1e-9 ? 1.0 - normal_upper(ahead / std::sqrt(d[k][l]))
                          : (ahead > 0.0 ? 1.0 : 0.0);
    }
    result.named_alone += alternatives[k].probability * p;
  }
  return result;
}

}  // namespace

std::vector<NextMeasurement> next_measurements(const Session& session, const Analysis& a) {
  if (a.judgement.listed.empty()) return {};
  std::vector<NextMeasurement> result;
  std::vector<Alternative> alternatives = leading(a);
  CandidateSession next(session, a);
  const auto rows = base_rows(next.session(), a.state, {});
  if (!rows) return {};
  for (Alternative& h : alternatives) predict(session, a, next.session(), *rows, h);
  std::vector<Candidate>& options = next.all();
  std::vector<Eigen::Index> chosen;
  Outlook now = outlook(alternatives, chosen);
  double reached = a.judgement.verdict == Verdict::named ? kEnough : now.named_alone;
  while (result.size() < kMostNextMeasurements && reached < kEnough) {
    std::size_t best = options.size();
    Outlook then = now;
    for (std::size_t c = 0; c < options.size(); ++c) {
      if (options[c].times == 0) continue;
      std::vector<Eigen::Index> more = chosen;
      more.insert(more.end(), options[c].rows.begin(), options[c].rows.end());
      const Outlook tried = outlook(alternatives, more);
      if (tried.confusion < then.confusion) {
        then = tried;
        best = c;
      }
    }
    if (best == options.size() || now.confusion - then.confusion < kPays * now.confusion) break;
    options[best].times -= 1;
    chosen.insert(chosen.end(), options[best].rows.begin(), options[best].rows.end());
    // The Gaussian approximation may dip where the first points only raise doubts; more data never
    // make the right name less likely in the mean.
    reached = std::max(reached, then.named_alone);
    result.push_back(options[best].measurement);
    result.back().raises_probability_to = reached;
    now = then;
  }
  add_link_reading(session, a, result);
  return result;
}

}  // namespace chaintrue::grid::diagnosis
