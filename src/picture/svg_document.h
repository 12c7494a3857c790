// An SVG document, written element by element.
#pragma once

#include <initializer_list>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "src/picture/colours.h"

namespace needlework::picture {

/// A length or place in pixels, to a tenth and without zeros that say nothing.
std::string pixels(double value);

/// A value may be any text: it is escaped when the document is written.
struct Attribute {
  Attribute(const char* name, std::string_view value) : name(name), value(value) {}
  Attribute(const char* name, double value) : name(name), value(pixels(value)) {}
  Attribute(const char* name, Colour value) : name(name), value(hex(value)) {}

  const char* name;
  std::string value;
};

void set(pugi::xml_node node, const Attribute& attribute);

/// Appends an element to `parent`, and returns it.
pugi::xml_node add(pugi::xml_node parent, const char* name,
                   std::initializer_list<Attribute> attributes = {});

struct TextStyle {
  double size = 13;  ///< height of a line is about 1.2 of it [pixels]
  const char* anchor = "start";
  bool bold = false;
  double turned = 0;  ///< degrees, clockwise
  Colour colour{0x22, 0x22, 0x22};
};

/// Adds text, the base line of which is at (x, y), with _{...} below and ^{...} above the line.
void add_text(pugi::xml_node parent, double x, double y, const std::string& text,
              const TextStyle& style = {});

/// About how long a text is, as fonts differ [pixels].
double text_width(const std::string& text, double size);

/// The text without the braces of _{...} and ^{...}.
std::string plain_text(const std::string& text);

class SvgDocument {
 public:
  /// Of this size [pixels], with a title and a description for those who cannot see it.
  SvgDocument(double width, double height, const std::string& title,
              const std::string& description);

  pugi::xml_node root() const { return document_.document_element(); }
  /// The file, as XML 1.0 in UTF-8.
  std::string text() const;

 private:
  pugi::xml_document document_;
};

}  // namespace needlework::picture
