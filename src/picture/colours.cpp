#include "src/picture/colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace needlework::picture {
namespace {

constexpr std::array<Colour, 7> curves{{{0x00, 0x72, 0xb2},
                                        {0xd5, 0x5e, 0x00},
                                        {0x00, 0x9e, 0x73},
                                        {0xcc, 0x79, 0xa7},
                                        {0xe6, 0x9f, 0x00},
                                        {0x56, 0xb4, 0xe9},
                                        {0x33, 0x33, 0x33}}};
// The maps of Matplotlib (CC0) at ten places; between them they are nearly linear.
constexpr std::array<Colour, 10> viridis{{{0x44, 0x01, 0x54},
                                          {0x48, 0x28, 0x78},
                                          {0x3e, 0x49, 0x89},
                                          {0x31, 0x68, 0x8e},
                                          {0x26, 0x82, 0x8e},
                                          {0x1f, 0x9e, 0x89},
                                          {0x35, 0xb7, 0x79},
                                          {0x6e, 0xce, 0x58},
                                          {0xb5, 0xde, 0x2b},
                                          {0xfd, 0xe7, 0x25}}};
constexpr std::array<Colour, 8> plasma{{{0x72, 0x01, 0xa8},
                                        {0x9c, 0x17, 0x9e},
                                        {0xbd, 0x37, 0x86},
                                        {0xd8, 0x57, 0x6b},
                                        {0xed, 0x79, 0x53},
                                        {0xfb, 0x9f, 0x3a},
                                        {0xfd, 0xca, 0x26},
                                        {0xf0, 0xf9, 0x21}}};
constexpr std::array<Colour, 7> blue_to_red{{{0x21, 0x66, 0xac},
                                             {0x67, 0xa9, 0xcf},
                                             {0xd1, 0xe5, 0xf0},
                                             {0xf7, 0xf7, 0xf7},
                                             {0xfd, 0xdb, 0xc7},
                                             {0xef, 0x8a, 0x62},
                                             {0xb2, 0x18, 0x2b}}};

std::uint8_t mixed_part(std::uint8_t first, std::uint8_t second, double share) {
  return static_cast<std::uint8_t>(std::lround(share * first + (1 - share) * second));
}

}  // namespace

std::string hex(Colour colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

Colour mixed(Colour first, Colour second, double share) {
  return {mixed_part(first.red, second.red, share), mixed_part(first.green, second.green, share),
          mixed_part(first.blue, second.blue, share)};
}

bool is_light(Colour colour) {
  // The brightness of a colour by ITU-R BT.601.
  return 0.299 * colour.red + 0.587 * colour.green + 0.114 * colour.blue > 150;
}

Colour curve_colour(std::size_t number) { return curves[number % curves.size()]; }

Gradient sequential_gradient() { return viridis; }
Gradient diverging_gradient() { return blue_to_red; }
Gradient bright_gradient() { return plasma; }

Colour colour_at(Gradient gradient, double share) {
  const double last = static_cast<double>(gradient.size() - 1);
  const double place = std::clamp(share, 0.0, 1.0) * last;
  const auto before = static_cast<std::size_t>(std::min(std::floor(place), last - 1));
  return mixed(gradient[before + 1], gradient[before], place - static_cast<double>(before));
}

}  // namespace needlework::picture
