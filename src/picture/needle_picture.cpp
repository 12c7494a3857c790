#include "src/picture/needle_picture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "src/box/box.h"
#include "src/box/own_numbers.h"
#include "src/box/tilt.h"
#include "src/picture/needle_values.h"
#include "src/picture/stroke_font.h"
#include "src/picture/walls.h"

namespace needlework::picture {
namespace {

constexpr double thickness = 0.07;   // of a needle in the middle of the box, in its length
constexpr double thinnest = 0.7;     // [pixels]
constexpr double faintest = 0.4;     // share of its colour that the farthest needle keeps
constexpr double least_unit = 0.55;  // letters of smaller pictures could not be read
constexpr double lattice = 8;        // lines across the longer edge of a wall

struct Theme {
  Colour ground, text, outline, needle;
  std::array<Colour, 3> walls;  // by their kind
};

Theme theme_of(bool dark) {
  if (dark) {
    return {{11, 16, 32},
            {230, 234, 245},
            {74, 86, 128},
            {150, 190, 255},
            {{{150, 162, 190}, {70, 190, 160}, {240, 130, 80}}}};
  }
  return {{255, 255, 255},
          {34, 34, 34},
          {150, 156, 170},
          {40, 80, 150},
          {{{100, 108, 126}, {0, 128, 100}, {196, 70, 16}}}};
}

std::string count_text(const State& state) {
  return state.size() == 1 ? "1 needle" : fmt::format("{} needles", state.size());
}

// Sizes of all needles or, where those of a species are alike, of the species.
const std::vector<double>& sizes_of(const std::vector<double>& own,
                                    const std::vector<double>& of_species) {
  return own.empty() || of_species.empty() ? of_species : own;
}

// So far needles reach out of the region that their centres are in.
double margin_of(const State& state, const NeedlePicture& settings) {
  const auto largest = [](const std::vector<double>& sizes) {
    return sizes.empty() ? 0 : std::ranges::max(sizes);
  };
  return (largest(sizes_of(state.own_bodies.length, settings.lengths)) +
          largest(sizes_of(state.own_bodies.diameter, settings.diameters))) /
         2;
}

// "1", or "0.5, 1" of several species, or "0.41 to 2.3" of needles that differ.
std::string text_of_sizes(const std::vector<double>& own, const std::vector<double>& of_species) {
  if (own.empty()) return fmt::format("{:g}", fmt::join(of_species, ", "));
  const auto [least, greatest] = std::ranges::minmax(own);
  return fmt::format("{:.3g} to {:.3g}", least, greatest);
}

class Painter {
 public:
  Painter(const State& state, const NeedlePicture& settings)
      : state_(state),
        box_(box_of(state)),
        cell_(state),
        settings_(settings),
        theme_(theme_of(settings.dark)),
        unit_(std::max(least_unit, std::min(settings.width, settings.height) / 832.0)),
        walls_(surfaces_of(settings.walls, state, settings.time)),
        region_(region_of(state, walls_)),
        camera_(region_, margin_of(state, settings), settings.camera, frame()) {}

  Drawing drawing() {
    const NeedleValues values = values_of(settings_.colour, state_, settings_.dark);
    drawing_.width = settings_.width;
    drawing_.height = settings_.height;
    drawing_.ground = theme_.ground;
    const auto edges = edges_of(region_, camera_);
    for (std::size_t i = 0; i < 9; ++i) draw_edge(edges[i]);
    draw_walls(true);
    draw_needles(values);
    for (std::size_t i = 9; i < 12; ++i) draw_edge(edges[i]);
    draw_walls(false);
    if (!values.label.empty()) draw_legend(values);
    draw_caption();
    draw_kinds_of_walls();
    describe(values);
    return std::move(drawing_);
  }

 private:
  // What the legend leaves for the box.
  Frame frame() const {
    const double edge = 14 * unit_;
    const double top = settings_.walls.empty() ? edge : edge + 26 * unit_;
    return {edge, top, settings_.width - edge, settings_.height - 76 * unit_};
  }

  void draw_line(const Vector& from, const Vector& to, double width, Colour colour) {
    drawing_.strokes.push_back(
        {camera_.see(from).place, camera_.see(to).place, width * unit_, colour});
  }

