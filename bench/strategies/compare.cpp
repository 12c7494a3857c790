#include "bench/strategies/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bench/strategies/cases.h"
#include "needlework/error.h"

namespace needlework::bench {
namespace {

using Json = nlohmann::ordered_json;

const CaseResult* find_case(const Results& results, const std::string& name) {
  for (const CaseResult& result : results.cases) {
    if (result.name == name) return &result;
  }
  return nullptr;
}

// A part of their names in which all cases of one result differ from those of the other.
struct OtherSetting {
  const NameParts::Named* part;
  std::string before, after;
};

NameParts without(NameParts parts, const NameParts::Named& part) {
  (parts.*part.part).clear();
  return parts;
}

const CaseResult* find_case(const Results& results, const NameParts& parts,
                            const NameParts::Named& but) {
  for (const CaseResult& result : results.cases) {
    if (without(parts_of(result.name), but) == without(parts, but)) return &result;
  }
  return nullptr;
}

std::optional<OtherSetting> other_setting(const Results& before, const Results& after) {
  for (const CaseResult& result : after.cases) {
    if (find_case(before, result.name)) return std::nullopt;
  }
  for (const NameParts::Named& part : NameParts::all) {
    const NameParts now = parts_of(after.cases.front().name);
    const CaseResult* const old = find_case(before, now, part);
    if (old) return OtherSetting{&part, parts_of(old->name).*part.part, now.*part.part};
  }
  return std::nullopt;
}

std::string percent(double quotient) { return fmt::format("{:+.1f} %", 100 * (quotient - 1)); }

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

}  // namespace

const char* const rule_of_verdicts =
    "A case is judged by its cost over that of the baseline in the same repetition. The change is "
    "the median of new over old relative costs over all pairs of repetitions, with the interval of "
    "95 % of Mann and Whitney's rank test. same: the interval lies within 3 % of no change. "
    "faster, "
    "slower: else, it lies on one side of it. unclear: else, or with too few repetitions, such as "
    "three and four. Results whose cases all differ in one setting are judged by their times "
    "themselves.";

Change change_between(const std::vector<double>& before, const std::vector<double>& after) {
  std::vector<double> differences;
  for (const double x : before) {
    for (const double y : after) differences.push_back(std::log(y / x));
  }
  std::sort(differences.begin(), differences.end());
  const double n = static_cast<double>(before.size()), m = static_cast<double>(after.size());
  // The rank of the bounds, by the normal approximation with correction for continuity.
  const double deviation = std::sqrt(n * m * (n + m + 1) / 12);
  const double rank = std::floor(n * m / 2 - 1.96 * deviation - 0.5);
  Change out{std::exp(median(differences)), 0, std::numeric_limits<double>::infinity()};
  if (rank >= 0) {
    const auto place = static_cast<std::size_t>(rank);
    out.low = std::exp(differences[place]);
    out.high = std::exp(differences[differences.size() - 1 - place]);
  }
  return out;
}

std::string verdict_of(const Change& change) {
  if (change.low >= 1 / (1 + same_within) && change.high <= 1 + same_within) return "same";
  if (change.high < 1) return "faster";
  if (change.low > 1) return "slower";
  return "unclear";
}

void require_common_case(const Results& before, const Results& after) {
  for (const CaseResult& result : after.cases) {
    if (find_case(before, result.name)) return;
  }
  if (other_setting(before, after)) return;
  throw InputError(
      "--compare: no case in common: expected results of the same subset, or of one scene with one "
      "other setting");
}

std::vector<std::string> unlike(const Results& before, const Results& after) {
  std::vector<std::string> out;
  for (const char* key : {"machine", "compiler", "flags"}) {
    const std::string old = about_text(before.about, key), now = about_text(after.about, key);
    if (old != now) out.push_back(fmt::format("{}: {} before, {} now", key, old, now));
  }
  if (by_wall_clock(before) != by_wall_clock(after)) {
    out.push_back(fmt::format("times: {} time before, {} time now",
                              by_wall_clock(before) ? "wall" : "CPU",
                              by_wall_clock(after) ? "wall" : "CPU"));
  }
  return out;
}

Comparison compare(const Results& before, const Results& after) {
  Comparison out;
  out.json = Json::array();
  const std::optional<OtherSetting> other = other_setting(before, after);
  if (other) {
    const auto named = [](const std::string& text) { return text.empty() ? "none" : text; };
    out.text = fmt::format(
        "{}: {} before, {} now. The baselines differ in it as well, so that the times themselves "
        "are\njudged: both have to come from one machine without other load.\n\n",
        other->part->name, named(other->before), named(other->after));
  }
  // The name of a case has a line of its own, so that long names fit.
  out.text += fmt::format("case\n{:>14} {:>9} {:>10} {:>10} {:>9} {:>21}  {}\n", "old us", "new us",
                          "old/base", "new/base", "change", "95 %", "verdict");
  for (const CaseResult& now : after.cases) {
    out.text += now.name + '\n';
    const CaseResult* old =
        other ? find_case(before, parts_of(now.name), *other->part) : find_case(before, now.name);
    if (!old) {
      out.text += fmt::format("{:>14} {:9.2f}  only in the new results\n", "-", now.median());
      continue;
    }
    if (now.is_baseline && !other) {
      out.text += fmt::format("{:14.2f} {:9.2f}  baseline, {} by itself\n", old->median(),
                              now.median(), percent(now.median() / old->median()));
      continue;
    }
    const std::vector<double> old_costs =
        other ? old->us_per_collision : relative_costs(before, *old);
    const std::vector<double> costs = other ? now.us_per_collision : relative_costs(after, now);
    const Change change = change_between(old_costs, costs);
    const std::string verdict = verdict_of(change);
    out.differs |= verdict == "faster" || verdict == "slower";
    const std::string interval =
        change.low > 0 ? fmt::format("{} .. {}", percent(change.low), percent(change.high)) : "-";
    const auto relative = [&](const std::vector<double>& cost) {
      return other ? std::string("-") : fmt::format("{:.4f}", median(cost));
    };
    out.text += fmt::format("{:14.2f} {:9.2f} {:>10} {:>10} {:>9} {:>21}  {}\n", old->median(),
                            now.median(), relative(old_costs), relative(costs),
                            percent(change.estimate), interval, verdict);
    out.json.push_back({{"name", now.name},
                        {"old_name", old->name},
                        {"old_us_per_collision", old->median()},
                        {"new_us_per_collision", now.median()},
                        {"old_relative_cost", other ? Json(nullptr) : Json(median(old_costs))},
                        {"new_relative_cost", other ? Json(nullptr) : Json(median(costs))},
                        {"change", change.estimate},
                        {"low", change.low},
                        {"high", number(change.high)},
                        {"verdict", verdict}});
  }
  return out;
}

}  // namespace needlework::bench
