// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/synthetic/atlas.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/containers.hpp"
#include "grid/synthetic/simulated_belts.hpp"
#include "interp/eigen.hpp"
#include "model/belts/belt_mechanism.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::synthetic {
namespace {

using model::MechanismExtent;
using model::MechanismVisit;
using MechanismPointer = std::shared_ptr<const Mechanism>;

/// The machine as set in its controller, and the true one.
struct SetAndActual {
  MechanismPointer set;
  MechanismPointer actual;
  /// The origin of commands and results.
  ToolPosition set_origin{};
  ToolPosition actual_origin{};
  int first_visit = 0;

  /// What the controller pays out for a command.
  auto paid_out(ToolPosition command) const {
    return set->predict({set_origin.x_mm + command.x_mm, set_origin.y_mm + command.y_mm}, {},
                        model::Derivatives::by_position);
  }
};

/// The machine with a cause at a size; empty if there is none.
using Made = std::optional<SetAndActual>;
using WithSize = std::function<Made(double)>;

// Margin of the lattice inside the area, so that a cause may shift it.
constexpr double kMargin = 0.04;
constexpr int kLatticeColumns = 7;
constexpr int kLatticeRows = 5;
// Enough for a smooth bow.
constexpr int kPointsOfLine = 13;
constexpr int kPointsOfSide = 5;

ToolPosition plus(ToolPosition a, ToolPosition b) { return {a.x_mm + b.x_mm, a.y_mm + b.y_mm}; }
ToolPosition minus(ToolPosition a, ToolPosition b) { return {a.x_mm - b.x_mm, a.y_mm - b.y_mm}; }

std::vector<ToolPosition> straight(ToolPosition from, ToolPosition to, int count) {
  std::vector<ToolPosition> points;
  for (const int i : each_below(count)) {
    const double part = as_double(i) / (count - 1);
    points.push_back(
        {from.x_mm + part * (to.x_mm - from.x_mm), from.y_mm + part * (to.y_mm - from.y_mm)});
  }
  return points;
}

std::vector<AtlasLine> lattice_over(const MechanismExtent& extent) {
  const double width = extent.x_max_mm - extent.x_min_mm;
  const double height = extent.y_max_mm - extent.y_min_mm;
  const double left = extent.x_min_mm + kMargin * width;
  const double right = extent.x_max_mm - kMargin * width;
  const double bottom = extent.y_min_mm + kMargin * height;
  const double top = extent.y_max_mm - kMargin * height;
  std::vector<AtlasLine> lines;
  for (const int row : each_below(kLatticeRows)) {
    const double y = bottom + row * (top - bottom) / (kLatticeRows - 1);
    lines.push_back({straight({left, y}, {right, y}, kPointsOfLine)});
  }
  for (const int column : each_below(kLatticeColumns)) {
    const double x = left + column * (right - left) / (kLatticeColumns - 1);
    lines.push_back({straight({x, bottom}, {x, top}, kPointsOfLine)});
  }
  const ToolPosition centre = extent.centre();
  const double half = 0.15 * std::min(width, height);
  constexpr double kCorners[][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const auto corner = [&](int i) {
    return plus(centre, {half * kCorners[i % 4][0], half * kCorners[i % 4][1]});
  };
  for (const int i : each_below(4))
    lines.push_back({straight(corner(i), corner(i + 1), kPointsOfSide), true});
  return lines;
}

/// The numbers of the mark at a true place: the inverse of place_of_mark(). Effects of the paper are
/// some parts in a thousand, so that each step gains two digits at least.
ToolPosition numbers_of_mark(const Mechanism& mechanism, ToolPosition place) {
  constexpr int kSteps = 12;
  ToolPosition written = place;
  for (int step = 0; step < kSteps; ++step)
    written = plus(written, minus(place, mechanism.place_of_mark(written)));
  return written;
}

/// (1). The first two lengths place the tool.
std::optional<ToolPosition> drawn_at(const SetAndActual& machine, ToolPosition command,
                                     const MechanismVisit& visit) {
  const auto paid_out = machine.paid_out(command);
  if (!paid_out) return std::nullopt;
  const VectorXd& lengths = paid_out->lengths_mm;
  Flags counting(as_size(lengths.size()), false);
  counting[0] = counting[1] = true;
  const auto place = lengths.size() == 2
                         ? machine.actual->locate(lengths, visit)
                         : locate_by_newton(*machine.actual, lengths, visit,
                                            plus(machine.actual_origin, command), counting);
  if (!place) return std::nullopt;
  return minus(numbers_of_mark(*machine.actual, *place), machine.actual_origin);
}

/// Which way each length went from one point to the next.
std::vector<double> directions(const SetAndActual& machine, ToolPosition from, ToolPosition to) {
  const auto before = machine.paid_out(from), after = machine.paid_out(to);
  if (!before || !after) return {};
  return mapped(each_below(after->lengths_mm.size()),
                [&](Index i) { return after->lengths_mm[i] < before->lengths_mm[i] ? -1.0 : 1.0; });
}

AtlasFrame frame_of(const std::vector<AtlasLine>& lines, const SetAndActual& machine, double size) {
  AtlasFrame frame{size, {}};
  for (const auto k : each_index(lines)) {
    const std::vector<ToolPosition>& points = lines[k].points;
    std::vector<std::optional<ToolPosition>> drawn;
    for (const auto i : each_index(points)) {
      MechanismVisit visit{.order = machine.first_visit + as_int(k)};
      // The first point is reached in the direction in which the line continues.
      const std::size_t to = std::max<std::size_t>(i, 1);
      visit.direction = directions(machine, points[to - 1], points[to]);
      drawn.push_back(drawn_at(machine, points[i], visit));
    }
    frame.lines.push_back(std::move(drawn));
  }
  return frame;
}

double largest_shift(const std::vector<AtlasLine>& lines, const AtlasFrame& frame) {
  double largest = 0.0;
  for (const auto k : each_index(lines)) {
    for (const auto i : each_index(lines[k].points)) {
      if (!frame.lines[k][i]) continue;
      const ToolPosition shift = minus(*frame.lines[k][i], lines[k].points[i]);
      largest = std::max(largest, std::hypot(shift.x_mm, shift.y_mm));
    }
  }
  return largest;
}

/// Sizes in the parameter's range that include the usual one, without zero effect.
std::vector<double> sizes_of(double null, double usual, double lower, double upper, bool integer) {
  std::vector<double> sizes;
  for (const double times : {-2.0, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0}) {
    const double size = times == 1.0 ? usual : null + times * (usual - null);
    if (size < lower || size > upper || (integer && size != std::round(size))) continue;
    sizes.push_back(size);
  }
  sort(sizes);
  return sizes;
}

std::string id_of(const AtlasPicture& picture) {
  if (picture.effect == nullptr) return std::string(picture.parameter);
  const std::string_view side = name(picture.side);
  return std::string(picture.effect->id) + (side.empty() ? "" : ":") + std::string(side);
}

/// Empty too where no such machine can be.
Made made_with(const WithSize& with_size, double size) {
  try {
    return with_size(size);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

void add_picture(AtlasPicture picture, const std::vector<double>& sizes, double usual,
                 const WithSize& with_size, Atlas& atlas) {
  for (const double size : sizes) {
    const auto machine = made_with(with_size, size);
    if (!machine) continue;
    picture.frames.push_back(frame_of(atlas.lines, *machine, size));
    if (size == usual) picture.usual = picture.frames.size() - 1;
  }
  if (picture.frames.empty() || picture.frames[picture.usual].size != usual) {
    atlas.not_drawn.push_back(id_of(picture));
    return;
  }
  picture.largest_shift_mm = largest_shift(atlas.lines, picture.frames[picture.usual]);
  atlas.pictures.push_back(std::move(picture));
}

AppliedEffect of_size(const Effect& effect, EffectSide side, std::size_t at, double size) {
  std::vector<double> values = nominal_values(effect);
  values[at] = size;
  return applied(effect, side, values);
}

std::size_t first_size(const Effect& effect) {
  std::size_t at = 0;
  while (effect.parameters[at].role != ParameterRole::size) ++at;
  return at;
}

void add_pictures(const Mechanism& mechanism, std::string_view cause,
                  const std::function<Made(Index, double)>& with_setting,
                  const std::function<Made(const AppliedEffect&)>& with_effect, Atlas& atlas) {
  const auto parameters = mechanism.parameters();
  for (const auto k : each_index(parameters)) {
    if (!cause.empty() && cause != parameters[k].name) continue;
    const double usual = parameters[k].prior_sigma.value_or(model::kParameterShiftSigma);
    const double most = 2.0 * usual;
    add_picture(
        {.parameter = parameters[k].name}, sizes_of(0.0, usual, -most, most, false), usual,
        [&](double size) { return with_setting(as_index(k), size); }, atlas);
  }
  for (const Effect* effect : mechanism.effects()) {
    if (!cause.empty() && cause != effect->id) continue;
    const std::size_t at = first_size(*effect);
    const EffectParameter& size_of = effect->parameters[at];
    for (const EffectSide side : effect->sides) {
      if (!mechanism.problems_of_effects({of_size(*effect, side, at, size_of.nominal)}).empty())
        continue;
      add_picture(
          {.effect = effect, .side = side, .parameter = size_of.name, .null = size_of.null},
          sizes_of(size_of.null, size_of.nominal, size_of.lower, size_of.upper, size_of.integer),
          size_of.nominal,
          [&](double size) { return with_effect(of_size(*effect, side, at, size)); }, atlas);
    }
  }
}

MechanismPointer with_parameter(const Mechanism& mechanism, Index k, double more) {
  VectorXd values = mechanism.values();
  values[k] += more;
  return mechanism.with_values(values);
}

/// The anchors that fit a session with the effect best, with every reading at full weight, as the
/// machine fits them.
std::optional<BeltMachine> calibrated(const BeltMachine& machine, const AppliedEffect& effect) {
  BeltsSpec spec;
  spec.columns = spec.rows = 6;
  static_assert(kAtlasPlaces == 6 * 6);
  spec.noise_mm = 0.0;
  spec.hidden = {effect};
  const auto session = simulate_belts(machine, machine, spec);
  if (!session) return std::nullopt;
  const Counting all(session->points.size(), kAllBelts);
  const auto found = belts::fit_anchors_from(*session, {anchors_of(machine), 0.0, {}}, all);
  if (!found) return std::nullopt;
  return with_anchors(machine, found->state.anchors);
}

ToolPosition origin_of(const BeltMachine& machine) {
  const FramePoint centre = to_frame(machine, {0.0, 0.0});
  return {centre.x_mm, centre.y_mm};
}

}  // namespace

Atlas atlas_of(const Mechanism& mechanism, std::string_view cause) {
  const MechanismPointer set = mechanism.with_values(mechanism.values());
  Atlas atlas;
  atlas.lines = lattice_over(mechanism.extent());
  add_pictures(
      mechanism, cause,
      [&](Index k, double more) -> Made {
        return SetAndActual{set, with_parameter(mechanism, k, more)};
      },
      [&](const AppliedEffect& effect) -> Made {
        return SetAndActual{set, mechanism.with_effects({effect})};
      },
      atlas);
  return atlas;
}

Atlas atlas_of(const BeltMachine& machine, std::string_view cause) {
  if (!machine.anchors_known) throw std::invalid_argument("an atlas of anchors that are not known");
  const auto actual = make_belt_mechanism(machine);
  const ToolPosition origin = origin_of(machine);
  MechanismExtent area = actual->extent();
  area = {area.x_min_mm - origin.x_mm, area.x_max_mm - origin.x_mm, area.y_min_mm - origin.y_mm,
          area.y_max_mm - origin.y_mm};
  Atlas atlas;
  atlas.calibrates_first = true;
  atlas.lines = lattice_over(area);
  add_pictures(
      *actual, cause,
      [&](Index k, double more) -> Made {
        const auto as_is =
            make_belt_mechanism(with_anchors(machine, with_parameter(*actual, k, more)->values()));
        return SetAndActual{actual, as_is, origin, origin_of(as_is->machine())};
      },
      [&](const AppliedEffect& effect) -> Made {
        const auto found = calibrated(machine, effect);
        if (!found) return std::nullopt;
        return SetAndActual{make_belt_mechanism(*found), actual->with_effects({effect}),
                            origin_of(*found), origin, kAtlasPlaces};
      },
      atlas);
  return atlas;
}

}  // namespace chaintrue::grid::synthetic