  void draw_edge(const std::pair<Vector, Vector>& edge) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (edge.first[axis] != edge.second[axis]) continue;
      if (is_open(walls_, axis, edge.first[axis] == region_.high[axis])) return;
    }
    draw_line(edge.first, edge.second, 1.3, theme_.outline);
  }

  void draw_walls(bool seen_from_the_gas) {
    for (const WallSurface& wall : walls_) {
      const bool is_behind = camera_.is_above(wall.axis, wall.place) != wall.is_high;
      if (is_behind == seen_from_the_gas) draw_wall(wall, is_behind);
    }
  }

  void draw_wall(const WallSurface& wall, bool with_lattice) {
    const Colour colour = theme_.walls[static_cast<std::size_t>(wall.kind)];
    const std::size_t a = (wall.axis + 1) % 3, b = (wall.axis + 2) % 3;
    const double cell =
        std::max(region_.high[a] - region_.low[a], region_.high[b] - region_.low[b]) / lattice;
    for (const auto& [across, along] : {std::pair(a, b), std::pair(b, a)}) {
      const double edge = region_.high[across] - region_.low[across];
      const int lines = with_lattice ? std::max(1, static_cast<int>(std::lround(edge / cell))) : 1;
      for (int n = 0; n <= lines; ++n) {
        Vector from = region_.low;
        from[wall.axis] = wall.place;
        from[across] += edge * n / lines;
        Vector to = from;
        to[along] = region_.high[along];
        const bool is_outline = n == 0 || n == lines;
        draw_line(region_.tilted(from), region_.tilted(to), is_outline ? 2.2 : 0.9,
                  is_outline ? colour : mixed(colour, theme_.ground, 0.55));
      }
    }
  }

  // A line for each kind of wall that there is, and what it is called.
  void draw_kinds_of_walls() {
    double x = 16 * unit_;
    const double y = 26 * unit_;
    for (const WallKind kind : {WallKind::resting, WallKind::moving, WallKind::thermal}) {
      const auto is_of_kind = [&](const WallSurface& wall) { return wall.kind == kind; };
      if (std::ranges::none_of(walls_, is_of_kind)) continue;
      const double level = y - 6 * unit_;
      drawing_.strokes.push_back({{x, level},
                                  {x + 26 * unit_, level},
                                  2.2 * unit_,
                                  theme_.walls[static_cast<std::size_t>(kind)]});
      write(name_of(kind), {x + 36 * unit_, y}, Words::Anchor::start);
      x += 36 * unit_ + length_of(drawing_.words.back()) + 24 * unit_;
    }
  }

  // In the box that is drawn.
  Vector place_of(const Vector& centre) const { return cell_.inside(box_.wrap(centre).place); }

