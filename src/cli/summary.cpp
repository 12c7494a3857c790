// The lines that a run ends with.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <string_view>
#include <type_traits>

#include "src/cli/messages.h"
#include "src/cli/report.h"
#include "src/composition/pair_name.h"
#include "src/runs/duration_text.h"
#include "src/runs/engine_choice.h"
#include "src/runs/exact_rates.h"
#include "src/runs/rod_totals.h"
#include "src/runs/size_text.h"
#include "src/scene/confinement.h"

namespace needlework::cli {
namespace {

template <class... Arguments>
std::string line(const char* name, fmt::format_string<Arguments...> format,
                 Arguments&&... arguments) {
  return fmt::format("  {:<14}", name) +
         fmt::format(format, std::forward<Arguments>(arguments)...) + "\n";
}

std::string per_cent(double share) {
  const double value = 100 * share;
  return value > 0 && value < 0.01 ? "less than 0.01 %" : fmt::format("{:.3g} %", value);
}

std::string reason(const runs::RunResult& result) {
  if (result.failure) return "stopped in an invalid state";
  switch (result.stop) {
    case Stop::time:
      return "ran to its end time";
    case Stop::collisions:
      return "ran to its number of collisions";
    case Stop::energy:
      return "ran to its energy";
    case Stop::wall_time:
      return "stopped at the limit of wall time";
    case Stop::interrupted:
      return "stopped by a signal";
    case Stop::walls_meet:
      return "ran until the walls left no more room";
    case Stop::jammed:
      return "jammed";
    case Stop::grown:
      return "grew to its packing fraction";
    case Stop::pressure:
      return "grew to its pressure";
    case Stop::no_room:
      return "grew until the box had no more room";
    case Stop::nothing_can_happen:
      break;
  }
  return "nothing can happen any more";
}

// The sample nearest to a tenth of the end's time, for the slope over the last decade.
const Totals* decade_before(const runs::RunResult& result) {
  const Totals* found = nullptr;
  for (const Totals& sample : result.samples) {
    if (sample.time > 0 && sample.time <= 0.101 * result.last.time) found = &sample;
  }
  return found;
}

double slope(double energy_before, double energy_after, double time_before, double time_after) {
  return std::log(energy_after / energy_before) / std::log(time_after / time_before);
}

std::string energy_lines(const Report& report) {
  const Totals& first = report.result.initial;
  const Totals& last = report.result.last;
  std::string text;
  const auto theory = report.theory_at(last);
  const bool cools = last.energy < 0.999 * first.energy;
  if (cools) {
    text += line("energy", "E/E(0) = {:.4g}", last.energy / first.energy);
    if (theory) {
      text.pop_back();
      text += fmt::format(", theory {:.4g}, measured/theory {:.3f}\n",
                          theory->energy() / first.energy, last.energy / theory->energy());
    }
    const Totals* before = decade_before(report.result);
    const auto theory_before = before ? report.theory_at(*before) : std::nullopt;
    if (theory && theory_before) {
      text += line("", "fell as t^{:.2f} over the last decade of time, theory t^{:.2f}",
                   slope(before->energy, last.energy, before->time, last.time),
                   slope(theory_before->energy(), theory->energy(), before->time, last.time));
    }
  } else {
    text += line("energy", "E = {:.6g} per needle{}, changed by {:.1e} of it", last.energy,
                 report.simulation.composition().has_fixed() ? " that moves" : "",
                 last.energy / first.energy - 1);
  }
  if (report.simulation.composition().turning_share() == 0)
    return text + line("temperatures", "T_tr = {:.4g}", last.t_tr);
  text += line("temperatures", "T_tr = {:.4g}, T_rot = {:.4g}, T_tr/T_rot = {:.4f}", last.t_tr,
               last.t_rot, last.t_tr / last.t_rot);
  if (theory) {
    text.pop_back();
    text += fmt::format(", theory {:.4f}\n", theory->t_tr / theory->t_rot);
  }
  return text;
}

// The few with the largest of these numbers, in their order, where there are more than a person
// reads.
std::vector<std::size_t> those_shown(const std::vector<std::uint64_t>& numbers) {
  constexpr std::size_t most = 16, few = 8;
  std::vector<std::size_t> out(numbers.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  if (out.size() <= most) return out;
  std::ranges::stable_sort(out, [&](auto a, auto b) { return numbers[a] > numbers[b]; });
  out.resize(few);
  std::ranges::sort(out);
  return out;
}

// Where the rest of them is.
std::string rest_line(std::size_t all, std::size_t shown, const char* order, const char* key) {
  if (shown == all) return {};
  return line("", "{} more, each with {}: run --json has all, in {}", all - shown, order, key);
}

// How the bodies of each species differ.
std::string size_lines(const Report& report) {
  const Composition& composition = report.simulation.composition();
  std::string text;
  for (const Species& species : composition.species()) {
    for (const std::string& size : runs::size_lines(species)) {
      const std::string name = composition.is_mixture() ? species.name + ": " : "";
      text += line(text.empty() ? "bodies" : "", "{}{}", name, size);
    }
  }
  return text;
}

// Why there is nothing of theory beside a gas that cools.
std::string theory_line(const Report& report) {
  const char* beyond = runs::beyond_cooling_theory(report.scene.composition());
  if (!beyond || runs::starts_in_equilibrium(report.scene)) return {};
  return line("theory", "none: that of cooling does not apply to {}", beyond);
}

// Temperatures of each species.
std::string temperature_lines(const Report& report) {
  const Composition& composition = report.simulation.composition();
  const auto totals = report.simulation.species_totals();
  const auto theory = report.species_theory_at(report.result.last);
  std::vector<std::uint64_t> counts;
  counts.reserve(totals.size());
  for (const SpeciesTotals& each : totals) counts.push_back(each.count);
  const std::vector<std::size_t> shown = those_shown(counts);
  std::string text;
  for (const std::size_t n : shown) {
    const bool turns = composition[n].turns();
    text += line(text.empty() ? "species" : "", "{}: {} {}, {}", composition[n].name, counts[n],
                 composition[n].has_axis() ? "needles" : "spheres",
                 composition[n].fixed
                     ? "fixed"
                     : fmt::format("T_tr = {:.4g}{}", totals[n].t_tr,
                                   turns ? fmt::format(", T_rot = {:.4g}", totals[n].t_rot) : ""));
    if (!theory) continue;
    text.pop_back();
    text += fmt::format(", theory {:.4g}, {:.4g}\n", (*theory)[n].t_tr, (*theory)[n].t_rot);
  }
  return text + rest_line(counts.size(), shown.size(), "as few or fewer", "species");
}

// Collisions of each two species: their number, or how their rate in equilibrium compares.
std::string pair_lines(const Report& report) {
  const Composition& composition = report.simulation.composition();
  const auto collisions = report.simulation.collisions_by_pair();
  const std::vector<double> exact = report.pair_rates_exact();
  const double time = report.result.last.time;
  // In the order of the indices of pairs.
  std::vector<std::string> names;
  std::vector<bool> both_fixed;
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      names.push_back(pair_name(composition, a, b));
      both_fixed.push_back(composition[a].fixed && composition[b].fixed);
    }
  }
  const std::vector<std::size_t> shown = those_shown(collisions);
  std::string text;
  for (const std::size_t pair : shown) {
    if (both_fixed[pair]) continue;
    text += line(text.empty() ? "pairs" : "", "{}: {} collisions", names[pair], collisions[pair]);
    if (exact.empty() || !(exact[pair] * time > 0)) continue;
    text.pop_back();
    text += fmt::format(", ratio to the exact rate {:.4f}\n",
                        static_cast<double>(collisions[pair]) / (exact[pair] * time));
  }
  return text + rest_line(names.size(), shown.size(), "as few or fewer", "collisions_by_pair");
}

// The numbers of a result that there are, with their names as words, without these.
template <class Sums>
std::string numbers_text(const Sums& sums, std::span<const std::string_view> without = {}) {
  std::string text;
  sums.for_each([&](const Described& number, const auto& value) {
    if (std::ranges::find(without, number.name) != without.end()) return;
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
      if (!std::isfinite(static_cast<double>(value))) return;
    }
    std::string name = number.name;
    std::ranges::replace(name, '_', ' ');
    text += fmt::format("{}{} ", text.empty() ? "" : ", ", name);
    if constexpr (std::is_integral_v<std::decay_t<decltype(value)>>) {
      text += fmt::format("{}", value);
    } else if constexpr (std::is_floating_point_v<std::decay_t<decltype(value)>>) {
      text += fmt::format("{:.5g}", value);
    } else {
      text += fmt::format("{:.5g}", fmt::join(value, ", "));
    }
  });
  return text;
}

