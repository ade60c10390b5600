// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/synthetic/generator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::synthetic {
namespace {

using model::Visit;

// The random streams. A new purpose gets a new number; existing numbers never change, so that a
// seed always gives the same grid.
enum Stream : std::uint64_t {
  kMarks = 1,
  kOrder = 2,
  kRepeats = 3,
  kJitter = 4,
  kLengthNoise = 5,
  kPositionNoise = 6,
  kBadPoints = 7,
  kSettings = 8,
  kSheet = 9,
};

// Resolution of a number with noise: far below any noise, and far above the differences between
// mathematical libraries, so that the bytes are the same everywhere.
constexpr double kNoisyStepMm = 1e-4;

double rounded(double value, double step) {
  if (step <= 0.0) return value;
  // Dividing by a whole number of steps per mm gives the double nearest to the decimal number.
  const double per_mm = std::round(1.0 / step);
  const bool divides = std::abs(per_mm * step - 1.0) < 1e-12;
  return divides ? std::round(value * per_mm) / per_mm : std::round(value / step) * step;
}

double step_of(double rounding_mm, double sigma_mm) {
  if (rounding_mm > 0.0) return rounding_mm;
  return sigma_mm > 0.0 ? kNoisyStepMm : 0.0;
}

double draw(Random& random, const SyntheticNoise& noise, double sigma) {
  if (sigma == 0.0) return 0.0;
  return sigma * (noise.heavy_tails ? random.heavy_tailed() : random.normal());
}

// Up to `radius` away, evenly over the disc.
MarkPoint jittered(MarkPoint place, double radius_mm, Random& random) {
  if (radius_mm == 0.0) return place;
  for (;;) {
    const double x = random.uniform(-1.0, 1.0);
    const double y = random.uniform(-1.0, 1.0);
    if (x * x + y * y <= 1.0) return {place.x_mm + radius_mm * x, place.y_mm + radius_mm * y};
  }
}

// Visits every mark in order, with repeats spread evenly between: after a share of the marks, one
// of them again.
std::vector<MarkPoint> session_of(const std::vector<Mark>& marks, int repeats, Random& random) {
  std::vector<MarkPoint> session;
  Indices unrepeated;
  int done = 0;
  for (const auto i : each_index(marks)) {
    session.push_back(marks[i].place);
    unrepeated.push_back(i);
    while (done < repeats && (i + 1) * as_size(repeats) >= marks.size() * as_size(done + 1)) {
      // Each mark is repeated once before any is visited a third time.
      if (unrepeated.empty()) {
        unrepeated = numbers_below(i + 1);
      }
      const std::size_t pick = random.below(unrepeated.size());
      session.push_back(marks[unrepeated[pick]].place);
      unrepeated.erase(unrepeated.begin() + static_cast<std::ptrdiff_t>(pick));
      ++done;
    }
  }
  return session;
}

std::vector<SettingOffset> drawn_offsets(const Machine& stated, const SyntheticSpec& spec) {
  std::vector<SettingOffset> offsets = spec.offsets;
  if (spec.draw_settings) {
    Random random(spec.seed, kSettings);
    for (const Setting setting : kMachineSettings) {
      offsets.push_back({setting, stated_sigma(stated, setting) * random.normal()});
    }
  }
  if (spec.sheet) {
    Random random(spec.seed, kSheet);
    offsets.push_back({Setting::sheet_x_mm, spec.sheet->shift_mm * random.normal()});
    offsets.push_back({Setting::sheet_y_mm, spec.sheet->shift_mm * random.normal()});
    offsets.push_back(
        {Setting::sheet_rotation_rad, 1e-3 * spec.sheet->rotation_mrad * random.normal()});
  }
  return offsets;
}

// The points at which the machine's effects miscount links.
Indices miscounted(const Machine& machine, const std::vector<Visit>& visits) {
  Indices points;
  for (const AppliedEffect& effect : machine.effects) {
    const Effect* known = model::effects::find_effect(machine, effect.effect);
    if (known == nullptr || !known->at_one_visit) continue;
    const auto value = [&](const EffectParameter& parameter) {
      return effect.parameters.at(std::string(parameter.name));
    };
    if (value(known->parameters.front()) == known->parameters.front().null) continue;
    for (const auto i : each_index(visits)) {
      if (visits[i].order == value(known->parameters.back())) points.push_back(i);
    }
  }
  return points;
}

// Noise, gross errors and rounding added to the true marks and readings; `bad_points` receives the
// gross errors.
std::vector<MeasuredPoint> written_down(const std::vector<MarkPoint>& marks,
                                        const std::vector<ChainLengths>& lengths,
                                        const SyntheticSpec& spec, Indices& bad_points) {
  const SyntheticNoise& noise = spec.noise;
  Random length_noise(spec.seed, kLengthNoise);
  Random position_noise(spec.seed, kPositionNoise);
  Random slips(spec.seed, kBadPoints);
  bad_points = numbers_below(marks.size());
  slips.shuffle(bad_points);
  bad_points.resize(std::min(bad_points.size(), as_size(spec.bad.count)));
  sort(bad_points);

  const double position_step = step_of(noise.position_rounding_mm, noise.position_mm);
  const double length_step = step_of(noise.length_rounding_mm, noise.length_mm);
  std::vector<MeasuredPoint> points;
  for (const auto i : each_index(marks)) {
    MarkPoint mark = marks[i];
    mark.x_mm += draw(position_noise, noise, noise.position_mm);
    mark.y_mm += draw(position_noise, noise, noise.position_mm);
    if (std::binary_search(bad_points.begin(), bad_points.end(), i)) {
      const double direction = slips.uniform(-std::numbers::pi, std::numbers::pi);
      mark.x_mm += spec.bad.size_mm * std::cos(direction);
      mark.y_mm += spec.bad.size_mm * std::sin(direction);
    }
    const double left = lengths[i].left_mm + draw(length_noise, noise, noise.length_mm);
    const double right = lengths[i].right_mm + draw(length_noise, noise, noise.length_mm);
    points.push_back({{rounded(mark.x_mm, position_step), rounded(mark.y_mm, position_step)},
                      ChainLengths{rounded(left, length_step), rounded(right, length_step)},
                      std::nullopt,
                      as_int(i)});
  }
  return points;
}

std::optional<StatedNoise> stated_noise(const SyntheticSpec& spec) {
  if (spec.stated) return spec.stated;
  if (spec.noise.length_mm == 0.0 && spec.noise.position_mm == 0.0) return std::nullopt;
  return StatedNoise{spec.noise.length_mm, spec.noise.position_mm};
}

// Reports the number of visits read so far.
std::function<void(std::size_t)> counting(const Progress& progress, std::size_t visits) {
  if (!progress) return {};
  return [&progress, total = as_double(visits)](std::size_t read) {
    tell(progress, {"the machine read at every mark", 1, 1, as_double(read) / total});
  };
}

}  // namespace

