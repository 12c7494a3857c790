#include "src/picture/stroke_font.h"

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

namespace needlework::picture {
namespace {

// Units of a shape: small letters are 4 high, digits 6.
constexpr double unit = 0.12;  // of the size of words
constexpr double gap = 1.6, space = 2.4;
constexpr double weight = 0.09;  // width of lines, of the size of words

// `l x y x y ...` is a line from point to point; `a x y rx ry from to` is an arc of an ellipse
// around (x, y), counterclockwise between two angles in degrees. y counts upwards from the base
// line.
struct Shape {
  double width;
  const char* lines;
};

constexpr Shape box{3, "l 0 0 3 0 3 5 0 5 0 0"};

const std::map<char, Shape>& shapes() {
  static const std::map<char, Shape> all{
      {'a', {4, "a 2 2 2 2 0 360 l 4 4 4 0"}},
      {'b', {4, "a 2 2 2 2 0 360 l 0 6 0 0"}},
      {'c', {3.4, "a 2 2 2 2 45 315"}},
      {'d', {4, "a 2 2 2 2 0 360 l 4 6 4 0"}},
      {'e', {4, "a 2 2 2 2 0 315 l 0 2 4 2"}},
      {'f', {2, "a 2 4.7 1.3 1.3 90 180 l 0.7 4.7 0.7 0 l 0 4 2 4"}},
      {'g', {4, "a 2 2 2 2 0 360 l 4 4 4 0 a 2 0 2 2 205 360"}},
      {'h', {3.4, "l 0 6 0 0 a 1.7 2.3 1.7 1.7 0 180 l 3.4 2.3 3.4 0"}},
      {'i', {0, "l 0 4 0 0 l 0 5.6 0 5.7"}},
      {'j', {1, "l 1 4 1 -0.8 a 0 -0.8 1 1 270 360 l 1 5.6 1 5.7"}},
      {'k', {3.2, "l 0 6 0 0 l 3 4 0 1.6 l 1.2 2.5 3.2 0"}},
      {'l', {0, "l 0 6 0 0"}},
      {'m',
       {6, "l 0 4 0 0 a 1.5 2.5 1.5 1.5 0 180 l 3 2.5 3 0 a 4.5 2.5 1.5 1.5 0 180 l 6 2.5 6 0"}},
      {'n', {3.4, "l 0 4 0 0 a 1.7 2.3 1.7 1.7 0 180 l 3.4 2.3 3.4 0"}},
      {'o', {4, "a 2 2 2 2 0 360"}},
      {'p', {4, "a 2 2 2 2 0 360 l 0 4 0 -2"}},
      {'q', {4, "a 2 2 2 2 0 360 l 4 4 4 -2"}},
      {'r', {1.9, "l 0 4 0 0 a 1.6 2.4 1.6 1.6 80 180"}},
      {'s', {3, "a 1.5 3 1.4 1 40 270 a 1.5 1 1.5 1 -140 90"}},
      {'t', {2, "l 0.8 5.4 0.8 1.2 a 2 1.2 1.2 1.2 180 270 l 0 4 2 4"}},
      {'u', {3.4, "l 0 4 0 1.7 a 1.7 1.7 1.7 1.7 180 360 l 3.4 4 3.4 0"}},
      {'v', {3.5, "l 0 4 1.75 0 3.5 4"}},
      {'w', {5.2, "l 0 4 1.3 0 2.6 4 3.9 0 5.2 4"}},
      {'x', {3.2, "l 0 4 3.2 0 l 3.2 4 0 0"}},
      {'y', {3.5, "l 0 4 1.75 0 l 3.5 4 1.2 -1.3 0.2 -1.8"}},
      {'z', {3, "l 0 4 3 4 0 0 3 0"}},
      {'0', {3.6, "a 1.8 3 1.8 3 0 360"}},
      {'1', {3.6, "l 0.6 4.7 2.1 6 2.1 0"}},
      {'2', {3.6, "a 1.8 4.3 1.7 1.7 -40 180 l 3.1 3.2 0.1 0 3.6 0"}},
      {'3', {3.6, "a 1.7 4.5 1.6 1.5 -90 150 a 1.7 1.5 1.9 1.5 -150 90"}},
      {'4', {3.8, "l 2.8 0 2.8 6 0 1.7 3.8 1.7"}},
      {'5', {3.6, "l 3.3 6 0.6 6 0.4 3.3 a 1.7 1.9 1.9 1.9 -150 132"}},
      {'6', {3.6, "a 1.8 1.9 1.8 1.9 0 360 a 3.6 1.9 3.6 4.1 100 180"}},
      {'7', {3.6, "l 0 6 3.6 6 1.2 0"}},
      {'8', {3.6, "a 1.8 4.55 1.5 1.45 0 360 a 1.8 1.55 1.8 1.55 0 360"}},
      {'9', {3.6, "a 1.8 4.1 1.8 1.9 0 360 a 0 4.1 3.6 4.1 -80 0"}},
      {'.', {0, "l 0 0 0 0.1"}},
      {',', {0.4, "l 0.4 0.1 0 -1"}},
      {':', {0, "l 0 0.2 0 0.3 l 0 3.4 0 3.5"}},
      {'/', {2.4, "l 0 -0.8 2.4 6.4"}},
      {'-', {2.4, "l 0 2.4 2.4 2.4"}},
      {'+', {3.2, "l 0 2.4 3.2 2.4 l 1.6 0.8 1.6 4"}},
      {'=', {3.2, "l 0 3.2 3.2 3.2 l 0 1.6 3.2 1.6"}},
      {'(', {1.3, "a 2.6 2.4 2.6 4.4 120 240"}},
      {')', {1.3, "a -1.3 2.4 2.6 4.4 -60 60"}},
  };
  return all;
}

const Shape& shape_of(char character) {
  const auto found = shapes().find(character);
  return found == shapes().end() ? box : found->second;
}

std::vector<std::vector<Point>> lines_of(const Shape& shape) {
  std::vector<std::vector<Point>> lines;
  std::istringstream words(shape.lines);
  for (std::string word; words >> word;) {
    if (word == "l") {
      lines.emplace_back();
    } else if (word == "a") {
      Point middle, radius;
      double from, to;
      words >> middle.x >> middle.y >> radius.x >> radius.y >> from >> to;
      std::vector<Point>& arc = lines.emplace_back();
      const int steps = static_cast<int>(std::ceil((to - from) / 15));
      for (int i = 0; i <= steps; ++i) {
        const double angle = (from + (to - from) * i / steps) * std::numbers::pi / 180;
        arc.push_back(
            {middle.x + radius.x * std::cos(angle), middle.y + radius.y * std::sin(angle)});
      }
    } else {
      Point point;
      point.x = std::stod(word);
      words >> point.y;
      lines.back().push_back(point);
    }
  }
  return lines;
}

double advance(char character) {
  return (character == ' ' ? space : shape_of(character).width) + gap;
}

}  // namespace

double length_of(const Words& words) {
  double length = -gap;
  for (const char character : words.text) length += advance(character);
  return std::max(0.0, length) * unit * words.size;
}

bool can_be_written(const std::string& text) {
  for (const char character : text) {
    if (character != ' ' && !shapes().contains(character)) return false;
  }
  return true;
}

std::vector<Stroke> strokes_of(const Words& words) {
  const double scale = unit * words.size;
  const double share = words.anchor == Words::Anchor::start    ? 0
                       : words.anchor == Words::Anchor::middle ? 0.5
                                                               : 1;
  double x = words.place.x - share * length_of(words);
  const auto place = [&](Point p) { return Point{x + scale * p.x, words.place.y - scale * p.y}; };
  std::vector<Stroke> strokes;
  for (const char character : words.text) {
    if (character != ' ') {
      for (const std::vector<Point>& line : lines_of(shape_of(character))) {
        for (std::size_t i = 1; i < line.size(); ++i) {
          strokes.push_back(
              {place(line[i - 1]), place(line[i]), weight * words.size, words.colour});
        }
      }
    }
    x += scale * advance(character);
  }
  return strokes;
}

}  // namespace needlework::picture