std::string stress_lines(const StressTotals& mean) {
  const auto with_error = [](double value, double error) {
    return std::isfinite(error) ? fmt::format("{:.4g} +- {:.2g}", value, error)
                                : fmt::format("{:.4g}", value);
  };
  const auto all = [&](std::size_t a, std::size_t b) {
    return mean.kinetic[a][b] + mean.collisional[a][b];
  };
  std::string text = line("pressure",
                          "P_xx {:.4g}, P_yy {:.4g}, P_zz {:.4g}, P_yx {:.4g}, P_xy "
                          "{:.4g}: mean over the run",
                          all(0, 0), all(1, 1), all(2, 2), all(1, 0), all(0, 1));
  if (!std::isnan(mean.viscosity)) {
    text += line("", "viscosity {}, P_xx - P_yy {}, P_yy - P_zz {}",
                 with_error(mean.viscosity, mean.viscosity_error),
                 with_error(mean.first_normal_difference, mean.first_normal_difference_error),
                 with_error(mean.second_normal_difference, mean.second_normal_difference_error));
  }
  return text;
}

// Those that are in no other line.
std::string rest_of_totals(const Totals& last) {
  constexpr std::array<std::string_view, 7> elsewhere = {
      "time", "t_tr", "t_rot", "energy", "momentum", "collisions", "tc_collisions"};
  const std::string text = numbers_text(last, elsewhere);
  return text.empty() ? text : line("totals", "{}", text);
}

