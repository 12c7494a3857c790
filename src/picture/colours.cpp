#include "src/picture/colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace needlework::picture {
namespace {

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
// Blue and red that grow brighter from a dull middle, and darker from a grey one.
constexpr std::array<Colour, 7> bright_blue_to_red{{{0x8c, 0xd0, 0xff},
                                                    {0x3d, 0x8f, 0xe8},
                                                    {0x35, 0x58, 0x94},
                                                    {0x55, 0x50, 0x5c},
                                                    {0x94, 0x45, 0x38},
                                                    {0xec, 0x6a, 0x3c},
                                                    {0xff, 0xbe, 0x85}}};
constexpr std::array<Colour, 5> dark_blue_to_red{{{0x10, 0x4e, 0x9e},
                                                  {0x5f, 0x9b, 0xcc},
                                                  {0xc8, 0xc8, 0xc8},
                                                  {0xe0, 0x7f, 0x5c},
                                                  {0xa5, 0x10, 0x25}}};

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

Gradient sequential_gradient(bool dark_ground) {
  // Without the part that is lost on the ground.
  return dark_ground ? Gradient(plasma) : Gradient(viridis).first(8);
}

Gradient diverging_gradient(bool dark_ground) {
  return dark_ground ? Gradient(bright_blue_to_red) : Gradient(dark_blue_to_red);
}

Colour colour_at(Gradient gradient, double share) {
  const double last = static_cast<double>(gradient.size() - 1);
  const double place = std::clamp(share, 0.0, 1.0) * last;
  const auto before = static_cast<std::size_t>(std::min(std::floor(place), last - 1));
  return mixed(gradient[before + 1], gradient[before], place - static_cast<double>(before));
}

}  // namespace needlework::picture
