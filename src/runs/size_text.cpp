#include "src/runs/size_text.h"

#include <fmt/format.h>

#include <optional>

namespace needlework::runs {
namespace {

std::string text_of(const Distribution& drawn) {
  std::string text = name_of(drawn.shape);
  if (drawn.mean) text += fmt::format(" of mean {:g}", *drawn.mean);
  if (drawn.width) text += fmt::format(", width {:g}", *drawn.width);
  if (drawn.exponent) text += fmt::format(" of exponent {:g}", *drawn.exponent);
  if (drawn.least) text += fmt::format(", at least {:g}", *drawn.least);
  if (drawn.greatest) text += fmt::format(", at most {:g}", *drawn.greatest);
  return text;
}

// A line of a number that differs, or that is drawn; nothing of another.
std::string line_of(const char* name, const Spread& spread, const std::string& drawn) {
  if (drawn.empty() && spread.is_one()) return {};
  return fmt::format("{}{}: {}mean {:.4g}, width {:.3g}, from {:.3g} to {:.3g}", name, drawn,
                     drawn.empty() ? "" : "drawn ", spread.mean, spread.width, spread.least,
                     spread.greatest);
}

std::string drawn_text(const std::optional<Distribution>& drawn) {
  return drawn ? " " + text_of(*drawn) : "";
}

// Of the bodies; nothing where each has its own.
std::optional<double> common_k(const Species& species) {
  if (!species.sizes) return species.k;
  return species.sizes->k.is_one() ? std::optional(species.sizes->k.mean) : std::nullopt;
}

std::string k_text(const Species& species) {
  const auto k = common_k(species);
  if (!k) return "of different k";
  if (species.diameter > 0) return fmt::format("k = {:.6g}", *k);
  if (*k == 6) return "k = 6, uniform rods";
  if (*k == 2) return "k = 2, all mass at the tips";
  return fmt::format("k = {:g}", *k);
}

}  // namespace

std::string shape_text(const Species& species) {
  const bool differ = species.sizes && !species.sizes->diameter.is_one();
  const std::string width =
      differ ? "different diameters" : fmt::format("diameter {:g}", species.diameter);
  if (!species.has_axis()) return (species.turns() ? "rough spheres of " : "spheres of ") + width;
  if (species.diameter > 0) {
    const std::string rods = "rods of " + width;
    return species.fixed ? rods : rods + ", " + k_text(species);
  }
  return species.fixed ? "thin needles" : k_text(species);
}

std::vector<std::string> size_lines(const Species& species) {
  std::vector<std::string> out;
  if (!species.sizes) return out;
  const Sizes& sizes = *species.sizes;
  const DrawnSizes& drawn = species.drawn;
  const auto add = [&](std::string line) {
    if (!line.empty()) out.push_back(std::move(line));
  };
  add(line_of("length", sizes.length, drawn_text(drawn.length)));
  add(line_of(
      "diameter", sizes.diameter,
      drawn.aspect ? fmt::format(" of aspect {:g}", *drawn.aspect) : drawn_text(drawn.diameter)));
  if (species.fixed) return out;
  add(line_of(
      "mass", sizes.mass,
      drawn.density ? fmt::format(" of density {:g}", *drawn.density) : drawn_text(drawn.mass)));
  if (!species.turns()) return out;
  add(line_of("k", sizes.k, drawn_text(drawn.k)));
  // It follows from the others, if it is not drawn.
  if (drawn.inertia) add(line_of("inertia", sizes.inertia, drawn_text(drawn.inertia)));
  return out;
}

}  // namespace needlework::runs
