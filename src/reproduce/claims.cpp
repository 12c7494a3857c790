#include "src/reproduce/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "src/scene/document.h"

namespace needlework::reproduce {
namespace {

std::optional<double> number_of(const Value& value) {
  if (const auto* real = value.as<double>()) return *real;
  if (const auto* integer = value.as<std::int64_t>()) return static_cast<double>(*integer);
  return std::nullopt;
}

class Reader {
 public:
  Reader(std::string_view text, std::string_view name) : document_(text, name, {}) {}

  std::vector<Claim> read() {
    for (const Entry& entry : document_.entries()) {
      if (entry.section.empty()) throw document_.error(entry, "expected a claim, [ID]");
      if (entry.is_head) {
        begin(entry);
      } else {
        take(entry);
      }
    }
    for (Claim& claim : claims_) require_complete(claim);
    return std::move(claims_);
  }

 private:
  void begin(const Entry& entry) {
    const auto same = [&](const Claim& claim) { return claim.id == entry.section; };
    if (std::any_of(claims_.begin(), claims_.end(), same)) {
      throw document_.error(entry, "expected another id: there is a claim of that name");
    }
    claims_.emplace_back().id = entry.section;
  }

  void take(const Entry& entry) {
    Claim& claim = claims_.back();
    if (entry.key == "paper" || entry.key == "precision") {
      (entry.key == "paper" ? claim.paper.number : claim.paper.precision) = number(entry);
    } else if (std::string* const text = text_of(claim, entry.key)) {
      const auto* value = entry.value.as<std::string>();
      if (!value || value->empty()) throw document_.error(entry, "expected a text");
      *text = *value;
    } else {
      throw document_.error(entry,
                            "expected one of figure, statement, where, quantity, paper, precision, "
                            "reading");
    }
  }

  double number(const Entry& entry) const {
    const auto value = number_of(entry.value);
    const bool fits = value && std::isfinite(*value) && (entry.key == "paper" || *value > 0);
    if (!fits) {
      throw document_.error(
          entry, entry.key == "paper" ? "expected a number" : "expected a number greater than 0");
    }
    return *value;
  }

  static std::string* text_of(Claim& claim, std::string_view key) {
    if (key == "figure") return &claim.figure;
    if (key == "statement") return &claim.statement;
    if (key == "where") return &claim.where;
    if (key == "quantity") return &claim.quantity;
    if (key == "reading") return &claim.reading;
    return nullptr;
  }

  void require_complete(Claim& claim) const {
    for (const char* key : {"figure", "statement", "quantity"}) {
      if (text_of(claim, key)->empty()) {
        throw document_.missing(fmt::format("{}.{}", claim.id, key), "expected a text");
      }
    }
    if (claim.paper.precision && !claim.paper.number) {
      throw document_.missing(claim.id + ".paper", "expected the number that has this precision");
    }
  }

  Document document_;
  std::vector<Claim> claims_;
};

}  // namespace

std::vector<Claim> read_claims(std::string_view text, std::string_view name) {
  return Reader(text, name).read();
}

}  // namespace needlework::reproduce