std::string rod_line(const Report& report) {
  if (!report.simulation.composition().has_width() || !(report.result.last.time > 0)) return {};
  const observe::RodTotals rods = runs::rod_totals(report.scene, report.simulation);
  return line("rods", "{}; pressure: {}", numbers_text(rods), rods.pressure_meaning);
}

std::string wall_lines(const Report& report) {
  // What says nothing of walls that are at rest, and not thermal.
  constexpr std::array<std::string_view, 5> of_motion = {"place", "work", "impulse_x", "impulse_y",
                                                         "impulse_z"};
  const std::vector<Scene::WallSide> sides = report.scene.wall_sides();
  const std::vector<WallTotals> walls = report.simulation.wall_totals();
  std::string text;
  for (std::size_t n = 0; n < sides.size(); ++n) {
    const WallTotals& wall = walls[n];
    const Scene::Wall& given = report.scene.walls[sides[n].entry];
    const bool is_plain = !given.motion && !given.temperature;
    text += line(text.empty() ? "walls" : "", "{} {}: {}", axis_name(wall), side_name(wall),
                 is_plain ? numbers_text(wall, of_motion) : numbers_text(wall));
  }
  return text;
}

// What has put energy into the needles, or taken it out.
std::string budget_line(const Report& report) {
  if (!acts_on_single_needles(report.scene)) return {};
  std::string text;
  const auto add = [&](const std::string& name, double energy) {
    text += fmt::format("{}{} {:+.5g}", text.empty() ? "" : ", ", name, energy);
  };
  const auto walls = report.simulation.wall_totals();
  report.simulation.energy_budget().for_each([&](const Described& number, const auto& energy) {
    const std::string name = number.name;
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(energy)>>) {
      const bool is_of_caller = name == "velocities_set";
      if (!is_of_caller || energy != 0) add(name, energy);
    } else {
      for (std::size_t n = 0; n < walls.size(); ++n) {
        add(fmt::format("wall {} {}", axis_name(walls[n]), side_name(walls[n])), energy[n]);
      }
    }
  });
  return line("energy from", "{} per needle", text);
}

