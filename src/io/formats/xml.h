// Strict access to the elements of an XML document: whatever is missing, doubled or unknown is an
// error that names its place.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace needlework::io {

class XmlDocument;

/// An element of a document, which must outlive it.
class XmlElement {
 public:
  XmlElement(const XmlDocument& document, pugi::xml_node node)
      : document_(&document), node_(node) {}

  std::string name() const;

  /// The only child of this name; InputError if there is none, or more than one.
  XmlElement child(const char* name) const;
  /// The first child of this name, and the sibling of the same name after this element.
  std::optional<XmlElement> first(const char* name) const;
  std::optional<XmlElement> next() const;

  bool has(const char* attribute) const;
  /// The text of an attribute; InputError if it is missing or given twice.
  std::string_view text(const char* attribute) const;
  /// A finite number.
  double number(const char* attribute) const;

  /// Throws InputError for attributes and children other than these, and for text.
  void require_only(std::initializer_list<std::string_view> attributes,
                    std::initializer_list<std::string_view> children) const;
  /// Throws InputError if the attribute is not one of these words.
  void require_word(const char* attribute, std::initializer_list<std::string_view> words,
                    std::string_view expected) const;

  /// Throws InputError, "PATH: line N: NAME: WHAT".
  [[noreturn]] void reject(std::string_view what) const;
  /// Throws InputError, "PATH: line N: NAME ATTRIBUTE = VALUE: expected EXPECTED".
  [[noreturn]] void reject(const char* attribute, std::string_view expected) const;

 private:
  const XmlDocument* document_;
  pugi::xml_node node_;
};

/// A document that is well-formed UTF-8 without a document type and so without entities of its own.
class XmlDocument {
 public:
  /// `path` begins messages. Throws InputError if the text is not such a document.
  XmlDocument(std::string text, std::string path);
  XmlDocument(const XmlDocument&) = delete;
  XmlDocument& operator=(const XmlDocument&) = delete;

  /// The element that holds all others; InputError if it has another name.
  XmlElement root(const char* name) const;

 private:
  friend class XmlElement;
  std::string place(std::ptrdiff_t offset) const;

  std::string text_;
  std::string path_;
  pugi::xml_document document_;
};

}  // namespace needlework::io
