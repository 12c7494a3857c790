#include "src/picture/svg_document.h"

#include <fmt/format.h>

#include <sstream>

#include "src/scene/printable.h"

namespace needlework::picture {
std::string pixels(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

pugi::xml_node add(pugi::xml_node parent, const char* name,
                   std::initializer_list<Attribute> attributes) {
  pugi::xml_node node = parent.append_child(name);
  for (const Attribute& attribute : attributes) {
    node.append_attribute(attribute.name).set_value(attribute.value.c_str());
  }
  return node;
}

void add_text(pugi::xml_node parent, const char* name, const std::string& text,
              std::initializer_list<Attribute> attributes) {
  // What XML cannot hold, and the name of a file may, is written as an escape sequence.
  add(parent, name, attributes).append_child(pugi::node_pcdata).set_value(printable(text).c_str());
}

SvgDocument::SvgDocument(double width, double height, const std::string& title,
                         const std::string& description) {
  pugi::xml_node svg = add(document_, "svg",
                           {{"xmlns", "http://www.w3.org/2000/svg"},
                            {"width", width},
                            {"height", height},
                            {"viewBox", fmt::format("0 0 {} {}", pixels(width), pixels(height))},
                            {"font-family", "Helvetica, Arial, 'DejaVu Sans', sans-serif"},
                            {"role", "img"}});
  add_text(svg, "title", title);
  add_text(svg, "desc", description);
}

std::string SvgDocument::text() const {
  std::ostringstream out;
  document_.save(out, "", pugi::format_default, pugi::encoding_utf8);
  return out.str();
}

}  // namespace needlework::picture