// The sample next to a time, if there is one within a twentieth of it.
const Totals* sample_at(const runs::RunResult& result, double time) {
  const Totals* found = nullptr;
  for (const Totals& sample : result.samples) {
    const double off = std::abs(sample.time - time);
    if (off < 0.05 * time && !(found && std::abs(found->time - time) < off)) found = &sample;
  }
  return found;
}

bool shows_course(const Report& report) {
  return !runs::starts_in_equilibrium(report.scene) && report.result.last.collisions > 0;
}

// Those of the course, by decades of time from about the mean free time on; every second or third
// decade of a long run.
std::vector<const Totals*> samples_of_course(const Report& report) {
  constexpr int most_rows = 8;
  const double mean_free_time = 1 / report.initial_collision_rate();
  const double begin = std::ceil(std::log10(0.5 * mean_free_time));
  const double end = std::floor(std::log10(report.result.last.time));
  const double stride = std::max(1.0, std::ceil((end - begin + 1) / most_rows));
  std::vector<const Totals*> out;
  for (double decade = begin; decade <= end; decade += stride) {
    if (const Totals* sample = sample_at(report.result, std::pow(10, decade)))
      out.push_back(sample);
  }
  return out;
}

// Asks theory of all samples below in the order of their times: it follows its curve once then.
void ask_theory(const Report& report) {
  std::vector<const Totals*> samples{&report.result.last};
  if (const Totals* before = decade_before(report.result)) samples.push_back(before);
  if (shows_course(report)) {
    const std::vector<const Totals*> more = samples_of_course(report);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  std::ranges::sort(samples, {}, &Totals::time);
  for (const Totals* sample : samples) report.theory_at(*sample);
}

// The course next to that of theory.
std::string curve_lines(const Report& report) {
  const Totals& first = report.result.initial;
  std::string rows;
  for (const Totals* sample : samples_of_course(report)) {
    const auto theory = report.theory_at(*sample);
    if (!theory) continue;
    rows += fmt::format("{:16}{:<10.4g}{:<12.4g}{:<12.4g}{:<12.4g}{:.4g}\n", "", sample->time,
                        sample->energy / first.energy, theory->energy() / first.energy,
                        sample->t_tr / sample->t_rot, theory->t_tr / theory->t_rot);
  }
  if (rows.empty()) return rows;
  return line("course", "{:<10}{:<12}{:<12}{:<12}{}", "time", "E/E(0)", "theory", "T_tr/T_rot",
              "theory") +
         rows;
}

// Over which needles means are that are of all.
const char* those_counted(const Report& report) {
  return report.simulation.composition().has_fixed() ? ", fixed ones among them" : "";
}

std::string rate_line(const Report& report) {
  const double rate = report.collision_rate();
  const double exact = report.collision_rate_exact();
  const double error = report.collision_rate_error();
  const char* of = those_counted(report);
  if (!std::isfinite(exact)) return line("rate", "{:.5g} per needle and time{}", rate, of);
  if (!(error > 0)) {
    return line("rate", "{:.5g} per needle and time{}, exact {:.5g}: ratio {:.4f}", rate, of, exact,
                rate / exact);
  }
  return line("rate", "{:.5g} per needle and time{}, exact {:.5g}: ratio {:.4f} +- {:.4f}", rate,
              of, exact, rate / exact, error / exact);
}

// How several threads shared the work; see docs/parallel.md.
std::string thread_line(const Report& report) {
  const std::string text = runs::threads_text(report.scene);
  const int threads = report.scene.engine.threads.value_or(1);
  if (threads == 1) return line("threads", "{}", text);
  const Counters& counters = report.simulation.counters();
  if (counters.phases == 0) {
    return line("threads", "{}; one did all: too few needles, or collisions, to share", text);
  }
  const auto events = static_cast<double>(counters.events);
  const double time = threads * report.result.loop.wall();
  return line(
      "threads",
      "{}: {:.3g} events between stalls, blocked {} of the time; {:.2g} looks at others and {:.2g} "
      "messages to them an event; {} of {} phases undone",
      text, events / static_cast<double>(std::max<std::uint64_t>(counters.stalls, 1)),
      per_cent(1e-9 * static_cast<double>(counters.blocked) / time),
      static_cast<double>(counters.border) / events,
      static_cast<double>(counters.messages) / events, counters.redone, counters.phases);
}

}  // namespace

