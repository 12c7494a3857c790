#include "src/picture/drawing.h"

#include <png.h>

#include <array>
#include <stdexcept>

#include "src/picture/raster.h"
#include "src/picture/stroke_font.h"
#include "src/picture/svg_document.h"

namespace needlework::picture {
namespace {

void add_line(pugi::xml_node group, const Stroke& stroke, double width, Colour colour) {
  add(group, "line",
      {{"x1", stroke.from.x},
       {"y1", stroke.from.y},
       {"x2", stroke.to.x},
       {"y2", stroke.to.y},
       {"stroke", colour},
       {"stroke-width", width}});
}

const char* name_of(Words::Anchor anchor) {
  constexpr std::array names{"start", "middle", "end"};
  return names[static_cast<std::size_t>(anchor)];
}

}  // namespace

std::string svg(const Drawing& drawing) {
  const double width = drawing.width, height = drawing.height;
  const SvgDocument document(width, height, drawing.title, drawing.description);
  add(document.root(), "rect", {{"width", width}, {"height", height}, {"fill", drawing.ground}});
  pugi::xml_node group = add(document.root(), "g", {{"stroke-linecap", "round"}});
  for (const Stroke& stroke : drawing.strokes) {
    if (stroke.halo > 0) add_line(group, stroke, stroke.width + 2 * stroke.halo, drawing.ground);
    add_line(group, stroke, stroke.width, stroke.colour);
  }
  for (const Words& words : drawing.words) {
    add_text(document.root(), "text", words.text,
             {{"x", words.place.x},
              {"y", words.place.y},
              {"font-size", words.size},
              {"text-anchor", name_of(words.anchor)},
              {"fill", words.colour}});
  }
  return document.text();
}

std::string png(const Drawing& drawing) {
  Raster raster(drawing.width, drawing.height, drawing.ground);
  for (const Stroke& stroke : drawing.strokes) raster.draw(stroke);
  for (const Words& words : drawing.words) {
    for (const Stroke& stroke : strokes_of(words)) raster.draw(stroke);
  }

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(drawing.width);
  image.height = static_cast<png_uint_32>(drawing.height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, raster.pixels().data(), 0,
                                 nullptr)) {
    throw std::runtime_error(std::string("libpng: ") + image.message);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace needlework::picture
