#include "src/picture/svg_document.h"

#include <fmt/format.h>

#include <sstream>
#include <vector>

#include "src/scene/printable.h"

namespace needlework::picture {
namespace {

// A part of a text: on the line (0), below it (-1) or above it (1).
struct Run {
  int level = 0;
  std::string text;
};

std::vector<Run> runs_of(const std::string& text) {
  std::vector<Run> runs{{}};
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool opens = (text[i] == '_' || text[i] == '^') && text.compare(i + 1, 1, "{") == 0;
    const std::size_t end = opens ? text.find('}', i) : std::string::npos;
    if (end == std::string::npos) {
      runs.back().text += text[i];
      continue;
    }
    runs.push_back({text[i] == '^' ? 1 : -1, text.substr(i + 2, end - i - 2)});
    runs.push_back({});
    i = end;
  }
  return runs;
}

constexpr double small = 0.72;  // size of what is below or above the line
double lift(int level) { return level > 0 ? 0.4 : level < 0 ? -0.22 : 0; }

void set_text(pugi::xml_node node, const std::string& text) {
  node.append_child(pugi::node_pcdata).set_value(printable(text).c_str());
}

std::size_t characters(const std::string& text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  return count;
}

}  // namespace

std::string pixels(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

void set(pugi::xml_node node, const Attribute& attribute) {
  node.append_attribute(attribute.name).set_value(attribute.value.c_str());
}

pugi::xml_node add(pugi::xml_node parent, const char* name,
                   std::initializer_list<Attribute> attributes) {
  pugi::xml_node node = parent.append_child(name);
  for (const Attribute& attribute : attributes) set(node, attribute);
  return node;
}

void add_text(pugi::xml_node parent, double x, double y, const std::string& text,
              const TextStyle& style) {
  pugi::xml_node node = add(parent, "text", {{"x", x}, {"y", y}, {"font-size", style.size}});
  if (std::string_view(style.anchor) != "start") {
    set(node, {"text-anchor", style.anchor});
  }
  if (style.bold) set(node, {"font-weight", "bold"});
  if (style.turned != 0) {
    set(node,
        {"transform", fmt::format("rotate({} {} {})", pixels(style.turned), pixels(x), pixels(y))});
  }
  set(node, {"fill", style.colour});
  double height = 0;  // above the line, where the last run was
  for (const Run& run : runs_of(text)) {
    if (run.text.empty()) continue;
    const double up = lift(run.level) * style.size;
    if (run.level == 0 && height == 0) {
      set_text(node, run.text);
      continue;
    }
    pugi::xml_node span = add(node, "tspan", {{"dy", height - up}});
    if (run.level != 0) set(span, {"font-size", small * style.size});
    set_text(span, run.text);
    height = up;
  }
}

double text_width(const std::string& text, double size) {
  double width = 0;
  for (const Run& run : runs_of(text)) {
    width += (run.level == 0 ? 1 : small) * static_cast<double>(characters(run.text));
  }
  return 0.55 * size * width;
}

std::string plain_text(const std::string& text) {
  std::string plain;
  for (const Run& run : runs_of(text)) {
    if (run.level > 0) plain += '^';
    plain += run.text;
  }
  return plain;
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
  set_text(add(svg, "title"), plain_text(title));
  set_text(add(svg, "desc"), plain_text(description));
}

std::string SvgDocument::text() const {
  std::ostringstream out;
  document_.save(out, "", pugi::format_default, pugi::encoding_utf8);
  return out.str();
}

}  // namespace needlework::picture
