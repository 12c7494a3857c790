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

/// Appends an element to `parent`, and returns it.
pugi::xml_node add(pugi::xml_node parent, const char* name,
                   std::initializer_list<Attribute> attributes = {});

/// Adds an element with these attributes that holds a text.
void add_text(pugi::xml_node parent, const char* name, const std::string& text,
              std::initializer_list<Attribute> attributes = {});

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
