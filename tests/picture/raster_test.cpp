#include "src/picture/raster.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>

namespace needlework::picture {
namespace {

constexpr Colour black{}, white{255, 255, 255}, red{255, 0, 0};

// Sum of the brightness of all pixels, as a number of white ones.
double light_of(const Raster& raster) {
  double sum = 0;
  for (const Colour& pixel : raster.pixels()) sum += pixel.green / 255.0;
  return sum;
}

TEST(Raster, CoversAsMuchAsALineIsLongAndWide) {
  for (const Point to : {Point{80, 20}, Point{20, 80}, Point{70, 60}, Point{33.3, 71.9}}) {
    for (const double width : {0.5, 1.0, 2.0, 3.7, 8.0}) {
      Raster raster(100, 100, black);
      raster.draw({{20, 20}, to, width, white});
      const double length = std::hypot(to.x - 20, to.y - 20);
      const double ends = 3.14159 / 4 * width * width;
      EXPECT_NEAR(light_of(raster), width * length + ends, 0.05 * width * length + 1)
          << to.x << " " << to.y << " " << width;
    }
  }
}

TEST(Raster, FillsWholePixelsOfALineBetweenThem) {
  Raster raster(10, 10, black);
  raster.draw({{3, 5}, {7, 5}, 2, white});
  EXPECT_EQ(raster.at(5, 4).red, 255);
  EXPECT_EQ(raster.at(5, 5).red, 255);
  EXPECT_EQ(raster.at(5, 3).red, 0);
  EXPECT_EQ(raster.at(5, 6).red, 0);
}

TEST(Raster, LeavesOutWhatIsOutside) {
  Raster raster(10, 10, black);
  raster.draw({{-50, -3}, {50, -3}, 2, white});
  raster.draw({{1e6, 5}, {2e6, 5}, 2, white});
  raster.draw({{-1e9, -1e9}, {-1e9, 1e9}, 3, white});
  EXPECT_EQ(light_of(raster), 0);
  raster.draw({{-1e6, 5}, {1e6, 5}, 2, white});
  EXPECT_EQ(light_of(raster), 20);
}

TEST(Raster, DrawsAPointAsADisc) {
  Raster raster(20, 20, black);
  raster.draw({{10, 10}, {10, 10}, 8, white});
  EXPECT_NEAR(light_of(raster), 3.14159 * 16, 1);
}

TEST(Raster, LaterLinesHideEarlierOnesAndAHaloClearsAroundThem) {
  Raster raster(20, 20, black);
  raster.draw({{0, 10}, {20, 10}, 10, white});
  raster.draw({{10, 0}, {10, 20}, 2, red, 2});
  EXPECT_EQ(raster.at(9, 10).green, 0);
  EXPECT_EQ(raster.at(9, 10).red, 255);
  EXPECT_EQ(raster.at(7, 10).red, 0);    // the halo
  EXPECT_EQ(raster.at(5, 10).red, 255);  // beyond it
}

TEST(Png, IsReadBackPixelByPixel) {
  Drawing drawing;
  drawing.width = 31;
  drawing.height = 17;
  drawing.ground = {1, 2, 3};
  drawing.strokes = {{{0, 0}, {31, 17}, 3, red}, {{4, 9}, {20, 2}, 1.5, white}};
  const std::string bytes = png(drawing);

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
  EXPECT_EQ(image.width, 31);
  EXPECT_EQ(image.height, 17);
  image.format = PNG_FORMAT_RGB;
  std::vector<Colour> pixels(31 * 17);
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr));
  Raster raster(31, 17, drawing.ground);
  for (const Stroke& stroke : drawing.strokes) raster.draw(stroke);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    EXPECT_EQ(hex(pixels[i]), hex(raster.pixels()[i])) << i;
  }
}

}  // namespace
}  // namespace needlework::picture