std::string summary_of(const Report& report) {
  const Scene& scene = report.scene;
  const Totals& last = report.result.last;
  const auto& box = scene.needles.box;
  std::string text = scene.title.empty() ? "" : scene.title + "\n";
  text += line("gas", "{} needles in a box of {:g} x {:g} x {:g}{}, {}", scene.needles.count,
               box[0], box[1], box[2], scene.has_moving_walls() ? " at the start" : "",
               report.simulation.effects());
  if (const std::string placement = report.simulation.placement(); !placement.empty())
    text += line("start", "{}", placement);
  text += size_lines(report);
  text += line("end", "{}: time {:.6g}", reason(report.result), last.time);
  if (report.simulation.composition().is_mixture()) ask_theory(report);
  if (report.result.initial.energy > 0) text += energy_lines(report);
  if (report.simulation.composition().is_mixture())
    text += temperature_lines(report) + pair_lines(report);
  if (runs::starts_in_equilibrium(scene) && last.time > 0) text += rate_line(report);
  if (shows_course(report)) text += curve_lines(report);
  text += theory_line(report);
  text += line("collisions", "{}, {:.4g} per needle{}", last.collisions,
               last.collisions ? report.collisions_per_needle() : 0.0, those_counted(report));
  if (scene.collisions.tc || scene.collisions.tc_relative) {
    const double share =
        static_cast<double>(last.tc_collisions) / static_cast<double>(last.collisions);
    text.pop_back();
    text += fmt::format("; {} of them ({}) elastic by the t_c rule\n", last.tc_collisions,
                        per_cent(last.collisions ? share : 0));
  }
  text += rest_of_totals(last);
  if (const auto contacts = report.simulation.sliding_contacts()) {
    text += line("contacts", "{}", numbers_text(*contacts));
  }
  if (const auto growth = report.simulation.growth())
    text += line("growth", "{}, as P V / (N T)", numbers_text(*growth));
  if (const auto stress = report.simulation.stress()) text += stress_lines(*stress);
  text += rod_line(report);
  text += wall_lines(report);
  text += budget_line(report);
  const int threads = scene.engine.threads.value_or(1);
  text += line("took", "{} of wall time", runs::duration_text(report.result.loop.wall()));
  if (report.result.collisions > 0) {
    text.pop_back();
    text += fmt::format("; {:.3g} us per collision of CPU time{}\n", report.us_per_collision(),
                        threads > 1 ? ", all threads together" : "");
  }
  if (threads > 1 || scene.engine.threads_by_size) text += thread_line(report);
  if (!scene.output.file.empty()) text += line("file", "{}", scene.output.file);
  return text;
}

}  // namespace needlework::cli