  void draw_needles(const NeedleValues& values) {
    std::vector<Seen> middles;
    for (const Vector& centre : state_.position) middles.push_back(camera_.see(place_of(centre)));
    std::vector<std::size_t> order(state_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return middles[a].nearness < middles[b].nearness;
    });
    for (const std::size_t i : order) {
      const Colour colour =
          values.label.empty() ? theme_.needle : colour_of(values, values.values[i]);
      draw_needle(i, middles[i], colour);
    }
  }

  void draw_needle(std::size_t i, const Seen& middle, Colour colour) {
    const double length = number_at(state_, i, &OwnBodies::length, settings_.lengths);
    const Vector centre = place_of(state_.position[i]);
    std::array<Vector, 2> ends{centre, centre};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double half = length / 2 * state_.orientation[i][axis];
      ends[0][axis] -= half;
      ends[1][axis] += half;
    }
    // Nearness shows more in the thickness than perspective alone would make it.
    const double diameter = settings_.diameters.empty()
                                ? 0
                                : number_at(state_, i, &OwnBodies::diameter, settings_.diameters);
    const bool has_width = diameter > 0;
    const double full = has_width ? diameter * middle.scale
                                  : thickness * length * middle.scale * (0.5 + middle.nearness);
    const double share = faintest + (1 - faintest) * std::clamp(middle.nearness, 0.0, 1.0);
    drawing_.strokes.push_back(
        {camera_.see(ends[0]).place, camera_.see(ends[1]).place, std::max(full, thinnest * unit_),
         mixed(colour, theme_.ground, share), has_width ? unit_ : 0.35 * full});
  }

  static Colour colour_of(const NeedleValues& values, double value) {
    return colour_at(values.gradient, Scale{values.range, false, 0, 1}(value));
  }

  void write(const std::string& text, Point place, Words::Anchor anchor) {
    drawing_.words.push_back({text, place, anchor, 17 * unit_, theme_.text});
  }

  // A bar of colours with what they mean above it and numbers below it.
  void draw_legend(const NeedleValues& values) {
    constexpr int parts = 64;
    const double left = 0.3 * settings_.width, right = 0.7 * settings_.width;
    // Its edges are between pixels, where parts that overlap leave no trace.
    const double bar = std::round(10 * unit_);
    const double y = std::round(settings_.height - 36 * unit_) + std::fmod(bar, 2) / 2;
    const Scale scale{values.range, false, left, right};
    const auto place = [&](double part) { return left + (right - left) * part / parts; };
    for (int i = 0; i < parts; ++i) {
      drawing_.strokes.push_back(
          {{place(i), y}, {place(i + 1), y}, bar, colour_at(values.gradient, (i + 0.5) / parts)});
    }
    write(values.label, {(left + right) / 2, y - 14 * unit_}, Words::Anchor::middle);
    for (const Tick& tick : ticks(values.range, false, 4)) {
      if (tick.value != std::round(tick.value)) continue;
      write(fmt::format("{:.0f}", tick.value), {scale(tick.value), y + 24 * unit_},
            Words::Anchor::middle);
    }
  }

  void draw_caption() {
    const double y = settings_.height - 12 * unit_, edge = 16 * unit_;
    if (settings_.time) {
      write(fmt::format("time {:.6g}", *settings_.time), {edge, y}, Words::Anchor::start);
    }
    write(count_text(state_), {settings_.width - edge, y}, Words::Anchor::end);
  }

  void describe(const NeedleValues& values) {
    const OwnBodies& own = state_.own_bodies;
    drawing_.title = count_text(state_);
    drawing_.description =
        fmt::format("{} of {} {} in a {}box of {:g} by {:g} by {:g}", count_text(state_),
                    settings_.lengths.size() == 1 && own.length.empty() ? "length" : "lengths",
                    text_of_sizes(own.length, settings_.lengths),
                    state_.periodic == std::array{true, true, true} ? "periodic " : "",
                    state_.box[0], state_.box[1], state_.box[2]);
    if (cell_.is_sheared()) drawing_.description += fmt::format(", tilted by {:g}", cell_.xy());
    if (!settings_.diameters.empty())
      drawing_.description +=
          fmt::format(", of diameter {}", text_of_sizes(own.diameter, settings_.diameters));
    std::vector<std::string> walled;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!state_.periodic[axis]) walled.emplace_back(1, "xyz"[axis]);
    }
    if (!walled.empty()) {
      drawing_.description += fmt::format(", not periodic along {}", fmt::join(walled, " and "));
    }
    for (const Scene::Wall& wall : settings_.walls) {
      drawing_.description += fmt::format(
          "{} {}", &wall == settings_.walls.data() ? ", walls:" : ",", description_of(wall));
    }
    if (settings_.time) drawing_.description += fmt::format(" at time {:.6g}", *settings_.time);
    if (!values.label.empty()) {
      drawing_.description += fmt::format("; colours are {} from {:g} to {:g}", values.label,
                                          values.range.low, values.range.high);
    }
    drawing_.description += ".";
  }

  const State& state_;
  Box box_;
  TiltedCell cell_;
  const NeedlePicture& settings_;
  Theme theme_;
  double unit_;  // of what is drawn, in pixels: 1 in a picture of the usual size
  std::vector<WallSurface> walls_;
  Region region_;
  Camera camera_;
  Drawing drawing_;
};

}  // namespace

Drawing drawing_of(const State& state, const NeedlePicture& settings) {
  return Painter(state, settings).drawing();
}

}  // namespace needlework::picture
