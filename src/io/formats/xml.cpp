#include "src/io/formats/xml.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "needlework/error.h"
#include "src/io/decimal.h"
#include "src/io/formats/lines.h"

namespace needlework::io {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr const char* blanks = " \t\r\n";
  const auto begin = std::min(text.find_first_not_of(blanks), text.size());
  return text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

bool contains(std::initializer_list<std::string_view> words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string listed(std::initializer_list<std::string_view> words) {
  return words.size() == 0 ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

std::optional<XmlElement> element(const XmlDocument& document, pugi::xml_node node) {
  return node ? std::optional(XmlElement(document, node)) : std::nullopt;
}

}  // namespace

std::string XmlElement::name() const { return quotation(node_.name()); }

XmlElement XmlElement::child(const char* name) const {
  const auto found = first(name);
  if (!found) reject(fmt::format("{} is missing: expected one", name));
  if (const auto second = found->next()) second->reject("the second: expected one");
  return *found;
}

std::optional<XmlElement> XmlElement::first(const char* name) const {
  return element(*document_, node_.child(name));
}

std::optional<XmlElement> XmlElement::next() const {
  return element(*document_, node_.next_sibling(node_.name()));
}

bool XmlElement::has(const char* attribute) const { return !node_.attribute(attribute).empty(); }

std::string_view XmlElement::text(const char* attribute) const {
  const pugi::xml_attribute found = node_.attribute(attribute);
  if (!found) reject(fmt::format("{} is missing: expected this attribute", attribute));
  for (auto other = found.next_attribute(); other; other = other.next_attribute()) {
    if (std::string_view(other.name()) == attribute) {
      reject(fmt::format("{} is given twice: expected it once", attribute));
    }
  }
  return found.value();
}

double XmlElement::number(const char* attribute) const {
  double value = 0;
  const std::errc error = read_decimal(text(attribute), value);
  if (error == std::errc::result_out_of_range) {
    reject(attribute, "a number that a double can hold");
  }
  if (error != std::errc()) reject(attribute, "a finite number");
  return value;
}

void XmlElement::require_only(std::initializer_list<std::string_view> attributes,
                              std::initializer_list<std::string_view> children) const {
  for (const pugi::xml_attribute attribute : node_.attributes()) {
    if (contains(attributes, attribute.name())) continue;
    reject(fmt::format("attribute {} cannot be carried over: expected {}",
                       quotation(attribute.name()), listed(attributes)));
  }
  for (const pugi::xml_node child : node_.children()) {
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) {
      reject(fmt::format("text '{}': expected elements only", quotation(trimmed(child.value()))));
    }
    if (contains(children, child.name())) continue;
    XmlElement(*document_, child)
        .reject(fmt::format("cannot be carried over: expected {} in {}", listed(children), name()));
  }
}

void XmlElement::require_word(const char* attribute, std::initializer_list<std::string_view> words,
                              std::string_view expected) const {
  if (!contains(words, text(attribute))) reject(attribute, expected);
}

void XmlElement::reject(std::string_view what) const {
  throw InputError(fmt::format("{}: {}: {}", document_->place(node_.offset_debug()), name(), what));
}

void XmlElement::reject(const char* attribute, std::string_view expected) const {
  throw InputError(fmt::format("{}: {} {} = {}: expected {}",
                               document_->place(node_.offset_debug()), name(), attribute,
                               quotation(node_.attribute(attribute).value()), expected));
}

XmlDocument::XmlDocument(std::string text, std::string path)
    : text_(std::move(text)), path_(std::move(path)) {
  const auto result = document_.load_buffer(
      text_.data(), text_.size(), pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
  if (result.status == pugi::status_out_of_memory) {
    throw InputError(path_ + ": too large for the memory of this machine");
  }
  if (!result) {
    throw InputError(
        fmt::format("{}: not well-formed XML: {}", place(result.offset), result.description()));
  }
  for (const pugi::xml_node node : document_.children()) {
    if (node.type() == pugi::node_doctype) {
      throw InputError(path_ + ": a document type (<!DOCTYPE ...>): expected none");
    }
    if (node.type() == pugi::node_element && node != document_.document_element()) {
      XmlElement(*this, node).reject("a second element outside of all others: expected one");
    }
  }
}

XmlElement XmlDocument::root(const char* name) const {
  const XmlElement root(*this, document_.document_element());
  if (root.name() != name) root.reject(fmt::format("expected {}", name));
  return root;
}

std::string XmlDocument::place(std::ptrdiff_t offset) const {
  if (offset < 0) return path_;
  const auto end = text_.begin() + std::min<std::ptrdiff_t>(offset, std::ssize(text_));
  return fmt::format("{}: line {}", path_, 1 + std::count(text_.begin(), end, '\n'));
}

}  // namespace needlework::io
