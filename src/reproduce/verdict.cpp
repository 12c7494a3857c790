#include "src/reproduce/verdict.h"

#include <cmath>

namespace needlework::reproduce {
namespace {

constexpr std::size_t least_seeds = 3;
constexpr double standard_errors = 3;

}  // namespace

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::agrees:
      return "agrees";
    case Verdict::differs:
      return "differs";
    default:
      return "open";
  }
}

Verdict verdict_of(const Stated& stated, const Measured& measured) {
  if (!stated.number || !stated.precision) return Verdict::open;
  if (measured.seeds && *measured.seeds < least_seeds) return Verdict::open;
  if (!std::isfinite(measured.value) || !std::isfinite(measured.error)) return Verdict::open;
  if (measured.error > *stated.precision) return Verdict::open;
  const double difference = std::abs(measured.value - *stated.number);
  return difference <= standard_errors * measured.error + *stated.precision ? Verdict::agrees
                                                                            : Verdict::differs;
}

}  // namespace needlework::reproduce