void offset_setting(Machine& machine, SheetPlacement& sheet, const SettingOffset& offset) {
  switch (offset.setting) {
    case Setting::sheet_x_mm:
      sheet.x_mm += offset.offset;
      break;
    case Setting::sheet_y_mm:
      sheet.y_mm += offset.offset;
      break;
    case Setting::sheet_rotation_rad:
      sheet.rotation_rad += offset.offset;
      break;
    default:
      machine = with_setting(machine, offset.setting,
                             stated_value(machine, offset.setting) + offset.offset);
  }
}

SyntheticTruth truth_of(const Machine& stated, const SyntheticSpec& spec) {
  SyntheticTruth truth{stated, drawn_offsets(stated, spec), {}};
  append_all(truth.machine.effects, spec.hidden);
  for (const SettingOffset& offset : truth.offsets) {
    offset_setting(truth.machine, truth.sheet, offset);
  }
  return truth;
}

ChainLengths unmodelled(BedPoint place) {
  return {std::sin(place.x_mm / 500.0 + 0.3) * std::cos(place.y_mm / 400.0),
          std::cos(place.x_mm / 450.0) * std::sin(place.y_mm / 420.0 + 0.5)};
}

tl::expected<SyntheticSession, UnreachableMark> generate(const Machine& stated,
                                                         const SyntheticSpec& spec,
                                                         const Progress& progress) {
  SyntheticSession session;
  SyntheticAnswer& answer = session.answer;
  answer.seed = spec.seed;
  answer.hidden = spec.hidden;
  static_cast<SyntheticTruth&>(answer) = truth_of(stated, spec);

  Random mark_random(spec.seed, kMarks);
  Random order_random(spec.seed, kOrder);
  Random repeat_random(spec.seed, kRepeats);
  Random jitter_random(spec.seed, kJitter);
  std::vector<Mark> pattern = marks(stated.bed, spec.design, mark_random);
  put_in_order(pattern, spec.order, order_random);
  std::vector<Visit> visits;
  for (const MarkPoint& intended : session_of(pattern, spec.repeats, repeat_random)) {
    const MarkPoint place = jittered(intended, spec.jitter_mm, jitter_random);
    visits.push_back({answer.sheet.to_bed(place), as_int(visits.size())});
    answer.places.push_back(visits.back().position);
  }

  const ReadingModel reading_model(answer.machine, spec.model);
  const auto lengths = model::readings(reading_model, visits, counting(progress, visits.size()));
  if (!lengths) {
    const BedPoint place = visits[lengths.error().place].position;
    return tl::unexpected(lengths.error().at(answer.sheet.to_mark(place)));
  }
  answer.lengths = *lengths;
  for (const auto i : each_index(visits)) {
    for (const Side side : kSides)
      answer.lengths[i][side] += spec.unmodelled_mm * unmodelled(visits[i].position)[side];
  }
  const model::MarkFrame mark_frame(answer.machine);
  auto written = mapped(answer.places, [&](const BedPoint& place) {
    return mark_frame.written(answer.sheet.to_mark(place));
  });

  session.grid.machine = stated;
  session.grid.noise = stated_noise(spec);
  session.grid.sheet = spec.sheet;
  session.grid.points = written_down(written, answer.lengths, spec, answer.bad_points);
  append_all(answer.bad_points, miscounted(answer.machine, visits));
  sort_unique(answer.bad_points);
  return session;
}

PlacesRead read_places(const Machine& stated, const std::vector<AppliedEffect>& hidden,
                       const std::vector<Visit>& visits, model::Model model,
                       const Progress& progress) {
  PlacesRead result;
  Machine machine = stated;
  append_all(machine.effects, hidden);
  const ReadingModel reading_model(machine, model);
  const model::MarkFrame mark_frame(machine);
  std::vector<Visit> reached;
  for (const auto i : each_index(visits)) {
    const auto reading = reading_model.at(visits[i].position);
    if (reading) {
      reached.push_back(visits[i]);
    } else {
      result.unreachable.emplace_back(i, reading.error().reason);
    }
  }
  const auto lengths = model::readings(reading_model, reached, counting(progress, reached.size()));
  result.grid.machine = stated;
  for (const auto i : each_index(reached)) {
    result.grid.points.push_back({mark_frame.written(identity_placement(reached[i].position)),
                                  lengths->at(i), std::nullopt, reached[i].order});
  }
  return result;
}

}  // namespace chaintrue::grid::synthetic
